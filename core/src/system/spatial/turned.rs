//! A point of one body as seen from another, and how fast the one turns against the other.

use nalgebra::Matrix3;

use super::{
    FreeBodies, Placed, Seat,
    blocks::{add_wrench, change, put, sub},
    seat::View,
};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    linear::cross_matrix,
    system::{GradientLink, Seen},
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

impl<S: Scalar> Turned<S> {
    /// The force (N) and the moment (N·m) in `force`, in the axes of the body that it is seen from.
    #[inline(always)]
    fn halves(&self, force: &SVector<S, 6>) -> [Vector3<S>; 2] {
        let [a, b, c, d, e, f] = force.data.0[0];
        [self.axes * Vector3::new(a, b, c), self.axes * Vector3::new(d, e, f)]
    }
}

impl<S: Scalar, const N: usize, const D: usize> GradientLink<S, FreeBodies<S, N, D>, D, 6> for Turned<S> {
    type View = View<S>;

    #[inline(always)]
    fn view(&self, bodies: &FreeBodies<S, N, D>, placed: &Placed<S, N, D>) -> View<S> {
        self.seat.look(bodies, placed)
    }

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.seat.is_moved_by(k)
    }

    /// Displacements do not turn.
    #[inline(always)]
    fn depends(&self, i: usize, k: usize) -> bool {
        i < 3 || k % 6 >= 3
    }

    #[inline(always)]
    fn seen(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N, D>), view: &View<S>) -> Seen<S, 6> {
        let place = self.axes.tr_mul(&view.displacement) + self.offset;
        let rate = self.axes.tr_mul(&self.seat.rate(view));
        let [of, from] = &view.rotations;
        let turning = view.across * of;
        let turning = self.axes.tr_mul(&if self.seat.from.is_some() { turning - from } else { turning });
        let zero = S::zero();
        Seen {
            place: SVector::<S, 6>::from([place.x, place.y, place.z, zero, zero, zero]),
            rate: SVector::<S, 6>::from([rate.x, rate.y, rate.z, turning.x, turning.y, turning.z]),
        }
    }

    #[inline(always)]
    fn gradient(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N, D>), view: &View<S>) -> SMatrix<S, 6, D> {
        let mut gradient = SMatrix::<S, 6, D>::zeros();
        let lengths: SMatrix<S, 3, D> = self.seat.lengths(view);
        change(&mut gradient, (0, 0), &self.axes.tr_mul(&lengths), |entry, from| *entry = from);
        if let Some(i) = self.seat.point.body {
            put(&mut gradient, (3, 6 * i + 3), &self.axes.tr_mul(&view.across));
        }
        if let Some(j) = self.seat.from {
            put(&mut gradient, (3, 6 * j + 3), &-self.axes.transpose());
        }
        gradient
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &View<S>,
        force: &SVector<S, 6>,
        sum: &mut SVector<S, D>,
    ) {
        let [push, moment] = self.halves(force);
        self.seat.add_force(view, &push, sum);
        let none = Vector3::zeros();
        if let Some(i) = self.seat.point.body {
            add_wrench(sum, i, [&none, &view.across.tr_mul(&moment)]);
        }
        if let Some(j) = self.seat.from {
            add_wrench(sum, j, [&none, &-moment]);
        }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &View<S>,
        _: &SMatrix<S, 6, D>,
        force: &SVector<S, 6>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let [push, moment] = self.halves(force);
        self.seat.carry(view, &self.seat.lengths(view), &push, stiffness);
        if let Some(i) = self.seat.point.body {
            sub(stiffness, (6 * i + 3, 6 * i + 3), &cross_matrix(&view.across.tr_mul(&moment)));
            if let Some(j) = self.seat.from {
                sub(stiffness, (6 * i + 3, 6 * j + 3), &-view.across.tr_mul(&cross_matrix(&moment)));
            }
        }
    }

    #[inline(always)]
    fn swept(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &View<S>,
        _: &SMatrix<S, 6, D>,
    ) -> SMatrix<S, 6, D> {
        let mut lengths = SMatrix::<S, 3, D>::zeros();
        self.seat.sweep(view, &self.seat.lengths(view), &mut lengths);
        let mut swept = SMatrix::<S, 6, D>::zeros();
        change(&mut swept, (0, 0), &self.axes.tr_mul(&lengths), |entry, from| *entry = from);
        let rotation = view.across * view.rotations[0];
        if let Some(j) = self.seat.from {
            put(&mut swept, (3, 6 * j + 3), &self.axes.tr_mul(&cross_matrix(&rotation)));
        }
        if let Some(i) = self.seat.point.body {
            sub(&mut swept, (3, 6 * i + 3), &self.axes.tr_mul(&(view.across * cross_matrix(&view.rotations[0]))));
        }
        swept
    }
}
