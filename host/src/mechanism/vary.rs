//! Parameters of a mechanism that vary over the production, beside its gaps.

use super::{Mechanism, NormalData};
use crate::setup::{self, rub_more, tilted_x, tilted_z};

/// A parameter of a mechanism that varies.
pub type Varied = setup::Varied<Parameter>;

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
