//! Material points of a tree: where they are, how they move, how that changes.

use super::{
    Coordinate, Placed, left,
    topology::{Carrier, Chain, Kind, Topology},
    turned,
};
use crate::{SMatrix, SVector, Scalar, Vector2};

/// A point of a body, or of the frame: `base` + Σ R(θ)·`arms` + Σ displacements, over the coordinates that move it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<S, const D: usize, C = Chain<D>> {
    /// Which coordinates move the point's body.
    pub carrier: C,
    /// Part in the axes of the frame (m).
    pub base: Vector2<S>,
    /// Parts in the axes of turning coordinates (m); 0 for sliding ones.
    pub arms: [Vector2<S>; D],
}

crate::cast::cast!([] [D] Point: Point<f64, D> => T Point<T, D> { base, arms; carrier });

impl<S: Scalar, const D: usize> Point<S, D> {
    /// A point of the frame at `base` (m).
    pub fn fixed(base: Vector2<S>) -> Self {
        Self { carrier: Chain::FRAME, base, arms: [Vector2::zeros(); D] }
    }

    /// The point of the same body that is `offset` (m) away, in the body's axes.
    #[must_use]
    pub fn plus(mut self, offset: Vector2<S>) -> Self {
        match self.carrier.turn.and_then(|turn| self.arms.get_mut(turn)) {
            Some(arm) => *arm += offset,
            None => self.base += offset,
        }
        self
    }

    /// The same point as one of a body that the coordinate `k` moves besides, by turning it about this point or by sliding it.
    #[must_use]
    pub fn on(mut self, k: usize, coordinate: &Coordinate<S>) -> Self {
        if let Some(moves) = self.carrier.moves.get_mut(k) {
            *moves = true;
        }
        if let Coordinate::Turn = coordinate {
            self.carrier.turn = Some(k);
        }
        self
    }
}

/// A point at a pose and motion.
///
/// What the coordinates that do not move it would do to it is left out, not added as zero: in the columns of `gradient` that
/// [`Carrier::moves`] denies there is nothing to look at.
#[derive(Clone, Copy, Debug)]
pub struct At<S, const D: usize, C> {
    carrier: C,
    /// Where it is (m).
    pub place: Vector2<S>,
    /// How its velocity goes by the generalised ones, column by column.
    pub gradient: [Vector2<S>; D],
    /// The arms in the frame (m), with what slides on them.
    arms: [Vector2<S>; D],
}

impl<S: Scalar, const D: usize, C: Carrier<D>> At<S, D, C> {
    /// `point` where and as fast as `placed` says.
    #[inline(always)]
    pub fn of<J: Topology<D>>(topology: &J, point: &Point<S, D, C>, placed: &Placed<S, D>) -> Self {
        let carrier = point.carrier;
        let mut place = point.base;
        let mut arms = [Vector2::zeros(); D];
        for k in 0..D {
            if carrier.moves(k) {
                match topology.kind(k) {
                    Kind::Turn => {
                        arms[k] = turned(&placed.axes[k], &point.arms[k]);
                        place += arms[k];
                    }
                    Kind::Slide { on } => {
                        let along = placed.axes[k] * placed.places[k];
                        place += along;
                        if let Some(on) = on {
                            arms[on] += along;
                        }
                    }
                }
            }
        }
        let mut gradient = [Vector2::zeros(); D];
        for k in 0..D {
            if carrier.moves(k) {
                gradient[k] = match topology.kind(k) {
                    Kind::Turn => left(&arms[k]),
                    Kind::Slide { .. } => placed.axes[k],
                };
            }
        }
        Self { carrier, place, gradient, arms }
    }

    /// Whether the coordinate `k` moves it.
    #[inline(always)]
    pub fn moves(&self, k: usize) -> bool {
        self.carrier.moves(k)
    }

    /// Its velocity (m/s), where the generalised ones are `rates`.
    #[inline(always)]
    pub fn velocity(&self, rates: &SVector<S, D>) -> Vector2<S> {
        let mut velocity = Vector2::zeros();
        for k in 0..D {
            if self.carrier.moves(k) {
                velocity += self.gradient[k] * rates[k];
            }
        }
        velocity
    }

    /// Adds the generalised force (N, N·m) of a `force` (N) at the point.
    #[inline(always)]
    pub fn add_force(&self, force: &Vector2<S>, sum: &mut SVector<S, D>) {
        for k in 0..D {
            if self.carrier.moves(k) {
                sum[k] += self.gradient[k].dot(force);
            }
        }
    }

    /// ∂(J·`rates`)/∂Q, the rates being held, column by column.
    #[inline(always)]
    pub fn swept<J: Topology<D>>(&self, topology: &J, placed: &Placed<S, D>, rates: &SVector<S, D>) -> [Vector2<S>; D] {
        let mut swept = [Vector2::zeros(); D];
        for k in 0..D {
            if self.carrier.moves(k) {
                match topology.kind(k) {
                    Kind::Turn => swept[k] -= self.arms[k] * rates[k],
                    Kind::Slide { on: Some(on) } => {
                        let across = left(&placed.axes[k]);
                        swept[on] += across * rates[k];
                        swept[k] += across * rates[on];
                    }
                    Kind::Slide { on: None } => {}
                }
            }
        }
        swept
    }

    /// Adds ∂(Jᵀ·`force`)/∂Q, the force (N) being held, to `matrix`.
    #[inline(always)]
    pub fn add_curvature<J: Topology<D>>(
        &self,
        topology: &J,
        placed: &Placed<S, D>,
        force: &Vector2<S>,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        for k in 0..D {
            if self.carrier.moves(k) {
                match topology.kind(k) {
                    Kind::Turn => matrix[(k, k)] -= self.arms[k].dot(force),
                    Kind::Slide { on: Some(on) } => {
                        let across = left(&placed.axes[k]).dot(force);
                        matrix[(on, k)] += across;
                        matrix[(k, on)] += across;
                    }
                    Kind::Slide { on: None } => {}
                }
            }
        }
    }
}
