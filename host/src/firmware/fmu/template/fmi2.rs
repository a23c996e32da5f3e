//! The functions of FMI 2.0.

use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};

use crate::ffi::{
    ERROR, Instance, Log, Logger, OK, freed, get, instantiated, lent, lent_mut, none_of, not_here, put, set,
    state_functions, with,
};

/// What an importer offers.
#[repr(C)]
pub struct Callbacks {
    logger: Option<Logger>,
    allocate: *const c_void,
    free: *const c_void,
    finished: *const c_void,
    environment: *mut c_void,
}

/// The kind of co-simulation.
const CO_SIMULATION: c_int = 1;

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetDebugLogging(instance: *mut c_void, _: c_int, _: usize, _: *const *const c_char) -> c_int {
    with(instance, |_| Ok(()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    token: *const c_char,
    _resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    _logging: c_int,
) -> *mut c_void {
    // SAFETY: null, or what the standard says is there.
    let log = unsafe {
        let name = if name.is_null() { CString::default() } else { CStr::from_ptr(name).to_owned() };
        match callbacks.as_ref() {
            Some(callbacks) => Log::Fmi2(callbacks.environment, callbacks.logger, name),
            None => Log::Fmi2(std::ptr::null_mut(), None, name),
        }
    };
    if kind != CO_SIMULATION {
        log.tell(ERROR, "this unit is for co-simulation");
        return std::ptr::null_mut();
    }
    instantiated(token, log)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(instance: *mut c_void) {
    // SAFETY: what instantiation gave, for the last time.
    unsafe { freed::<Instance>(instance) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    instance: *mut c_void,
    _tolerance_defined: c_int,
    _tolerance: f64,
    start: f64,
    _stop_defined: c_int,
    _stop: f64,
) -> c_int {
    with(instance, |instance| instance.situation.set_start(start))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(instance: *mut c_void) -> c_int {
    with(instance, |instance| instance.situation.enter_initialization(instance.situation.time()))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(instance: *mut c_void) -> c_int {
    with(instance, |instance| instance.situation.exit_initialization())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(instance: *mut c_void) -> c_int {
    with(instance, |instance| instance.situation.terminate())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(instance: *mut c_void) -> c_int {
    with(instance, |instance| instance.situation.reset())
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *mut f64,
) -> c_int {
    // SAFETY: lengths are the importer's.
    unsafe { get(instance, lent(references, count), lent_mut(values, count)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *const f64,
) -> c_int {
    // SAFETY: lengths are the importer's.
    unsafe { set(instance, lent(references, count), lent(values, count)) }
}

/// Reading and writing variables of other types: there are none.
macro_rules! no_variables {
    ($($get:ident, $set:ident, $of:ty;)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $get(instance: *mut c_void, _: *const c_uint, count: usize, _: *mut $of) -> c_int {
            none_of(instance, stringify!($get), count)
        }

        #[unsafe(no_mangle)]
        pub extern "C" fn $set(instance: *mut c_void, _: *const c_uint, count: usize, _: *const $of) -> c_int {
            none_of(instance, stringify!($set), count)
        }
    )*};
}

no_variables! {
    fmi2GetInteger, fmi2SetInteger, c_int;
    fmi2GetBoolean, fmi2SetBoolean, c_int;
    fmi2GetString, fmi2SetString, *const c_char;
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(instance: *mut c_void, current: f64, size: f64, _no_going_back: c_int) -> c_int {
    with(instance, |instance| instance.situation.advance(current, size))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2CancelStep(instance: *mut c_void) -> c_int {
    with(instance, |_| Err("fmi2CancelStep: every step ends before its call returns".into()))
}

/// The kinds of status that there is an answer to.
const LAST_SUCCESSFUL_TIME: c_int = 2;
const TERMINATED: c_int = 3;

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(instance: *mut c_void, _: c_int, value: *mut c_int) -> c_int {
    with(instance, |_| {
        // SAFETY: null, or room for one.
        unsafe { put(value, OK) };
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(instance: *mut c_void, kind: c_int, value: *mut f64) -> c_int {
    with(instance, |instance| {
        if kind != LAST_SUCCESSFUL_TIME {
            return Err(format!("fmi2GetRealStatus: there is no status of the kind {kind}").into());
        }
        // SAFETY: null, or room for one.
        unsafe { put(value, instance.situation.time()) };
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetIntegerStatus(instance: *mut c_void, kind: c_int, _: *mut c_int) -> c_int {
    with(instance, |_| Err(format!("fmi2GetIntegerStatus: there is no status of the kind {kind}").into()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(instance: *mut c_void, kind: c_int, value: *mut c_int) -> c_int {
    with(instance, |_| {
        if kind != TERMINATED {
            return Err(format!("fmi2GetBooleanStatus: there is no status of the kind {kind}").into());
        }
        // SAFETY: null, or room for one.
        unsafe { put(value, 0) };
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStringStatus(instance: *mut c_void, kind: c_int, _: *mut *const c_char) -> c_int {
    with(instance, |_| Err(format!("fmi2GetStringStatus: there is no status of the kind {kind}").into()))
}

state_functions! {
    fmi2GetFMUstate, fmi2SetFMUstate, fmi2FreeFMUstate,
    fmi2SerializedFMUstateSize, fmi2SerializeFMUstate, fmi2DeSerializeFMUstate
}

not_here! {
    fmi2GetDirectionalDerivative(a: *const c_uint, b: usize, c: *const c_uint, d: usize, e: *const f64, f: *mut f64);
    fmi2SetRealInputDerivatives(a: *const c_uint, b: usize, c: *const c_int, d: *const f64);
    fmi2GetRealOutputDerivatives(a: *const c_uint, b: usize, c: *const c_int, d: *mut f64);
}
