//! What elements in space see.

use nalgebra::Matrix3;

use super::{FreeBodies, Placed, bodies::PlacedBody};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    linear::cross_matrix,
    system::{Link, Seen},
};

/// A point of a body, or of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Port<S> {
    /// Which body; `None` for the frame, which also stands for a body that is not there.
    pub body: Option<usize>,
    /// The point (m) from the body's centre of mass, in its axes; in the frame from its origin.
    pub lever: Vector3<S>,
}

/// A point of one body as seen from another, in the axes of the latter: displacement (m) since the nominal poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat<S> {
    /// The point.
    pub point: Port<S>,
    /// The body that it is seen from; `None` for the frame.
    pub from: Option<usize>,
}

/// The same, in axes that are turned against those of the body, and with the rotation of the point's body against it: the
/// first three are lengths, the last three angles of which the rates alone are told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turned<S> {
    /// The point and where it is seen from.
    pub seat: Seat<S>,
    /// The axes, columns in the body's axes.
    pub axes: Matrix3<S>,
    /// Place (m) of the point in these axes at the nominal poses.
    pub offset: Vector3<S>,
}

/// A point of a body along an axis of the frame, and the body's centre of mass, whose speed along it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along<S> {
    /// The body; one that is not there stands still.
    pub body: usize,
    /// Where the force acts (m), from the centre of mass in the body's axes.
    pub lever: Vector3<S>,
    /// Direction in the frame, of unit length.
    pub axis_w: Vector3<S>,
}

/// How fast a body turns about an axis of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct About<S> {
    /// The body; one that is not there stands still.
    pub body: usize,
    /// Direction in the frame, of unit length.
    pub axis_w: Vector3<S>,
}

/// A point seen from a body, with what its derivatives are made of.
#[derive(Clone, Copy, Debug)]
pub struct View<S> {
    /// Displacement since the nominal poses, in the axes of the body that it is seen from (m).
    displacement: Vector3<S>,
    /// From that body's centre of mass, in its axes (m).
    lever: Vector3<S>,
    /// From the point's body into these axes.
    across: Matrix3<S>,
    /// From the frame into these axes.
    to_seat: Matrix3<S>,
    /// Velocity of the centres of mass against each other, in these axes (m/s).
    velocity: Vector3<S>,
    /// Angular velocities, each in its body's axes (rad/s).
    rotations: [Vector3<S>; 2],
}

impl<S: Scalar> Seat<S> {
    /// Whether the coordinate `k` moves the point or what it is seen from.
    #[inline(always)]
    fn is_moved_by(&self, k: usize) -> bool {
        let body = Some(k / 6);
        self.point.body == body || self.from == body
    }

    #[inline(always)]
    fn look<const N: usize, const D: usize>(&self, bodies: &FreeBodies<S, N, D>, placed: &Placed<S, N, D>) -> View<S> {
        let centre = |body: Option<usize>| {
            body.and_then(|body| bodies.bodies().get(body)).map_or(Vector3::zeros(), |body| body.centre_w)
        };
        let nominal = centre(self.point.body) + self.point.lever - centre(self.from);
        let of = self.point.body.map_or(PlacedBody::still(), |body| placed.body(body));
        let moved_w = of.displacement_w + (of.to_frame * self.point.lever - self.point.lever);
        match self.from {
            Some(body) => {
                let from = placed.body(body);
                let to_seat = from.to_frame.transpose();
                let displacement = (to_seat * nominal - nominal) + to_seat * (moved_w - from.displacement_w);
                View {
                    displacement,
                    lever: nominal + displacement,
                    across: to_seat * of.to_frame,
                    to_seat,
                    velocity: to_seat * (of.velocity_w - from.velocity_w),
                    rotations: [of.rotation_b, from.rotation_b],
                }
            }
            None => View {
                displacement: moved_w,
                lever: nominal + moved_w,
                across: of.to_frame,
                to_seat: Matrix3::identity(),
                velocity: of.velocity_w,
                rotations: [of.rotation_b, Vector3::zeros()],
            },
        }
    }

    /// How fast the point moves, seen from the body.
    #[inline(always)]
    fn rate(&self, view: &View<S>) -> Vector3<S> {
        let [of, from] = &view.rotations;
        let rate = view.velocity + view.across * of.cross(&self.point.lever);
        if self.from.is_some() { rate - from.cross(&view.lever) } else { rate }
    }

    /// Adds the generalised force (N, N·m) of a `force` (N) on the point, given in the axes of the body that it is seen from.
    #[inline(always)]
    fn add_force<const D: usize>(&self, view: &View<S>, force: &Vector3<S>, sum: &mut SVector<S, D>) {
        let force_w = if self.from.is_some() { view.to_seat.tr_mul(force) } else { *force };
        if let Some(i) = self.point.body {
            let torque_b = self.point.lever.cross(&view.across.tr_mul(force));
            add_wrench(sum, i, [&force_w, &torque_b]);
        }
        if let Some(j) = self.from {
            add_wrench(sum, j, [&-force_w, &force.cross(&view.lever)]);
        }
    }

    /// How these lengths go by the velocities.
    #[inline(always)]
    fn lengths<const D: usize>(&self, view: &View<S>) -> SMatrix<S, 3, D> {
        let mut gradient = SMatrix::<S, 3, D>::zeros();
        if let Some(i) = self.point.body {
            put(&mut gradient, (0, 6 * i), &view.to_seat);
            put(&mut gradient, (0, 6 * i + 3), &-(view.across * cross_matrix(&self.point.lever)));
        }
        if let Some(i) = self.from {
            put(&mut gradient, (0, 6 * i), &-view.to_seat);
            put(&mut gradient, (0, 6 * i + 3), &cross_matrix(&view.lever));
        }
        gradient
    }

    /// Subtracts ∂(Λᵀφ)/∂Q for the `force` φ (N) from `stiffness`.
    #[inline(always)]
    fn carry<const D: usize>(
        &self,
        view: &View<S>,
        gradient: &SMatrix<S, 3, D>,
        force: &Vector3<S>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let turned = cross_matrix(force);
        let to_frame = view.to_seat.transpose();
        if let Some(i) = self.point.body {
            let arm = cross_matrix(&self.point.lever);
            let force_b = view.across.tr_mul(force);
            sub(stiffness, (6 * i + 3, 6 * i + 3), &(arm * cross_matrix(&force_b)));
            if let Some(j) = self.from {
                sub(stiffness, (6 * i, 6 * j + 3), &-(to_frame * turned));
                sub(stiffness, (6 * i + 3, 6 * j + 3), &-(arm * view.across.tr_mul(&turned)));
            }
        }
        if let Some(j) = self.from {
            sub(stiffness, (6 * j, 6 * j + 3), &(to_frame * turned));
            sub_rows(stiffness, 6 * j + 3, &(turned * gradient));
        }
    }

    /// ∂(Λ·V)/∂Q.
    #[inline(always)]
    fn sweep<const D: usize>(&self, view: &View<S>, gradient: &SMatrix<S, 3, D>, swept: &mut SMatrix<S, 3, D>) {
        let [of, from] = &view.rotations;
        let carried = of.cross(&self.point.lever);
        if let Some(j) = self.from {
            sub_rows(swept, 0, &(cross_matrix(from) * gradient));
            add(swept, (0, 6 * j + 3), &cross_matrix(&(view.velocity + view.across * carried)));
        }
        if let Some(i) = self.point.body {
            sub(swept, (0, 6 * i + 3), &(view.across * cross_matrix(&carried)));
        }
    }
}

impl<S: Scalar, const N: usize, const D: usize> Link<S, FreeBodies<S, N, D>, D, 3> for Seat<S> {
    type View = View<S>;

    #[inline(always)]
    fn view(&self, bodies: &FreeBodies<S, N, D>, placed: &Placed<S, N, D>) -> View<S> {
        self.look(bodies, placed)
    }

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.is_moved_by(k)
    }

    #[inline(always)]
    fn seen(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N, D>), view: &View<S>) -> Seen<S, 3> {
        Seen { place: view.displacement, rate: self.rate(view) }
    }

    #[inline(always)]
    fn gradient(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N, D>), view: &View<S>) -> SMatrix<S, 3, D> {
        self.lengths(view)
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &View<S>,
        force: &SVector<S, 3>,
        sum: &mut SVector<S, D>,
    ) {
        Seat::add_force(self, view, force, sum);
    }

    #[inline(always)]
    fn add_carried(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &View<S>,
        gradient: &SMatrix<S, 3, D>,
        force: &SVector<S, 3>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        self.carry(view, gradient, force, stiffness);
    }

    #[inline(always)]
    fn swept(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &View<S>,
        gradient: &SMatrix<S, 3, D>,
    ) -> SMatrix<S, 3, D> {
        let mut swept = SMatrix::zeros();
        self.sweep(view, gradient, &mut swept);
        swept
    }
}

impl<S: Scalar> Turned<S> {
    /// The force (N) and the moment (N·m) in `force`, in the axes of the body that it is seen from.
    #[inline(always)]
    fn halves(&self, force: &SVector<S, 6>) -> [Vector3<S>; 2] {
        let [a, b, c, d, e, f] = force.data.0[0];
        [self.axes * Vector3::new(a, b, c), self.axes * Vector3::new(d, e, f)]
    }
}

impl<S: Scalar, const N: usize, const D: usize> Link<S, FreeBodies<S, N, D>, D, 6> for Turned<S> {
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

impl<S: Scalar> Along<S> {
    /// How the speed at the point goes by the angular velocity of the body, which is `at` a pose.
    #[inline(always)]
    fn arm(&self, at: &PlacedBody<S>) -> Vector3<S> {
        self.lever.cross(&at.to_frame.tr_mul(&self.axis_w))
    }
}

impl<S: Scalar, const N: usize, const D: usize> Link<S, FreeBodies<S, N, D>, D, 2> for Along<S> {
    type View = ();

    #[inline(always)]
    fn view(&self, _: &FreeBodies<S, N, D>, _: &Placed<S, N, D>) {}

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.body == k / 6
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>), (): &()) -> Seen<S, 2> {
        let at = placed.body(self.body);
        let along = self.axis_w.dot(&at.velocity_w);
        let turning = self.arm(&at).dot(&at.rotation_b);
        Seen { place: SVector::zeros(), rate: SVector::<S, 2>::new(along + turning, along) }
    }

    #[inline(always)]
    fn gradient(&self, (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>), (): &()) -> SMatrix<S, 2, D> {
        let arm = self.arm(&placed.body(self.body));
        let mut gradient = SMatrix::<S, 2, D>::zeros();
        put_row(&mut gradient, (0, 6 * self.body), &self.axis_w);
        put_row(&mut gradient, (1, 6 * self.body), &self.axis_w);
        put_row(&mut gradient, (0, 6 * self.body + 3), &arm);
        gradient
    }

    #[inline(always)]
    fn add_force(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        force: &SVector<S, 2>,
        sum: &mut SVector<S, D>,
    ) {
        let torque_b = self.arm(&placed.body(self.body)) * force[0];
        add_wrench(sum, self.body, [&(self.axis_w * (force[0] + force[1])), &torque_b]);
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        _: &SMatrix<S, 2, D>,
        force: &SVector<S, 2>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let axis_b = placed.body(self.body).to_frame.tr_mul(&self.axis_w) * force[0];
        let at = 6 * self.body + 3;
        sub(stiffness, (at, at), &(cross_matrix(&self.lever) * cross_matrix(&axis_b)));
    }

    #[inline(always)]
    fn swept(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        _: &SMatrix<S, 2, D>,
    ) -> SMatrix<S, 2, D> {
        let at = placed.body(self.body);
        let axis_b = at.to_frame.tr_mul(&self.axis_w);
        // ω·(lever × axis), the axis turning against the body: ∂axis = axis × θ.
        let by_turn = axis_b.cross(&self.lever.cross(&at.rotation_b));
        let mut swept = SMatrix::<S, 2, D>::zeros();
        put_row(&mut swept, (0, 6 * self.body + 3), &by_turn);
        swept
    }
}

impl<S: Scalar, const N: usize, const D: usize> Link<S, FreeBodies<S, N, D>, D, 1> for About<S> {
    type View = ();

    #[inline(always)]
    fn view(&self, _: &FreeBodies<S, N, D>, _: &Placed<S, N, D>) {}

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.body == k / 6
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>), (): &()) -> Seen<S, 1> {
        let at = placed.body(self.body);
        let rate = at.to_frame.tr_mul(&self.axis_w).dot(&at.rotation_b);
        Seen { place: SVector::zeros(), rate: SVector::<S, 1>::new(rate) }
    }

    #[inline(always)]
    fn gradient(&self, (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>), (): &()) -> SMatrix<S, 1, D> {
        let axis_b = placed.body(self.body).to_frame.tr_mul(&self.axis_w);
        let mut gradient = SMatrix::<S, 1, D>::zeros();
        put_row(&mut gradient, (0, 6 * self.body + 3), &axis_b);
        gradient
    }

    #[inline(always)]
    fn add_force(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        force: &SVector<S, 1>,
        sum: &mut SVector<S, D>,
    ) {
        let axis_b = placed.body(self.body).to_frame.tr_mul(&self.axis_w);
        add_wrench(sum, self.body, [&Vector3::zeros(), &(axis_b * force[0])]);
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        _: &SMatrix<S, 1, D>,
        force: &SVector<S, 1>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let axis_b = placed.body(self.body).to_frame.tr_mul(&self.axis_w) * force[0];
        let at = 6 * self.body + 3;
        sub(stiffness, (at, at), &cross_matrix(&axis_b));
    }

    #[inline(always)]
    fn swept(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        _: &SMatrix<S, 1, D>,
    ) -> SMatrix<S, 1, D> {
        let at = placed.body(self.body);
        // ω·axis with ∂axis = axis × θ.
        let by_turn = at.rotation_b.cross(&at.to_frame.tr_mul(&self.axis_w));
        let mut swept = SMatrix::<S, 1, D>::zeros();
        put_row(&mut swept, (0, 6 * self.body + 3), &by_turn);
        swept
    }
}

/// Adds a force (N) and a torque (N·m) on a body to `sum`; those on one that is not there are left out.
#[inline(always)]
fn add_wrench<S: Scalar, const D: usize>(sum: &mut SVector<S, D>, body: usize, [force, torque]: [&Vector3<S>; 2]) {
    if let Some([x, y, z, a, b, c]) = sum.data.0[0].as_chunks_mut::<6>().0.get_mut(body) {
        (*x, *y, *z) = (*x + force.x, *y + force.y, *z + force.z);
        (*a, *b, *c) = (*a + torque.x, *b + torque.y, *c + torque.z);
    }
}

/// Does `change` to each entry of a block of `matrix` that begins `at` a row and a column, with that of `block`; what of it lies
/// outside is left out.
#[inline(always)]
fn change<S: Scalar, const R: usize, const D: usize, const H: usize, const W: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    block: &SMatrix<S, H, W>,
    change: impl Fn(&mut S, S),
) {
    for (column, from) in matrix.data.0.iter_mut().skip(at.1).zip(&block.data.0) {
        for (entry, from) in column.iter_mut().skip(at.0).zip(from) {
            change(entry, *from);
        }
    }
}

#[inline(always)]
fn put<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    block: &Matrix3<S>,
) {
    change(matrix, at, block, |entry, from| *entry = from);
}

#[inline(always)]
fn put_row<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    row: &Vector3<S>,
) {
    change(matrix, at, &row.transpose(), |entry, from| *entry = from);
}

#[inline(always)]
fn add<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    block: &Matrix3<S>,
) {
    change(matrix, at, block, |entry, from| *entry += from);
}

#[inline(always)]
fn sub<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    block: &Matrix3<S>,
) {
    change(matrix, at, block, |entry, from| *entry -= from);
}

/// Subtracts `rows` from those of `matrix` from `first` on.
#[inline(always)]
fn sub_rows<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    first: usize,
    rows: &SMatrix<S, 3, D>,
) {
    change(matrix, (first, 0), rows, |entry, from| *entry -= from);
}
