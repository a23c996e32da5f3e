//! The functions of FMI 3.0.

use std::ffi::{c_char, c_int, c_void};

use crate::ffi::{
    ERROR, Instance, Log, LogMessage, freed, get, instantiated, lent, lent_mut, none_of, not_here, put, set,
    state_functions, with,
};

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
    log: Option<LogMessage>,
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
    log: Option<LogMessage>,
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
    log: Option<LogMessage>,
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

state_functions! {
    fmi3GetFMUState, fmi3SetFMUState, fmi3FreeFMUState,
    fmi3SerializedFMUStateSize, fmi3SerializeFMUState, fmi3DeserializeFMUState
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
