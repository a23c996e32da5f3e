//! Parameters of a mechanism that vary over the production, beside its gaps.

use slipfit_core::menu::FrictionData;
use slipfit_tolerance::model::Contributor;

use super::{Mechanism, NormalData};

/// A parameter that varies, and by how much from the scene's value: a mechanism's, or of another menu `P`.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied<P = Parameter> {
    /// Which.
    pub parameter: P,
    /// Its deviation (SI) from the scene's value.
    pub deviation: Contributor,
}

/// A parameter that can vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Coefficient of friction of all joints.
    Friction,
    /// Stiffness of all contacts; it varies by shares of itself.
    Stiffness,
    /// Damping of all contacts.
    Damping,
    /// Mass of a body; the inertia goes with it.
    Mass(usize),
    /// Gain of a drive.
    Gain(usize),
    /// End of a drive's ramp.
    RampEnd(usize),
    /// Direction of gravity: rotation about the frame's x.
    TiltX,
    /// Direction of gravity: rotation about the frame's z, in a plane within it.
    TiltZ,
}

impl Parameter {
    /// Moves the parameter of `mechanism` by a `deviation` (SI).
    pub fn apply(self, mechanism: &mut Mechanism, deviation: f64) {
        let laws = mechanism.joints.iter_mut().map(|joint| &mut joint.laws);
        match self {
            Self::Friction => laws.for_each(|laws| rub_more(&mut laws.friction, deviation)),
            Self::Stiffness => laws.for_each(|laws| match &mut laws.contact {
                NormalData::Impact(data) => data.stiffness *= 1.0 + deviation,
                NormalData::HuntCrossley(data) | NormalData::LankaraniNikravesh(data) => {
                    data.stiffness *= 1.0 + deviation;
                }
            }),
            Self::Damping => laws.for_each(|laws| {
                if let NormalData::Impact(data) = &mut laws.contact {
                    data.damping += deviation;
                }
            }),
            Self::Mass(body) => {
                let body = &mut mechanism.bodies[body];
                let share = 1.0 + deviation / body.mass;
                body.mass += deviation;
                body.inertia = body.inertia.map(|moment| moment * share);
            }
            Self::Gain(drive) => mechanism.drives[drive].drive.gain += deviation,
            Self::RampEnd(drive) => mechanism.drives[drive].drive.ramp_end += deviation,
            Self::TiltX => mechanism.gravity = tilted_x(mechanism.gravity, deviation),
            Self::TiltZ => mechanism.gravity = tilted_z(mechanism.gravity, deviation),
        }
    }
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
