//! The compiled part of the Python module `slipfit`: commands as functions, columns as buffers.
//!
//! It computes nothing itself. Each command goes through [`slipfit::cli::call`], like those of the command line.
#![allow(unsafe_code, reason = "Python's buffers are pointers; column.rs alone has them")]

mod column;
mod value;

use std::{
    ffi::OsString,
    sync::{
        Mutex, PoisonError,
        mpsc::{RecvTimeoutError, channel},
    },
    thread,
    time::Duration,
};

use pyo3::{prelude::*, types::PyList};
use slipfit::{
    cli::{self, Answer, Failure},
    system::interrupt,
};

/// How often a running command looks for Ctrl-C.
const LOOK: Duration = Duration::from_millis(20);

/// An exception of the module `slipfit._errors` with these arguments.
fn error<'py>(py: Python<'py>, name: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let class = py.import("slipfit._errors").and_then(|errors| errors.getattr(name));
    match class.and_then(|class| class.call1(arguments)) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

fn raise(py: Python<'_>, failure: &Failure) -> PyErr {
    match failure {
        Failure::Scene(scene) => {
            let places = scene.problems().zip(scene.places());
            let problems: Vec<_> =
                places.map(|(problem, at)| (problem.to_string(), at.file, at.line, at.column, at.allowed)).collect();
            error(py, "SceneError", (scene.render(false), problems))
        }
        Failure::Input(why) => error(py, "InputError", (why,)),
        Failure::Work(_) => error(py, "WorkError", (failure.to_string(),)),
    }
}

/// Runs a command and returns `(value, text, warnings)`: the object that `--json` prints, or `None`; other output; warnings.
///
/// The GIL is released. Ctrl-C stops all commands that run in this process and raises `KeyboardInterrupt`.
#[pyfunction]
fn call(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<(Py<PyAny>, String, Vec<String>)> {
    let (send, receive) = channel();
    let work = thread::Builder::new().name("slipfit".into()).spawn(move || {
        // Nobody listens only if the interpreter is gone.
        let _ = send.send(cli::call(arguments));
    })?;
    // A receiver alone cannot be looked at from where the GIL is released.
    let receive = Mutex::new(receive);
    let wait = || receive.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK);
    let mut signal = None;
    let result = loop {
        match py.detach(wait) {
            Ok(result) => break Some(result),
            Err(RecvTimeoutError::Disconnected) => break None,
            Err(RecvTimeoutError::Timeout) if signal.is_none() => {
                if let Err(raised) = py.check_signals() {
                    signal = Some(raised);
                    interrupt::request();
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
    };
    // A panic has been reported where the channel closed without a result.
    drop(work.join());
    if let Some(raised) = signal {
        interrupt::clear();
        return Err(raised);
    }
    match result {
        Some(Ok(Answer { value: found, text, warnings })) => {
            let found = found.map(|found| value::to_python(py, &found)).transpose()?;
            Ok((found.map_or_else(|| py.None(), Bound::unbind), text, warnings))
        }
        Some(Err(failure)) => Err(raise(py, &failure)),
        None => Err(error(py, "WorkError", ("slipfit stopped by an internal error; see standard error",))),
    }
}

/// Runs the command line `arguments`, the program's name first. Returns the exit code.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cli::run(arguments))
}

/// The names of the shipped scenes.
#[pyfunction]
fn shipped(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    PyList::new(py, slipfit::scene::SHIPPED.iter().map(|(name, _)| *name))
}

#[pymodule]
fn _slipfit(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<column::Column>()?;
    module.add_function(wrap_pyfunction!(call, module)?)?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(shipped, module)?)
}
