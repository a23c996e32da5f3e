//! A pin between the walls of two slots, as the slide of the paper has them.

use super::{Contact, Law, Response};
use crate::{
    SMatrix, SVector, Scalar,
    law::{Friction, Normal},
    mechanism::Way,
};

/// A pin between two walls across (the x axis of the walls' body) and two walls up and down (its y axis); it slides along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin<S, N, F> {
    /// Gaps (m) at the nominal poses: left, right, rail, wall.
    pub gaps: [S; 4],
    /// Their laws.
    pub contact: Contact<N, F>,
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Pin<S, N, F> {
    /// Adds what the slot along axis `A`, with the tangents `T` and `U`, does to the `response`; what friction in it remembers then.
    #[inline(always)]
    fn slot<const A: usize, const T: usize, const U: usize>(
        &self,
        [low, high]: [S; 2],
        place: &SVector<S, 3>,
        rate: &SVector<S, 3>,
        (memory, way): (&F::Memory, Way<S>),
        response: &mut Response<S, 3>,
    ) -> F::Memory {
        // The slot is told the velocity of its own material, and answers with the force on it.
        let slot = self.contact.normal.slot(low, high, place[A], -rate[A]);
        let (traction, kept) =
            self.contact.friction.traction(memory, &way.sliding([-rate[T], -rate[U]], slot.normal()));
        let Response { force, impedance, stiffness, .. } = response;
        force[A] -= slot.force();
        force[T] -= traction.force[0];
        force[U] -= traction.force[1];
        let ([own, normal], [own_stiffness, normal_stiffness]) = (slot.impedances(way.over), slot.stiffnesses());
        let [by_first, by_second] = traction.per_normal;
        impedance[(A, A)] += own;
        impedance[(T, A)] += by_first * normal;
        impedance[(U, A)] += by_second * normal;
        stiffness[(A, A)] += own_stiffness;
        stiffness[(T, A)] += by_first * normal_stiffness;
        stiffness[(U, A)] += by_second * normal_stiffness;
        let [a, b, c] = traction.impedance;
        impedance[(T, T)] += a;
        impedance[(T, U)] += b;
        impedance[(U, T)] += b;
        impedance[(U, U)] += c;
        kept
    }
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 3> for Pin<S, N, F> {
    type Memory = [F::Memory; 2];

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 2;

    #[inline(always)]
    fn fresh() -> [F::Memory; 2] {
        [F::fresh(); 2]
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 3>,
        rate: &SVector<S, 3>,
        memory: &[F::Memory; 2],
        way: Way<S>,
    ) -> (Response<S, 3>, [F::Memory; 2]) {
        let [left, right, rail, wall] = self.gaps;
        let mut response = Response {
            force: SVector::zeros(),
            impedance: SMatrix::zeros(),
            stiffness: SMatrix::zeros(),
            per_time: SVector::zeros(),
        };
        let [across, up] = memory;
        let next = [
            self.slot::<0, 1, 2>([left, right], place, rate, (across, way), &mut response),
            self.slot::<1, 0, 2>([wall, rail], place, rate, (up, way), &mut response),
        ];
        (response, next)
    }

    #[inline(always)]
    fn shifted(base: &[F::Memory; 2], from: &[F::Memory; 2], to: &[F::Memory; 2], weight: S) -> [F::Memory; 2] {
        let at = |i: usize| F::shifted(&base[i], &from[i], &to[i], weight);
        [at(0), at(1)]
    }

    #[inline(always)]
    fn or_old(new: &[F::Memory; 2], condition: S, old: &[F::Memory; 2]) -> [F::Memory; 2] {
        [F::or_old(&new[0], condition, &old[0]), F::or_old(&new[1], condition, &old[1])]
    }
}
