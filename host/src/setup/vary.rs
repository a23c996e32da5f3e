//! What differs from unit to unit beside the gaps.

use slipfit_core::menu::FrictionData;
use slipfit_tolerance::model::Contributor;

/// A parameter that varies, and by how much from the stated value: of a slide, or of another menu `P`.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied<P = SlideParameter> {
    /// Which.
    pub parameter: P,
    /// Its deviation (SI) from the scene's value.
    pub deviation: Contributor,
}

/// A parameter of a slide that can vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlideParameter {
    /// Coefficient of friction.
    Friction,
    /// Stiffness of the contacts.
    Stiffness,
    /// Damping of the contacts.
    Damping,
    /// Mass; the inertia goes with it.
    Mass,
    /// Gain of the drive.
    Gain,
    /// End of the drive's ramp.
    RampEnd,
    /// Direction of gravity: rotation about the frame's x.
    TiltX,
    /// Direction of gravity: rotation about the frame's z.
    TiltZ,
}

impl SlideParameter {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Friction,
        Self::Stiffness,
        Self::Damping,
        Self::Mass,
        Self::Gain,
        Self::RampEnd,
        Self::TiltX,
        Self::TiltZ,
    ];
}

/// Raises the coefficient of `friction` by a `deviation`; where there is no friction there is none.
pub fn rub_more(friction: &mut FrictionData<f64>, deviation: f64) {
    match friction {
        FrictionData::Regularised { coefficient, .. } | FrictionData::Exact { coefficient } => {
            *coefficient += deviation
        }
        FrictionData::None => {}
    }
}

/// `gravity` (m/s²) turned about x by an `angle` (rad).
pub fn tilted_x([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    [x, cos * y - sin * z, sin * y + cos * z]
}

/// `gravity` (m/s²) turned about z by an `angle` (rad).
pub fn tilted_z([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    [cos * x - sin * y, sin * x + cos * y, z]
}
