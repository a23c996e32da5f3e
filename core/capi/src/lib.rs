//! The predictor, the flash table and the monitor for C. The header is `include/slipfit.h`, generated from this crate.
//!
//! Every object lives in memory of the caller's: there is no global state. Calls that take an object by a const pointer only
//! read it, so that an interrupt and a thread may make them at once; any other call needs the object to itself. Nothing allocates, blocks or panics;
//! every function checks its pointers, and that an object was made before it is used.
#![no_std]
#![allow(unsafe_code, reason = "the one crate that speaks C")]
#![allow(non_camel_case_types, reason = "names as C has them")]

#[cfg(not(target_os = "none"))]
extern crate std;

/// Makes a panic reachable, so that a test sees that no program links then.
#[cfg(feature = "reachable-panic")]
#[unsafe(no_mangle)]
pub extern "C" fn slipfit_panic(divisor: u32) -> u32 {
    1 / divisor
}

mod ahead;
mod border;
mod deadline;
mod integers;
mod jam_watch;
mod layout;
mod monitor;
mod observer;
mod predictor;
mod production;
mod scene;
mod scrubber;
mod seal;
mod slots;
mod status;
mod table;

pub use ahead::*;
pub use deadline::*;
pub use integers::*;
pub use jam_watch::*;
pub use layout::*;
pub use monitor::*;
pub use observer::*;
pub use predictor::*;
pub use production::*;
pub use scene::*;
pub use scrubber::*;
pub use seal::*;
pub use slots::*;
pub use status::*;
pub use table::*;

/// A program links only while no panic is reachable: this calls what nobody defines. Link-time optimisation drops it then, so
/// that the archive goes together with others of Rust, which have handlers of their own.
#[cfg(all(feature = "panic-handler", target_os = "none"))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        safe fn slipfit_panic_is_reachable() -> !;
    }
    slipfit_panic_is_reachable()
}
