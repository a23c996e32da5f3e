//! What elements in the plane see.

use nalgebra::Matrix2;

use super::{
    Placed, PlanarTree, Point, left,
    point::At,
    rigid::Rigids,
    topology::{Carrier, Chain, Topology, Turns},
    tree::turned,
};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    system::{Link, Seen},
};

/// A point of one body seen from another, in the axes of the latter: displacement from `seat` to `point` along `normal` and to the left of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across<S, const D: usize, P = Chain<D>, Q = Chain<D>> {
    /// The point.
    pub point: Point<S, D, P>,
    /// Where it is seen from.
    pub seat: Point<S, D, Q>,
    /// First axis, of unit length, fixed in the body of `seat`.
    pub normal: Vector2<S>,
}

/// The same link from a hole's centre, the `seat`, to a pin's, in the axes of the frame, with the turning of both bodies: displacement along x and
/// y, then how fast the hole's and the pin's body turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between<S, const D: usize, H = Chain<D>, P = Chain<D>> {
    /// Centre of the hole.
    pub hole: Point<S, D, H>,
    /// Centre of the pin.
    pub pin: Point<S, D, P>,
}

/// How much a body has turned against another, 0 where it has not been told; and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning<A = Option<usize>, B = Option<usize>> {
    /// What turns the body.
    pub body: A,
    /// What turns the other.
    pub against: B,
}

/// A point along an axis of the frame, and another of the same body whose speed along it counts: a drive's point and its sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along<S, const D: usize, C = Chain<D>> {
    /// Where the force acts.
    pub point: Point<S, D, C>,
    /// Where the speed is measured.
    pub sensor: Point<S, D, C>,
    /// Direction, of unit length.
    pub axis: Vector2<S>,
}

/// Two points at a pose and motion: the one that is seen, and where from.
#[derive(Clone, Copy, Debug)]
pub struct Pair<S, const D: usize, P, Q> {
    point: At<S, D, P>,
    seat: At<S, D, Q>,
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
    fn gradient(&self) -> [Vector2<S>; D] {
        self.less(&self.point.gradient, &self.seat.gradient)
    }

    /// How its rate does, the velocities being held.
    #[inline(always)]
    fn swept<J: Topology<D>>(&self, topology: &J, placed: &Placed<S, D>) -> [Vector2<S>; D] {
        let rates = &placed.rates;
        self.less(&self.point.swept(topology, placed, rates), &self.seat.swept(topology, placed, rates))
    }

    /// Adds the generalised force (N, N·m) of a `force` (N) on the point, and the opposite one on the seat.
    #[inline(always)]
    fn add_force(&self, force: &Vector2<S>, sum: &mut SVector<S, D>) {
        for (k, column) in self.gradient().iter().enumerate() {
            if self.point.moves(k) || self.seat.moves(k) {
                sum[k] += column.dot(force);
            }
        }
    }

    /// Its rate (m/s).
    #[inline(always)]
    fn rate(&self, rates: &SVector<S, D>) -> Vector2<S> {
        self.point.velocity(rates) - self.seat.velocity(rates)
    }

    #[inline(always)]
    fn add_carried<J: Topology<D>>(
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

impl<S: Scalar, J: Topology<D>, R: Rigids<S, J, D>, P: Carrier<D>, Q: Carrier<D>, const D: usize>
    Link<S, PlanarTree<S, D, J, R>, D, 2> for Across<S, D, P, Q>
{
    type View = Pair<S, D, P, Q>;

    #[inline(always)]
    fn view(&self, tree: &PlanarTree<S, D, J, R>, placed: &Placed<S, D>) -> Self::View {
        Pair { point: tree.at(&self.point, placed), seat: tree.at(&self.seat, placed) }
    }

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.point.carrier.moves(k) || self.seat.carrier.moves(k)
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>), pair: &Self::View) -> Seen<S, 2> {
        let axes = self.axes(placed);
        let apart = pair.point.place - pair.seat.place;
        let mut rate = pair.rate(&placed.rates);
        if let Some(turn) = self.seat.carrier.turn() {
            rate -= left(&apart) * placed.rates[turn];
        }
        Seen { place: axes.tr_mul(&apart), rate: axes.tr_mul(&rate) }
    }

    #[inline(always)]
    fn gradient(&self, (_, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>), pair: &Self::View) -> SMatrix<S, 2, D> {
        let axes = self.axes(placed);
        let mut columns = pair.gradient();
        if let Some(turn) = self.seat.carrier.turn() {
            columns[turn] -= left(&(pair.point.place - pair.seat.place));
        }
        SMatrix::<S, 2, D>::from_columns(&columns.map(|column| axes.tr_mul(&column)))
    }

    #[inline(always)]
    fn add_force(
        &self,
        (_, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>),
        pair: &Self::View,
        force: &SVector<S, 2>,
        sum: &mut SVector<S, D>,
    ) {
        let force = self.axes(placed) * force;
        pair.add_force(&force, sum);
        if let Some(turn) = self.seat.carrier.turn() {
            sum[turn] -= left(&(pair.point.place - pair.seat.place)).dot(&force);
        }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (tree, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>),
        pair: &Self::View,
        _: &SMatrix<S, 2, D>,
        force: &SVector<S, 2>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let force = self.axes(placed) * force;
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
        (tree, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>),
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
        SMatrix::<S, 2, D>::from_columns(&swept.map(|column| axes.tr_mul(&column)))
    }
}

impl<S: Scalar, const D: usize, C> Along<S, D, C> {
    /// What the columns of point and sensor have along the axis, a row each.
    #[inline(always)]
    fn along(&self, [point, sensor]: [&[Vector2<S>; D]; 2]) -> SMatrix<S, 2, D> {
        let columns: [_; D] =
            core::array::from_fn(|k| SVector::<S, 2>::new(self.axis.dot(&point[k]), self.axis.dot(&sensor[k])));
        SMatrix::<S, 2, D>::from_columns(&columns)
    }
}

/// `columns` above rows of zeros.
#[inline(always)]
fn above_zeros<S: Scalar, const D: usize>(columns: &[Vector2<S>; D]) -> SMatrix<S, 4, D> {
    let zero = S::zero();
    SMatrix::<S, 4, D>::from_columns(&columns.map(|column| SVector::<S, 4>::new(column.x, column.y, zero, zero)))
}

impl<S: Scalar, J: Topology<D>, R: Rigids<S, J, D>, H: Carrier<D>, P: Carrier<D>, const D: usize>
    Link<S, PlanarTree<S, D, J, R>, D, 4> for Between<S, D, H, P>
{
    type View = Pair<S, D, P, H>;

    #[inline(always)]
    fn view(&self, tree: &PlanarTree<S, D, J, R>, placed: &Placed<S, D>) -> Self::View {
        Pair { point: tree.at(&self.pin, placed), seat: tree.at(&self.hole, placed) }
    }

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.hole.carrier.moves(k) || self.pin.carrier.moves(k)
    }

    #[inline(always)]
    fn depends(&self, i: usize, k: usize) -> bool {
        match i {
            2 => self.hole.carrier.turn() == Some(k),
            3 => self.pin.carrier.turn() == Some(k),
            _ => true,
        }
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>), pair: &Self::View) -> Seen<S, 4> {
        let zero = S::zero();
        let apart = pair.point.place - pair.seat.place;
        let velocity = pair.rate(&placed.rates);
        let mut rate = SVector::<S, 4>::new(velocity.x, velocity.y, zero, zero);
        for (i, turn) in [(2, self.hole.carrier.turn()), (3, self.pin.carrier.turn())] {
            if let Some(turn) = turn {
                rate[i] = placed.rates[turn];
            }
        }
        Seen { place: SVector::<S, 4>::new(apart.x, apart.y, zero, zero), rate }
    }

    #[inline(always)]
    fn gradient(&self, _: (&PlanarTree<S, D, J, R>, &Placed<S, D>), pair: &Self::View) -> SMatrix<S, 4, D> {
        let mut gradient = above_zeros(&pair.gradient());
        for (i, turn) in [(2, self.hole.carrier.turn()), (3, self.pin.carrier.turn())] {
            if let Some(turn) = turn {
                gradient[(i, turn)] = S::one();
            }
        }
        gradient
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&PlanarTree<S, D, J, R>, &Placed<S, D>),
        pair: &Self::View,
        force: &SVector<S, 4>,
        sum: &mut SVector<S, D>,
    ) {
        pair.add_force(&Vector2::new(force[0], force[1]), sum);
        for (i, turn) in [(2, self.hole.carrier.turn()), (3, self.pin.carrier.turn())] {
            if let Some(turn) = turn {
                sum[turn] += force[i];
            }
        }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (tree, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>),
        pair: &Self::View,
        _: &SMatrix<S, 4, D>,
        force: &SVector<S, 4>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        pair.add_carried(tree.topology(), placed, &Vector2::new(force[0], force[1]), stiffness);
    }

    #[inline(always)]
    fn swept(
        &self,
        (tree, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>),
        pair: &Self::View,
        _: &SMatrix<S, 4, D>,
    ) -> SMatrix<S, 4, D> {
        above_zeros(&pair.swept(tree.topology(), placed))
    }
}

impl<S: Scalar, J: Topology<D>, R: Rigids<S, J, D>, A: Turns, B: Turns, const D: usize>
    Link<S, PlanarTree<S, D, J, R>, D, 1> for Turning<A, B>
{
    type View = ();

    #[inline(always)]
    fn view(&self, _: &PlanarTree<S, D, J, R>, _: &Placed<S, D>) {}

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.body.turn() == Some(k) || self.against.turn() == Some(k)
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>), (): &()) -> Seen<S, 1> {
        let mut axis = Vector2::new(S::one(), S::zero());
        let mut rate = S::zero();
        if let Some(body) = self.body.turn() {
            axis = placed.axes[body];
            rate = placed.rates[body];
        }
        if let Some(against) = self.against.turn() {
            let back = placed.axes[against];
            axis = turned(&Vector2::new(back.x, -back.y), &axis);
            rate -= placed.rates[against];
        }
        Seen { place: SVector::<S, 1>::new(angle(&axis)), rate: SVector::<S, 1>::new(rate) }
    }

    #[inline(always)]
    fn gradient(&self, _: (&PlanarTree<S, D, J, R>, &Placed<S, D>), (): &()) -> SMatrix<S, 1, D> {
        let mut gradient = SMatrix::<S, 1, D>::zeros();
        if let Some(body) = self.body.turn() {
            gradient[(0, body)] = S::one();
        }
        if let Some(against) = self.against.turn() {
            gradient[(0, against)] = -S::one();
        }
        gradient
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&PlanarTree<S, D, J, R>, &Placed<S, D>),
        (): &(),
        force: &SVector<S, 1>,
        sum: &mut SVector<S, D>,
    ) {
        if let Some(body) = self.body.turn() {
            sum[body] += force[0];
        }
        if let Some(against) = self.against.turn() {
            sum[against] -= force[0];
        }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        _: (&PlanarTree<S, D, J, R>, &Placed<S, D>),
        (): &(),
        _: &SMatrix<S, 1, D>,
        _: &SVector<S, 1>,
        _: &mut SMatrix<S, D, D>,
    ) {
    }

    #[inline(always)]
    fn swept(&self, _: (&PlanarTree<S, D, J, R>, &Placed<S, D>), (): &(), _: &SMatrix<S, 1, D>) -> SMatrix<S, 1, D> {
        SMatrix::zeros()
    }
}

impl<S: Scalar, J: Topology<D>, R: Rigids<S, J, D>, C: Carrier<D>, const D: usize> Link<S, PlanarTree<S, D, J, R>, D, 2>
    for Along<S, D, C>
{
    type View = [At<S, D, C>; 2];

    #[inline(always)]
    fn view(&self, tree: &PlanarTree<S, D, J, R>, placed: &Placed<S, D>) -> Self::View {
        [tree.at(&self.point, placed), tree.at(&self.sensor, placed)]
    }

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.point.carrier.moves(k)
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>), view: &Self::View) -> Seen<S, 2> {
        let [point, sensor] = view;
        let along = |of: [&Vector2<S>; 2]| SVector::<S, 2>::new(self.axis.dot(of[0]), self.axis.dot(of[1]));
        let velocities = [point, sensor].map(|at| at.velocity(&placed.rates));
        Seen { place: along([&point.place, &sensor.place]), rate: along(velocities.each_ref()) }
    }

    #[inline(always)]
    fn gradient(&self, _: (&PlanarTree<S, D, J, R>, &Placed<S, D>), view: &Self::View) -> SMatrix<S, 2, D> {
        self.along(view.each_ref().map(|at| &at.gradient))
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&PlanarTree<S, D, J, R>, &Placed<S, D>),
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
        (tree, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>),
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
        (tree, placed): (&PlanarTree<S, D, J, R>, &Placed<S, D>),
        view: &Self::View,
        _: &SMatrix<S, 2, D>,
    ) -> SMatrix<S, 2, D> {
        let [point, sensor] = view.each_ref().map(|at| at.swept(tree.topology(), placed, &placed.rates));
        self.along([&point, &sensor])
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
