//! A ring around a rod: the paper's cylindrical joint in space.
//!
//! The rod is the third axis of the link. With ρ from the rod's axis to the ring's centre the gap is q − |ρ|; the rod pushes the
//! ring's body along −ρ at the point of its surface on the far side of its axis, and there they rub, along the rod and around it.

use super::{Contact, Law, Response, along, steady};
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
    type Memory = F::Memory;

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 2;

    #[inline(always)]
    fn fresh() -> F::Memory {
        F::fresh()
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 6>,
        rate: &SVector<S, 6>,
        memory: &F::Memory,
        way: Way<S>,
    ) -> (Response<S, 6>, F::Memory) {
        let one = S::one();
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

        // By ρ along normal and tangent, then velocity and rotation along normal, tangent and rod. Along the tangent the
        // axes turn by 1/|ρ|.
        let by_turn = along::<S, 8>(1, per_distance);
        let depth = (distance - self.clearance, along::<S, 8>(0, one));
        let approach = (outward, along::<S, 8>(2, one) + by_turn * aside);
        let around =
            (aside - rim * rate[5], along::<S, 8>(3, one) - by_turn * outward - along(0, rate[5]) - along(7, rim));
        let along_rod = (
            rate[2] + rim * about_tangent,
            along::<S, 8>(4, one) + along(0, about_tangent) + along(6, rim) - by_turn * (rim * about_normal),
        );
        let touch = self.contact.touch(memory, way, [depth, approach], [around, along_rod]);
        let ([turn, rub], [turn_slope, rub_slope]) = (touch.traction, touch.traction_slopes);
        let rows = [
            -touch.force_slope - by_turn * turn,
            turn_slope - by_turn * touch.force,
            rub_slope,
            by_turn * -(rim * rub),
            rub_slope * rim + along(0, rub),
            -(turn_slope * rim) - along(0, turn),
        ];
        let push = tangent * turn - normal * touch.force;
        let moment = tangent * (rim * rub);
        let force = SVector::<S, 6>::new(push.x, push.y, rub, moment.x, moment.y, -(rim * turn));
        let (mut by_place, mut by_rate) = (SMatrix::<S, 6, 6>::zeros(), SMatrix::<S, 6, 6>::zeros());
        for (i, row) in rows.iter().enumerate() {
            for j in 0..2 {
                by_place[(i, j)] = -row[j];
            }
            for j in 0..6 {
                by_rate[(i, j)] = -row[j + 2];
            }
        }
        let axes = [normal, tangent];
        (steady(force, in_link(&axes, by_rate), in_link(&axes, by_place)).moving(way.over, 2), touch.memory)
    }

    #[inline(always)]
    fn shifted(base: &F::Memory, from: &F::Memory, to: &F::Memory, weight: S) -> F::Memory {
        F::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn or_old(new: &F::Memory, condition: S, old: &F::Memory) -> F::Memory {
        F::or_old(new, condition, old)
    }
}

/// A·`local`·Aᵀ, where A turns two triples from the axes normal, tangent and rod into those of the link. Written out, because most
/// of A is zero.
#[inline(always)]
fn in_link<S: Scalar>([normal, tangent]: &[Vector2<S>; 2], mut local: SMatrix<S, 6, 6>) -> SMatrix<S, 6, 6> {
    for first in [0, 3] {
        for j in 0..6 {
            let turned = normal * local[(first, j)] + tangent * local[(first + 1, j)];
            (local[(first, j)], local[(first + 1, j)]) = (turned.x, turned.y);
        }
    }
    for first in [0, 3] {
        for i in 0..6 {
            let turned = normal * local[(i, first)] + tangent * local[(i, first + 1)];
            (local[(i, first)], local[(i, first + 1)]) = (turned.x, turned.y);
        }
    }
    local
}
