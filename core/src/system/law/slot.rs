//! Two opposing walls in the plane, between which a point slides.

use super::{Contact, Law, Response, steady};
use crate::{
    SMatrix, SVector, Scalar,
    law::{Friction, Normal, fit::SlotForce},
    mechanism::Way,
};

/// Two straight lines in the plane whose normal is the first axis of its link; the point between them rubs along the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slot<S, N, F> {
    /// Gaps (m) where the point is at its seat, to the line that pushes along the axis and to the one that pushes against it;
    /// negative is preload.
    pub gaps: [S; 2],
    /// Its laws.
    pub contact: Contact<N, F>,
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 2> for Slot<S, N, F> {
    type Internal = F::Internal;

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 1;

    #[inline(always)]
    fn fresh(&self) -> F::Internal {
        F::fresh()
    }

    #[inline(always)]
    fn gap(&self, place: &SVector<S, 2>) -> S {
        let [low, high] = self.gaps;
        -(-(low + place[0])).max_of(place[0] - high)
    }

    #[inline(always)]
    fn each_gap(&self, place: &SVector<S, 2>, rate: &SVector<S, 2>, mut see: impl FnMut(S, S)) {
        let [low, high] = self.gaps;
        see(low + place[0], rate[0]);
        see(high - place[0], -rate[0]);
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 2>,
        rate: &SVector<S, 2>,
        internal: &F::Internal,
        way: Way<S>,
    ) -> (Response<S, 2>, F::Internal) {
        let zero = S::zero();
        let [low, high] = self.gaps;
        // A slot is told where the point is and how fast its own material moves against it, and answers with the force on that.
        let slot = self.contact.normal.slot(low, high, place[0], -rate[0]);
        let (traction, internal) =
            self.contact.friction.traction(internal, &way.sliding([rate[1], zero], slot.normal()));
        let ([own, normal], [own_stiffness, normal_stiffness]) = (slot.impedances(way.over), slot.stiffnesses());
        let by_normal = traction.per_normal[0];
        let response = steady(
            SVector::<S, 2>::new(-slot.force(), traction.force[0]),
            SMatrix::<S, 2, 2>::new(own, zero, -(by_normal * normal), traction.impedance[0]),
            SMatrix::<S, 2, 2>::new(own_stiffness, zero, -(by_normal * normal_stiffness), zero),
        );
        (response, internal)
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
