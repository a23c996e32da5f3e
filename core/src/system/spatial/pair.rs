//! Two bodies as a link between them sees them: how a force between them acts, and how it changes as they move.
//!
//! The axes of the link stand still in the body that it looks from; all but places and laws is told in those of the frame. The motion
//! of the bodies has three parts: how fast the one centre of mass moves against the other, a; how fast the body that is looked at
//! turns, b; and how fast the body that it is looked at from turns, c. With r and ℓ from either centre of mass to the point that is
//! seen, and s from there to the one where forces act, the bodies move there by a + b × (r + s) − c × (ℓ + s) against each other, and
//! a force f does work on the parts by f, (r + s) × f and −(ℓ + s) × f. The axes of the link carry s along.
//!
//! No closures here: they are not always inlined, and in lanes every number in one that is not would be a call.

use nalgebra::Matrix3;

use super::{
    FreeBodies, Placed, Seat,
    blocks::{TURNING, VELOCITY, add_block, add_wrench},
};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    linear::{cross_columns, cross_matrix, cross_rows, twice_crossed},
    product::{cross, difference, opposite, outer, product, sum, times, transposed_times},
    system::Response,
};

/// How forces or moments change, negated, by the three parts of motion; by place these are displacement of the centres against each
/// other, and the turns of both.
type Change<S> = [Matrix3<S>; 3];

/// The centre of mass of body `i` in the nominal pose (m).
#[inline(always)]
fn centre<S: Scalar, const N: usize, const D: usize>(bodies: &FreeBodies<S, N, D>, i: usize) -> Vector3<S> {
    match bodies.bodies().get(i) {
        Some(body) => body.centre_w,
        None => Vector3::zeros(),
    }
}

/// `torques` and `moments`, if there are any.
#[inline(always)]
fn with_moments<S: Scalar>(torques: Matrix3<S>, moments: Option<&Matrix3<S>>) -> Matrix3<S> {
    match moments {
        Some(moments) => sum(&torques, moments),
        None => torques,
    }
}

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
    /// From the point to where forces act, s (m); `None` where that is there.
    reach: Option<Vector3<S>>,
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
        let (lever, none) = (seat.point.lever, Vector3::zeros());
        let of = seat.point.body.and_then(|body| Some((body, placed.bodies.get(body)?)));
        let (mut nominal, mut moved, mut arm, mut velocity, mut turns) = (lever, none, lever, none, none);
        if let Some((i, of)) = of {
            arm = times(&of.to_frame, &lever);
            nominal += centre(bodies, i);
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
                reach: None,
                velocity,
                turning: [turns, none],
            };
        };
        nominal -= centre(bodies, j);
        moved -= from.displacement_w;
        let axes = from.to_frame.transpose();
        Self {
            bodies: [of.map(|(i, _)| i), Some(j)],
            axes: Some(axes),
            // Of displacements, not places, so that the distance from the frame's origin costs no digits; turns leave the rounding
            // of the levers.
            displacement: (times(&axes, &nominal) - nominal) + times(&axes, &moved),
            levers: [arm, nominal + moved],
            reach: None,
            velocity: velocity - from.velocity_w,
            turning: [turns, from.rotation_w],
        }
    }

    /// The same in other `axes`, columns in those of now.
    #[inline(always)]
    pub(super) fn in_axes(self, axes: &Matrix3<S>) -> Self {
        let rows = axes.transpose();
        Self {
            axes: Some(match &self.axes {
                Some(now) => product(&rows, now),
                None => rows,
            }),
            displacement: transposed_times(axes, &self.displacement),
            ..self
        }
    }

    /// The same with forces that act `reach` (m) away from the point, in the axes of the link.
    #[inline(always)]
    pub(super) fn reaching(self, reach: &Vector3<S>) -> Self {
        Self { reach: Some(self.in_frame(reach)), ..self }
    }

    /// In the axes of the link, of what the frame has.
    #[inline(always)]
    fn seen(&self, vector: Vector3<S>) -> Vector3<S> {
        match &self.axes {
            Some(axes) => times(axes, &vector),
            None => vector,
        }
    }

    /// In the axes of the frame, of what the link has.
    #[inline(always)]
    fn in_frame(&self, vector: &Vector3<S>) -> Vector3<S> {
        match &self.axes {
            Some(axes) => transposed_times(axes, vector),
            None => *vector,
        }
    }

    /// In the axes of the frame, of what goes by vectors of the link.
    #[inline(always)]
    fn block(&self, entries: &Matrix3<S>) -> Matrix3<S> {
        match &self.axes {
            Some(axes) => product(&axes.transpose(), &product(entries, axes)),
            None => *entries,
        }
    }

    /// From either centre of mass to where forces act (m).
    #[inline(always)]
    fn arms(&self) -> [Vector3<S>; 2] {
        match &self.reach {
            Some(reach) => [self.levers[0] + reach, self.levers[1] + reach],
            None => self.levers,
        }
    }

    /// How fast the bodies move against each other where forces act, in the axes of the link (m/s).
    #[inline(always)]
    pub(super) fn rate(&self) -> Vector3<S> {
        let ([r, l], [b, c]) = (&self.arms(), &self.turning);
        let rate = self.velocity + cross(b, r);
        self.seen(if self.bodies[1].is_some() { rate - cross(c, l) } else { rate })
    }

    /// How fast the body that is looked at turns against the other, in the axes of the link (rad/s).
    #[inline(always)]
    pub(super) fn turning(&self) -> Vector3<S> {
        let [b, c] = &self.turning;
        self.seen(if self.bodies[1].is_some() { b - c } else { *b })
    }

    /// Adds the generalised force (N, N·m) of a `force` (N).
    #[inline(always)]
    pub(super) fn add_force<const D: usize>(&self, force: &Vector3<S>, sum: &mut SVector<S, D>) {
        let push = self.in_frame(force);
        let [r, l] = &self.arms();
        if let Some(i) = self.bodies[0] {
            add_wrench(sum, i, [&push, &cross(r, &push)]);
        }
        if let Some(j) = self.bodies[1] {
            add_wrench(sum, j, [&-push, &-cross(l, &push)]);
        }
    }

    /// See [`Link::add_impedance`](crate::system::Link::add_impedance). Where the reach goes by the place, `moment` tells how that
    /// changes s × f, negated (N).
    #[inline(always)]
    pub(super) fn add_impedance<const D: usize>(
        &self,
        response: &Response<S, 3>,
        moment: Option<&Matrix3<S>>,
        a: S,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        let [by_rate, by_place] = [self.block(&response.impedance), self.block(&response.stiffness)];
        let mut change = self.by_velocity(&by_rate);
        for (entry, by_place) in change.iter_mut().zip(self.by_place(&by_place, &by_rate)) {
            *entry += by_place * a;
        }
        let moment = match moment {
            Some(moment) => Some(self.by_displacement(&(self.block(moment) * a))),
            None => None,
        };
        self.add(&change, moment, matrix);
        self.carry(&self.in_frame(&(response.force * a)), matrix);
    }

    /// See [`Link::add_derivatives`](crate::system::Link::add_derivatives); `moment` as for [`add_impedance`](Self::add_impedance).
    #[inline(always)]
    pub(super) fn add_derivatives<const D: usize>(
        &self,
        response: &Response<S, 3>,
        moment: Option<&Matrix3<S>>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let [by_rate, by_place] = [self.block(&response.impedance), self.block(&response.stiffness)];
        self.add(&self.by_velocity(&by_rate), None, damping);
        let moment = match moment {
            Some(moment) => Some(self.by_displacement(&self.block(moment))),
            None => None,
        };
        self.add(&self.by_place(&by_place, &by_rate), moment, stiffness);
        self.carry(&self.in_frame(&response.force), stiffness);
    }

    /// How forces change, negated, by the parts of motion where `by_move` tells how by the rate.
    #[inline(always)]
    fn by_velocity(&self, by_move: &Matrix3<S>) -> Change<S> {
        let [r, l] = &self.arms();
        let of_other = if self.bodies[1].is_some() { opposite(&cross_rows(l, by_move)) } else { Matrix3::zeros() };
        [*by_move, cross_rows(r, by_move), of_other]
    }

    /// How forces or moments change, negated, by small motions of the bodies where `by_place` tells how by the place alone.
    #[inline(always)]
    fn by_displacement(&self, by_place: &Matrix3<S>) -> Change<S> {
        let [r, l] = &self.levers;
        let of_other = if self.bodies[1].is_some() { opposite(&cross_rows(l, by_place)) } else { Matrix3::zeros() };
        [*by_place, cross_rows(r, by_place), of_other]
    }

    /// How forces change, negated, by small motions of the bodies, where `by_place` and `by_move` tell how by place and rate. Held are
    /// the velocities of the centres in the frame, and the angular velocities each in its own body.
    #[inline(always)]
    fn by_place(&self, by_place: &Matrix3<S>, by_move: &Matrix3<S>) -> Change<S> {
        let [[r, _], [b, c]] = [&self.levers, &self.turning];
        let turned = cross_rows(&cross(b, r), by_move);
        let turned = match &self.reach {
            Some(reach) => sum(&turned, &cross_rows(b, &cross_rows(reach, by_move))),
            None => turned,
        };
        let by_place = if self.bodies[1].is_some() { sum(by_place, &cross_rows(c, by_move)) } else { *by_place };
        let [by_move_of, of_one, of_other] = self.by_displacement(&by_place);
        let of_other = if self.bodies[1].is_some() {
            difference(&of_other, &sum(&cross_rows(&self.velocity, by_move), &turned))
        } else {
            of_other
        };
        [by_move_of, sum(&of_one, &turned), of_other]
    }

    /// Adds the generalised forces of forces, and of moments besides if there are any, that change by the parts of motion.
    #[inline(always)]
    fn add<const D: usize>(&self, forces: &Change<S>, moments: Option<Change<S>>, matrix: &mut SMatrix<S, D, D>) {
        let [by_move, of_one, of_other] = forces;
        let [by_move_m, of_one_m, of_other_m] = match moments {
            Some([a, b, c]) => [Some(a), Some(b), Some(c)],
            None => [None; 3],
        };
        if let Some(i) = self.bodies[0] {
            self.add_columns([i, VELOCITY], by_move, by_move_m.as_ref(), matrix);
            self.add_columns([i, TURNING], of_one, of_one_m.as_ref(), matrix);
        }
        if let Some(j) = self.bodies[1] {
            let by_move_m = match &by_move_m {
                Some(moments) => Some(opposite(moments)),
                None => None,
            };
            self.add_columns([j, VELOCITY], &opposite(by_move), by_move_m.as_ref(), matrix);
            self.add_columns([j, TURNING], of_other, of_other_m.as_ref(), matrix);
        }
    }

    /// Adds the generalised forces of forces, and of moments besides, that change by one part of motion.
    #[inline(always)]
    fn add_columns<const D: usize>(
        &self,
        by: [usize; 2],
        forces: &Matrix3<S>,
        moments: Option<&Matrix3<S>>,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        let [r, l] = &self.arms();
        if let Some(i) = self.bodies[0] {
            add_block(matrix, [[i, VELOCITY], by], forces);
            add_block(matrix, [[i, TURNING], by], &with_moments(cross_columns(r, forces), moments));
        }
        if let Some(j) = self.bodies[1] {
            add_block(matrix, [[j, VELOCITY], by], &opposite(forces));
            add_block(matrix, [[j, TURNING], by], &opposite(&with_moments(cross_columns(l, forces), moments)));
        }
    }

    /// Subtracts how the generalised forces of a `force` that the link's axes carry along change with small motions of the bodies;
    /// torques as their bodies see them.
    #[inline(always)]
    fn carry<const D: usize>(&self, push: &Vector3<S>, matrix: &mut SMatrix<S, D, D>) {
        let [r, l] = &self.levers;
        let arm = twice_crossed(&outer(push, r));
        let arm = match &self.reach {
            Some(reach) => sum(&arm, &cross_matrix(&cross(reach, push))),
            None => arm,
        };
        if let Some(i) = self.bodies[0] {
            add_block(matrix, [[i, TURNING], [i, TURNING]], &opposite(&arm));
        }
        if let Some(j) = self.bodies[1] {
            let turned = cross_matrix(push);
            if let Some(i) = self.bodies[0] {
                add_block(matrix, [[i, VELOCITY], [j, TURNING]], &turned);
                add_block(matrix, [[i, TURNING], [j, TURNING]], &arm);
                add_block(matrix, [[j, TURNING], [i, VELOCITY]], &opposite(&turned));
                add_block(matrix, [[j, TURNING], [i, TURNING]], &twice_crossed(&outer(r, push)));
            }
            add_block(matrix, [[j, VELOCITY], [j, TURNING]], &opposite(&turned));
            add_block(matrix, [[j, TURNING], [j, VELOCITY]], &turned);
            add_block(matrix, [[j, TURNING], [j, TURNING]], &opposite(&twice_crossed(&outer(l, push))));
        }
    }
}
