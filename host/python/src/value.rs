//! Results as Python objects.

use pyo3::{
    IntoPyObjectExt,
    prelude::*,
    types::{PyDict, PyList},
};
use serde_json::Value;

use crate::column::Column;

/// `value` as dict, list, str, number, bool or None. Samples become a dict of columns by their names.
///
/// # Errors
/// Where Python has no memory left.
pub fn to_python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::Null => Ok(py.None().into_bound(py)),
        Value::Bool(one) => one.into_bound_py_any(py),
        Value::Number(number) => match (number.as_u64(), number.as_i64()) {
            (Some(whole), _) => whole.into_bound_py_any(py),
            (_, Some(whole)) => whole.into_bound_py_any(py),
            _ => number.as_f64().unwrap_or(f64::NAN).into_bound_py_any(py),
        },
        Value::String(text) => text.into_bound_py_any(py),
        Value::Array(all) => {
            let list = PyList::empty(py);
            for one in all {
                list.append(to_python(py, one)?)?;
            }
            Ok(list.into_any())
        }
        Value::Object(entries) => {
            let dict = PyDict::new(py);
            for (key, one) in entries {
                let names = entries.get("columns").and_then(Value::as_array);
                match (key.as_str(), one, names) {
                    ("samples", Value::Object(columns), _) => {
                        let samples = PyDict::new(py);
                        for (name, numbers) in columns {
                            samples.set_item(name, column(numbers.as_array().into_iter().flatten()))?;
                        }
                        dict.set_item(key, samples)?;
                    }
                    ("samples", Value::Array(rows), Some(names)) => {
                        let samples = PyDict::new(py);
                        for (k, name) in names.iter().enumerate() {
                            let numbers = rows.iter().map(|row| row.get(k).unwrap_or(&Value::Null));
                            samples.set_item(name.as_str().unwrap_or_default(), column(numbers))?;
                        }
                        dict.set_item(key, samples)?;
                    }
                    _ => dict.set_item(key, to_python(py, one)?)?,
                }
            }
            Ok(dict.into_any())
        }
    }
}

/// Numbers, NaN where there is none.
fn column<'a>(numbers: impl Iterator<Item = &'a Value>) -> Column {
    Column::of(numbers.map(|number| number.as_f64().unwrap_or(f64::NAN)).collect())
}
