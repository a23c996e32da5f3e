//! Two points that an element acts between.

use super::{
    Placed,
    point::At,
    topology::{Carrier, Topology},
};
use crate::{SMatrix, SVector, Scalar, Vector2};

/// Two points at a pose and motion: the one that is seen, and where from.
#[derive(Clone, Copy, Debug)]
pub struct Pair<S, const D: usize, P, Q> {
    pub(super) point: At<S, D, P>,
    pub(super) seat: At<S, D, Q>,
}

impl<S: Scalar, const D: usize, P: Carrier<D>, Q: Carrier<D>> Pair<S, D, P, Q> {
    /// The columns of the point less those of the seat, where the coordinate moves them.
    #[inline(always)]
    fn less(&self, point: &[Vector2<S>; D], seat: &[Vector2<S>; D]) -> [Vector2<S>; D] {
        let mut apart = [Vector2::zeros(); D];
        for k in 0..D {
            apart[k] = match (self.point.moves(k), self.seat.moves(k)) {
                (true, true) => point[k] - seat[k],
                (true, false) => point[k],
                (false, true) => -seat[k],
                (false, false) => Vector2::zeros(),
            };
        }
        apart
    }

    /// How the way from the seat to the point goes by the coordinates.
    #[inline(always)]
    pub(super) fn gradient(&self) -> [Vector2<S>; D] {
        self.less(&self.point.gradient, &self.seat.gradient)
    }

    /// How its rate does, the velocities being held.
    #[inline(always)]
    pub(super) fn swept<J: Topology<D>>(&self, topology: &J, placed: &Placed<S, D>) -> [Vector2<S>; D] {
        let rates = &placed.rates;
        self.less(&self.point.swept(topology, placed, rates), &self.seat.swept(topology, placed, rates))
    }

    /// Adds the generalised force (N, N·m) of a `force` (N) on the point, and the opposite one on the seat.
    #[inline(always)]
    pub(super) fn add_force(&self, force: &Vector2<S>, sum: &mut SVector<S, D>) {
        for (k, column) in self.gradient().iter().enumerate() {
            if self.point.moves(k) || self.seat.moves(k) {
                sum[k] += column.dot(force);
            }
        }
    }

    /// Its rate (m/s).
    #[inline(always)]
    pub(super) fn rate(&self, rates: &SVector<S, D>) -> Vector2<S> {
        self.point.velocity(rates) - self.seat.velocity(rates)
    }

    #[inline(always)]
    pub(super) fn add_carried<J: Topology<D>>(
        &self,
        topology: &J,
        placed: &Placed<S, D>,
        force: &Vector2<S>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        self.point.add_curvature(topology, placed, &-force, stiffness);
        self.seat.add_curvature(topology, placed, force, stiffness);
    }
}
