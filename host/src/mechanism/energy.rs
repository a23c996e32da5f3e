//! Whether the energy of a run is what its drives and gravity can have supplied.
//!
//! Contacts, friction and dampers take energy and springs return at most what was put into them. A motion with more energy than its
//! start, the fall of its bodies and the work of its drives account for is an error of the computation.

use nalgebra::Vector3;

use slipfit_core::system::spatial::PlacedBody;

use super::{JointKind, Mechanism, columns::BodyMotion, joint_elements::joints_of_elements};

/// The energy, as a share of the greatest one, that a run may have beyond what was supplied.
pub const ENERGY: f64 = 0.01;

/// The energy account of a run (J).
pub struct Energies {
    /// What was stored at the start: in motion and height, and in pressed contacts and turned springs.
    start: f64,
    /// The latter.
    stored: f64,
}

impl Energies {
    /// Of a run of `mechanism` that starts with these `motions` and this `energy` of motion and height; `pressed` are the gaps (m) of its
    /// elements there, as far as they are contacts.
    pub fn new(
        mechanism: &Mechanism,
        motions: &[BodyMotion],
        energy: [f64; 2],
        pressed: impl Iterator<Item = Option<f64>>,
    ) -> Self {
        let contacts = pressed.zip(joints_of_elements(mechanism)).filter_map(|(gap, joint)| {
            let ([stiffness, exponent], depth) = (joint?.laws.contact.spring(), -gap?);
            // Of a pin the deepest of its four walls is known.
            let is_pin = matches!(joint?.kind, JointKind::Track { .. }) && joint?.walls.is_parallel();
            let walls = if is_pin { 4.0 } else { 1.0 };
            (depth > 0.0).then(|| walls * stiffness * libm::pow(depth, exponent + 1.0) / (exponent + 1.0))
        });
        let springs = mechanism.springs.iter().map(|spring| spring.energy(mechanism, motions));
        let stored: f64 = contacts.chain(springs).sum();
        Self { start: energy.iter().sum::<f64>() + stored, stored }
    }

    /// The energy that nothing supplied, as a share of the greatest that there was, of a run at the ends of whose steps bodies have these
    /// energies of motion and height, and drives have done this work.
    pub fn excess(&self, at_knots: impl Iterator<Item = ([f64; 2], f64)>) -> f64 {
        let (mut spent, mut excess) = (self.stored, 0.0);
        for ([moving, height], work) in at_knots {
            // What falls, or swings, spends its height, although the sum of both does not change.
            spent = [self.start, work, moving, height].into_iter().fold(spent, |most, one| most.max(one.abs()));
            // A NaN is no energy that anything supplied.
            let too_much = moving + height - self.start - work;
            if too_much > excess || too_much.is_nan() {
                excess = too_much;
            }
        }
        if excess == 0.0 { 0.0 } else { excess / spent.max(f64::MIN_POSITIVE) }
    }
}

impl Mechanism {
    /// Energy (J) of motion, and of height against gravity from the drawn pose, of `bodies`.
    pub fn energy(&self, bodies: &[PlacedBody<f64>]) -> [f64; 2] {
        let gravity = Vector3::from(self.gravity);
        let each = self.bodies.iter().zip(bodies).enumerate().map(|(k, (body, at))| {
            let (moved, inertia) = self.moved_with(k);
            let turning: f64 = at.rotation_b.iter().zip(inertia).map(|(spin, inertia)| inertia * spin * spin).sum();
            let height = -body.mass * gravity.dot(&at.displacement_w);
            [0.5 * (moved * at.velocity_w.norm_squared() + turning), height]
        });
        each.fold([0.0, 0.0], |[moving, height], [of_motion, of_height]| [moving + of_motion, height + of_height])
    }
}

/// The work (J) of a drive.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    /// Up to when it was seen last.
    pub done: f64,
    /// When (s) that was, and its power (W) then.
    last: [f64; 2],
}

impl Work {
    /// Takes note of its `power` (W) at time `t` (s). Times ascend.
    pub fn observe(&mut self, t: f64, power: f64) {
        let [before, power_before] = self.last;
        self.done += 0.5 * (t - before) * (power + power_before);
        self.last = [t, power];
    }
}
