//! What holds the body at a pin.

use nalgebra::{Matrix2, Vector2};

use crate::{
    Scalar,
    law::{Elastic, Friction, Impact, Stop, stop::Resistance},
    mechanism::Way,
};

/// The force of a joint on the body at its pin and how it changes. Axes of the body; of the matrices rows are forces.
#[derive(Clone, Copy, Debug)]
pub struct JointForce<S, M> {
    /// Force (N).
    pub force: Vector2<S>,
    /// −∂force/∂u (N·s/m) by the velocity of the body's material at the pin, which also moves it over the time `a`.
    pub impedance: Matrix2<S>,
    /// −∂force/∂x (N/m) by the displacement of the body's material at the pin.
    pub stiffness: Matrix2<S>,
    /// What friction remembers if the motion is accepted.
    pub memory: M,
}

/// A clearance joint in the plane: a stop [`Across`], or a [`Journal`](super::Journal) around the pin.
pub trait Joint<S>: Copy {
    /// The force by the laws `contact` and `friction` with the pin displaced by `offset` (m) as seen from the body, whose
    /// material there moves with `u` (m/s); both in the body's axes.
    fn force<E: Elastic<S>, F: Friction<S>>(
        &self,
        laws: (&Impact<S, E>, &F),
        memory: &F::Memory,
        offset: Vector2<S>,
        u: Vector2<S>,
        way: Way<S>,
    ) -> JointForce<S, F::Memory>;
}

/// A [`Stop`] across: its axis is the body's x, and along z the pin rubs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across<C>(pub C);

impl<S: Scalar, C: Stop<S>> Joint<S> for Across<C> {
    #[inline(always)]
    fn force<E: Elastic<S>, F: Friction<S>>(
        &self,
        (contact, friction): (&Impact<S, E>, &F),
        memory: &F::Memory,
        offset: Vector2<S>,
        u: Vector2<S>,
        way: Way<S>,
    ) -> JointForce<S, F::Memory> {
        let stop = self.0.resistance(contact, offset.x, u.x);
        let zero = S::zero();
        let (traction, memory) = friction.traction(memory, &way.rubbing([u.y, zero], stop.normal()));
        let [along, _] = traction.per_normal;
        let ([own, normal], [own_stiffness, normal_stiffness]) = (stop.impedances(way.a), stop.stiffnesses());
        JointForce {
            force: Vector2::new(stop.force(), traction.force[0]),
            impedance: Matrix2::new(own, zero, along * normal, traction.impedance[0]),
            stiffness: Matrix2::new(own_stiffness, zero, along * normal_stiffness, zero),
            memory,
        }
    }
}
