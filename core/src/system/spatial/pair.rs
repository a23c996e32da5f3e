//! Two bodies as a link between them sees them: how a force between them acts, and how it changes as they move.
//!
//! The axes of the link stand still in the body that it looks from; all but places and laws is told in those of the frame. The motion
//! of the bodies has three parts: how fast the one centre of mass moves against the other, a; how fast the body that is looked at
//! turns, b; and how fast the body that it is looked at from turns, c. With r and ℓ from either centre of mass to the point, the
//! point moves by a + b × r − c × ℓ and its body turns by b − c. So a force f at the point and a moment m do work on the parts by f,
//! r × f + m and −(ℓ × f + m).

use nalgebra::Matrix3;

use super::{
    FreeBodies, Placed, Seat,
    blocks::{TURNING, VELOCITY, add_block, add_wrench},
};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    linear::{cross_matrix, cross_rows, twice_crossed},
    product::{cross, outer, product, times, transposed_times},
    system::Response,
};

/// How forces, and where `H` is 2 moments too, change with rates or places at the point: rows, then columns.
type AtPoint<S, const H: usize> = [[Matrix3<S>; H]; H];

/// How they change, negated, by the three parts of motion; by place these are displacement of the centres against each other, and the
/// turns of both.
type Change<S, const H: usize> = [[Matrix3<S>; 3]; H];

/// Two bodies as a link sees them.
#[derive(Clone, Copy, Debug)]
pub struct Pair<S> {
    /// Which bodies: the one that is looked at, the one that it is looked at from.
    bodies: [Option<usize>; 2],
    /// From the axes of the frame into those of the link; `None` where these are the same.
    axes: Option<Matrix3<S>>,
    /// Of the point since the nominal poses, in the axes of the link (m).
    pub(super) displacement: Vector3<S>,
    /// From either centre of mass to the point, r and ℓ (m).
    levers: [Vector3<S>; 2],
    /// Of the centres of mass against each other, a (m/s).
    velocity: Vector3<S>,
    /// Angular velocities, b and c (rad/s).
    turning: [Vector3<S>; 2],
}

impl<S: Scalar> Pair<S> {
    /// The point of `seat` seen in the axes of the body that it is seen from.
    #[inline(always)]
    pub(super) fn new<const N: usize, const D: usize>(
        seat: &Seat<S>,
        bodies: &FreeBodies<S, N, D>,
        placed: &Placed<S, N>,
    ) -> Self {
        let centre = |body: usize| bodies.bodies().get(body).map_or(Vector3::zeros(), |body| body.centre_w);
        let (lever, none) = (seat.point.lever, Vector3::zeros());
        let of = seat.point.body.and_then(|body| Some((body, placed.bodies.get(body)?)));
        let (mut nominal, mut moved, mut arm, mut velocity, mut turns) = (lever, none, lever, none, none);
        if let Some((i, of)) = of {
            arm = times(&of.to_frame, &lever);
            nominal += centre(i);
            moved = of.displacement_w + (arm - lever);
            (velocity, turns) = (of.velocity_w, of.rotation_w);
        }
        let Some((j, from)) = seat.from.and_then(|body| Some((body, placed.bodies.get(body)?))) else {
            let bodies = [of.map(|(i, _)| i), None];
            return Self {
                bodies,
                axes: None,
                displacement: moved,
                levers: [arm, nominal + moved],
                velocity,
                turning: [turns, none],
            };
        };
        nominal -= centre(j);
        moved -= from.displacement_w;
        let axes = from.to_frame.transpose();
        Self {
            bodies: [of.map(|(i, _)| i), Some(j)],
            axes: Some(axes),
            // Of displacements, not places, so that the distance from the frame's origin costs no digits; turns leave the rounding
            // of the levers.
            displacement: (times(&axes, &nominal) - nominal) + times(&axes, &moved),
            levers: [arm, nominal + moved],
            velocity: velocity - from.velocity_w,
            turning: [turns, from.rotation_w],
        }
    }

    /// The same in other `axes`, columns in those of now.
    #[inline(always)]
    pub(super) fn in_axes(self, axes: &Matrix3<S>) -> Self {
        let rows = axes.transpose();
        Self {
            axes: Some(self.axes.map_or(rows, |now| product(&rows, &now))),
            displacement: transposed_times(axes, &self.displacement),
            ..self
        }
    }

    /// In the axes of the link, of what the frame has.
    #[inline(always)]
    fn seen(&self, vector: Vector3<S>) -> Vector3<S> {
        self.axes.map_or(vector, |axes| times(&axes, &vector))
    }

    /// How fast the point moves, in the axes of the link (m/s).
    #[inline(always)]
    pub(super) fn rate(&self) -> Vector3<S> {
        let [[r, l], [b, c]] = [&self.levers, &self.turning];
        let rate = self.velocity + cross(b, r);
        self.seen(if self.bodies[1].is_some() { rate - cross(c, l) } else { rate })
    }

    /// How fast its body turns, in the axes of the link (rad/s).
    #[inline(always)]
    pub(super) fn turning(&self) -> Vector3<S> {
        let [b, c] = &self.turning;
        self.seen(if self.bodies[1].is_some() { b - c } else { *b })
    }

    /// The vectors of a link's `numbers`, in the axes of the frame.
    #[inline(always)]
    fn vectors<const R: usize, const H: usize>(&self, numbers: &SVector<S, R>) -> [Vector3<S>; H] {
        let mut vectors = [Vector3::zeros(); H];
        for (vector, three) in vectors.iter_mut().zip(numbers.data.0[0].as_chunks::<3>().0) {
            let three = Vector3::from(*three);
            *vector = self.axes.map_or(three, |axes| transposed_times(&axes, &three));
        }
        vectors
    }

    /// The 3 × 3 blocks of a link's `entries`, in the axes of the frame.
    #[inline(always)]
    fn blocks<const R: usize, const H: usize>(&self, entries: &SMatrix<S, R, R>) -> AtPoint<S, H> {
        let mut blocks = [[Matrix3::zeros(); H]; H];
        for (i, row) in blocks.iter_mut().enumerate() {
            for (block, columns) in row.iter_mut().zip(entries.data.0.as_chunks::<3>().0) {
                for (to, from) in block.data.0.iter_mut().zip(columns) {
                    to.iter_mut().zip(from.iter().skip(3 * i)).for_each(|(to, from)| *to = *from);
                }
                if let Some(axes) = &self.axes {
                    *block = product(&axes.transpose(), &product(block, axes));
                }
            }
        }
        blocks
    }

    /// Adds the generalised force (N, N·m) of a `force` (N) at the point and, where `H` is 2, of a moment (N·m).
    #[inline(always)]
    pub(super) fn add_force<const H: usize, const R: usize, const D: usize>(
        &self,
        force: &SVector<S, R>,
        sum: &mut SVector<S, D>,
    ) {
        let (push, moment) = force_and_moment(&self.vectors::<R, H>(force));
        let [r, l] = &self.levers;
        let with_moment = |torque: Vector3<S>| moment.map_or(torque, |moment| torque + moment);
        if let Some(i) = self.bodies[0] {
            add_wrench(sum, i, [&push, &with_moment(cross(r, &push))]);
        }
        if let Some(j) = self.bodies[1] {
            add_wrench(sum, j, [&-push, &-with_moment(cross(l, &push))]);
        }
    }

    /// See [`Link::add_impedance`](crate::system::Link::add_impedance).
    #[inline(always)]
    pub(super) fn add_impedance<const H: usize, const R: usize, const D: usize>(
        &self,
        response: &Response<S, R>,
        a: S,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        let (by_rate, by_place) = (self.blocks::<R, H>(&response.impedance), self.blocks(&response.stiffness));
        let mut change = self.by_velocity(&by_rate);
        for (row, by_place) in change.iter_mut().zip(self.by_place(&by_place, &by_rate)) {
            row.iter_mut().zip(by_place).for_each(|(entry, by_place)| *entry += by_place * a);
        }
        self.add(&change, matrix);
        self.carry::<H, D>(&self.vectors(&(response.force * a)), matrix);
    }

    /// See [`Link::add_derivatives`](crate::system::Link::add_derivatives).
    #[inline(always)]
    pub(super) fn add_derivatives<const H: usize, const R: usize, const D: usize>(
        &self,
        response: &Response<S, R>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let (by_rate, by_place) = (self.blocks::<R, H>(&response.impedance), self.blocks(&response.stiffness));
        self.add(&self.by_velocity(&by_rate), damping);
        self.add(&self.by_place(&by_place, &by_rate), stiffness);
        self.carry::<H, D>(&self.vectors(&response.force), stiffness);
    }

    /// How forces change, negated, by the parts of motion where `by` tells how by the rates at the point.
    #[inline(always)]
    fn by_velocity<const H: usize>(&self, by: &AtPoint<S, H>) -> Change<S, H> {
        let [r, l] = &self.levers;
        let mut change = [[Matrix3::zeros(); 3]; H];
        for (change, row) in change.iter_mut().zip(by) {
            let (by_move, by_turn) = force_and_moment(row);
            let with_turn = |matrix: Matrix3<S>| by_turn.map_or(matrix, |by_turn| matrix + by_turn);
            change[0] = by_move;
            change[1] = with_turn(cross_rows(r, &by_move));
            if self.bodies[1].is_some() {
                change[2] = -with_turn(cross_rows(l, &by_move));
            }
        }
        change
    }

    /// How forces change, negated, by small motions of the bodies, where `by_place` and `by_rate` tell how by place and rate at the
    /// point. Held are the velocities of the centres in the frame, and the angular velocities each in its own body. Only the first
    /// three places, lengths, count: laws see no angles.
    #[inline(always)]
    fn by_place<const H: usize>(&self, by_place: &AtPoint<S, H>, by_rate: &AtPoint<S, H>) -> Change<S, H> {
        let [[r, l], [b, c]] = [&self.levers, &self.turning];
        let carried = cross(b, r);
        let mut change = [[Matrix3::zeros(); 3]; H];
        for ((change, by_place), by_rate) in change.iter_mut().zip(by_place).zip(by_rate) {
            let ((by_place, _), (by_move, by_turn)) = (force_and_moment(by_place), force_and_moment(by_rate));
            let turned = cross_rows(&carried, &by_move);
            let turned = by_turn.map_or(turned, |by_turn| turned + cross_rows(b, &by_turn));
            if self.bodies[1].is_some() {
                let by_move_of = by_place + cross_rows(c, &by_move);
                change[0] = by_move_of;
                change[1] = cross_rows(r, &by_move_of) + turned;
                change[2] = -(cross_rows(l, &by_move_of) + cross_rows(&self.velocity, &by_move) + turned);
            } else {
                change[0] = by_place;
                change[1] = cross_rows(r, &by_place) + turned;
            }
        }
        change
    }

    /// Adds the generalised forces of `change` to `matrix`.
    #[inline(always)]
    fn add<const H: usize, const D: usize>(&self, change: &Change<S, H>, matrix: &mut SMatrix<S, D, D>) {
        let (forces, moments) = force_and_moment(change);
        let column = |part: usize| [forces[part], moments.map_or(Matrix3::zeros(), |moments| moments[part])];
        if let Some(i) = self.bodies[0] {
            self.add_columns::<H, D>([i, VELOCITY], column(0), matrix);
            self.add_columns::<H, D>([i, TURNING], column(1), matrix);
        }
        if let Some(j) = self.bodies[1] {
            self.add_columns::<H, D>([j, VELOCITY], column(0).map(|block| -block), matrix);
            self.add_columns::<H, D>([j, TURNING], column(2), matrix);
        }
    }

    /// Adds the generalised forces of forces at the point and, where `H` is 2, of moments that change by a part of motion.
    #[inline(always)]
    fn add_columns<const H: usize, const D: usize>(
        &self,
        by: [usize; 2],
        [forces, moments]: [Matrix3<S>; 2],
        matrix: &mut SMatrix<S, D, D>,
    ) {
        let [r, l] = &self.levers;
        let columns = matrix.data.0.as_chunks_mut::<3>().0.get_mut(2 * by[0] + by[1]);
        for ((column, force), moment) in columns.into_iter().flatten().zip(&forces.data.0).zip(&moments.data.0) {
            let (force, moment) = (Vector3::from(*force), Vector3::from(*moment));
            let mut act = |body: usize, force: Vector3<S>, torque: Vector3<S>| {
                if let Some([x, y, z, a, b, c]) = column.as_chunks_mut::<6>().0.get_mut(body) {
                    (*x, *y, *z) = (*x + force.x, *y + force.y, *z + force.z);
                    (*a, *b, *c) = (*a + torque.x, *b + torque.y, *c + torque.z);
                }
            };
            let with_moment = |torque: Vector3<S>| if H == 2 { torque + moment } else { torque };
            if let Some(i) = self.bodies[0] {
                act(i, force, with_moment(cross(r, &force)));
            }
            if let Some(j) = self.bodies[1] {
                act(j, -force, -with_moment(cross(l, &force)));
            }
        }
    }

    /// Subtracts how the generalised forces of a `force` that the link's axes carry along change with small motions of the bodies;
    /// torques as their bodies see them.
    #[inline(always)]
    fn carry<const H: usize, const D: usize>(&self, force: &[Vector3<S>; H], matrix: &mut SMatrix<S, D, D>) {
        let [r, l] = &self.levers;
        let (push, moment) = force_and_moment(force);
        let arm = twice_crossed(&outer(&push, r));
        let arm = moment.map_or(arm, |moment| arm + cross_matrix(&moment));
        if let Some(i) = self.bodies[0] {
            add_block(matrix, [[i, TURNING], [i, TURNING]], &-arm);
        }
        if let Some(j) = self.bodies[1] {
            let turned = cross_matrix(&push);
            if let Some(i) = self.bodies[0] {
                add_block(matrix, [[i, VELOCITY], [j, TURNING]], &turned);
                add_block(matrix, [[i, TURNING], [j, TURNING]], &arm);
                add_block(matrix, [[j, TURNING], [i, VELOCITY]], &-turned);
                add_block(matrix, [[j, TURNING], [i, TURNING]], &twice_crossed(&outer(r, &push)));
            }
            add_block(matrix, [[j, VELOCITY], [j, TURNING]], &-turned);
            add_block(matrix, [[j, TURNING], [j, VELOCITY]], &turned);
            add_block(matrix, [[j, TURNING], [j, TURNING]], &-twice_crossed(&outer(l, &push)));
        }
    }
}

/// What belongs to the force, and to the moment where `H` is 2.
#[inline(always)]
fn force_and_moment<T: Copy, const H: usize>(of: &[T; H]) -> (T, Option<T>) {
    const { assert!(H == 1 || H == 2, "a force, or a force and a moment") }
    (of[0], of.get(1).copied())
}
