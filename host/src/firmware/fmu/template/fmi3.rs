//! The functions of FMI 3.0.

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

/// What an importer is told of, as it wishes to hear it.
pub enum Log {
    Fmi3(*mut c_void, Option<unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char)>),
    Fmi2(*mut c_void, Option<crate::fmi2::Logger>, CString),
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

/// Keeps the state of the instance in `*state`, a new one where that is null.
pub unsafe fn keep(pointer: *mut c_void, state: *mut *mut c_void) -> c_int {
    with(pointer, |instance| {
        let kept = instance.situation.clone();
        // SAFETY: room for a pointer, which is null or what this function gave before.
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
    })
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
        unsafe {
            match state.as_mut() {
                None => return Err("there is no room for the state".into()),
                Some(state) => match state.cast::<Situation>().as_mut() {
                    Some(before) => *before = read,
                    None => *state = Box::into_raw(Box::new(read)).cast(),
                },
            }
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    _on: bool,
    _count: usize,
    _categories: *const *const c_char,
) -> c_int {
    with(instance, |_| Ok(()))
}

type LogMessage = Option<unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char)>;

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging: bool,
    _events: bool,
    _early_return: bool,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    log: LogMessage,
    _update: *const c_void,
) -> *mut c_void {
    instantiated(token, Log::Fmi3(environment, log))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging: bool,
    environment: *mut c_void,
    log: LogMessage,
) -> *mut c_void {
    Log::Fmi3(environment, log).tell(ERROR, "this unit is for co-simulation");
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging: bool,
    environment: *mut c_void,
    log: LogMessage,
    _clock: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> *mut c_void {
    Log::Fmi3(environment, log).tell(ERROR, "this unit is for co-simulation");
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    // SAFETY: what instantiation gave, for the last time.
    unsafe { freed::<Instance>(instance) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    _tolerance_defined: bool,
    _tolerance: f64,
    start: f64,
    _stop_defined: bool,
    _stop: f64,
) -> c_int {
    with(instance, |instance| instance.situation.enter_initialization(start))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3ExitInitializationMode(instance: *mut c_void) -> c_int {
    with(instance, |instance| instance.situation.exit_initialization())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3Terminate(instance: *mut c_void) -> c_int {
    with(instance, |instance| instance.situation.terminate())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3Reset(instance: *mut c_void) -> c_int {
    with(instance, |instance| instance.situation.reset())
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
    value_count: usize,
) -> c_int {
    // SAFETY: lengths are the importer's.
    unsafe { get(instance, lent(references, count), lent_mut(values, value_count)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> c_int {
    // SAFETY: lengths are the importer's.
    unsafe { set(instance, lent(references, count), lent(values, value_count)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    current: f64,
    size: f64,
    _no_going_back: bool,
    event: *mut bool,
    terminate: *mut bool,
    early: *mut bool,
    last: *mut f64,
) -> c_int {
    // SAFETY: null, or room for one each.
    unsafe {
        put(event, false);
        put(terminate, false);
        put(early, false);
    }
    with(instance, |instance| {
        let done = instance.situation.advance(current, size);
        // SAFETY: as above.
        unsafe { put(last, instance.situation.time()) };
        done
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    unsafe { keep(instance, state) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(instance: *mut c_void, state: *mut c_void) -> c_int {
    unsafe { go_back(instance, state) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    unsafe { free_state(instance, state) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: *mut c_void,
    state: *mut c_void,
    size: *mut usize,
) -> c_int {
    unsafe { size_of_state(instance, state, size) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: *mut c_void,
    state: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> c_int {
    unsafe { write_state(instance, state, bytes, size) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: *mut c_void,
    bytes: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> c_int {
    unsafe { read_state(instance, bytes, size, state) }
}

/// Functions of what this unit has not: they answer with an error.
macro_rules! not_here {
    ($($name:ident($($argument:ident: $of:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(instance: *mut c_void $(, $argument: $of)*) -> c_int {
            $(let _ = $argument;)*
            with(instance, |_| Err(concat!(stringify!($name), ": this unit has nothing of the kind").into()))
        }
    )*};
}

/// Reading and writing variables of other types: there are none.
macro_rules! no_variables {
    ($($get:ident, $set:ident, $of:ty;)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $get(instance: *mut c_void, _: *const u32, count: usize, _: *mut $of, _: usize) -> c_int {
            none_of(instance, stringify!($get), count)
        }

        #[unsafe(no_mangle)]
        pub extern "C" fn $set(instance: *mut c_void, _: *const u32, count: usize, _: *const $of, _: usize) -> c_int {
            none_of(instance, stringify!($set), count)
        }
    )*};
}

/// Of no variables all is well.
pub fn none_of(instance: *mut c_void, call: &str, count: usize) -> c_int {
    with(instance, |_| match count {
        0 => Ok(()),
        _ => Err(format!("{call}: all variables are floating point of 64 bits").into()),
    })
}

no_variables! {
    fmi3GetFloat32, fmi3SetFloat32, f32;
    fmi3GetInt8, fmi3SetInt8, i8;
    fmi3GetUInt8, fmi3SetUInt8, u8;
    fmi3GetInt16, fmi3SetInt16, i16;
    fmi3GetUInt16, fmi3SetUInt16, u16;
    fmi3GetInt32, fmi3SetInt32, i32;
    fmi3GetUInt32, fmi3SetUInt32, u32;
    fmi3GetInt64, fmi3SetInt64, i64;
    fmi3GetUInt64, fmi3SetUInt64, u64;
    fmi3GetBoolean, fmi3SetBoolean, bool;
    fmi3GetString, fmi3SetString, *const c_char;
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetBinary(
    instance: *mut c_void,
    _: *const u32,
    count: usize,
    _: *mut usize,
    _: *mut *const u8,
    _: usize,
) -> c_int {
    none_of(instance, "fmi3GetBinary", count)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetBinary(
    instance: *mut c_void,
    _: *const u32,
    count: usize,
    _: *const usize,
    _: *const *const u8,
    _: usize,
) -> c_int {
    none_of(instance, "fmi3SetBinary", count)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetClock(instance: *mut c_void, _: *const u32, count: usize, _: *mut bool) -> c_int {
    none_of(instance, "fmi3GetClock", count)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetClock(instance: *mut c_void, _: *const u32, count: usize, _: *const bool) -> c_int {
    none_of(instance, "fmi3SetClock", count)
}

not_here! {
    fmi3EnterEventMode();
    fmi3EnterStepMode();
    fmi3EnterConfigurationMode();
    fmi3ExitConfigurationMode();
    fmi3EvaluateDiscreteStates();
    fmi3UpdateDiscreteStates(a: *mut bool, b: *mut bool, c: *mut bool, d: *mut bool, e: *mut bool, f: *mut f64);
    fmi3GetNumberOfVariableDependencies(a: u32, b: *mut usize);
    fmi3GetVariableDependencies(a: u32, b: *mut usize, c: *mut u32, d: *mut usize, e: *mut c_int, f: usize);
    fmi3GetDirectionalDerivative(a: *const u32, b: usize, c: *const u32, d: usize, e: *const f64, f: usize, g: *mut f64, h: usize);
    fmi3GetAdjointDerivative(a: *const u32, b: usize, c: *const u32, d: usize, e: *const f64, f: usize, g: *mut f64, h: usize);
    fmi3GetOutputDerivatives(a: *const u32, b: usize, c: *const i32, d: *mut f64, e: usize);
    fmi3GetIntervalDecimal(a: *const u32, b: usize, c: *mut f64, d: *mut c_int);
    fmi3GetIntervalFraction(a: *const u32, b: usize, c: *mut u64, d: *mut u64, e: *mut c_int);
    fmi3GetShiftDecimal(a: *const u32, b: usize, c: *mut f64);
    fmi3GetShiftFraction(a: *const u32, b: usize, c: *mut u64, d: *mut u64);
    fmi3SetIntervalDecimal(a: *const u32, b: usize, c: *const f64);
    fmi3SetIntervalFraction(a: *const u32, b: usize, c: *const u64, d: *const u64);
    fmi3SetShiftDecimal(a: *const u32, b: usize, c: *const f64);
    fmi3SetShiftFraction(a: *const u32, b: usize, c: *const u64, d: *const u64);
    fmi3EnterContinuousTimeMode();
    fmi3CompletedIntegratorStep(a: bool, b: *mut bool, c: *mut bool);
    fmi3SetTime(a: f64);
    fmi3SetContinuousStates(a: *const f64, b: usize);
    fmi3GetContinuousStates(a: *mut f64, b: usize);
    fmi3GetContinuousStateDerivatives(a: *mut f64, b: usize);
    fmi3GetNominalsOfContinuousStates(a: *mut f64, b: usize);
    fmi3GetEventIndicators(a: *mut f64, b: usize);
    fmi3GetNumberOfContinuousStates(a: *mut usize);
    fmi3GetNumberOfEventIndicators(a: *mut usize);
    fmi3ActivateModelPartition(a: u32, b: f64);
}
