//! What elements in the plane see.

use nalgebra::Matrix2;

use super::{Placed, PlanarTree, Point, left, point::At, tree::turned};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    system::{Link, Seen},
};

/// A point of one body seen from another, in the axes of the latter: displacement from `seat` to `point` along `normal` and to the left of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across<S, const D: usize> {
    /// The point.
    pub point: Point<S, D>,
    /// Where it is seen from.
    pub seat: Point<S, D>,
    /// First axis, of unit length, fixed in the body of `seat`.
    pub normal: Vector2<S>,
}

/// The same link from a hole's centre, the `seat`, to a pin's, in the axes of the frame, with the turning of both bodies: displacement along x and
/// y, then how fast the hole's and the pin's body turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between<S, const D: usize> {
    /// Centre of the hole.
    pub hole: Point<S, D>,
    /// Centre of the pin.
    pub pin: Point<S, D>,
}

/// How much a body has turned against another, 0 where it has not been told; and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// The turning coordinate of the body.
    pub body: Option<usize>,
    /// That of the other.
    pub against: Option<usize>,
}

/// A point along an axis of the frame, and another whose speed along it counts: a drive's point and its sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along<S, const D: usize> {
    /// Where the force acts.
    pub point: Point<S, D>,
    /// Where the speed is measured.
    pub sensor: Point<S, D>,
    /// Direction, of unit length.
    pub axis: Vector2<S>,
}

impl<S: Scalar, const D: usize> Across<S, D> {
    /// The axes in the frame.
    #[inline(always)]
    fn axes(&self, placed: &Placed<S, D>) -> Matrix2<S> {
        let normal = match self.seat.turn {
            Some(turn) => turned(&placed.axes[turn], &self.normal),
            None => self.normal,
        };
        Matrix2::from_columns(&[normal, left(&normal)])
    }

    /// From the seat to the point (m), in the frame, and the gradient of the point's velocity against the material of the
    /// seat's body.
    #[inline(always)]
    fn relative(&self, at: &At<S, D>, seat: &At<S, D>) -> (Vector2<S>, SMatrix<S, 2, D>) {
        let apart = at.place - seat.place;
        let mut gradient = at.gradient - seat.gradient;
        if let Some(turn) = self.seat.turn {
            let carried = left(&apart);
            gradient[(0, turn)] -= carried.x;
            gradient[(1, turn)] -= carried.y;
        }
        (apart, gradient)
    }
}

impl<S: Scalar, const D: usize> Link<S, PlanarTree<S, D>, D, 2> for Across<S, D> {
    #[inline(always)]
    fn seen(&self, tree: &PlanarTree<S, D>, placed: &Placed<S, D>) -> Seen<S, 2, D> {
        let (at, seat) = (At::of(tree, &self.point, placed), At::of(tree, &self.seat, placed));
        let axes = self.axes(placed);
        let (apart, gradient) = self.relative(&at, &seat);
        let gradient = axes.tr_mul(&gradient);
        Seen { place: axes.tr_mul(&apart), rate: gradient * placed.rates, gradient }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (tree, placed): (&PlanarTree<S, D>, &Placed<S, D>),
        _: &Seen<S, 2, D>,
        force: &SVector<S, 2>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let (at, seat) = (At::of(tree, &self.point, placed), At::of(tree, &self.seat, placed));
        let force = self.axes(placed) * force;
        at.add_curvature(tree, &self.point, placed, &-force, stiffness);
        seat.add_curvature(tree, &self.seat, placed, &force, stiffness);
        if let Some(turn) = self.seat.turn {
            // With y from seat to point the coordinate is Rᵀy: its second derivatives have −left(∂y) twice and −y once.
            let apart = at.place - seat.place;
            let across = (at.gradient - seat.gradient).tr_mul(&left(&force));
            for k in 0..D {
                // left(y)·f = −y·left(f)
                stiffness[(turn, k)] -= across[k];
                stiffness[(k, turn)] -= across[k];
            }
            stiffness[(turn, turn)] += apart.dot(&force);
        }
    }

    #[inline(always)]
    fn swept(&self, tree: &PlanarTree<S, D>, placed: &Placed<S, D>) -> SMatrix<S, 2, D> {
        let (at, seat) = (At::of(tree, &self.point, placed), At::of(tree, &self.seat, placed));
        let rates = &placed.rates;
        let mut swept = at.swept(tree, &self.point, placed, rates) - seat.swept(tree, &self.seat, placed, rates);
        if let Some(turn) = self.seat.turn {
            let (_, gradient) = self.relative(&at, &seat);
            let plain = at.gradient - seat.gradient;
            // The velocity in the frame is u = ẏ − ω·left(y); in the turning axes it also goes by −left(u).
            for k in 0..D {
                let column = left(&Vector2::new(plain[(0, k)], plain[(1, k)])) * -rates[turn];
                swept[(0, k)] += column.x;
                swept[(1, k)] += column.y;
            }
            let carried = left(&(gradient * rates));
            swept[(0, turn)] -= carried.x;
            swept[(1, turn)] -= carried.y;
        }
        self.axes(placed).tr_mul(&swept)
    }
}

impl<S: Scalar, const D: usize> Link<S, PlanarTree<S, D>, D, 4> for Between<S, D> {
    #[inline(always)]
    fn seen(&self, tree: &PlanarTree<S, D>, placed: &Placed<S, D>) -> Seen<S, 4, D> {
        let (hole, pin) = (At::of(tree, &self.hole, placed), At::of(tree, &self.pin, placed));
        let apart = pin.place - hole.place;
        let moving = pin.gradient - hole.gradient;
        let mut gradient = SMatrix::<S, 4, D>::zeros();
        gradient.fixed_view_mut::<2, D>(0, 0).copy_from(&moving);
        if let Some(turn) = self.hole.turn {
            gradient[(2, turn)] = S::one();
        }
        if let Some(turn) = self.pin.turn {
            gradient[(3, turn)] = S::one();
        }
        let zero = S::zero();
        Seen { place: SVector::<S, 4>::new(apart.x, apart.y, zero, zero), rate: gradient * placed.rates, gradient }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (tree, placed): (&PlanarTree<S, D>, &Placed<S, D>),
        _: &Seen<S, 4, D>,
        force: &SVector<S, 4>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let force = Vector2::new(force[0], force[1]);
        At::of(tree, &self.pin, placed).add_curvature(tree, &self.pin, placed, &-force, stiffness);
        At::of(tree, &self.hole, placed).add_curvature(tree, &self.hole, placed, &force, stiffness);
    }

    #[inline(always)]
    fn swept(&self, tree: &PlanarTree<S, D>, placed: &Placed<S, D>) -> SMatrix<S, 4, D> {
        let at = |point| At::of(tree, point, placed).swept(tree, point, placed, &placed.rates);
        let mut swept = SMatrix::<S, 4, D>::zeros();
        swept.fixed_view_mut::<2, D>(0, 0).copy_from(&(at(&self.pin) - at(&self.hole)));
        swept
    }
}

impl<S: Scalar, const D: usize> Link<S, PlanarTree<S, D>, D, 1> for Turning {
    #[inline(always)]
    fn seen(&self, _: &PlanarTree<S, D>, placed: &Placed<S, D>) -> Seen<S, 1, D> {
        let mut gradient = SMatrix::<S, 1, D>::zeros();
        let mut axis = Vector2::new(S::one(), S::zero());
        if let Some(body) = self.body {
            gradient[(0, body)] += S::one();
            axis = turned(&placed.axes[body], &axis);
        }
        if let Some(against) = self.against {
            gradient[(0, against)] -= S::one();
            let back = placed.axes[against];
            axis = turned(&Vector2::new(back.x, -back.y), &axis);
        }
        Seen { place: SVector::<S, 1>::new(angle(&axis)), rate: gradient * placed.rates, gradient }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        _: (&PlanarTree<S, D>, &Placed<S, D>),
        _: &Seen<S, 1, D>,
        _: &SVector<S, 1>,
        _: &mut SMatrix<S, D, D>,
    ) {
    }

    #[inline(always)]
    fn swept(&self, _: &PlanarTree<S, D>, _: &Placed<S, D>) -> SMatrix<S, 1, D> {
        SMatrix::zeros()
    }
}

impl<S: Scalar, const D: usize> Link<S, PlanarTree<S, D>, D, 2> for Along<S, D> {
    #[inline(always)]
    fn seen(&self, tree: &PlanarTree<S, D>, placed: &Placed<S, D>) -> Seen<S, 2, D> {
        let (point, sensor) = (At::of(tree, &self.point, placed), At::of(tree, &self.sensor, placed));
        let mut gradient = SMatrix::<S, 2, D>::zeros();
        gradient.set_row(0, &self.axis.tr_mul(&point.gradient));
        gradient.set_row(1, &self.axis.tr_mul(&sensor.gradient));
        let place = SVector::<S, 2>::new(self.axis.dot(&point.place), self.axis.dot(&sensor.place));
        Seen { place, rate: gradient * placed.rates, gradient }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (tree, placed): (&PlanarTree<S, D>, &Placed<S, D>),
        _: &Seen<S, 2, D>,
        force: &SVector<S, 2>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        for (point, force) in [(&self.point, force[0]), (&self.sensor, force[1])] {
            At::of(tree, point, placed).add_curvature(tree, point, placed, &(self.axis * -force), stiffness);
        }
    }

    #[inline(always)]
    fn swept(&self, tree: &PlanarTree<S, D>, placed: &Placed<S, D>) -> SMatrix<S, 2, D> {
        let row = |point| self.axis.tr_mul(&At::of(tree, point, placed).swept(tree, point, placed, &placed.rates));
        let mut swept = SMatrix::<S, 2, D>::zeros();
        swept.set_row(0, &row(&self.point));
        swept.set_row(1, &row(&self.sensor));
        swept
    }
}

/// The angle (rad), −π to π, of a direction of unit length, without branches: a half angle thrice, then a series.
#[inline(always)]
fn angle<S: Scalar>(direction: &Vector2<S>) -> S {
    let (one, quarter) = (S::one(), S::from_f64(1e-30));
    // tan(θ/2) = sin/(1 + cos); near ±π the divisor vanishes.
    let mut t = direction.y / (one + direction.x).max_of(quarter);
    let huge = S::from_f64(1e9);
    t = t.within(-huge, huge);
    for _ in 0..3 {
        t /= one + (one + t * t).sqrt();
    }
    let square = t * t;
    // arctan: |t| ≤ tan(π/16) = 0.199.
    let mut series = S::zero();
    for k in (0..12u32).rev() {
        let term = one / S::from_count(2 * k + 1);
        series = (if k % 2 == 0 { term } else { -term }) + series * square;
    }
    S::from_f64(16.0) * t * series
}
