//! What programs start from that call the library as C does.

use std::mem::MaybeUninit;

use slipfit_capi::{SLIPFIT_SCHEME_IMPLICIT_EULER, slipfit_scene};
use slipfit_problems::cd_rom;

/// An object's memory as C has it before it is made.
pub fn zeroed<T>() -> T {
    // SAFETY: the library's types are plain words and numbers.
    unsafe { MaybeUninit::zeroed().assume_init() }
}

/// A scene that can be stepped, with `friction_law`.
pub fn scene(friction_law: u32) -> slipfit_scene {
    let data = cd_rom::data(0.0f32);
    slipfit_scene {
        scheme: SLIPFIT_SCHEME_IMPLICIT_EULER,
        step: 1e-3,
        mass: data.body.mass,
        inertia: data.body.inertia_b.into(),
        gravity: data.body.gravity_w.into(),
        pins: data.body.pins_w.map(Into::into),
        gap_means: data.body.gaps,
        gap_deviations: cd_rom::TABLE_2.map(|[_, deviation]| (deviation / 1000.0) as f32),
        stiffness: data.contact.stiffness,
        exponent: data.contact.exponent,
        damping: data.contact.damping,
        depth: data.contact.depth,
        friction_law,
        friction_coefficient: 0.3,
        friction_stick_band: 1e-4,
        drive_gain: data.drive.gain,
        drive_ramp: [data.drive.ramp_start, data.drive.ramp_end],
        drive_speed: data.drive.speed,
        drive_point: [0.0; 3],
    }
}
