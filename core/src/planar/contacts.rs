//! The contacts of the planar body: forces at its pins, in body axes, and how they change.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::{
    Planar,
    turn::{Turn, at, turned},
};
use crate::{
    Scalar,
    law::{Elastic, Friction, Stop, friction::Rubbing, stop::Resistance},
};

/// How forces are to be linearised; see [`Rubbing`].
#[derive(Clone, Copy)]
pub(super) struct Way<S> {
    pub a: S,
    pub mass_rate: S,
    pub tangent_share: S,
}

/// Where the body is and how it moves, in its axes.
#[derive(Clone, Copy)]
pub(super) struct Placed<S> {
    pub turn: Turn<S>,
    pub displacement_b: Vector2<S>,
    pub velocity_b: Vector2<S>,
    pub rotation: S,
}

/// The force at one pin and −∂force/∂(u, x), by the velocity and the displacement of the material there.
pub(super) struct PinForce<S, M> {
    pub lever: Vector2<S>,
    pub force: Vector2<S>,
    pub impedance: Matrix2<S>,
    pub stiffness: Matrix2<S>,
    /// What friction remembers if the motion is accepted.
    pub memory: M,
}

impl<S: Scalar, C: Stop<S>, E: Elastic<S>, F: Friction<S>, const PINS: usize> Planar<S, C, E, F, PINS> {
    /// Force and torque of all contacts (N, N·m), in body axes; `collect` sees them pin by pin.
    #[inline(always)]
    pub(super) fn contact_forces(
        &self,
        placed: &Placed<S>,
        memory: &[F::Memory; PINS],
        way: Way<S>,
        mut collect: impl FnMut(&PinForce<S, F::Memory>),
    ) -> Vector3<S> {
        let mut sum = Vector3::zeros();
        for ((pin, stop), memory) in self.body.pins_w.iter().zip(&self.body.stops).zip(memory) {
            let offset = placed.turn.change(*pin) - placed.displacement_b;
            let lever = *pin + offset;
            let u = placed.velocity_b + turned(lever) * placed.rotation;
            let stop = stop.resistance(&self.contact, offset.x, u.x);
            let rubbing = Rubbing {
                sliding: [u.y, S::zero()],
                normal: stop.normal(),
                mass_rate: way.mass_rate,
                tangent_share: way.tangent_share,
            };
            let (traction, memory) = self.friction.traction(memory, &rubbing);
            let [along, _] = traction.per_normal;
            let ([own, normal], [own_stiffness, normal_stiffness]) = (stop.impedances(way.a), stop.stiffnesses());
            let zero = S::zero();
            let pin = PinForce {
                lever,
                force: Vector2::new(stop.force(), traction.force[0]),
                impedance: Matrix2::new(own, zero, along * normal, traction.impedance[0]),
                stiffness: Matrix2::new(own_stiffness, zero, along * normal_stiffness, zero),
                memory,
            };
            sum += at(lever, pin.force);
            collect(&pin);
        }
        sum
    }
}
