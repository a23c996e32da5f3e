//! A point of one body as seen from another.

use nalgebra::Matrix2;

use super::{
    Placed, PlanarTree, Point, left,
    pair::Pair,
    topology::{Carrier, Chain, Topology},
    turned,
};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    product::{applied, is_wide, transposed_in_plane},
    system::{GradientLink, Seen},
};

/// A point of one body seen from another, in the axes of the latter: displacement (m) from `seat` to `point` along `normal` and to the
/// left of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across<S, const D: usize, P = Chain<D>, Q = Chain<D>> {
    /// The point.
    pub point: Point<S, D, P>,
    /// Where it is seen from.
    pub seat: Point<S, D, Q>,
    /// First axis, of unit length, fixed in the body of `seat`.
    pub normal: Vector2<S>,
}

crate::cast::cast!([] [D] Across: Across<f64, D> => T Across<T, D> { point, seat, normal });

/// The `columns` in these axes.
#[inline(always)]
fn in_axes<S: Scalar, const D: usize>(axes: &Matrix2<S>, columns: &[Vector2<S>; D]) -> SMatrix<S, 2, D> {
    if !is_wide::<S>() {
        return SMatrix::<S, 2, D>::from_columns(&columns.map(|column| transposed_in_plane(axes, &column)));
    }
    let mut turned = SMatrix::<S, 2, D>::zeros();
    for (turned, column) in turned.data.0.iter_mut().zip(columns) {
        *turned = transposed_in_plane(axes, column).data.0[0];
    }
    turned
}

impl<S: Scalar, const D: usize, P, Q: Carrier<D>> Across<S, D, P, Q> {
    /// The axes in the frame.
    #[inline(always)]
    fn axes(&self, placed: &Placed<S, D>) -> Matrix2<S> {
        let normal = match self.seat.carrier.turn() {
            Some(turn) => turned(&placed.axes[turn], &self.normal),
            None => self.normal,
        };
        Matrix2::from_columns(&[normal, left(&normal)])
    }
}

impl<S: Scalar, J: Topology<D>, P: Carrier<D>, Q: Carrier<D>, const D: usize> GradientLink<S, PlanarTree<S, D, J>, D, 2>
    for Across<S, D, P, Q>
{
    type View = Pair<S, D, P, Q>;

    #[inline(always)]
    fn view(&self, tree: &PlanarTree<S, D, J>, placed: &Placed<S, D>) -> Self::View {
        Pair { point: tree.at(&self.point, placed), seat: tree.at(&self.seat, placed) }
    }

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.point.carrier.moves(k) || self.seat.carrier.moves(k)
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&PlanarTree<S, D, J>, &Placed<S, D>), pair: &Self::View) -> Seen<S, 2> {
        let axes = self.axes(placed);
        let apart = pair.point.place - pair.seat.place;
        let mut rate = pair.rate(&placed.rates);
        if let Some(turn) = self.seat.carrier.turn() {
            rate -= left(&apart) * placed.rates[turn];
        }
        Seen { place: transposed_in_plane(&axes, &apart), rate: transposed_in_plane(&axes, &rate) }
    }

    #[inline(always)]
    fn gradient(&self, (_, placed): (&PlanarTree<S, D, J>, &Placed<S, D>), pair: &Self::View) -> SMatrix<S, 2, D> {
        let axes = self.axes(placed);
        let mut columns = pair.gradient();
        if let Some(turn) = self.seat.carrier.turn() {
            columns[turn] -= left(&(pair.point.place - pair.seat.place));
        }
        in_axes(&axes, &columns)
    }

    #[inline(always)]
    fn add_force(
        &self,
        (_, placed): (&PlanarTree<S, D, J>, &Placed<S, D>),
        pair: &Self::View,
        force: &SVector<S, 2>,
        sum: &mut SVector<S, D>,
    ) {
        let force = applied(&self.axes(placed), force);
        pair.add_force(&force, sum);
        if let Some(turn) = self.seat.carrier.turn() {
            sum[turn] -= left(&(pair.point.place - pair.seat.place)).dot(&force);
        }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (tree, placed): (&PlanarTree<S, D, J>, &Placed<S, D>),
        pair: &Self::View,
        _: &SMatrix<S, 2, D>,
        force: &SVector<S, 2>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let force = applied(&self.axes(placed), force);
        pair.add_carried(tree.topology(), placed, &force, stiffness);
        if let Some(turn) = self.seat.carrier.turn() {
            // With y from seat to point the coordinate is Rᵀy: its second derivatives have −left(∂y) twice and −y once.
            let across = left(&force);
            for (k, column) in pair.gradient().iter().enumerate() {
                if pair.point.moves(k) || pair.seat.moves(k) {
                    // left(y)·f = −y·left(f)
                    let entry = column.dot(&across);
                    stiffness[(turn, k)] -= entry;
                    stiffness[(k, turn)] -= entry;
                }
            }
            stiffness[(turn, turn)] += (pair.point.place - pair.seat.place).dot(&force);
        }
    }

    #[inline(always)]
    fn swept(
        &self,
        (tree, placed): (&PlanarTree<S, D, J>, &Placed<S, D>),
        pair: &Self::View,
        _: &SMatrix<S, 2, D>,
    ) -> SMatrix<S, 2, D> {
        let rates = &placed.rates;
        let mut swept = pair.swept(tree.topology(), placed);
        if let Some(turn) = self.seat.carrier.turn() {
            // The velocity in the frame is u = ẏ − ω·left(y); in the turning axes it also goes by −left(u).
            let apart = pair.point.place - pair.seat.place;
            let velocity = pair.rate(rates) - left(&apart) * rates[turn];
            for (k, (column, plain)) in swept.iter_mut().zip(pair.gradient()).enumerate() {
                if pair.point.moves(k) || pair.seat.moves(k) {
                    *column -= left(&plain) * rates[turn];
                }
            }
            swept[turn] -= left(&velocity);
        }
        let axes = self.axes(placed);
        in_axes(&axes, &swept)
    }
}
