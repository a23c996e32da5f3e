//! A journal: a hole of the body around a pin, the paper's cylindrical joint (Fig. 3).
//!
//! With the radial clearance q and the pin's middle off the hole's by ρ, the gap is q − |ρ|, and its normal n is along ρ.
//! The pin pushes the hole's wall, and so the body, along n. It rubs along the tangent t = y × n against u·t + R·ω, the
//! velocity of the body's material at the rim of the pin, whose radius is R; so friction also has the torque R times itself
//! about the pin. Where the pin is inside there is no force, and so none where ρ = 0 has no direction.

use nalgebra::{Matrix2, Vector2};

use super::{Joint, JointForce, Moment, SeenPin, turn::turned};
use crate::{
    ParameterError, Scalar,
    error::bounded,
    law::{Elastic, Friction, Impact},
    mechanism::Way,
};

/// A journal that is concentric with its pin at the nominal pose.
///
/// Friction's memory is the force along t, and so goes round with the pin. Without contact at a step's end it is zero; should
/// the pin cross the hole within one step, the old force counts along the tangent at the other side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Journal<S> {
    clearance: S,
    radius: S,
}

impl<S: Scalar + PartialOrd> Journal<S> {
    /// A journal of the radial `clearance` (m), by which the hole's radius exceeds the pin's, around a pin of `radius` (m),
    /// 0 for a point, on which turning rubs nothing.
    ///
    /// # Errors
    /// If either is not finite or out of bounds, 1e-9…1 m for the clearance and 0…10 m for the radius. There is no journal
    /// without clearance: its pin would not meet the hole at one point.
    pub fn new(clearance: S, radius: S) -> Result<Self, ParameterError<S>> {
        Ok(Self {
            clearance: bounded("journal.clearance", clearance, [1e-9, 1.0])?,
            radius: bounded("journal.radius", radius, [0.0, 10.0])?,
        })
    }
}

impl<S: Scalar> Joint<S> for Journal<S> {
    #[inline(always)]
    fn force<E: Elastic<S>, F: Friction<S>>(
        &self,
        (contact, friction): (&Impact<S, E>, &F),
        memory: &F::Memory,
        SeenPin { offset, u, rotation }: &SeenPin<S>,
        way: Way<S>,
    ) -> JointForce<S, F::Memory> {
        let zero = S::zero();
        let squared = offset.dot(offset);
        let per_distance = squared.max_of(S::from_f64(1e-30)).rsqrt();
        let normal = offset * per_distance;
        let tangent = turned(normal);
        let (outward, aside) = (u.dot(&normal), u.dot(&tangent));
        let wall = contact.response(squared * per_distance - self.clearance, -outward);
        let sliding = aside + self.radius * *rotation;
        let (traction, memory) = friction.traction(memory, &way.sliding([sliding, zero], wall.force));
        let ([rub, ..], [per_normal, _]) = (traction.force, traction.per_normal);
        // A law that sticks also does so without load, which counts for nothing here.
        let drag = wall.force.select_gt(zero, traction.impedance[0], zero);

        // In the axes (n, t), which a displacement along t turns by 1/|ρ|; `by_turn` is what friction has of that.
        let (damping, stiffness) = (wall.impedance(zero), wall.stiffness());
        let by_velocity = Matrix2::new(damping, zero, -per_normal * damping, drag);
        let by_turn = drag * outward + per_normal * damping * aside;
        let by_place = |by_turn: S| {
            let turning = -(damping * aside + rub) * per_distance;
            Matrix2::new(stiffness, turning, -per_normal * stiffness, (wall.force + by_turn) * per_distance)
        };
        // Over long steps a fast approach would make it so negative that it steers Newton the wrong way.
        let steering = by_turn.max_of(zero);
        let axes = Matrix2::from_columns(&[normal, tangent]);
        let in_body = |local: Matrix2<S>| axes * local * axes.transpose();
        let dragged_by_place = |by_turn: S| Vector2::new(-per_normal * stiffness, by_turn * per_distance);
        let dragged_by_velocity = Vector2::new(-per_normal * damping, drag);
        let moment = Moment {
            torque: self.radius * rub,
            impedance: axes * (dragged_by_velocity + dragged_by_place(steering) * way.a) * self.radius,
            stiffness: axes * dragged_by_place(by_turn) * self.radius,
            force_by_rotation: tangent * (drag * self.radius),
            torque_by_rotation: drag * self.radius * self.radius,
        };
        JointForce {
            force: normal * wall.force + tangent * rub,
            impedance: in_body(by_velocity + by_place(steering) * way.a),
            stiffness: in_body(by_place(by_turn)),
            moment: Some(moment),
            memory,
        }
    }
}

#[cfg(test)]
mod tests;
