//! Where pointers become references: every unsafe line of the library.

use core::{mem::MaybeUninit, slice};

use crate::status::{Refusal, SLIPFIT_LENGTH, SLIPFIT_MISALIGNED, SLIPFIT_NOT_MADE, SLIPFIT_NULL};

/// What an object's memory holds once it was made: a mark that is neither erased nor zeroed memory, and the object.
#[repr(C)]
pub(crate) struct Made<T> {
    mark: u32,
    value: MaybeUninit<T>,
}

/// An object as C sees it: opaque memory with room for `Object`.
///
/// # Safety
/// The type is plain memory, at least as large and as aligned as a [`Made`] object, which [`fits`] asserts.
pub(crate) unsafe trait Storage: Sized {
    /// What lives there.
    type Object;
    /// Tells objects of one type from those of another.
    const MARK: u32;
}

/// An object whose memory may be all zeros.
///
/// # Safety
/// All zeros are a value of its type.
pub(crate) unsafe trait Zeroed: Storage {}

/// Whether the object fits its storage.
pub(crate) const fn fits<S: Storage>() -> bool {
    let (size, align) = (size_of::<Made<S::Object>>(), align_of::<Made<S::Object>>());
    // What is overwritten is not dropped.
    size <= size_of::<S>() && align <= align_of::<S>() && !core::mem::needs_drop::<S::Object>()
}

fn checked<T>(pointer: *const T) -> Result<(), Refusal> {
    if pointer.is_null() {
        Err(Refusal(SLIPFIT_NULL))
    } else if pointer.is_aligned() {
        Ok(())
    } else {
        Err(Refusal(SLIPFIT_MISALIGNED))
    }
}

/// What `pointer` points at.
///
/// # Safety
/// If it is neither null nor misaligned, a `T` must be there that nobody writes meanwhile.
pub(crate) unsafe fn input<'a, T>(pointer: *const T) -> Result<&'a T, Refusal> {
    checked(pointer)?;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { &*pointer })
}

/// Writes `value` to where `pointer` points.
///
/// # Safety
/// If it is neither null nor misaligned, memory for a `T` must be there that nobody else uses meanwhile.
pub(crate) unsafe fn output<T>(pointer: *mut T, value: impl FnOnce() -> Result<T, Refusal>) -> Result<(), Refusal> {
    checked(pointer)?;
    let value = value()?;
    // SAFETY: checked, and the caller's promise.
    unsafe { pointer.write(value) };
    Ok(())
}

/// The `length` bytes at `pointer`.
///
/// # Safety
/// If the pointer is not null, they must be there and stay as they are for as long as what is made of them is used.
pub(crate) unsafe fn bytes(pointer: *const u8, length: u32) -> Result<&'static [u8], Refusal> {
    checked(pointer)?;
    let length = usize::try_from(length).ok().filter(|length| isize::try_from(*length).is_ok());
    let length = length.ok_or(Refusal(SLIPFIT_LENGTH))?;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { slice::from_raw_parts(pointer, length) })
}

/// The words of the `size` bytes at `pointer`, a multiple of four.
///
/// # Safety
/// If the pointer is neither null nor misaligned, they must be there, written before, and nobody may write them meanwhile.
pub(crate) unsafe fn words<'a>(pointer: *const u32, size: u32) -> Result<&'a [u32], Refusal> {
    checked(pointer)?;
    let length = usize::try_from(size).ok().filter(|size| isize::try_from(*size).is_ok() && size.is_multiple_of(4));
    let length = length.ok_or(Refusal(SLIPFIT_LENGTH))? / 4;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { slice::from_raw_parts(pointer, length) })
}

/// Makes an object in `storage`. Until that succeeds there is none, whatever was there before.
///
/// # Safety
/// If it is neither null nor misaligned, the storage must be there and nobody else may use it meanwhile.
pub(crate) unsafe fn make<S: Storage>(
    storage: *mut S,
    object: impl FnOnce() -> Result<S::Object, Refusal>,
) -> Result<(), Refusal> {
    const { assert!(fits::<S>()) };
    checked(storage)?;
    let made = storage.cast::<Made<S::Object>>();
    // SAFETY: checked, large enough by the assertion, and the caller's promise.
    unsafe {
        (&raw mut (*made).mark).write(0);
        (&raw mut (*made).value).write(MaybeUninit::new(object()?));
        (&raw mut (*made).mark).write(S::MARK);
    }
    Ok(())
}

/// As [`make`], in place, of an object that is too large for the stack: all zeros, which `fill` makes what it is to be.
///
/// # Safety
/// As [`make`].
pub(crate) unsafe fn make_in_place<S: Zeroed>(
    storage: *mut S,
    fill: impl FnOnce(&mut S::Object) -> Result<(), Refusal>,
) -> Result<(), Refusal> {
    const { assert!(fits::<S>()) };
    checked(storage)?;
    let made = storage.cast::<Made<S::Object>>();
    // SAFETY: checked, large enough by the assertion, all zeros are an object, and the caller's promise.
    unsafe {
        made.write_bytes(0, 1);
        fill((*made).value.assume_init_mut())?;
        (&raw mut (*made).mark).write(S::MARK);
    }
    Ok(())
}

/// The object in `storage`.
///
/// # Safety
/// If it is neither null nor misaligned, the storage must be there, written at least once (zeroes will do), and nobody
/// may write it meanwhile.
pub(crate) unsafe fn object<'a, S: Storage>(storage: *const S) -> Result<&'a S::Object, Refusal> {
    checked(storage)?;
    let made = storage.cast::<Made<S::Object>>();
    // SAFETY: checked, and the caller's promise; the mark says that the object was made.
    unsafe {
        if (&raw const (*made).mark).read() != S::MARK {
            return Err(Refusal(SLIPFIT_NOT_MADE));
        }
        Ok((*made).value.assume_init_ref())
    }
}

/// The object in `storage`, to be changed.
///
/// # Safety
/// As [`object`], and nobody may read it meanwhile either.
pub(crate) unsafe fn object_mut<'a, S: Storage>(storage: *mut S) -> Result<&'a mut S::Object, Refusal> {
    // SAFETY: the caller's promise.
    unsafe { object::<S>(storage)? };
    let made = storage.cast::<Made<S::Object>>();
    // SAFETY: as above.
    Ok(unsafe { (*made).value.assume_init_mut() })
}
