//! Columns of a result.

use std::sync::Arc;

use arrow_array::{RecordBatch, RecordBatchIterator, RecordBatchOptions, ffi_stream::FFI_ArrowArrayStream};
use arrow_schema::{ArrowError, Schema};
use pyo3::{
    IntoPyObjectExt,
    exceptions::{PyKeyError, PyTypeError, PyValueError},
    prelude::*,
    types::{PyCapsule, PyDict, PyIterator, PyList, PyTuple},
};
use slipfit::show::columns;

use crate::column::{Column, capsule};

/// Columns of equal length, in their order. A mapping of names to columns.
///
/// A name may leave out its unit in parentheses. polars.DataFrame(columns), pyarrow.table(columns) and other libraries that take
/// Arrow streams share the memory of the numbers.
#[pyclass(frozen, mapping, module = "slipfit")]
pub struct Columns(Vec<Py<Column>>);

impl Columns {
    /// Columns of the program.
    ///
    /// # Errors
    /// Where Python has no memory left.
    pub fn of(py: Python<'_>, columns: columns::Columns) -> PyResult<Self> {
        columns.0.into_iter().map(|column| Py::new(py, Column::of(column))).collect::<PyResult<_>>().map(Self)
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|column| column.get().name())
    }
}

/// A name without its unit.
fn bare(name: &str) -> &str {
    name.strip_suffix(')').and_then(|start| start.rsplit_once(" (")).map_or(name, |(start, _)| start)
}

#[pymethods]
impl Columns {
    /// Of a list of columns, all equally long.
    #[new]
    fn new(columns: Vec<Py<Column>>) -> PyResult<Self> {
        let mut lengths = columns.iter().map(|column| column.get().array().len());
        let first = lengths.next();
        match lengths.any(|length| Some(length) != first) {
            true => Err(PyValueError::new_err("columns are not equally long")),
            false => Ok(Self(columns)),
        }
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Py<Column>> {
        let mut found = self.0.iter().filter(|column| column.get().name() == name);
        let mut without_unit = self.0.iter().filter(|column| bare(column.get().name()) == name);
        match (found.next(), without_unit.next(), without_unit.next()) {
            (Some(column), ..) | (None, Some(column), None) => Ok(column.clone_ref(py)),
            (None, Some(_), Some(_)) => {
                Err(PyKeyError::new_err(format!("{name:?} is several columns; state the unit")))
            }
            (None, None, _) => {
                let names: Vec<_> = self.names().collect();
                Err(PyKeyError::new_err(format!("there is no column {name:?}, there is {}", names.join(", "))))
            }
        }
    }

    fn __contains__(&self, name: &Bound<'_, PyAny>) -> bool {
        let name = name.extract::<&str>();
        name.is_ok_and(|name| self.names().any(|own| own == name || bare(own) == name))
    }

    /// Refuses to be one array, of which numpy and pandas would make the names.
    #[pyo3(signature = (*_arguments, **_keywords))]
    fn __array__(&self, _arguments: &Bound<'_, PyTuple>, _keywords: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        Err(PyTypeError::new_err(
            "columns are not one array: allowed are columns[name] for numpy, columns.to_pandas(), and libraries that take Arrow streams",
        ))
    }

    /// A pandas.DataFrame of Arrow's types, which shares the memory. pandas and pyarrow have to be installed.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let types = PyDict::new(py);
        types.set_item("types_mapper", py.import("pandas")?.getattr("ArrowDtype")?)?;
        py.import("pyarrow")?.call_method1("table", (slf,))?.call_method("to_pandas", (), Some(&types))
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, self.names())?.try_iter()
    }

    /// The names, in order.
    fn keys<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, self.names())
    }

    /// The columns, in order.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, &self.0)
    }

    /// Names and columns, in order.
    fn items<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, self.names().zip(&self.0))
    }

    /// Number of values of each column.
    #[getter]
    fn rows(&self) -> usize {
        self.0.first().map_or(0, |column| column.get().array().len())
    }

    /// A dict of names and lists.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for column in &self.0 {
            dict.set_item(column.get().name(), column.get().tolist(py)?)?;
        }
        Ok(dict)
    }

    fn __repr__(&self) -> String {
        let names: Vec<_> = self.names().collect();
        format!("<Columns of {} rows: {}>", self.rows(), names.join(", "))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.0.len() == other.0.len() && self.0.iter().zip(&other.0).all(|(one, other)| one.get() == other.get())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        (slf.get_type(), (slf.get().values(slf.py())?,)).into_bound_py_any(slf.py())
    }

    /// The Arrow PyCapsule interface: a stream of one batch. Nothing is copied.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // Whoever wants other kinds casts by itself, as the interface allows.
        drop(requested_schema);
        let fields: Vec<_> = self.0.iter().map(|column| column.get().field()).collect();
        let schema = Arc::new(Schema::new(fields));
        let arrays = self.0.iter().map(|column| column.get().array()).collect();
        let failed = |error: ArrowError| PyValueError::new_err(error.to_string());
        let options = RecordBatchOptions::new().with_row_count(Some(self.rows()));
        let batch = RecordBatch::try_new_with_options(schema.clone(), arrays, &options).map_err(failed)?;
        let stream = FFI_ArrowArrayStream::new(Box::new(RecordBatchIterator::new([Ok(batch)], schema)));
        capsule(py, stream, c"arrow_array_stream")
    }
}
