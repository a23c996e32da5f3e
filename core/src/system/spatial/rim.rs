//! Where a ring around a rod touches it.

use nalgebra::Matrix3;

use super::{FreeBodies, Pair, Placed, Seat};
use crate::{
    SMatrix, SVector, Scalar, Vector2, Vector3,
    linear::length,
    product::{cross, times},
    system::{Law, Link, Response, Seen, planar::left},
};

/// A ring around a rod, which is the third axis of the link: displacement of the ring's centre from the rod's axis (m), and how fast
/// the ring moves against the rod where they touch (m/s), at the point of the rod's surface that is farthest from the ring's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim<S, A = Parallel> {
    /// The ring's centre and where it is seen from.
    pub seat: Seat<S>,
    /// How the axes are turned.
    pub axes: A,
    /// Radius of the rod (m).
    pub radius: S,
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

/// A ring and its rod at a pose and motion.
#[derive(Clone, Copy, Debug)]
pub struct View<S> {
    pair: Pair<S>,
    /// How the reach to the point of contact changes with the first two places, in the axes of the link.
    reach_by_place: [Vector3<S>; 2],
}

impl<S: Scalar> View<S> {
    /// The `response` with what the point of contact, which goes with the place, makes of its rate; and how the moment of the force
    /// there changes with the place, negated.
    #[inline(always)]
    fn swept(&self, response: &Response<S, 3>) -> (Response<S, 3>, Matrix3<S>) {
        let (mut response, mut moment) = (*response, Matrix3::zeros());
        let (turning, force) = (self.pair.turning(), response.force);
        for (k, reach) in self.reach_by_place.iter().enumerate() {
            let rate = times(&response.impedance, &cross(&turning, reach));
            response.stiffness.data.0[k][0] += rate.x;
            response.stiffness.data.0[k][1] += rate.y;
            response.stiffness.data.0[k][2] += rate.z;
            moment.data.0[k] = cross(&force, reach).data.0[0];
        }
        (response, moment)
    }
}

impl<S: Scalar, A: TurnedAxes<S>, const N: usize, const D: usize> Link<S, FreeBodies<S, N, D>, D, 3> for Rim<S, A> {
    type View = View<S>;

    #[inline(always)]
    fn view(&self, bodies: &FreeBodies<S, N, D>, placed: &Placed<S, N>) -> View<S> {
        let pair = Pair::new(&self.seat, bodies, placed);
        let pair = match self.axes.columns() {
            Some(axes) => pair.in_axes(&axes),
            None => pair,
        };
        let zero = S::zero();
        let apart = Vector2::new(pair.displacement.x, pair.displacement.y);
        let [distance, per_distance] = length(&apart);
        let normal = apart * per_distance;
        let tangent = left(&normal);
        // From the ring's centre back to the rod's axis and beyond by its radius; where the centre moves aside, the normal turns.
        let reach = normal * -(distance + self.radius);
        let turned = tangent * (self.radius * per_distance);
        let [x, y] = [turned * tangent.x, turned * tangent.y];
        View {
            pair: pair.reaching(&Vector3::new(reach.x, reach.y, zero)),
            reach_by_place: [Vector3::new(-(S::one() + x.x), -x.y, zero), Vector3::new(-y.x, -(S::one() + y.y), zero)],
        }
    }

    #[inline(always)]
    fn seen(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N>), view: &View<S>) -> Seen<S, 3> {
        Seen { place: view.pair.displacement, rate: view.pair.rate() }
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &View<S>,
        force: &SVector<S, 3>,
        sum: &mut SVector<S, D>,
    ) {
        view.pair.add_force(force, sum);
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 3>>(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &View<S>,
        response: &Response<S, 3>,
        a: S,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        let (response, moment) = view.swept(response);
        view.pair.add_impedance(&response, Some(&moment), a, matrix);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, 3>>(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N>),
        view: &View<S>,
        response: &Response<S, 3>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let (response, moment) = view.swept(response);
        view.pair.add_derivatives(&response, Some(&moment), damping, stiffness);
    }
}
