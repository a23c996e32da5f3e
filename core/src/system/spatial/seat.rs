//! What a link measures of a point of one body as seen from another.

use super::{FreeBodies, Pair, Placed, Seat};
use crate::{
    SMatrix, SVector, Scalar,
    system::{Law, Link, Response, Seen},
};

impl<S: Scalar, const N: usize, const D: usize> Link<S, FreeBodies<S, N, D>, D, 3> for Seat<S> {
    type View = Pair<S>;

    #[inline(always)]
    fn view(&self, bodies: &FreeBodies<S, N, D>, placed: &Placed<S, N>) -> Pair<S> {
        Pair::new(self, bodies, placed)
    }

    #[inline(always)]
    fn seen(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N>), view: &Pair<S>) -> Seen<S, 3> {
        Seen { place: view.displacement, rate: view.rate() }
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &Pair<S>,
        force: &SVector<S, 3>,
        sum: &mut SVector<S, D>,
    ) {
        view.add_force(force, sum);
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 3>>(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &Pair<S>,
        response: &Response<S, 3>,
        a: S,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        view.add_impedance(response, None, a, matrix);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, 3>>(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &Pair<S>,
        response: &Response<S, 3>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        view.add_derivatives(response, None, damping, stiffness);
    }
}
