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

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 3> for Pin<S, N, F> {
    type Memory = [F::Memory; 2];

    const STICKS: bool = F::STICKS;

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
        let zero = S::zero();
        let [left, right, rail, wall] = self.gaps;
        let mut next = *memory;
        let mut force = SVector::<S, 3>::zeros();
        let (mut impedance, mut stiffness) = (SMatrix::<S, 3, 3>::zeros(), SMatrix::<S, 3, 3>::zeros());
        let slots = [([left, right], [0, 1, 2]), ([wall, rail], [1, 0, 2])];
        for ((([low, high], [n, first, second]), memory), next) in slots.into_iter().zip(memory).zip(&mut next) {
            // The slot is told the velocity of its own material, and answers with the force on it.
            let slot = self.contact.normal.slot(low, high, place[n], -rate[n]);
            let sliding = [-rate[first], -rate[second]];
            let (traction, kept) = self.contact.friction.traction(memory, &way.sliding(sliding, slot.normal()));
            *next = kept;
            force[n] -= slot.force();
            force[first] -= traction.force[0];
            force[second] -= traction.force[1];
            let ([own, normal], [own_stiffness, normal_stiffness]) = (slot.impedances(zero), slot.stiffnesses());
            let [by_first, by_second] = traction.per_normal;
            for (row, by_rate, by_place) in [
                (n, own, own_stiffness),
                (first, by_first * normal, by_first * normal_stiffness),
                (second, by_second * normal, by_second * normal_stiffness),
            ] {
                impedance[(row, n)] += by_rate;
                stiffness[(row, n)] += by_place;
            }
            let [a, b, c] = traction.impedance;
            for (row, column, value) in [(first, first, a), (first, second, b), (second, first, b), (second, second, c)]
            {
                impedance[(row, column)] += value;
            }
        }
        (Response { force, impedance, stiffness, per_time: SVector::zeros() }, next)
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
