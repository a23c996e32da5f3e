//! What both versions of the standard need where they meet C.

use std::{
    ffi::{CStr, CString, c_char, c_int, c_void},
    panic::{AssertUnwindSafe, catch_unwind},
    slice::{from_raw_parts, from_raw_parts_mut},
};

use crate::{
    instance::{Situation, Trouble, deserialised, serialised},
    model::TOKEN,
};

pub const OK: c_int = 0;
pub const ERROR: c_int = 3;
pub const FATAL: c_int = 4;

/// Told of environment, status, category and message.
pub type LogMessage = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

/// Told of environment, instance, status, category and a message as `printf` takes it.
pub type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// What an importer is told of, as it wishes to hear it.
pub enum Log {
    Fmi3(*mut c_void, Option<LogMessage>),
    Fmi2(*mut c_void, Option<Logger>, CString),
}

/// What an importer holds a pointer to.
pub struct Instance {
    pub situation: Situation,
    pub log: Log,
}

impl Log {
    /// Tells of `trouble`.
    pub fn tell(&self, status: c_int, trouble: &str) {
        let message = CString::new(trouble.replace('\0', " ")).unwrap_or_default();
        let category = c"logStatusError".as_ptr();
        // SAFETY: the importer's own function and environment; the texts live until it returns.
        unsafe {
            match self {
                Self::Fmi3(environment, Some(log)) => log(*environment, status, category, message.as_ptr()),
                Self::Fmi2(environment, Some(log), name) => {
                    log(*environment, name.as_ptr(), status, category, c"%s".as_ptr(), message.as_ptr());
                }
                Self::Fmi3(_, None) | Self::Fmi2(_, None, _) => {}
            }
        }
    }
}

/// Does `work` on the instance behind `pointer`; what goes wrong is told to the log.
pub fn with(pointer: *mut c_void, work: impl FnOnce(&mut Instance) -> Result<(), Trouble>) -> c_int {
    // SAFETY: the importer's pointer is null, or what instantiation gave it and has not been freed; FMI forbids two calls at once.
    let Some(instance) = (unsafe { pointer.cast::<Instance>().as_mut() }) else { return ERROR };
    match catch_unwind(AssertUnwindSafe(|| work(instance))) {
        Ok(Ok(())) => OK,
        Ok(Err(trouble)) => {
            instance.log.tell(ERROR, &trouble.0);
            ERROR
        }
        Err(_) => FATAL,
    }
}

/// What an importer lends for reading; nothing if it is null.
pub unsafe fn lent<'a, T>(pointer: *const T, count: usize) -> &'a [T] {
    // SAFETY: FMI has the importer say how many there are.
    if pointer.is_null() { &[] } else { unsafe { from_raw_parts(pointer, count) } }
}

/// The same for writing.
pub unsafe fn lent_mut<'a, T>(pointer: *mut T, count: usize) -> &'a mut [T] {
    // SAFETY: as above.
    if pointer.is_null() { &mut [] } else { unsafe { from_raw_parts_mut(pointer, count) } }
}

/// Writes `value` where the importer wants it, if it does.
pub unsafe fn put<T>(pointer: *mut T, value: T) {
    // SAFETY: null, or room for one.
    if !pointer.is_null() {
        unsafe { pointer.write(value) }
    }
}

/// A new instance, if `token` is this unit's.
pub fn instantiated(token: *const c_char, log: Log) -> *mut c_void {
    // SAFETY: null, or a text that ends with a zero.
    let token = if token.is_null() { c"" } else { unsafe { CStr::from_ptr(token) } };
    if token.to_bytes() != TOKEN.as_bytes() {
        log.tell(ERROR, &format!("the token is {}, this unit's is {TOKEN}", token.to_string_lossy()));
        return std::ptr::null_mut();
    }
    match Situation::new() {
        Ok(situation) => Box::into_raw(Box::new(Instance { situation, log })).cast(),
        Err(Trouble(why)) => {
            log.tell(ERROR, &why);
            std::ptr::null_mut()
        }
    }
}

/// Drops what `pointer` owns.
pub unsafe fn freed<T>(pointer: *mut c_void) {
    // SAFETY: null, or what was given away by `Box::into_raw` as a `T` and not been freed.
    if !pointer.is_null() {
        drop(unsafe { Box::from_raw(pointer.cast::<T>()) });
    }
}

pub fn get(pointer: *mut c_void, references: &[u32], into: &mut [f64]) -> c_int {
    with(pointer, |instance| instance.situation.get(references, into))
}

pub fn set(pointer: *mut c_void, references: &[u32], values: &[f64]) -> c_int {
    with(pointer, |instance| instance.situation.set(references, values))
}

/// The functions of states, which both versions call otherwise.
macro_rules! state_functions {
    ($keep:ident, $go_back:ident, $free:ident, $size:ident, $write:ident, $read:ident) => {
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $keep(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
            unsafe { $crate::ffi::keep(instance, state) }
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $go_back(instance: *mut c_void, state: *mut c_void) -> c_int {
            unsafe { $crate::ffi::go_back(instance, state) }
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $free(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
            unsafe { $crate::ffi::free_state(instance, state) }
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $size(instance: *mut c_void, state: *mut c_void, size: *mut usize) -> c_int {
            unsafe { $crate::ffi::size_of_state(instance, state, size) }
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $write(
            instance: *mut c_void,
            state: *mut c_void,
            bytes: *mut u8,
            size: usize,
        ) -> c_int {
            unsafe { $crate::ffi::write_state(instance, state, bytes, size) }
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $read(
            instance: *mut c_void,
            bytes: *const u8,
            size: usize,
            state: *mut *mut c_void,
        ) -> c_int {
            unsafe { $crate::ffi::read_state(instance, bytes, size, state) }
        }
    };
}
pub(crate) use state_functions;

/// Functions of what this unit has not: they answer with an error.
macro_rules! not_here {
    ($($name:ident($($argument:ident: $of:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(instance: *mut c_void $(, $argument: $of)*) -> c_int {
            $(let _ = $argument;)*
            $crate::ffi::with(instance, |_| Err(concat!(stringify!($name), ": this unit has nothing of the kind").into()))
        }
    )*};
}
pub(crate) use not_here;

/// Keeps the state of the instance in `*state`, a new one where that is null.
pub unsafe fn keep(pointer: *mut c_void, state: *mut *mut c_void) -> c_int {
    with(pointer, |instance| {
        // SAFETY: the importer's promise.
        unsafe { handed_over(instance.situation.clone(), state) }
    })
}

/// Puts `kept` into `*state`, or into a new state where that is null.
///
/// # Safety
/// `state` is null, or room for a pointer that is null or what this function gave before.
unsafe fn handed_over(kept: Situation, state: *mut *mut c_void) -> Result<(), Trouble> {
    // SAFETY: the caller's promise.
    unsafe {
        match state.as_mut() {
            None => return Err("there is no room for the state".into()),
            Some(state) => match state.cast::<Situation>().as_mut() {
                Some(before) => *before = kept,
                None => *state = Box::into_raw(Box::new(kept)).cast(),
            },
        }
    }
    Ok(())
}

/// Goes back to a `state` that was kept.
pub unsafe fn go_back(pointer: *mut c_void, state: *mut c_void) -> c_int {
    with(pointer, |instance| {
        // SAFETY: null, or a state that this unit gave.
        let state = unsafe { state.cast::<Situation>().as_ref() }.ok_or("there is no state to go back to")?;
        instance.situation = state.clone();
        Ok(())
    })
}

pub unsafe fn free_state(pointer: *mut c_void, state: *mut *mut c_void) -> c_int {
    with(pointer, |_| {
        // SAFETY: null, or where the importer keeps a state that this unit gave.
        if let Some(state) = unsafe { state.as_mut() } {
            unsafe { freed::<Situation>(*state) };
            *state = std::ptr::null_mut();
        }
        Ok(())
    })
}

pub unsafe fn size_of_state(pointer: *mut c_void, state: *mut c_void, size: *mut usize) -> c_int {
    with(pointer, |_| {
        // SAFETY: as above.
        let state = unsafe { state.cast::<Situation>().as_ref() }.ok_or("there is no state to write down")?;
        unsafe { put(size, serialised(state).len()) };
        Ok(())
    })
}

pub unsafe fn write_state(pointer: *mut c_void, state: *mut c_void, bytes: *mut u8, size: usize) -> c_int {
    with(pointer, |_| {
        // SAFETY: as above.
        let state = unsafe { state.cast::<Situation>().as_ref() }.ok_or("there is no state to write down")?;
        let written = serialised(state);
        let room = unsafe { lent_mut(bytes, size) };
        let part = room.get_mut(..written.len()).ok_or("there is too little room for the state")?;
        part.copy_from_slice(&written);
        Ok(())
    })
}

pub unsafe fn read_state(pointer: *mut c_void, bytes: *const u8, size: usize, state: *mut *mut c_void) -> c_int {
    with(pointer, |_| {
        // SAFETY: as above.
        let read = deserialised(unsafe { lent(bytes, size) })?;
        unsafe { handed_over(read, state) }
    })
}

/// Of no variables all is well.
pub fn none_of(instance: *mut c_void, call: &str, count: usize) -> c_int {
    with(instance, |_| match count {
        0 => Ok(()),
        _ => Err(format!("{call}: all variables are floating point of 64 bits").into()),
    })
}
