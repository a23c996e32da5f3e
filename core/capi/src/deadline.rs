//! The deadline of an interrupt.

use slipfit_core::deadline::{Deadline, Timing};

use crate::{
    border::{Storage, make, object, object_mut, output},
    status::{slipfit_status, status},
};

/// Memory of a deadline; opaque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_deadline {
    words: [u32; 8],
}

/// The timing of an interrupt since its first call. No count wraps around.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_timing {
    /// Calls that have begun.
    pub calls: u32,
    /// Periods in which no call began. A call that begins up to half a period late is in its own.
    pub missed: u32,
    /// The longest call, in ticks of the counter.
    pub longest: u32,
    /// Calls that took longer than a period.
    pub overruns: u32,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_deadline {
    type Object = Deadline;
    const MARK: u32 = 0x534c_4431;
}

/// Makes a deadline in `*storage` for an interrupt every `period` ticks (2 to 2^29) of a counter that counts up and wraps around at 2^32.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_deadline_init(storage: *mut slipfit_deadline, period: u32) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { make(storage, || Ok(Deadline::new(period)?)) })
}

/// A call of the interrupt begins, at `now` of the counter.
///
/// # Safety
/// As for slipfit_deadline_init; the memory has been written before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_deadline_begin(storage: *mut slipfit_deadline, now: u32) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        unsafe { object_mut(storage)? }.begin(now);
        Ok(())
    })
}

/// The call ends, at `now` of the counter.
///
/// # Safety
/// As for slipfit_deadline_begin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_deadline_end(storage: *mut slipfit_deadline, now: u32) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        unsafe { object_mut(storage)? }.end(now);
        Ok(())
    })
}

/// Sets `*timing` to what is known of all calls so far.
///
/// # Safety
/// As for slipfit_deadline_begin; nobody else uses `*timing` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_deadline_read(
    storage: *const slipfit_deadline,
    timing: *mut slipfit_timing,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(timing, || {
            let Timing { calls, missed, longest, overruns } = object(storage)?.timing();
            Ok(slipfit_timing { calls, missed, longest, overruns })
        })
    })
}
