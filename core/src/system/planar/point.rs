//! Material points of a tree: where they are, how they move, how that changes.

use super::{Coordinate, Placed, PlanarTree, left, tree::turned};
use crate::{SMatrix, SVector, Scalar, Vector2};

/// A point of a body, or of the frame: `base` + Σ R(θ)·`arms` + Σ displacements, over the coordinates that move it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<S, const D: usize> {
    /// The coordinate that turns the point's body; `None` where the body does not turn.
    pub turn: Option<usize>,
    /// Part in the axes of the frame (m).
    pub base: Vector2<S>,
    /// Which coordinates move the point's body.
    pub moves: [bool; D],
    /// Parts in the axes of turning coordinates (m); 0 for sliding ones.
    pub arms: [Vector2<S>; D],
}

impl<S: Scalar, const D: usize> Point<S, D> {
    /// A point of the frame at `base` (m).
    pub fn fixed(base: Vector2<S>) -> Self {
        Self { turn: None, base, moves: [false; D], arms: [Vector2::zeros(); D] }
    }

    /// The point of the same body that is `offset` (m) away, in the body's axes.
    #[must_use]
    pub fn plus(mut self, offset: Vector2<S>) -> Self {
        match self.turn.and_then(|turn| self.arms.get_mut(turn)) {
            Some(arm) => *arm += offset,
            None => self.base += offset,
        }
        self
    }

    /// The same point as one of a body that the coordinate `k` moves besides, by turning it about this point or by sliding it.
    #[must_use]
    pub fn on(mut self, k: usize, coordinate: &Coordinate<S>) -> Self {
        if let Some(moves) = self.moves.get_mut(k) {
            *moves = true;
        }
        if let Coordinate::Turn = coordinate {
            self.turn = Some(k);
        }
        self
    }
}

/// A point at a pose and motion.
pub(super) struct At<S, const D: usize> {
    /// Where it is (m).
    pub place: Vector2<S>,
    /// How its velocity goes by the generalised ones.
    pub gradient: SMatrix<S, 2, D>,
    /// The arms in the frame (m), with what slides on them.
    arms: [Vector2<S>; D],
}

impl<S: Scalar, const D: usize> At<S, D> {
    #[inline(always)]
    pub fn of(tree: &PlanarTree<S, D>, point: &Point<S, D>, placed: &Placed<S, D>) -> Self {
        let mut place = point.base;
        let mut arms = [Vector2::zeros(); D];
        for (k, _) in point.moves.iter().enumerate().filter(|(_, moves)| **moves) {
            match tree.coordinates()[k] {
                Coordinate::Turn => {
                    let arm = turned(&placed.axes[k], &point.arms[k]);
                    arms[k] += arm;
                    place += arm;
                }
                Coordinate::Slide { on, .. } => {
                    let along = placed.axes[k] * placed.places[k];
                    place += along;
                    if let Some(on) = on {
                        arms[on] += along;
                    }
                }
            }
        }
        let mut gradient = SMatrix::<S, 2, D>::zeros();
        for (k, arm) in arms.iter().enumerate() {
            if point.moves[k] {
                let column = match tree.coordinates()[k] {
                    Coordinate::Turn => left(arm),
                    Coordinate::Slide { .. } => placed.axes[k],
                };
                gradient.set_column(k, &column);
            }
        }
        Self { place, gradient, arms }
    }

    /// ∂(J·`rates`)/∂Q, the rates being held.
    #[inline(always)]
    pub fn swept(
        &self,
        tree: &PlanarTree<S, D>,
        point: &Point<S, D>,
        placed: &Placed<S, D>,
        rates: &SVector<S, D>,
    ) -> SMatrix<S, 2, D> {
        let mut swept = SMatrix::<S, 2, D>::zeros();
        for (k, _) in point.moves.iter().enumerate().filter(|(_, moves)| **moves) {
            match tree.coordinates()[k] {
                Coordinate::Turn => add(&mut swept, k, &(self.arms[k] * -rates[k])),
                Coordinate::Slide { on: Some(on), .. } => {
                    let across = left(&placed.axes[k]);
                    add(&mut swept, on, &(across * rates[k]));
                    add(&mut swept, k, &(across * rates[on]));
                }
                Coordinate::Slide { on: None, .. } => {}
            }
        }
        swept
    }

    /// How J̇·V goes by the velocities V and by the place.
    #[inline(always)]
    pub fn swept_slopes(
        &self,
        tree: &PlanarTree<S, D>,
        point: &Point<S, D>,
        placed: &Placed<S, D>,
    ) -> [SMatrix<S, 2, D>; 2] {
        let two = S::one() + S::one();
        let rates = &placed.rates;
        let by_rate = self.swept(tree, point, placed, rates) * two;
        let mut by_place = SMatrix::<S, 2, D>::zeros();
        for (k, _) in point.moves.iter().enumerate().filter(|(_, moves)| **moves) {
            match tree.coordinates()[k] {
                Coordinate::Turn => add(&mut by_place, k, &(left(&self.arms[k]) * -(rates[k] * rates[k]))),
                Coordinate::Slide { on: Some(on), .. } => {
                    let axis = placed.axes[k];
                    add(&mut by_place, on, &(axis * -(two * rates[on] * rates[k])));
                    add(&mut by_place, k, &(axis * -(rates[on] * rates[on])));
                }
                Coordinate::Slide { on: None, .. } => {}
            }
        }
        [by_rate, by_place]
    }

    /// Adds ∂(Jᵀ·`force`)/∂Q, the force (N) being held, to `matrix`.
    #[inline(always)]
    pub fn add_curvature(
        &self,
        tree: &PlanarTree<S, D>,
        point: &Point<S, D>,
        placed: &Placed<S, D>,
        force: &Vector2<S>,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        for (k, _) in point.moves.iter().enumerate().filter(|(_, moves)| **moves) {
            match tree.coordinates()[k] {
                Coordinate::Turn => matrix[(k, k)] -= self.arms[k].dot(force),
                Coordinate::Slide { on: Some(on), .. } => {
                    let across = left(&placed.axes[k]).dot(force);
                    matrix[(on, k)] += across;
                    matrix[(k, on)] += across;
                }
                Coordinate::Slide { on: None, .. } => {}
            }
        }
    }
}

/// Adds `column` to column `k` of `matrix`.
#[inline(always)]
fn add<S: Scalar, const D: usize>(matrix: &mut SMatrix<S, 2, D>, k: usize, column: &Vector2<S>) {
    matrix[(0, k)] += column.x;
    matrix[(1, k)] += column.y;
}
