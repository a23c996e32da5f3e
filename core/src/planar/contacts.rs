//! The contacts of the planar body: forces at its pins, in body axes.

use nalgebra::{Vector2, Vector3};

use super::{
    Joint, JointForce, Planar, SeenPin,
    turn::{Turn, turned},
};
use crate::{
    Scalar,
    law::{Elastic, Friction},
    mechanism::Way,
};

/// Where the body is and how it moves, in its axes.
#[derive(Clone, Copy)]
pub(super) struct Placed<S> {
    pub turn: Turn<S>,
    pub displacement_b: Vector2<S>,
    pub velocity_b: Vector2<S>,
    pub rotation: S,
}

impl<S: Scalar, C: Joint<S>, E: Elastic<S>, F: Friction<S>, const PINS: usize> Planar<S, C, E, F, PINS> {
    /// Force and torque of all contacts (N, N·m), in body axes; `collect` sees them pin by pin, with the lever (m) from the
    /// centre of mass.
    #[inline(always)]
    pub(super) fn contact_forces(
        &self,
        placed: &Placed<S>,
        memory: &[F::Memory; PINS],
        way: Way<S>,
        mut collect: impl FnMut(Vector2<S>, &JointForce<S, F::Memory>),
    ) -> Vector3<S> {
        let mut sum = Vector3::zeros();
        for ((pin, joint), memory) in self.body.pins_w.iter().zip(&self.body.joints).zip(memory) {
            let offset = placed.turn.change(*pin) - placed.displacement_b;
            let lever = *pin + offset;
            let u = placed.velocity_b + turned(lever) * placed.rotation;
            let pin = SeenPin { offset, u, rotation: placed.rotation };
            let joint = joint.force((&self.contact, &self.friction), memory, &pin, way);
            sum += joint.about(lever);
            collect(lever, &joint);
        }
        sum
    }
}
