//! The compiled part of the Python module `slipfit`: commands as functions, columns that numpy and data frames share.
//!
//! It computes nothing itself. Each command goes through [`slipfit::cli::call`], like those of the command line.
#![allow(unsafe_code, reason = "Python's buffers are pointers; column.rs alone has them")]

mod column;
mod columns;

use std::{
    ffi::OsString,
    sync::{
        Mutex, PoisonError,
        mpsc::{Receiver, RecvTimeoutError, channel},
    },
    thread,
    time::Duration,
};

use pyo3::{
    call::PyCallArgs,
    prelude::*,
    types::{IntoPyDict, PyDict},
};
use slipfit::{
    cli::{
        self, Failure,
        call::{Answer, Call, Progress, Want},
    },
    system::interrupt::Stop,
};

use self::{column::Column, columns::Columns};

/// How often a running command looks for Ctrl-C and reports its progress.
const LOOK: Duration = Duration::from_millis(20);

/// An exception of the module `slipfit._errors` with these arguments.
fn error<'py>(py: Python<'py>, name: &str, arguments: impl PyCallArgs<'py>) -> PyErr {
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

/// What a command returns: what it prints; warnings that are not in JSON; columns; draws; names and texts of pictures.
type Returned = (String, Vec<String>, Option<Columns>, Option<Columns>, Vec<(String, String)>);

/// Runs a command, whose name and options are `arguments`.
///
/// `scene` is the text of the scene, if it is not in a file. `columns` and `draws` say whether those of `--csv` and `--draws` are
/// wanted, `pictures` whether those of `--plot` and `--plots` are. `progress` is called with what is done, how much of it, and of how
/// much (None if that is not known); whatever it raises stops this command.
///
/// Other Python threads go on. Ctrl-C in the main thread stops the command that it waits for and raises KeyboardInterrupt.
#[pyfunction]
#[pyo3(signature = (arguments, scene = None, columns = false, draws = false, pictures = false, progress = None))]
fn call(
    py: Python<'_>,
    arguments: Vec<OsString>,
    scene: Option<String>,
    columns: bool,
    draws: bool,
    pictures: bool,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Returned> {
    let wanted = [(Want::Columns, columns), (Want::Draws, draws), (Want::Pictures, pictures)];
    let wanted = wanted.into_iter().filter(|(_, wanted)| *wanted).map(|(want, _)| want).collect();
    let call = Call::new(arguments, scene, wanted);
    let (send, receive) = channel();
    let running = call.clone();
    let work = thread::Builder::new().name("slipfit".into()).spawn(move || {
        // Nobody listens only if the interpreter is gone.
        let _ = send.send(cli::answer(&running));
    })?;
    let mut told = None;
    let mut tell = || {
        let now = call.progress();
        if let (Some(tell), Some(Progress { what, done, of }), true) = (&progress, &now, now != told) {
            tell.call1((what, *done, *of))?;
        }
        told = now;
        PyResult::Ok(())
    };
    let result = wait(py, receive, call.stop(), || py.check_signals().and_then(|()| tell()));
    // What has been done since it was last told.
    if let Ok(Some(Ok(_))) = &result {
        tell()?;
    }
    // A panic has been reported where the channel closed without a result.
    let panicked = py.detach(|| work.join().is_err());
    match result? {
        _ if panicked => Err(error(py, "WorkError", ("slipfit stopped by an internal error; see standard error",))),
        None => Err(error(py, "WorkError", ("slipfit stopped without a result",))),
        Some(Err(failure)) => Err(raise(py, &failure)),
        Some(Ok(Answer { text, warnings, columns, draws, pictures })) => {
            let of =
                |columns: Option<slipfit::show::columns::Columns>| columns.map(|all| Columns::of(py, all)).transpose();
            Ok((text, warnings, of(columns)?, of(draws)?, pictures))
        }
    }
}

/// What a thread sends; `None` if it ends without. Meanwhile `look` is called again and again; where it fails, the work is stopped.
fn wait<T: Send>(
    py: Python<'_>,
    receive: Receiver<T>,
    stop: &Stop,
    mut look: impl FnMut() -> PyResult<()>,
) -> PyResult<Option<T>> {
    // A receiver alone cannot be shared with where Python's lock is released.
    let receive = Mutex::new(receive);
    let next = || receive.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK);
    let mut stopped = None;
    let result = loop {
        match py.detach(next) {
            Ok(result) => break Some(result),
            Err(RecvTimeoutError::Disconnected) => break None,
            Err(RecvTimeoutError::Timeout) if stopped.is_none() => {
                if let Err(raised) = look() {
                    stopped = Some(raised);
                    stop.request();
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
    };
    match stopped {
        None => Ok(result),
        Some(raised) => Err(raised),
    }
}

/// Runs the command line `arguments`, the program's name first. Returns the exit code.
///
/// `program` starts the command line again, for commands that work in processes of their own.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>, program: Vec<OsString>) -> u8 {
    py.detach(|| cli::run(arguments, &program))
}

/// The shipped scenes: names and texts.
#[pyfunction]
fn shipped(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    slipfit::scene::SHIPPED.into_py_dict(py)
}

/// An argument: its name, what its value is called (`None` if it has none), help, whether it may be repeated, and whether it has no
/// option but a place.
type Argument = (String, Option<String>, String, bool, bool);

/// The names of the commands, what each does, and its arguments.
#[pyfunction]
fn commands() -> Vec<(String, String, Vec<Argument>)> {
    let text = |text: Option<&clap::builder::StyledStr>| text.map(ToString::to_string).unwrap_or_default();
    let described = |argument: &clap::Arg| {
        let value = argument.get_action().takes_values().then(|| {
            let names = argument.get_value_names().unwrap_or_default();
            names.first().map(ToString::to_string).unwrap_or_default()
        });
        let repeated = matches!(argument.get_action(), clap::ArgAction::Append);
        let name = argument.get_long().unwrap_or(argument.get_id().as_str());
        let mut help = text(argument.get_long_help().or(argument.get_help()));
        let values: Vec<_> = argument.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
        if !values.is_empty() && argument.get_action().takes_values() {
            help = format!("{}. Allowed: {}", help.trim_end_matches('.'), values.join(", "));
        }
        if let [default] = argument.get_default_values()
            && argument.get_action().takes_values()
        {
            help = format!("{}. If not given: {}", help.trim_end_matches('.'), default.to_string_lossy());
        }
        (name.to_owned(), value, help, repeated, argument.is_positional())
    };
    let command = |command: &clap::Command| {
        let all = command.get_arguments().filter(|argument| !argument.is_hide_set()).map(described).collect();
        (command.get_name().to_owned(), text(command.get_long_about().or(command.get_about())), all)
    };
    cli::command().get_subcommands().map(command).collect()
}

#[pymodule(gil_used = false)]
fn _slipfit(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<Column>()?;
    module.add_class::<Columns>()?;
    module.add_function(wrap_pyfunction!(call, module)?)?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(commands, module)?)?;
    module.add_function(wrap_pyfunction!(shipped, module)?)
}
