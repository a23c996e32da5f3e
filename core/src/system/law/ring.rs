//! A ring around a rod: the paper's cylindrical joint in space.
//!
//! The rod is the third axis of the link. With ρ from the rod's axis to the ring's centre the gap is q − |ρ|; the rod pushes the
//! ring's body along −ρ at the point of its surface on the far side of its axis, and there they rub, along the rod and around it.

use super::{Contact, Law, Response, steady};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    law::{Friction, Normal},
    mechanism::Way,
    system::planar::left,
};

/// The law of a ring, seen as displacement of its centre from the rod's origin and the rotation of its body against the rod's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring<S, N, F> {
    /// Radial clearance q (m).
    pub clearance: S,
    /// Radius of the rod (m).
    pub radius: S,
    /// Its laws.
    pub contact: Contact<N, F>,
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 6> for Ring<S, N, F> {
    type Internal = F::Internal;

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 2;

    #[inline(always)]
    fn fresh() -> F::Internal {
        F::fresh()
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 6>,
        rate: &SVector<S, 6>,
        internal: &F::Internal,
        way: Way<S>,
    ) -> (Response<S, 6>, F::Internal) {
        let apart = Vector2::new(place[0], place[1]);
        let squared = apart.dot(&apart);
        let per_distance = squared.max_of(S::from_f64(1e-30)).rsqrt();
        let distance = squared * per_distance;
        let normal = apart * per_distance;
        let tangent = left(&normal);
        let (moving, turning) = (Vector2::new(rate[0], rate[1]), Vector2::new(rate[3], rate[4]));
        let (outward, aside) = (moving.dot(&normal), moving.dot(&tangent));
        let (about_normal, about_tangent) = (turning.dot(&normal), turning.dot(&tangent));
        let rim = distance + self.radius;
        let sliding = [aside - rim * rate[5], rate[2] + rim * about_tangent];
        let (pressed, traction, internal) =
            self.contact.meet(internal, way, [distance - self.clearance, outward], sliding);
        let (force, [turn, rub]) = (pressed.force, traction.force);
        let ([own, mixed, other], [by_turn, by_rub]) = (traction.impedance, traction.per_normal);

        // How friction around the rod and along it changes, negated, with the six rates; the first two velocities and the first two
        // turns enter through normal and tangent. Rows of `impedance` follow from them, columns are the rates.
        let damping = pressed.impedance(None);
        let row = |per_normal: S, [around, along]: [S; 2]| {
            let (moves, turns) = (normal * (per_normal * damping) + tangent * around, tangent * (rim * along));
            [moves.x, moves.y, along, turns.x, turns.y, -(rim * around)]
        };
        let (turn_row, rub_row) = (row(by_turn, [own, mixed]), row(by_rub, [mixed, other]));
        let pushed = normal * damping;
        let mut impedance = SMatrix::<S, 6, 6>::zeros();
        for (j, (turn, rub)) in turn_row.into_iter().zip(rub_row).enumerate() {
            let push = tangent * turn;
            let moment = tangent * (rim * rub);
            let column = [push.x, push.y, rub, moment.x, moment.y, -(rim * turn)];
            impedance.data.0[j] = column;
        }
        for (j, by_move) in [pushed.x, pushed.y].into_iter().enumerate() {
            impedance.data.0[j][0] += normal.x * by_move;
            impedance.data.0[j][1] += normal.y * by_move;
        }

        // With the place along the normal and along the tangent; along the tangent normal and tangent turn by 1/|ρ| (rad/m).
        let stiffness = pressed.stiffness();
        let force_aside = damping * (per_distance * aside);
        let (around, along) = (-(per_distance * outward), -(per_distance * rim * about_normal));
        let turn_by = [
            by_turn * stiffness - own * rate[5] + mixed * about_tangent,
            by_turn * force_aside + own * around + mixed * along,
        ];
        let rub_by = [
            by_rub * stiffness - mixed * rate[5] + other * about_tangent,
            by_rub * force_aside + mixed * around + other * along,
        ];
        let column = |[push, turned]: [S; 2], rub: S, [about, moment]: [S; 2], twist: S| {
            let (push, moment) = (normal * push + tangent * turned, normal * about + tangent * moment);
            SVector::<S, 6>::from([push.x, push.y, rub, moment.x, moment.y, twist])
        };
        let by_normal =
            column([stiffness, turn_by[0]], rub_by[0], [S::zero(), rim * rub_by[0] - rub], turn - rim * turn_by[0]);
        let by_tangent = column(
            [force_aside + per_distance * turn, turn_by[1] + per_distance * force],
            rub_by[1],
            [rim * (per_distance * rub), rim * rub_by[1]],
            -(rim * turn_by[1]),
        );
        let mut by_place = SMatrix::<S, 6, 6>::zeros();
        for (k, column) in by_place.data.0.iter_mut().enumerate().take(2) {
            *column = (by_normal * normal[k] + by_tangent * tangent[k]).data.0[0];
        }

        let push = tangent * turn - normal * force;
        let moment = tangent * (rim * rub);
        let force = SVector::<S, 6>::new(push.x, push.y, rub, moment.x, moment.y, -(rim * turn));
        (steady(force, impedance, by_place).moving(way.over, 2), internal)
    }

    #[inline(always)]
    fn shifted(base: &F::Internal, from: &F::Internal, to: &F::Internal, weight: S) -> F::Internal {
        F::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn or_old(new: &F::Internal, condition: S, old: &F::Internal) -> F::Internal {
        F::or_old(new, condition, old)
    }
}
