//! The watch for jams, for a drive without a table.

use slipfit_core::monitor::{JamWatch, Limits};

use crate::{
    border::{Storage, input, make, object_mut, output},
    monitor::{code, slipfit_limits, slipfit_sample},
    status::{slipfit_status, status},
};

/// Memory of a jam watch; opaque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_jam_watch {
    words: [u64; 8],
}

#[derive(Clone, Copy)]
pub(crate) struct Watching {
    limits: Limits,
    watch: JamWatch,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_jam_watch {
    type Object = Watching;
    const MARK: u32 = 0x534c_4a31;
}

/// Makes a jam watch in `*storage`, which needs no table: of the limits it goes by `period`, `blind`, `force_most` and `hold`,
/// but all must be in bounds, as those of slipfit_limits_for_noise are. The first motion starts with it, others with
/// slipfit_jam_watch_restart.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_jam_watch_init(
    storage: *mut slipfit_jam_watch,
    limits: *const slipfit_limits,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make(storage, || Ok(Watching { limits: Limits::from(*input(limits)?).checked()?, watch: JamWatch::default() }))
    })
}

/// Sets `*verdict` to what a sample says, after those before it, as a monitor would: SLIPFIT_BLIND, SLIPFIT_FREE, SLIPFIT_JAM or
/// SLIPFIT_NO_DATA, never SLIPFIT_TIGHT. What is NAN neither counts nor starts anew.
///
/// # Safety
/// As for slipfit_jam_watch_init; the memory has been written before; nobody else uses `*verdict` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_jam_watch_step(
    storage: *mut slipfit_jam_watch,
    sample: *const slipfit_sample,
    verdict: *mut u32,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(verdict, || {
            let sample = (*input(sample)?).into();
            let Watching { limits, watch } = object_mut(storage)?;
            Ok(code(watch.step(limits, &sample)))
        })
    })
}

/// Starts another motion: forgets all samples, and keeps the limits.
///
/// # Safety
/// As for slipfit_jam_watch_init; the memory has been written before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_jam_watch_restart(storage: *mut slipfit_jam_watch) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        unsafe { object_mut(storage)? }.watch = JamWatch::default();
        Ok(())
    })
}
