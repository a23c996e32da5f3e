//! A pin as seen from a hole.

use super::{
    Placed, PlanarTree, Point,
    pair::Pair,
    topology::{Carrier, Chain, Topology, Turns},
};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    system::{Change, GradientLink, Seen},
};

/// The centre of a pin as seen from a hole's, in the axes of the frame, with the turning of both bodies: displacement along x and y
/// (m), then how fast the hole's and the pin's body turn (rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between<S, const D: usize, H = Chain<D>, P = Chain<D>> {
    /// Centre of the hole.
    pub hole: Point<S, D, H>,
    /// Centre of the pin.
    pub pin: Point<S, D, P>,
}

crate::cast::cast!([] [D] Between: Between<f64, D> => T Between<T, D> { hole, pin });

impl<S, const D: usize, H: Turns, P: Turns> Between<S, D, H, P> {
    /// The coordinates that turn the hole's and the pin's body, each after the number whose rate it is.
    #[inline(always)]
    fn turns(&self) -> [(usize, Option<usize>); 2] {
        [(2, self.hole.carrier.turn()), (3, self.pin.carrier.turn())]
    }
}

/// `columns` above rows of zeros.
#[inline(always)]
fn above_zeros<S: Scalar, const D: usize>(columns: &[Vector2<S>; D]) -> SMatrix<S, 4, D> {
    let zero = S::zero();
    SMatrix::<S, 4, D>::from_columns(&columns.map(|column| SVector::<S, 4>::new(column.x, column.y, zero, zero)))
}

impl<S: Scalar, J: Topology<D>, H: Carrier<D>, P: Carrier<D>, const D: usize> GradientLink<S, PlanarTree<S, D, J>, D, 4>
    for Between<S, D, H, P>
{
    type View = Pair<S, D, P, H>;

    #[inline(always)]
    fn view(&self, tree: &PlanarTree<S, D, J>, placed: &Placed<S, D>) -> Self::View {
        Pair { point: tree.at(&self.pin, placed), seat: tree.at(&self.hole, placed) }
    }

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.hole.carrier.moves(k) || self.pin.carrier.moves(k)
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&PlanarTree<S, D, J>, &Placed<S, D>), pair: &Self::View) -> Seen<S, 4> {
        let zero = S::zero();
        let apart = pair.point.place - pair.seat.place;
        let velocity = pair.rate(&placed.rates);
        let mut rate = SVector::<S, 4>::new(velocity.x, velocity.y, zero, zero);
        for (i, turn) in self.turns() {
            if let Some(turn) = turn {
                rate[i] = placed.rates[turn];
            }
        }
        Seen { place: SVector::<S, 4>::new(apart.x, apart.y, zero, zero), rate }
    }

    #[inline(always)]
    fn gradient(&self, _: (&PlanarTree<S, D, J>, &Placed<S, D>), pair: &Self::View) -> SMatrix<S, 4, D> {
        let mut gradient = above_zeros(&pair.gradient());
        for (i, turn) in self.turns() {
            if let Some(turn) = turn {
                gradient[(i, turn)] = S::one();
            }
        }
        gradient
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&PlanarTree<S, D, J>, &Placed<S, D>),
        pair: &Self::View,
        force: &SVector<S, 4>,
        sum: &mut SVector<S, D>,
    ) {
        pair.add_force(&Vector2::new(force[0], force[1]), sum);
        for (i, turn) in self.turns() {
            if let Some(turn) = turn {
                sum[turn] += force[i];
            }
        }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (tree, placed): (&PlanarTree<S, D, J>, &Placed<S, D>),
        pair: &Self::View,
        _: &SMatrix<S, 4, D>,
        force: &SVector<S, 4>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        pair.add_carried(tree.topology(), placed, &Vector2::new(force[0], force[1]), stiffness);
    }

    /// The turns' rates go by one coordinate each, and by that as they are.
    #[inline(always)]
    fn add_product(&self, gradient: &SMatrix<S, 4, D>, change: &Change<'_, S, 4, D>, sum: &mut SMatrix<S, D, D>) {
        let moves = |k: usize| self.hole.carrier.moves(k) || self.pin.carrier.moves(k);
        for k in 0..D {
            if moves(k) {
                let mut column = change.with(0, k) + change.with(1, k);
                for (i, turn) in self.turns() {
                    if turn == Some(k) {
                        column += change.with(i, k);
                    }
                }
                for j in 0..D {
                    if moves(j) {
                        sum[(j, k)] += gradient[(0, j)] * column[0];
                        sum[(j, k)] += gradient[(1, j)] * column[1];
                    }
                }
                for (i, turn) in self.turns() {
                    if let Some(turn) = turn {
                        sum[(turn, k)] += column[i];
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn swept(
        &self,
        (tree, placed): (&PlanarTree<S, D, J>, &Placed<S, D>),
        pair: &Self::View,
        _: &SMatrix<S, 4, D>,
    ) -> SMatrix<S, 4, D> {
        above_zeros(&pair.swept(tree.topology(), placed))
    }
}
