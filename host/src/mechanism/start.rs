//! How a mechanism starts: at rest as it is drawn, or turned and moving as its bodies say.

use nalgebra::{UnitQuaternion, Vector3};
use slipfit_core::{
    pose::{Orientation, Pose},
    system::{
        planar::Coordinate,
        spatial::tree::{Joint as IdealJoint, Mount},
    },
};

use super::{Mechanism, Mounts, mounts::flat};

/// Where and how fast a mechanism on ideal joints starts.
pub struct Rest<const D: usize> {
    /// Coordinates (m, rad) from the drawn pose.
    pub places: [f64; D],
    /// Their rates (m/s, rad/s).
    pub rates: [f64; D],
}

impl<const D: usize> Rest<D> {
    /// That of `mechanism`.
    pub fn of(mechanism: &Mechanism, mounts: &Mounts) -> Self {
        let (mut places, mut rates) = ([0.0; D], [0.0; D]);
        for (k, owned) in mounts.coordinates().iter().enumerate() {
            let start = mechanism.bodies[owned.body].start;
            (places[k], rates[k]) = match owned.coordinate {
                Coordinate::Turn => (start.angle, start.spin),
                Coordinate::Slide { axis, .. } => match start.thrown {
                    Some(thrown) => (0.0, axis.dot(&flat(thrown.velocity))),
                    None => (0.0, start.speed),
                },
            };
        }
        Self { places, rates }
    }

    /// That of `mechanism` in space on its `mounts`.
    pub fn on_joints(mechanism: &Mechanism, mounts: &[Mount<f64>]) -> Self {
        let (mut places, mut rates) = ([0.0; D], [0.0; D]);
        let mut k = 0;
        for mount in mounts {
            let start = mechanism.bodies[mount.body].start;
            let [of_slide, of_turn] = [(0.0, start.speed), (start.angle, start.spin)];
            let own: &[(f64, f64)] = match mount.joint {
                IdealJoint::Revolute { .. } => &[of_turn],
                IdealJoint::Prismatic { .. } => &[of_slide],
                IdealJoint::Cylindrical { .. } => &[of_slide, of_turn],
                IdealJoint::Fixed | IdealJoint::Spherical { .. } | IdealJoint::Free => &[],
            };
            for (j, (place, rate)) in own.iter().enumerate() {
                (places[k + j], rates[k + j]) = (*place, *rate);
            }
            k += mount.joint.freedoms();
        }
        Self { places, rates }
    }
}

/// The poses of the free bodies of `mechanism` in space at the start, and their velocities (m/s, rad/s), the angular ones in the axes of
/// the body.
pub fn thrown(mechanism: &Mechanism) -> Vec<(Pose<f64>, [f64; 6])> {
    let of_body = |body: &super::Body| {
        let Some(thrown) = body.start.thrown else { return (Pose::nominal(), [0.0; 6]) };
        let turned = UnitQuaternion::from_scaled_axis(Vector3::from(thrown.turned));
        let orientation = Orientation { w: turned.w, v: turned.imag() };
        let [[x, y, z], spin] =
            [thrown.velocity.into(), turned.inverse() * Vector3::from(thrown.spin)].map(<[f64; 3]>::from);
        (Pose { displacement_w: thrown.displacement.into(), orientation }, [x, y, z, spin[0], spin[1], spin[2]])
    };
    mechanism.bodies.iter().map(of_body).collect()
}
