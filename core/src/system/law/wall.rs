//! A one-sided wall: in the plane a pad, in space a plane along one of the axes.

use super::{Contact, Law, Response, Rub, along, steady};
use crate::{
    SMatrix, SVector, Scalar,
    law::{Friction, Normal},
    mechanism::Way,
};

/// A straight line in the plane whose normal is the first axis of its link; the point rubs along the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pad<S, N, F> {
    /// Gap (m) where the point is at its seat; negative is preload.
    pub gap: S,
    /// Its laws.
    pub contact: Contact<N, F>,
}

/// A plane in space whose outward normal, towards the point, is an axis of the body that carries it, or its opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall<S, N, F> {
    /// Which axis, 0 to 2.
    pub axis: usize,
    /// 1 if the normal points along the axis, −1 if against it.
    pub sign: S,
    /// Gap (m) at the nominal poses; negative is preload.
    pub gap: S,
    /// Its laws.
    pub contact: Contact<N, F>,
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 2> for Pad<S, N, F> {
    type Memory = F::Memory;

    const STICKS: bool = F::STICKS;

    #[inline(always)]
    fn fresh() -> F::Memory {
        F::fresh()
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 2>,
        rate: &SVector<S, 2>,
        memory: &F::Memory,
        way: Way<S>,
    ) -> (Response<S, 2>, F::Memory) {
        let zero = S::zero();
        let Rub { force, stiffness, damping, traction, per_force, per_sliding, memory } =
            self.contact.rub(memory, way, [-(self.gap + place[0]), -rate[0]], rate[1]);
        let response = steady(
            SVector::<S, 2>::new(force, traction),
            SMatrix::<S, 2, 2>::new(damping, zero, -(per_force * damping), per_sliding),
            SMatrix::<S, 2, 2>::new(stiffness, zero, -(per_force * stiffness), zero),
        );
        (response, memory)
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

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 3> for Wall<S, N, F> {
    type Memory = F::Memory;

    const STICKS: bool = F::STICKS;

    #[inline(always)]
    fn fresh() -> F::Memory {
        F::fresh()
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 3>,
        rate: &SVector<S, 3>,
        memory: &F::Memory,
        way: Way<S>,
    ) -> (Response<S, 3>, F::Memory) {
        let one = S::one();
        let [n, first, second] = [self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3];
        let depth = (-(self.gap + self.sign * place[n]), along::<S, 4>(0, -self.sign));
        let approach = (-self.sign * rate[n], along(1, -self.sign));
        let sliding = [(rate[first], along(2, one)), (rate[second], along(3, one))];
        let touch = self.contact.touch(memory, way, [depth, approach], sliding);
        let mut force = SVector::zeros();
        let (mut impedance, mut stiffness) = (SMatrix::zeros(), SMatrix::zeros());
        let rows = [
            (n, touch.force * self.sign, touch.force_slope * self.sign),
            (first, touch.traction[0], touch.traction_slopes[0]),
            (second, touch.traction[1], touch.traction_slopes[1]),
        ];
        for (row, value, slope) in rows {
            force[row] = value;
            stiffness[(row, n)] = -slope[0];
            impedance[(row, n)] = -slope[1];
            impedance[(row, first)] = -slope[2];
            impedance[(row, second)] = -slope[3];
        }
        (steady(force, impedance, stiffness), touch.memory)
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
