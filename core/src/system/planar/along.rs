//! A point and a sensor along an axis of the frame.

use super::{
    Placed, PlanarTree, Point,
    point::At,
    topology::{Carrier, Chain, Topology},
};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    system::{GradientLink, Seen},
};

/// Displacements (m) along an axis of the frame: of a drive's point, and of its sensor on the same body, whose speed counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along<S, const D: usize, C = Chain<D>> {
    /// Where the force acts.
    pub point: Point<S, D, C>,
    /// Where the speed is measured.
    pub sensor: Point<S, D, C>,
    /// Direction, of unit length.
    pub axis: Vector2<S>,
}

crate::cast::cast!([] [D] Along: Along<f64, D> => T Along<T, D> { point, sensor, axis });

impl<S: Scalar, const D: usize, C> Along<S, D, C> {
    /// What the columns of point and sensor have along the axis, a row each.
    #[inline(always)]
    fn along(&self, [point, sensor]: [&[Vector2<S>; D]; 2]) -> SMatrix<S, 2, D> {
        let columns: [_; D] =
            core::array::from_fn(|k| SVector::<S, 2>::new(self.axis.dot(&point[k]), self.axis.dot(&sensor[k])));
        SMatrix::<S, 2, D>::from_columns(&columns)
    }
}

impl<S: Scalar, J: Topology<D>, C: Carrier<D>, const D: usize> GradientLink<S, PlanarTree<S, D, J>, D, 2>
    for Along<S, D, C>
{
    type View = [At<S, D, C>; 2];

    #[inline(always)]
    fn view(&self, tree: &PlanarTree<S, D, J>, placed: &Placed<S, D>) -> Self::View {
        [tree.at(&self.point, placed), tree.at(&self.sensor, placed)]
    }

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.point.carrier.moves(k)
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&PlanarTree<S, D, J>, &Placed<S, D>), view: &Self::View) -> Seen<S, 2> {
        let [point, sensor] = view;
        let along = |of: [&Vector2<S>; 2]| SVector::<S, 2>::new(self.axis.dot(of[0]), self.axis.dot(of[1]));
        let velocities = [point, sensor].map(|at| at.velocity(&placed.rates));
        Seen { place: along([&point.place, &sensor.place]), rate: along(velocities.each_ref()) }
    }

    #[inline(always)]
    fn gradient(&self, _: (&PlanarTree<S, D, J>, &Placed<S, D>), view: &Self::View) -> SMatrix<S, 2, D> {
        self.along(view.each_ref().map(|at| &at.gradient))
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&PlanarTree<S, D, J>, &Placed<S, D>),
        view: &Self::View,
        force: &SVector<S, 2>,
        sum: &mut SVector<S, D>,
    ) {
        for (at, force) in view.iter().zip(force) {
            at.add_force(&(self.axis * *force), sum);
        }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (tree, placed): (&PlanarTree<S, D, J>, &Placed<S, D>),
        view: &Self::View,
        _: &SMatrix<S, 2, D>,
        force: &SVector<S, 2>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        for (at, force) in view.iter().zip(force) {
            at.add_curvature(tree.topology(), placed, &(self.axis * -*force), stiffness);
        }
    }

    #[inline(always)]
    fn swept(
        &self,
        (tree, placed): (&PlanarTree<S, D, J>, &Placed<S, D>),
        view: &Self::View,
        _: &SMatrix<S, 2, D>,
    ) -> SMatrix<S, 2, D> {
        let [point, sensor] = view.each_ref().map(|at| at.swept(tree.topology(), placed, &placed.rates));
        self.along([&point, &sensor])
    }
}
