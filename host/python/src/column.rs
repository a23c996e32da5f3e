//! A column of values that numpy and data frames share without copying.

use std::{
    collections::HashMap,
    ffi::{CStr, c_int, c_void},
    sync::Arc,
};

use arrow_array::{
    Array, ArrayRef, BooleanArray, DictionaryArray, Float64Array, Int32Array, Int64Array, StringArray,
    ffi::{FFI_ArrowArray, FFI_ArrowSchema, to_ffi},
    types::Int32Type,
};
use arrow_buffer::NullBuffer;
use arrow_schema::{DataType, Field};
use pyo3::{
    IntoPyObjectExt,
    exceptions::{PyBufferError, PyIndexError, PyValueError},
    ffi,
    prelude::*,
    types::{PyBool, PyBytes, PyCapsule, PyInt, PyIterator, PyList, PySlice, PyString},
};
use slipfit::show::columns::{self, Values, Words};

/// Values that do not change: numbers, whole numbers, true and false, or words.
///
/// numpy.asarray(column) shares the memory of numbers, which are NaN where there is none. Libraries that take Arrow arrays share
/// it, too, and see what is missing as null.
#[pyclass(frozen, sequence, module = "slipfit")]
pub struct Column {
    /// Its name, as the first line of a CSV file has it.
    #[pyo3(get)]
    name: String,
    /// Its unit, "" if there is none.
    #[pyo3(get)]
    unit: String,
    array: ArrayRef,
    /// Number of values and bytes of each, as buffers state them.
    shape: [isize; 2],
}

/// Kinds of values.
const NUMBERS: &str = "numbers";
const COUNTS: &str = "counts";
const FLAGS: &str = "flags";
const WORDS: &str = "words";
/// Bytes of a number.
const BYTES: usize = size_of::<f64>();

impl Column {
    /// A column of the program.
    pub fn of(column: columns::Column) -> Self {
        let columns::Column { name, unit, values } = column;
        let array: ArrayRef = match values {
            Values::Numbers(numbers) => Arc::new(numbers_of(numbers)),
            // Signed, as differences of them are: no count of a file is beyond 2^63.
            Values::Counts(numbers) => Arc::new(Int64Array::from_iter_values(numbers.into_iter().map(|n| n as i64))),
            Values::Flags(flags) => Arc::new(BooleanArray::from(flags)),
            Values::Words(Words { kinds, rows }) => {
                let kinds = Arc::new(StringArray::from(kinds));
                // Every row has a kind, so that this cannot fail.
                Arc::new(DictionaryArray::<Int32Type>::new(Int32Array::from(rows), kinds))
            }
        };
        let shape = [array.len() as isize, BYTES as isize];
        Self { name, unit, array, shape }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Name, kind and unit.
    pub fn field(&self) -> Field {
        let unit = (!self.unit.is_empty()).then(|| ("unit".to_owned(), self.unit.clone()));
        let kind = self.array.data_type().clone();
        Field::new(&self.name, kind, true).with_metadata(unit.into_iter().collect::<HashMap<_, _>>())
    }

    /// Its values.
    pub fn array(&self) -> ArrayRef {
        self.array.clone()
    }

    /// The numbers in memory, and the letter by which buffers call their kind.
    fn numbers(&self) -> Option<(*const c_void, &'static CStr)> {
        let any = self.array.as_any();
        let float = any.downcast_ref().map(|array: &Float64Array| (array.values().as_ptr().cast(), c"d"));
        float.or_else(|| any.downcast_ref().map(|array: &Int64Array| (array.values().as_ptr().cast(), c"q")))
    }

    fn value<'py>(&self, py: Python<'py>, row: usize) -> PyResult<Bound<'py, PyAny>> {
        let any = self.array.as_any();
        if self.array.is_null(row) {
            return Ok(py.None().into_bound(py));
        }
        if let Some(array) = any.downcast_ref::<Float64Array>() {
            return array.value(row).into_bound_py_any(py);
        }
        if let Some(array) = any.downcast_ref::<Int64Array>() {
            return array.value(row).into_bound_py_any(py);
        }
        if let Some(array) = any.downcast_ref::<BooleanArray>() {
            return array.value(row).into_bound_py_any(py);
        }
        let words = any.downcast_ref::<DictionaryArray<Int32Type>>();
        let word = words.and_then(|words| {
            let kinds = words.values().as_any().downcast_ref::<StringArray>()?;
            Some(kinds.value(words.keys().value(row) as usize))
        });
        word.into_bound_py_any(py)
    }
}

impl PartialEq for Column {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.unit == other.unit && self.array.as_ref() == other.array.as_ref()
    }
}

/// Numbers, those that are NaN as missing ones.
fn numbers_of(numbers: Vec<f64>) -> Float64Array {
    let missing = numbers.iter().any(|number| number.is_nan());
    let nulls = missing.then(|| NullBuffer::from_iter(numbers.iter().map(|number| !number.is_nan())));
    Float64Array::new(numbers.into(), nulls)
}

/// What `values` have to be for a column of this `kind`, or of the kind that they seem to have.
fn values_of(values: &Bound<'_, PyAny>, kind: Option<&str>) -> PyResult<Values> {
    let wrong = |_| {
        PyValueError::new_err(
            "a column has numbers, whole numbers, true and false, or words; allowed is a list of one kind",
        )
    };
    let text = values.is_instance_of::<PyString>() || values.is_instance_of::<PyBytes>();
    let list = if values.hasattr("tolist")? { values.call_method0("tolist")? } else { values.clone() };
    let all: Vec<Bound<'_, PyAny>> = list.extract().map_err(wrong)?;
    let flags = all.iter().filter(|one| one.is_instance_of::<PyBool>()).count();
    let kind = match kind {
        Some(kind) => kind,
        None if all.is_empty() => NUMBERS,
        None if flags == all.len() => FLAGS,
        None if all.iter().any(|one| one.is_instance_of::<PyString>()) => WORDS,
        None if all.iter().all(|one| one.is_instance_of::<PyInt>() && one.extract::<u64>().is_ok()) => COUNTS,
        None => NUMBERS,
    };
    // Python counts true as 1.
    if text || (flags > 0 && kind != FLAGS) {
        return Err(wrong(PyValueError::new_err(())));
    }
    Ok(match kind {
        FLAGS => Values::Flags(list.extract().map_err(wrong)?),
        COUNTS => {
            let counts: Vec<u64> = list.extract().map_err(wrong)?;
            if counts.iter().any(|count| i64::try_from(*count).is_err()) {
                return Err(PyValueError::new_err("a column has a whole number beyond 2^63; allowed are smaller ones"));
            }
            Values::Counts(counts)
        }
        WORDS => Values::Words(list.extract::<Vec<Option<String>>>().map_err(wrong)?.into_iter().collect()),
        NUMBERS => {
            let numbers: Vec<Option<f64>> = list.extract().map_err(wrong)?;
            Values::Numbers(numbers.into_iter().map(|number| number.unwrap_or(f64::NAN)).collect())
        }
        other => {
            let message = format!("a column's kind is {other:?}, allowed is {NUMBERS}, {COUNTS}, {FLAGS} or {WORDS}");
            return Err(PyValueError::new_err(message));
        }
    })
}

#[pymethods]
impl Column {
    /// Numbers, whole numbers, true and false, or words; None where there is none. The values tell the `kind`, if it is not given.
    #[new]
    #[pyo3(signature = (values, name = "", unit = "", kind = None))]
    fn new(values: &Bound<'_, PyAny>, name: &str, unit: &str, kind: Option<&str>) -> PyResult<Self> {
        let values = values_of(values, kind)?;
        Ok(Self::of(columns::Column { name: name.into(), unit: unit.into(), values }))
    }

    /// What it has: "numbers", "counts" (whole numbers from 0 on), "flags" (true and false) or "words".
    #[getter]
    fn kind(&self) -> &'static str {
        match self.array.data_type() {
            DataType::Float64 => NUMBERS,
            DataType::Int64 => COUNTS,
            DataType::Boolean => FLAGS,
            _ => WORDS,
        }
    }

    fn __len__(&self) -> usize {
        self.array.len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.tolist(py)?.try_iter()
    }

    /// A value, or for a slice a list of them.
    fn __getitem__<'py>(&self, py: Python<'py>, index: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        if index.is_instance_of::<PySlice>() {
            return self.tolist(py)?.as_any().get_item(index);
        }
        let index: isize = index.extract()?;
        let count = self.array.len();
        let at = if index < 0 { index + count as isize } else { index };
        match usize::try_from(at).ok().filter(|at| *at < count) {
            Some(at) => self.value(py, at),
            None => Err(PyIndexError::new_err(format!("{index} is not in a column of {count}"))),
        }
    }

    fn __repr__(&self) -> String {
        format!("<Column {:?} of {} values>", self.name, self.array.len())
    }

    fn __eq__(&self, other: &Self) -> bool {
        self == other
    }

    /// The values as a list, None where there is none.
    pub fn tolist<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let values = (0..self.array.len()).map(|row| self.value(py, row)).collect::<PyResult<Vec<_>>>()?;
        PyList::new(py, values)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let (py, own) = (slf.py(), slf.get());
        (slf.get_type(), (own.tolist(py)?, &own.name, &own.unit, own.kind())).into_bound_py_any(py)
    }

    /// The Arrow PyCapsule interface: schema and array. Nothing is copied.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_array__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyCapsule>, Bound<'py, PyCapsule>)> {
        // Whoever wants another kind casts by itself, as the interface allows.
        drop(requested_schema);
        let failed = |error: arrow_schema::ArrowError| PyValueError::new_err(error.to_string());
        let (array, _) = to_ffi(&self.array.to_data()).map_err(failed)?;
        let schema = FFI_ArrowSchema::try_from(&self.field()).map_err(failed)?;
        Ok((capsule(py, schema, c"arrow_schema")?, capsule::<FFI_ArrowArray>(py, array, c"arrow_array")?))
    }

    /// # Safety
    /// Python passes a `view` to fill in.
    unsafe fn __getbuffer__(slf: Bound<'_, Self>, view: *mut ffi::Py_buffer, flags: c_int) -> PyResult<()> {
        if view.is_null() {
            return Err(PyBufferError::new_err("there is no view to fill in"));
        }
        // SAFETY: `view` is valid by the protocol, which asks for no object where an exception is raised.
        unsafe { (*view).obj = std::ptr::null_mut() };
        let own = slf.get();
        let Some((start, kind)) = own.numbers() else {
            return Err(PyBufferError::new_err(
                "a column of words, or of true and false, has no buffer: tolist() has them",
            ));
        };
        if flags & ffi::PyBUF_WRITABLE == ffi::PyBUF_WRITABLE {
            return Err(PyBufferError::new_err("a column is read-only"));
        }
        let wanted = |flag: c_int| flags & flag == flag;
        let [count, stride] = own.shape.each_ref().map(|number| std::ptr::from_ref(number).cast_mut());
        // SAFETY: `view` is valid by the protocol. Values and shape live as long as the object, which `view` owns.
        unsafe {
            (*view).buf = start.cast_mut();
            (*view).len = own.shape[0] * own.shape[1];
            (*view).itemsize = own.shape[1];
            (*view).readonly = 1;
            (*view).ndim = 1;
            (*view).format = if wanted(ffi::PyBUF_FORMAT) { kind.as_ptr().cast_mut() } else { std::ptr::null_mut() };
            (*view).shape = if wanted(ffi::PyBUF_ND) { count } else { std::ptr::null_mut() };
            (*view).strides = if wanted(ffi::PyBUF_STRIDES) { stride } else { std::ptr::null_mut() };
            (*view).suboffsets = std::ptr::null_mut();
            (*view).internal = std::ptr::null_mut();
            (*view).obj = slf.into_ptr();
        }
        Ok(())
    }
}

/// Something that Arrow's libraries take over by a pointer, under its name.
pub fn capsule<'py, T: 'static + Send>(
    py: Python<'py>,
    value: T,
    name: &'static CStr,
) -> PyResult<Bound<'py, PyCapsule>> {
    PyCapsule::new_with_value(py, value, name)
}
