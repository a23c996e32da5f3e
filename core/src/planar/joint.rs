//! What holds the body at a pin.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use super::turn::{at, spread};
use crate::{
    Scalar,
    law::{Elastic, Friction, Impact, Stop, stop::Resistance},
    mechanism::Way,
};

/// A pin as seen from the body, in the body's axes.
#[derive(Clone, Copy, Debug)]
pub struct SeenPin<S> {
    /// Displacement of the pin's middle (m).
    pub offset: Vector2<S>,
    /// Velocity of the body's material there (m/s).
    pub u: Vector2<S>,
    /// Angular velocity of the body (rad/s).
    pub rotation: S,
}

/// The force of a joint on the body at the middle of its pin and how it changes. Axes of the body; of the matrices rows are
/// forces.
#[derive(Clone, Copy, Debug)]
pub struct JointForce<S, M> {
    /// Force (N).
    pub force: Vector2<S>,
    /// −∂force/∂u (N·s/m) by the velocity of the body's material at the pin, which also moves it over the time `a`.
    pub impedance: Matrix2<S>,
    /// −∂force/∂x (N/m) by the displacement of the body's material at the pin, while u stays.
    pub stiffness: Matrix2<S>,
    /// What friction on a pin of some width adds, if it can.
    pub moment: Option<Moment<S>>,
    /// What friction remembers if the motion is accepted.
    pub memory: M,
}

/// The torque of a joint about the middle of its pin, and all that goes by the body's turning.
#[derive(Clone, Copy, Debug)]
pub struct Moment<S> {
    /// Torque on the body (N·m).
    pub torque: S,
    /// −∂torque/∂u (N·s), as the impedance of the force.
    pub impedance: Vector2<S>,
    /// −∂torque/∂x (N), as the stiffness of the force.
    pub stiffness: Vector2<S>,
    /// −∂force/∂ω (N·s) by the angular velocity.
    pub force_by_rotation: Vector2<S>,
    /// −∂torque/∂ω (N·m·s).
    pub torque_by_rotation: S,
}

impl<S: Scalar, M> JointForce<S, M> {
    /// Force and torque about the centre of mass, from which `lever` (m) leads to the pin.
    #[inline(always)]
    pub(super) fn about(&self, lever: Vector2<S>) -> Vector3<S> {
        with_torque(at(lever, self.force), self.moment.as_ref().map(|moment| moment.torque))
    }

    /// What its impedance means for force and torque by the body's velocity and angular velocity.
    #[inline(always)]
    pub(super) fn damping(&self, lever: Vector2<S>) -> Matrix3<S> {
        let mut damping = spread(lever, columns(lever, &self.impedance, self.moment.map(|moment| moment.impedance)));
        if let Some(Moment { force_by_rotation, torque_by_rotation, .. }) = self.moment {
            let by_rotation = with_torque(at(lever, force_by_rotation), Some(torque_by_rotation));
            damping.column_mut(2).zip_apply(&by_rotation, |sum, part| *sum += part);
        }
        damping
    }

    /// What its stiffness means for force and torque by the body's displacement and turn, while the body's velocity stays:
    /// where the body turns with `rotation` (rad/s), a displacement changes the velocity of its material at the pin.
    #[inline(always)]
    pub(super) fn stiffness(&self, lever: Vector2<S>, rotation: S) -> Matrix3<S> {
        let carried = Matrix2::new(S::zero(), -rotation, rotation, S::zero());
        let moment = self.moment.map(|moment| moment.stiffness + carried.tr_mul(&moment.impedance));
        spread(lever, columns(lever, &(self.stiffness + self.impedance * carried), moment))
    }

    /// −∂(force, torque) by a change of u.
    #[inline(always)]
    pub(super) fn by_velocity(&self, lever: Vector2<S>, u: Vector2<S>) -> Vector3<S> {
        let torque = self.moment.as_ref().map(|moment| moment.impedance.dot(&u));
        with_torque(at(lever, self.impedance * u), torque)
    }
}

#[inline(always)]
fn with_torque<S: Scalar>(at: Vector3<S>, torque: Option<S>) -> Vector3<S> {
    match torque {
        Some(torque) => Vector3::new(at.x, at.y, at.z + torque),
        None => at,
    }
}

/// Force and torque by either part of u, from those of the force and of the torque about the pin.
#[inline(always)]
fn columns<S: Scalar>(lever: Vector2<S>, force: &Matrix2<S>, torque: Option<Vector2<S>>) -> [Vector3<S>; 2] {
    let [x, z]: [[S; 2]; 2] = force.data.0;
    [
        with_torque(at(lever, Vector2::from(x)), torque.map(|torque| torque.x)),
        with_torque(at(lever, Vector2::from(z)), torque.map(|torque| torque.y)),
    ]
}

/// A clearance joint in the plane: a stop [`Across`], or a [`Journal`](super::Journal) around the pin.
pub trait Joint<S>: Copy {
    /// The force by the laws `contact` and `friction`.
    fn force<E: Elastic<S>, F: Friction<S>>(
        &self,
        laws: (&Impact<S, E>, &F),
        memory: &F::Memory,
        pin: &SeenPin<S>,
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
        SeenPin { offset, u, .. }: &SeenPin<S>,
        way: Way<S>,
    ) -> JointForce<S, F::Memory> {
        let stop = self.0.resistance(contact, offset.x, u.x);
        let zero = S::zero();
        let (traction, memory) = friction.traction(memory, &way.sliding([u.y, zero], stop.normal()));
        let [along, _] = traction.per_normal;
        let ([own, normal], [own_stiffness, normal_stiffness]) = (stop.impedances(way.a), stop.stiffnesses());
        JointForce {
            force: Vector2::new(stop.force(), traction.force[0]),
            impedance: Matrix2::new(own, zero, along * normal, traction.impedance[0]),
            stiffness: Matrix2::new(own_stiffness, zero, along * normal_stiffness, zero),
            moment: None,
            memory,
        }
    }
}
