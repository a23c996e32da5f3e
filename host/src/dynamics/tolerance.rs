//! The error of force that a step of the desk may make, and the stick band that goes with it.
//!
//! Exact friction has no derivative at rest, which error control needs. The desk takes the regularised law instead, with
//! a stick band that follows the tolerance: a band of four times the error of speed that a step may make. The result
//! tends to exact friction as the tolerance does to zero, at the cost of the regularised law; a narrower band would make
//! steps chatter between sticking and sliding. What creep within the band changes is part of the difference to a run at a
//! tenth of the tolerance.

use slipfit_core::menu::FrictionData;

use super::driven::Driven;
use crate::setup::Scene;

/// Stick bands in the error of speed that a step may make; see the top of the file.
const STICK_BANDS: f64 = 4.0;

/// Bounds of the stick band (m/s) that stands for true stick.
pub(super) const STICK_BAND: [f64; 2] = [1e-9, 1e-4];

/// How much a narrow stick band may tighten the tolerance.
const NARROWEST: f64 = 0.01;

/// The least error of force (N) that a step is held to, where the drive has no force.
const LEAST_TOLERANCE: f64 = 1e-9;

/// The error of force (N) that a step of `scene` may make: the scene's share of the drive's greatest force, or of the slide's
/// weight where nothing is commanded; less where a narrow stick band asks for it.
pub fn tolerance(scene: &Scene) -> f64 {
    tolerance_of(scene, scene.run.error)
}

/// The same for another share of the drive's greatest force.
pub fn tolerance_of(scene: &Scene, error: f64) -> f64 {
    let [x, y, z] = scene.slide.gravity;
    let weight = scene.slide.mass * libm::sqrt(x * x + y * y + z * z);
    let greatest = if scene.greatest_force() > 0.0 { scene.greatest_force() } else { weight };
    // A stated stick band has to be resolved, or steps chatter within it.
    let resolving = match scene.friction {
        FrictionData::Regularised { stick_band, .. } if scene.drive.gain > 0.0 => {
            scene.drive.gain * stick_band / STICK_BANDS
        }
        _ => f64::INFINITY,
    };
    let share = error * greatest;
    share.min(resolving.max(share * NARROWEST)).max(LEAST_TOLERANCE)
}

/// The stick band (m/s) that stands for true stick at this `tolerance` (N); `None` unless friction is exact.
pub fn stick_band(scene: &Scene, tolerance: f64) -> Option<f64> {
    let band = STICK_BANDS * tolerance / scene.drive.gain.max(f64::MIN_POSITIVE);
    matches!(scene.friction, FrictionData::Exact { .. }).then(|| band.clamp(STICK_BAND[0], STICK_BAND[1]))
}
