//! A ring around a rod: the paper's cylindrical joint in space.
//!
//! The rod is the third axis of the link. With ρ from the rod's axis to the ring's centre the gap is q − |ρ|; the rod pushes the
//! ring's body along −ρ at the point of its surface on the far side of its axis, and there they rub, along the rod and around it.

use super::{Contact, Law, Response, steady};
use crate::{
    SMatrix, SVector, Scalar, Vector2, Vector3,
    law::{Friction, Normal},
    linear::{growing, length},
    mechanism::Way,
    system::planar::left,
};

/// The law of a ring, seen as displacement of its centre from the rod and as the rate where they touch: see
/// [`Rim`](crate::system::spatial::Rim).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring<S, N, F> {
    /// Radial clearance q (m).
    pub clearance: S,
    /// Its laws.
    pub contact: Contact<N, F>,
}

/// Directions about a rod, across it.
struct Around<S> {
    normal: Vector2<S>,
    tangent: Vector2<S>,
}

impl<S: Scalar> Around<S> {
    /// Of numbers along the normal, around the rod and along it.
    #[inline(always)]
    fn vector(&self, outward: S, around: S, along: S) -> Vector3<S> {
        let across = self.normal * outward + self.tangent * around;
        Vector3::new(across.x, across.y, along)
    }

    /// Of what goes by motions along the normal, around the rod and along it.
    #[inline(always)]
    fn matrix(&self, outward: Vector3<S>, around: Vector3<S>, along: Vector3<S>) -> SMatrix<S, 3, 3> {
        let x = outward * self.normal.x + around * self.tangent.x;
        let y = outward * self.normal.y + around * self.tangent.y;
        SMatrix::<S, 3, 3>::from_columns(&[x, y, along])
    }
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 3> for Ring<S, N, F> {
    type Internal = F::Internal;

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 2;

    #[inline(always)]
    fn fresh(&self) -> F::Internal {
        F::fresh()
    }

    #[inline(always)]
    fn gap(&self, place: &SVector<S, 3>) -> S {
        let [distance, _] = length(&Vector2::new(place[0], place[1]));
        self.clearance - distance
    }

    #[inline(always)]
    fn each_gap(&self, place: &SVector<S, 3>, rate: &SVector<S, 3>, mut see: impl FnMut(S, S)) {
        let [distance, speed] = growing(&Vector2::new(place[0], place[1]), &Vector2::new(rate[0], rate[1]));
        see(self.clearance - distance, -speed);
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 3>,
        rate: &SVector<S, 3>,
        internal: &F::Internal,
        way: Way<S>,
    ) -> (Response<S, 3>, F::Internal) {
        let zero = S::zero();
        let apart = Vector2::new(place[0], place[1]);
        let [distance, per_distance] = length(&apart);
        let normal = apart * per_distance;
        let tangent = left(&normal);
        let moving = Vector2::new(rate[0], rate[1]);
        let (outward, around) = (moving.dot(&normal), moving.dot(&tangent));
        let (pressed, traction, internal) =
            self.contact.meet(internal, way, [distance - self.clearance, outward], [around, rate[2]]);
        let (push, [turn, rub]) = (pressed.force, traction.force);
        let ([own, mixed, other], [by_turn, by_rub]) = (traction.impedance, traction.per_normal);
        let rod = Around { normal, tangent };
        let damping = pressed.impedance(None);
        let impedance = rod.matrix(
            rod.vector(damping, by_turn * damping, by_rub * damping),
            rod.vector(zero, own, mixed),
            rod.vector(zero, mixed, other),
        );
        // Where the ring's centre moves aside, normal and tangent turn by 1/|ρ| (rad/m).
        let (faster, slower) = (per_distance * around, per_distance * outward);
        let aside = rod.vector(per_distance * turn, per_distance * push - own * slower, -(mixed * slower));
        let (more, faster) = (pressed.stiffness(), damping * faster);
        let stiffness = rod.matrix(
            rod.vector(more, by_turn * more, by_rub * more),
            rod.vector(faster, by_turn * faster, by_rub * faster) + aside,
            Vector3::zeros(),
        );
        (steady(rod.vector(-push, turn, rub), impedance, stiffness).moving(way.over, 2), internal)
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
