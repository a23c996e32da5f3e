//! Ctrl-C: long work asks now and then whether to stop, so that nothing is left half written.

pub use slipfit_desk::interrupt::requested;

/// From now on the first Ctrl-C only asks to stop; a second one ends the process at once.
///
/// # Errors
/// If the system refuses the handler.
pub fn install() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(|| {
        if slipfit_desk::interrupt::request() {
            std::process::exit(1);
        }
    })
}
