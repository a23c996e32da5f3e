//! A column of numbers that numpy and others share without copying.

use std::ffi::{c_int, c_void};

use pyo3::{
    exceptions::{PyBufferError, PyIndexError},
    ffi,
    prelude::*,
};

/// Numbers (f64) that do not change. `numpy.asarray(column)` shares their memory.
#[pyclass(frozen, module = "slipfit._slipfit", eq)]
#[derive(PartialEq)]
pub struct Column(Box<[f64]>, [isize; 2]);

impl Column {
    /// Of these numbers.
    pub fn of(numbers: Vec<f64>) -> Self {
        let count = numbers.len() as isize;
        Self(numbers.into(), [count, size_of::<f64>() as isize])
    }
}

#[pymethods]
impl Column {
    #[new]
    fn new(numbers: Vec<f64>) -> Self {
        Self::of(numbers)
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __getitem__(&self, index: isize) -> PyResult<f64> {
        let count = self.0.len() as isize;
        let at = if index < 0 { index + count } else { index };
        let found = usize::try_from(at).ok().and_then(|at| self.0.get(at));
        found.copied().ok_or_else(|| PyIndexError::new_err(format!("{index} is not in a column of {count}")))
    }

    fn __repr__(&self) -> String {
        format!("<Column of {} numbers>", self.0.len())
    }

    /// The numbers as a list.
    fn tolist(&self) -> Vec<f64> {
        self.0.to_vec()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, (Vec<f64>,)) {
        (slf.get_type().into_any(), (slf.get().tolist(),))
    }

    /// # Safety
    /// Python passes a `view` to fill in.
    unsafe fn __getbuffer__(slf: Bound<'_, Self>, view: *mut ffi::Py_buffer, flags: c_int) -> PyResult<()> {
        if view.is_null() || flags & ffi::PyBUF_WRITABLE == ffi::PyBUF_WRITABLE {
            return Err(PyBufferError::new_err("a column is read-only"));
        }
        let Self(numbers, shape) = slf.get();
        let wanted = |flag: c_int| flags & flag == flag;
        // SAFETY: `view` is valid by the protocol. Numbers and shape live as long as the object, which `view` owns.
        unsafe {
            (*view).buf = numbers.as_ptr().cast_mut().cast::<c_void>();
            (*view).len = size_of_val(&**numbers) as isize;
            (*view).itemsize = size_of::<f64>() as isize;
            (*view).readonly = 1;
            (*view).ndim = 1;
            (*view).format = if wanted(ffi::PyBUF_FORMAT) { c"d".as_ptr().cast_mut() } else { std::ptr::null_mut() };
            let [count, stride] = shape.each_ref().map(|number| std::ptr::from_ref(number).cast_mut());
            (*view).shape = if wanted(ffi::PyBUF_ND) { count } else { std::ptr::null_mut() };
            (*view).strides = if wanted(ffi::PyBUF_STRIDES) { stride } else { std::ptr::null_mut() };
            (*view).suboffsets = std::ptr::null_mut();
            (*view).internal = std::ptr::null_mut();
            (*view).obj = slf.into_ptr();
        }
        Ok(())
    }
}
