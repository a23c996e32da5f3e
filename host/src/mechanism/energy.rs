//! Whether the energy of a run is what its drives and gravity can have supplied.
//!
//! Contacts, friction and dampers take energy and springs return at most what was put into them. A motion with more energy than its
//! start, the fall of its bodies and the work of its drives account for is an error of the computation.

use nalgebra::Vector3;

use super::{Action, JointKind, Mechanism, columns::BodyMotion, joint_elements::joints_of_elements};
use crate::dynamics::observer::Instant;

/// The energy, as a share of the greatest one, that a run may have beyond what was supplied.
pub const ENERGY: f64 = 0.01;

/// The energy account of a run (J).
pub struct Energies<'a> {
    mechanism: &'a Mechanism,
    /// What was stored at the start: in motion and height, and in pressed contacts and turned springs.
    start: f64,
    /// Work of each drive.
    work: Vec<f64>,
    /// Time (s) and power (W) of each drive when it was seen last.
    last: (f64, Vec<f64>),
    /// The greatest of what there was to spend, and of what there was too much of it.
    spent: f64,
    excess: f64,
}

impl<'a> Energies<'a> {
    /// Of a run of `mechanism` that starts with these `motions`; `pressed` are the gaps (m) of its elements there, as far as they are
    /// contacts.
    pub fn new(mechanism: &'a Mechanism, motions: &[BodyMotion], pressed: impl Iterator<Item = Option<f64>>) -> Self {
        let contacts = pressed.zip(joints_of_elements(mechanism)).filter_map(|(gap, joint)| {
            let ([stiffness, exponent], depth) = (joint?.laws.contact.spring(), -gap?);
            // Of a pin the deepest of its four walls is known.
            let is_pin = matches!(joint?.kind, JointKind::Track { .. }) && joint?.walls.is_parallel();
            let walls = if is_pin { 4.0 } else { 1.0 };
            (depth > 0.0).then(|| walls * stiffness * libm::pow(depth, exponent + 1.0) / (exponent + 1.0))
        });
        let springs = mechanism.springs.iter().map(|spring| spring.energy(mechanism, motions));
        let stored: f64 = contacts.chain(springs).sum();
        let start = mechanism.energy(motions).iter().sum::<f64>() + stored;
        let count = mechanism.drives.len();
        Self { mechanism, start, work: vec![0.0; count], last: (0.0, vec![0.0; count]), spent: stored, excess: 0.0 }
    }

    /// Takes note of the `motions` and the `drives` at time `t` (s). Times ascend.
    pub fn observe(&mut self, t: f64, motions: &[BodyMotion], drives: &[Instant]) {
        let length = t - self.last.0;
        for (k, (named, at)) in self.mechanism.drives.iter().zip(drives).enumerate() {
            let motion = &motions[named.body];
            let speed = match named.action {
                Action::Turns { .. } => at.vz,
                Action::Pushes { axis } => {
                    let point = motion.orientation * named.drive.point_b;
                    (motion.velocity + motion.spin.cross(&point)).dot(&Vector3::from(axis))
                }
            };
            // An offset of the drive train works like a force.
            let offset = named.train.map_or(0.0, |train| train.offset);
            let power = (at.force - offset) * speed;
            self.work[k] += 0.5 * length * (power + self.last.1[k]);
            self.last.1[k] = power;
        }
        self.last.0 = t;
        let work: f64 = self.work.iter().sum();
        // What falls, or swings, spends its height, although the sum of both does not change.
        let [moving, height] = self.mechanism.energy(motions);
        let energy = moving + height;
        let all = [self.start, work, moving, height].into_iter().fold(self.spent, |most, one| most.max(one.abs()));
        self.spent = all;
        // A NaN is no energy that anything supplied.
        let excess = energy - self.start - work;
        if excess > self.excess || excess.is_nan() {
            self.excess = excess;
        }
    }

    /// The energy that nothing supplied, as a share of the greatest energy that there was.
    pub fn excess(&self) -> f64 {
        if self.excess == 0.0 { 0.0 } else { self.excess / self.spent.max(f64::MIN_POSITIVE) }
    }
}

impl Mechanism {
    /// Energy (J) of motion, and of height against gravity from the drawn pose.
    fn energy(&self, motions: &[BodyMotion]) -> [f64; 2] {
        let gravity = Vector3::from(self.gravity);
        let each = self.bodies.iter().zip(motions).enumerate().map(|(k, (body, motion))| {
            let (moved, inertia) = self.moved_with(k);
            // In a plane axes of body and frame share the one that counts.
            let spin_b = if self.planar { motion.spin } else { motion.orientation.inverse() * motion.spin };
            let turning: f64 = spin_b.iter().zip(inertia).map(|(spin, inertia)| inertia * spin * spin).sum();
            [0.5 * (moved * motion.velocity.norm_squared() + turning), -body.mass * gravity.dot(&motion.displacement)]
        });
        each.fold([0.0, 0.0], |[moving, height], [of_motion, of_height]| [moving + of_motion, height + of_height])
    }
}
