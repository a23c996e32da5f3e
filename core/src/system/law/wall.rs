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

crate::cast::cast!([N F] [] Pad: Pad<f64, N, F> => T Pad<T, N::Of<T>, F::Of<T>> { gap, contact });

/// An axis of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl Axis {
    /// What belongs to this axis of what belongs to x, y and z.
    #[inline(always)]
    pub fn of<T: Copy>(self, each: [T; 3]) -> T {
        let [own, _, _] = self.first(each);
        own
    }

    /// The unit vector along it.
    pub fn unit<S: Scalar>(self) -> [S; 3] {
        self.in_order([S::one(), S::zero(), S::zero()])
    }

    /// What belongs to this axis, and to the two that follow it in turn, of what belongs to x, y and z.
    #[inline(always)]
    fn first<T: Copy>(self, [x, y, z]: [T; 3]) -> [T; 3] {
        match self {
            Self::X => [x, y, z],
            Self::Y => [y, z, x],
            Self::Z => [z, x, y],
        }
    }

    /// The other way round.
    #[inline(always)]
    fn in_order<T: Copy>(self, [own, second, third]: [T; 3]) -> [T; 3] {
        match self {
            Self::X => [own, second, third],
            Self::Y => [third, own, second],
            Self::Z => [second, third, own],
        }
    }
}

/// A plane in space whose outward normal, towards the point, is an axis of the body that carries it, or its opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall<S, N, F> {
    /// Which axis.
    pub axis: Axis,
    /// 1 if the normal points along the axis, −1 if against it.
    pub sign: S,
    /// Gap (m) at the nominal poses; negative is preload.
    pub gap: S,
    /// Its laws.
    pub contact: Contact<N, F>,
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 2> for Pad<S, N, F> {
    type Internal = F::Internal;

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 1;

    #[inline(always)]
    fn fresh(&self) -> F::Internal {
        F::fresh()
    }

    #[inline(always)]
    fn gap(&self, place: &SVector<S, 2>) -> S {
        self.gap + place[0]
    }

    #[inline(always)]
    fn each_gap(&self, place: &SVector<S, 2>, rate: &SVector<S, 2>, mut see: impl FnMut(S, S)) {
        see(self.gap + place[0], rate[0]);
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
        let Rub { force, stiffness, damping, traction, per_force, per_sliding, internal } =
            self.contact.rub(internal, way, [-self.gap(place), -rate[0]], rate[1]);
        let response = steady(
            SVector::<S, 2>::new(force, traction),
            SMatrix::<S, 2, 2>::new(damping, zero, -(per_force * damping), per_sliding),
            SMatrix::<S, 2, 2>::new(stiffness, zero, -(per_force * stiffness), zero),
        );
        (response.moving(way.over, 1), internal)
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

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 3> for Wall<S, N, F> {
    type Internal = F::Internal;

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 3;

    #[inline(always)]
    fn fresh(&self) -> F::Internal {
        F::fresh()
    }

    #[inline(always)]
    fn gap(&self, place: &SVector<S, 3>) -> S {
        self.gap + self.sign * self.axis.of(place.data.0[0])
    }

    #[inline(always)]
    fn each_gap(&self, place: &SVector<S, 3>, rate: &SVector<S, 3>, mut see: impl FnMut(S, S)) {
        see(self.gap(place), self.sign * self.axis.of(rate.data.0[0]));
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
        let (zero, one) = (S::zero(), S::one());
        let [rate, first, second] = self.axis.first(rate.data.0[0]);
        let depth = (-self.gap(place), along::<S, 4>(0, -self.sign));
        let approach = (-self.sign * rate, along(1, -self.sign));
        let sliding = [(first, along(2, one)), (second, along(3, one))];
        let touch = self.contact.touch(internal, way, [depth, approach], sliding);
        let along_normal = touch.force_slope * self.sign;
        let [along_first, along_second] = touch.traction_slopes;
        // Columns by place along the normal, and by the rates along normal and tangents.
        let column = |k: usize| self.axis.in_order([-along_normal[k], -along_first[k], -along_second[k]]);
        let matrix = |columns: [[S; 3]; 3]| SMatrix::<S, 3, 3>::from(self.axis.in_order(columns));
        let force = self.axis.in_order([touch.force * self.sign, touch.traction[0], touch.traction[1]]);
        let impedance = matrix([column(1), column(2), column(3)]);
        let stiffness = matrix([column(0), [zero; 3], [zero; 3]]);
        (steady(force.into(), impedance, stiffness).moving(way.over, 3), touch.internal)
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
