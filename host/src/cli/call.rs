//! Commands as functions: what another program passes to a command, and what it gets instead of output on the terminal.

use std::{
    cell::RefCell,
    ffi::OsString,
    path::Path,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use indicatif::ProgressBar;
use slipfit_system::{
    files,
    interrupt::{self, Stop},
};

use super::failure::Failure;
use crate::show::{columns::Columns, plot::PlotError};

/// A command that another program calls.
pub struct Call {
    arguments: Vec<OsString>,
    scene: Option<String>,
    wanted: Vec<Want>,
    stop: Stop,
    answer: Mutex<Answer>,
    bar: Mutex<Option<ProgressBar>>,
}

/// What commands have beside what they print.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    /// The columns of the option `--csv`.
    Columns,
    /// The columns of the option `--draws`.
    Draws,
    /// The pictures of the options `--plot` and `--plots`.
    Pictures,
}

/// What a command returns.
#[derive(Debug, Default)]
pub struct Answer {
    /// What the command prints on standard output.
    pub text: String,
    /// Warnings that are not in the JSON output.
    pub warnings: Vec<String>,
    /// The columns of `--csv`, if they are wanted and the command has them.
    pub columns: Option<Columns>,
    /// The columns of `--draws`, likewise.
    pub draws: Option<Columns>,
    /// Names and texts (SVG) of the pictures, if they are wanted. Commands that draw nothing, or not of such a scene, have none.
    pub pictures: Vec<(String, String)>,
}

/// How far a command is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What it does.
    pub what: String,
    /// How much is done, in units, levels or samples.
    pub done: u64,
    /// Of how much; `None` if that is not known.
    pub of: Option<u64>,
}

thread_local! {
    /// The call that this thread works on; `None` if it works for the command line.
    static CURRENT: RefCell<Option<Arc<Call>>> = const { RefCell::new(None) };
}

impl Call {
    /// Of `arguments`, which follow the program's name on the command line.
    ///
    /// `scene` is the text of the scene, if there need not be a file: then the file that the arguments name is not read. `wanted` are
    /// what is wanted beside it.
    pub fn new(arguments: Vec<OsString>, scene: Option<String>, wanted: Vec<Want>) -> Arc<Self> {
        let (stop, answer, bar) = Default::default();
        Arc::new(Self { arguments, scene, wanted, stop, answer, bar })
    }

    /// How far it is; `None` before its work begins.
    pub fn progress(&self) -> Option<Progress> {
        let bar = locked(&self.bar);
        bar.as_ref().map(|bar| Progress { what: bar.message(), done: bar.position(), of: bar.length() })
    }

    /// What stops it, and no other.
    pub fn stop(&self) -> &Stop {
        &self.stop
    }

    /// Whether this is wanted.
    pub fn wants(&self, want: Want) -> bool {
        self.wanted.contains(&want)
    }

    /// Takes `columns`, those of `--draws` or of `--csv`: the first, or more rows of them.
    pub fn give(&self, want: Want, columns: Columns) {
        let mut answer = self.answer();
        let all = if want == Want::Draws { &mut answer.draws } else { &mut answer.columns };
        match all {
            Some(all) => all.append(&columns),
            None => *all = Some(columns),
        }
    }

    /// The arguments of the command.
    pub fn arguments(&self) -> &[OsString] {
        &self.arguments
    }

    /// The answer so far.
    pub fn answer(&self) -> MutexGuard<'_, Answer> {
        locked(&self.answer)
    }

    /// A bar that nobody sees, whose progress can be asked for.
    pub fn bar(&self, what: &'static str, length: Option<u64>) -> ProgressBar {
        let bar = ProgressBar::hidden().with_message(what);
        if let Some(length) = length {
            bar.set_length(length);
        }
        *locked(&self.bar) = Some(bar.clone());
        bar
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The call that this thread works on; `None` if it works for the command line.
pub fn current() -> Option<Arc<Call>> {
    CURRENT.with_borrow(Clone::clone)
}

/// Lets this thread do `work` for a `call`, or for the command line.
pub fn within<T>(call: Option<Arc<Call>>, work: impl FnOnce() -> T) -> T {
    let stop = call.as_ref().map(|call| call.stop.clone());
    interrupt::with(&CURRENT, call, || interrupt::within(stop, work))
}

/// The text of the scene that the current call passes.
pub fn scene() -> Option<String> {
    current()?.scene.clone()
}

/// Writes `columns` as CSV to `path`, if there is one, and gives them to the current call, if it wants them.
///
/// # Errors
/// A file that cannot be written.
pub fn columns(
    want: Want,
    path: Option<&Path>,
    columns: impl FnOnce() -> Result<Columns, Failure>,
) -> Result<(), Failure> {
    let call = current().filter(|call| call.wants(want));
    if path.is_none() && call.is_none() {
        return Ok(());
    }
    let columns = columns()?;
    if let Some(path) = path {
        files::write(path, &columns.to_csv()?)?;
    }
    if let Some(call) = call {
        call.give(want, columns);
    }
    Ok(())
}

/// Whether the current call wants pictures.
pub fn wants_pictures() -> bool {
    current().is_some_and(|call| call.wants(Want::Pictures))
}

/// Writes what `draw` draws (SVG) to `path`, if there is one, and gives it to the current call under this `name`, if it wants pictures.
///
/// # Errors
/// If there is a path: a picture without anything to draw, and a file that cannot be written.
pub fn picture(
    path: Option<&Path>,
    name: &str,
    draw: impl FnOnce() -> Result<String, PlotError>,
) -> Result<(), Failure> {
    let call = current().filter(|call| call.wants(Want::Pictures));
    if path.is_none() && call.is_none() {
        return Ok(());
    }
    let svg = match draw() {
        Ok(svg) => svg,
        // Nobody asked for a file that would be missing.
        Err(_) if path.is_none() => return Ok(()),
        Err(error) => return Err(anyhow::Error::from(error).into()),
    };
    if let Some(path) = path {
        files::write(path, svg.as_bytes())?;
    }
    if let Some(call) = call {
        call.answer().pictures.push((name.to_owned(), svg));
    }
    Ok(())
}
