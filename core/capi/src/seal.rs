//! Whether memory is still what it was.

use core::ffi::c_void;

use crate::{
    border::{output, words},
    status::{slipfit_status, status},
};

/// Writes to `*seal` a hash of the `size` bytes at `object`, a multiple of four, such as an object of this library with its parameters and
/// its state. Take it after the last call that changed the object, and compare it before the next use: one flipped
/// bit always changes it, and several do but by chance, once in four billion times.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; the object's memory has been written before, and nobody
/// writes it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_seal(object: *const c_void, size: u32, seal: *mut u32) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        let words = words(object.cast(), size)?;
        // FNV-1a by words, turned: each step can be undone, so that what differs at one word differs at the end, and the turn brings the
        // highest bits down, which a product would leave where they are.
        let next = |seal: u32, word: &u32| (seal ^ *word).wrapping_mul(0x0100_0193).rotate_left(13);
        output(seal, || Ok(words.iter().fold(0x811c_9dc5, next)))
    })
}
