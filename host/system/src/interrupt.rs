//! A request to stop, such as Ctrl-C: long work looks at it now and then, so that nothing is left half written.

use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Asks all work of this process to stop. Whether that had been asked before.
pub fn request() -> bool {
    REQUESTED.swap(true, Ordering::Relaxed)
}

/// Forgets the request, once the work that it was for has stopped.
pub fn clear() {
    REQUESTED.store(false, Ordering::Relaxed);
}

/// Whether somebody asked to stop.
pub fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// From now on the first Ctrl-C only asks to stop; a second one ends the process at once.
///
/// # Errors
/// If the system refuses the handler.
pub fn install() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(|| {
        if request() {
            std::process::exit(1);
        }
    })
}
