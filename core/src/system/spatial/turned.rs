//! A point of one body as seen from another, and how fast the one turns against the other.

use nalgebra::Matrix3;

use super::{FreeBodies, Pair, Placed, Seat};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    system::{Law, Link, Response, Seen},
};

/// A point of one body as seen from another, and the rotation of its body against that one, both in axes that are turned against
/// those of the latter: three lengths (m), then three angles (rad) of which the rates alone are told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turned<S> {
    /// The point and where it is seen from.
    pub seat: Seat<S>,
    /// The axes, columns in the body's axes.
    pub axes: Matrix3<S>,
    /// Place (m) of the point in these axes at the nominal poses.
    pub offset: Vector3<S>,
}

impl<S: Scalar, const N: usize, const D: usize> Link<S, FreeBodies<S, N, D>, D, 6> for Turned<S> {
    type View = Pair<S>;

    #[inline(always)]
    fn view(&self, bodies: &FreeBodies<S, N, D>, placed: &Placed<S, N, D>) -> Pair<S> {
        Pair::new(&self.seat, bodies, placed).in_axes(&self.axes)
    }

    #[inline(always)]
    fn seen(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N, D>), view: &Pair<S>) -> Seen<S, 6> {
        let (place, rate, turning, zero) = (view.displacement + self.offset, view.rate(), view.turning(), S::zero());
        Seen {
            place: SVector::<S, 6>::from([place.x, place.y, place.z, zero, zero, zero]),
            rate: SVector::<S, 6>::from([rate.x, rate.y, rate.z, turning.x, turning.y, turning.z]),
        }
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &Pair<S>,
        force: &SVector<S, 6>,
        sum: &mut SVector<S, D>,
    ) {
        view.add_force::<2, 6, D>(force, sum);
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 6>>(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
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
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &Pair<S>,
        response: &Response<S, 6>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        view.add_derivatives::<2, 6, D>(response, damping, stiffness);
    }
}
