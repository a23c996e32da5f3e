//! Parameters of a mechanism that can vary over the production, beside its gaps, or be unknown.

use super::{Mechanism, NormalData, Walls};
use crate::setup::{self, Adjustable, tilted_x, tilted_z};

/// A parameter of a mechanism that varies.
pub type Varied = setup::Varied<Parameter>;
/// An unknown parameter of a mechanism.
pub type Uncertain = setup::Uncertain<Parameter>;

/// A parameter of a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Coefficient of friction of all joints: of those with two the kinetic one, and the static one with it.
    Friction,
    /// Speed below which the regularised friction of all joints fades.
    StickBand,
    /// Stiffness of all contacts; it varies by shares of itself.
    Stiffness,
    /// Damping of all contacts.
    Damping,
    /// Penetration at which the damping of all contacts is full.
    Depth,
    /// Mass of a body; the inertia goes with it.
    Mass(usize),
    /// Gain of a drive.
    Gain(usize),
    /// End of a drive's ramp.
    RampEnd(usize),
    /// The most that a drive's motor gives.
    Limit(usize),
    /// Coulomb friction of a drive's train, along and against its axis.
    Coulomb(usize),
    /// Viscous friction of a drive's train.
    Viscous(usize),
    /// Offset of a drive's train.
    Offset(usize),
    /// Slope of all walls of a joint that have one.
    Slope(usize),
    /// Direction of gravity: rotation about the frame's x.
    TiltX,
    /// Direction of gravity: rotation about the frame's z, in a plane within it.
    TiltZ,
}

impl Adjustable for Parameter {
    type Of = Mechanism;

    fn change(self, mechanism: &mut Mechanism, change: &mut dyn FnMut(f64) -> f64) {
        let gravity = mechanism.gravity;
        let mut replace = |value: Option<&mut f64>| {
            if let Some(value) = value {
                *value = change(*value);
            }
        };
        let joints = mechanism.joints.iter_mut().filter(|joint| !joint.kind.is_ideal());
        let laws = joints.map(|joint| &mut joint.laws);
        match self {
            Self::Friction => laws.for_each(|laws| {
                let mut coefficients = laws.friction.coefficients();
                let Some(kinetic) = coefficients.pop() else { return };
                let before = *kinetic;
                replace(Some(kinetic));
                // A static coefficient keeps its ratio to the kinetic one.
                for at_rest in coefficients {
                    *at_rest = if before > 0.0 { *at_rest * (*kinetic / before) } else { at_rest.max(*kinetic) };
                }
            }),
            Self::StickBand => laws.for_each(|laws| replace(laws.friction.stick_band_mut())),
            Self::Stiffness => laws.for_each(|laws| match &mut laws.contact {
                NormalData::Impact(data) => replace(Some(&mut data.stiffness)),
                NormalData::HuntCrossley(data) | NormalData::LankaraniNikravesh(data) => {
                    replace(Some(&mut data.stiffness));
                }
            }),
            Self::Damping | Self::Depth => laws.for_each(|laws| {
                if let NormalData::Impact(data) = &mut laws.contact {
                    replace(Some(if self == Self::Damping { &mut data.damping } else { &mut data.depth }));
                }
            }),
            Self::Mass(body) => {
                let body = &mut mechanism.bodies[body];
                let before = body.mass;
                replace(Some(&mut body.mass));
                body.inertia = body.inertia.map(|moment| moment * (body.mass / before));
            }
            Self::Gain(drive) => replace(Some(&mut mechanism.drives[drive].drive.gain)),
            Self::RampEnd(drive) => replace(Some(&mut mechanism.drives[drive].drive.ramp_end)),
            Self::Limit(drive) => replace(mechanism.drives[drive].train.as_mut().map(|train| &mut train.limit)),
            Self::Coulomb(drive) => {
                mechanism.drives[drive]
                    .train
                    .iter_mut()
                    .flat_map(|train| &mut train.coulomb)
                    .for_each(|of| replace(Some(of)));
            }
            Self::Viscous(drive) => replace(mechanism.drives[drive].train.as_mut().map(|train| &mut train.viscous)),
            Self::Offset(drive) => replace(mechanism.drives[drive].train.as_mut().map(|train| &mut train.offset)),
            Self::Slope(joint) => {
                if let Walls::Stated(contours) = &mut mechanism.joints[joint].walls {
                    contours.iter_mut().filter(|of| of.slope != 0.0).for_each(|of| replace(Some(&mut of.slope)));
                }
            }
            Self::TiltX => mechanism.gravity = tilted_x(gravity, change(0.0)),
            Self::TiltZ => mechanism.gravity = tilted_z(gravity, change(0.0)),
        }
    }

    fn varies_by_shares(self) -> bool {
        self == Self::Stiffness
    }
}
