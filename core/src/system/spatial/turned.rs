//! A point of one body as seen from another, and how fast the one turns against the other.

use nalgebra::Matrix3;

use super::{FreeBodies, Pair, Placed, Seat};
use crate::{
    SMatrix, SVector, Scalar,
    system::{Law, Link, Response, Seen},
};

/// A point of one body as seen from another, and the rotation of its body against that one, both in axes that may be turned against
/// those of the latter: three lengths (m), then three angles (rad) of which the rates alone are told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turned<S, A = Parallel> {
    /// The point and where it is seen from.
    pub seat: Seat<S>,
    /// How the axes are turned.
    pub axes: A,
}

/// Axes that are not turned: nothing is left of them at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parallel;

/// How axes are turned against those of a body.
pub trait TurnedAxes<S>: Copy {
    /// The axes, columns in those of the body; `None` where they are the same.
    fn columns(&self) -> Option<Matrix3<S>>;
}

impl<S> TurnedAxes<S> for Parallel {
    #[inline(always)]
    fn columns(&self) -> Option<Matrix3<S>> {
        None
    }
}

impl<S: Scalar> TurnedAxes<S> for Matrix3<S> {
    #[inline(always)]
    fn columns(&self) -> Option<Matrix3<S>> {
        Some(*self)
    }
}

/// Chosen at run time.
impl<S: Scalar> TurnedAxes<S> for Option<Matrix3<S>> {
    #[inline(always)]
    fn columns(&self) -> Option<Matrix3<S>> {
        *self
    }
}

impl<S: Scalar, A: TurnedAxes<S>, const N: usize, const D: usize> Link<S, FreeBodies<S, N, D>, D, 6> for Turned<S, A> {
    type View = Pair<S>;

    #[inline(always)]
    fn view(&self, bodies: &FreeBodies<S, N, D>, placed: &Placed<S, N>) -> Pair<S> {
        let pair = Pair::new(&self.seat, bodies, placed);
        self.axes.columns().map_or(pair, |axes| pair.in_axes(&axes))
    }

    #[inline(always)]
    fn seen(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N>), view: &Pair<S>) -> Seen<S, 6> {
        let (place, rate, turning, zero) = (view.displacement, view.rate(), view.turning(), S::zero());
        Seen {
            place: SVector::<S, 6>::from([place.x, place.y, place.z, zero, zero, zero]),
            rate: SVector::<S, 6>::from([rate.x, rate.y, rate.z, turning.x, turning.y, turning.z]),
        }
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &Pair<S>,
        force: &SVector<S, 6>,
        sum: &mut SVector<S, D>,
    ) {
        view.add_force::<2, 6, D>(force, sum);
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 6>>(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &Pair<S>,
        response: &Response<S, 6>,
        a: S,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        view.add_impedance::<2, 6, D>(response, a, matrix);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, 6>>(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &Pair<S>,
        response: &Response<S, 6>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        view.add_derivatives::<2, 6, D>(response, damping, stiffness);
    }
}
