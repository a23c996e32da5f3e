//! Commands as functions: what another program passes to a command, and what it gets instead of output on the terminal.

use std::{
    cell::RefCell,
    ffi::OsString,
    path::Path,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use indicatif::ProgressBar;
use slipfit_system::files;

use super::failure::Failure;
use crate::show::columns::Columns;

/// A command that another program calls.
pub struct Call {
    arguments: Vec<OsString>,
    scene: Option<String>,
    wanted: Vec<Want>,
    answer: Mutex<Answer>,
    bar: Mutex<Option<ProgressBar>>,
}

/// Columns that commands have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    /// Those of the option `--csv`.
    Columns,
    /// Those of the option `--draws`.
    Draws,
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
    /// the columns that are wanted.
    pub fn new(arguments: Vec<OsString>, scene: Option<String>, wanted: Vec<Want>) -> Arc<Self> {
        Arc::new(Self { arguments, scene, wanted, answer: Mutex::default(), bar: Mutex::default() })
    }

    /// How far it is; `None` before its work begins.
    pub fn progress(&self) -> Option<Progress> {
        let bar = locked(&self.bar);
        bar.as_ref().map(|bar| Progress { what: bar.message(), done: bar.position(), of: bar.length() })
    }

    /// Whether these columns are wanted.
    pub fn wants(&self, want: Want) -> bool {
        self.wanted.contains(&want)
    }

    /// Takes `columns`: the first, or more rows of them.
    pub fn give(&self, want: Want, columns: Columns) {
        let mut answer = self.answer();
        let all = match want {
            Want::Columns => &mut answer.columns,
            Want::Draws => &mut answer.draws,
        };
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
    /// Puts the earlier call back, also if the work panics.
    struct Restore(Option<Arc<Call>>);
    impl Drop for Restore {
        fn drop(&mut self) {
            CURRENT.set(self.0.take());
        }
    }
    let _restore = Restore(CURRENT.replace(call));
    work()
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
