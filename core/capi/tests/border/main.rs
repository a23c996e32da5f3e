//! Whatever C passes is answered by a status, and whatever a function writes is finite.
#![allow(unsafe_code, reason = "calls the library as C does")]

mod ahead;
#[path = "../common/mod.rs"]
mod common;
mod deadline;
mod integers;
mod jam_watch;
mod monitor;
mod observer;
mod pointers;
mod predictor;
mod production;
mod scrubber;
mod seal;
mod slots;
mod table;

use std::ptr;

use proptest::test_runner::Config;
use slipfit_capi::*;

/// What floating point has that a careless program trips over.
const SPECIAL: [f32; 14] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    1e30,
    -1e30,
    0.0,
    -0.0,
    f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    1e-40,
    1.0,
];

/// Floats of a scene.
const NUMBERS: usize = size_of::<slipfit_scene>() / size_of::<f32>();

fn scene() -> slipfit_scene {
    common::scene(if cfg!(feature = "exact") { SLIPFIT_FRICTION_EXACT } else { SLIPFIT_FRICTION_REGULARISED })
}

/// A scene with regularised friction, whichever law the library is built for.
fn regularised() -> slipfit_scene {
    common::scene(SLIPFIT_FRICTION_REGULARISED)
}

/// The scene with the bits of some of its numbers changed, its laws' numbers too.
fn changed(mut scene: slipfit_scene, changes: &[(usize, u32)]) -> slipfit_scene {
    for (place, bits) in changes {
        // SAFETY: every field is a word of four bytes, for which every value will do.
        unsafe { ptr::from_mut(&mut scene).cast::<u32>().add(place % NUMBERS).write(*bits) };
    }
    scene
}

/// How often properties are tried; an interpreter has little time.
fn cases() -> Config {
    Config { failure_persistence: None, ..Config::with_cases(if cfg!(miri) { 4 } else { 2000 }) }
}
