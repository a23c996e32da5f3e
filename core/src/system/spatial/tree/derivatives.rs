//! How bodies on joints, and the forces on them, go by the coordinates: J and what it makes of velocities and accelerations change
//! with the pose.
//!
//! A small turn δ of the coordinate j takes along all that hangs behind it as one rigid body: what moves against the part before the
//! joint, by v′ and ω′ with the accelerations a′ and α′, moves the same way in turned axes. So with θ the axis of a turn, none of a
//! slide, d the move of a centre of mass, ω and α the turning of the part before:
//!
//! | by δ | centre of mass | turning |
//! |---|---|---|
//! | velocity | ω × d + θ × v′ | θ × ω′ |
//! | acceleration | α × d + ω × (ω × d) + 2ω × (θ × v′) + θ × a′ | θ × α′ + ω × (θ × ω′) |

use super::{
    SpatialTree,
    motion::Pairs,
    numbers::{pair, times},
    placed::Placed,
};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    product::{cross, dot, times as of_three},
    system::spatial::{PlacedBody, blocks::add_pair},
};

/// How the motion of a body changes by one coordinate: its centre of mass, and its turning.
#[derive(Clone, Copy)]
struct Change<S> {
    /// By a small displacement, the velocities of the coordinates held.
    velocity: [Vector3<S>; 2],
    /// Likewise, the accelerations of the coordinates held, too.
    acceleration: [Vector3<S>; 2],
    /// Of the column of J, with time.
    column_rate: [Vector3<S>; 2],
}

impl<S: Scalar, const N: usize, const W: usize, const D: usize> SpatialTree<S, N, W, D> {
    /// How the motion of `body` changes by the coordinate `k`, which moves it; `of_coordinates` and `of_bodies` are accelerations.
    #[inline(always)]
    fn change(
        &self,
        placed: &Placed<S, N, W, D>,
        [k, body]: [usize; 2],
        of_coordinates: &SVector<S, D>,
        of_bodies: &Pairs<S, N>,
    ) -> Change<S> {
        let none = [Vector3::zeros(); 2];
        let still = Change { velocity: none, acceleration: none, column_rate: none };
        let Some(coordinate) = self.coordinates.get(k) else { return still };
        let (Some(Some(hung)), Some(joint)) = (self.mounts.get(coordinate.mount), placed.joints.get(coordinate.mount))
        else {
            return still;
        };
        let two = S::from_f64(2.0);
        let [moved, axis] = placed.column(k, body);
        let at = placed.free.body(body);
        let before = hung.on.map_or(PlacedBody::still(), |on| placed.free.body(on));
        let [before_centre, before_turning] = hung.on.and_then(|on| of_bodies.get(on).copied()).unwrap_or(none);
        let [own_centre, own_turning] = of_bodies.get(body).copied().unwrap_or(none);
        let (spin, arm) = (&before.rotation_w, self.between(placed, hung.on, body));
        let carried = |arm: &Vector3<S>| cross(&before_turning, arm) + cross(spin, &cross(spin, arm));
        if !coordinate.kind.turns() {
            return Change {
                velocity: [cross(spin, &moved), Vector3::zeros()],
                acceleration: [carried(&moved), Vector3::zeros()],
                column_rate: [cross(spin, &moved), Vector3::zeros()],
            };
        }
        // The slides of the same joint come before its turns.
        let [slid, _] = self.relative(placed, hung.coordinates, of_coordinates);
        let velocity = at.velocity_w - before.velocity_w - cross(spin, &arm) - joint.sliding;
        let rotation = at.rotation_w - spin;
        let turning = own_turning - before_turning - cross(spin, &rotation);
        let of_joint = before_centre + carried(&arm) + cross(spin, &joint.sliding) * two + slid;
        let acceleration = own_centre - of_joint - cross(spin, &velocity) * two;
        let (swept, turned) = (cross(&axis, &velocity), cross(&axis, &rotation));
        let own = placed.free.body(hung.body);
        let axis_rate = cross(&own.rotation_w, &axis);
        let at_joint = own.velocity_w - cross(&own.rotation_w, &joint.arms[1]);
        Change {
            velocity: [cross(spin, &moved) + swept, turned],
            acceleration: [
                carried(&moved) + cross(spin, &swept) * two + cross(&axis, &acceleration),
                cross(&axis, &turning) + cross(spin, &turned),
            ],
            column_rate: [
                cross(&axis_rate, &self.arm(placed, k, body)) + cross(&axis, &(at.velocity_w - at_joint)),
                axis_rate,
            ],
        }
    }

    /// Adds how gravity and inertia go by the velocities and by the places of the coordinates, negated, while their accelerations are
    /// held.
    #[inline(never)] // For size.
    pub(super) fn add_own_jacobians(
        &self,
        placed: &Placed<S, N, W, D>,
        of_coordinates: &SVector<S, D>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let accelerations = self.accelerations(placed, of_coordinates);
        self.subtract_turned(placed, &self.own_wrench(placed, &accelerations), S::one(), stiffness);
        for k in 0..D {
            let (mut by_rate, mut by_place) = (SVector::<S, W>::zeros(), SVector::<S, W>::zeros());
            let bodies = self.free.bodies().iter().zip(&placed.free.bodies).zip(&accelerations);
            for (i, ((body, at), [_, turning])) in bodies.enumerate() {
                if !self.is_moved(k, i) {
                    continue;
                }
                let change = self.change(placed, [k, i], of_coordinates, &accelerations);
                let [_, axis] = placed.column(k, i);
                let (inertia, spin) = (at.in_frame(&body.inertia_b), &at.rotation_w);
                let momentum = of_three(&inertia, spin);
                let gyroscopic = |by: &Vector3<S>| cross(by, &momentum) + cross(spin, &of_three(&inertia, by));
                // What a turn of the body makes of its inertia times a vector.
                let turned =
                    |v: &Vector3<S>| cross(&axis, &of_three(&inertia, v)) - of_three(&inertia, &cross(&axis, v));
                let [centre_rate, turning_rate] = [0, 1].map(|part| change.velocity[part] + change.column_rate[part]);
                let by_turning = of_three(&inertia, &turning_rate) + gyroscopic(&axis);
                add_pair(&mut by_rate.data.0[0], i, [&(centre_rate * body.mass), &by_turning]);
                let [centre, turning_change] = change.acceleration;
                let by_turn = of_three(&inertia, &turning_change)
                    + turned(turning)
                    + cross(spin, &turned(spin))
                    + gyroscopic(&change.velocity[1]);
                add_pair(&mut by_place.data.0[0], i, [&(centre * body.mass), &by_turn]);
            }
            add_column(damping, k, &self.reduced(placed, &by_rate));
            add_column(stiffness, k, &self.reduced(placed, &by_place));
        }
    }

    /// Subtracts what J makes of a `wrench` on the bodies as it turns with the coordinates, times `weight`: ∂(Jᵀ)/∂Q·F.
    #[inline(never)] // For size.
    fn subtract_turned(
        &self,
        placed: &Placed<S, N, W, D>,
        wrench: &SVector<S, W>,
        weight: S,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        for (j, (column, by)) in stiffness.data.0.iter_mut().zip(&self.coordinates).enumerate() {
            for (k, (entry, coordinate)) in column.iter_mut().zip(&self.coordinates).enumerate() {
                // Whether the coordinate j turns the axis of the coordinate k, or is behind it.
                let is_same = by.mount == coordinate.mount;
                let owner = self.mounts.get(coordinate.mount).copied().flatten().map_or(N, |hung| hung.body);
                let is_before = if is_same {
                    j <= k || (by.kind.turns() && coordinate.kind.turns())
                } else {
                    self.is_moved(j, owner)
                };
                for body in 0..N {
                    if self.is_moved(j, body) && self.is_moved(k, body) {
                        let ([moved, axis], [by_moved, by_axis]) = (placed.column(k, body), placed.column(j, body));
                        let [force, torque] = pair(&wrench.data.0[0], body);
                        let turned = if is_before {
                            dot(&cross(&by_axis, &moved), &force) + dot(&cross(&by_axis, &axis), &torque)
                        } else {
                            dot(&cross(&axis, &by_moved), &force)
                        };
                        *entry += -(turned * weight);
                    }
                }
            }
        }
    }

    /// Adds Jᵀ·`matrix`·J, where the matrix tells how a `wrench` on the free bodies goes, negated, by velocities that also move them
    /// over the time `a` (s). How velocities change with J meanwhile is left out: it steers, the force decides.
    #[inline(never)] // For size.
    pub(super) fn add_impedance(
        &self,
        placed: &Placed<S, N, W, D>,
        (wrench, matrix): (&SVector<S, W>, &SMatrix<S, W, W>),
        a: S,
        sum: &mut SMatrix<S, D, D>,
    ) {
        for k in 0..D {
            let mut by_rate = self.by_column(placed, matrix, k);
            self.add_seen(placed, k, &(wrench * a), &mut by_rate);
            add_column(sum, k, &self.reduced(placed, &by_rate));
        }
        self.subtract_turned(placed, wrench, a, sum);
    }

    /// Adds to `damping` and `stiffness` how a `wrench` on the free bodies goes by the coordinates, where `by_rate` and `by_place`
    /// tell how it goes by the velocities and places of the bodies, all negated.
    #[inline(never)] // For size.
    pub(super) fn add_derivatives(
        &self,
        placed: &Placed<S, N, W, D>,
        wrench: &SVector<S, W>,
        [by_rate, by_place]: [&SMatrix<S, W, W>; 2],
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let none = (SVector::zeros(), [[Vector3::zeros(); 2]; N]);
        for k in 0..D {
            add_column(damping, k, &self.reduced(placed, &self.by_column(placed, by_rate, k)));
            // Places of free bodies hold velocities in the frame, and angular ones in the body.
            let mut change = SVector::<S, W>::zeros();
            for (i, at) in placed.free.bodies.iter().enumerate() {
                if self.is_moved(k, i) {
                    let [_, axis] = placed.column(k, i);
                    let [centre, turning] = self.change(placed, [k, i], &none.0, &none.1).velocity;
                    add_pair(&mut change.data.0[0], i, [&centre, &(turning - cross(&axis, &at.rotation_w))]);
                }
            }
            let mut sum = self.by_column(placed, by_place, k) + times(by_rate, &change);
            self.add_seen(placed, k, wrench, &mut sum);
            add_column(stiffness, k, &self.reduced(placed, &sum));
        }
        self.subtract_turned(placed, wrench, S::one(), stiffness);
    }

    /// Adds what the torques of a `wrench` change by as the coordinate `k` turns their bodies, negated. Derivatives of free bodies are
    /// of torques as the bodies see them.
    #[inline(always)]
    fn add_seen(&self, placed: &Placed<S, N, W, D>, k: usize, wrench: &SVector<S, W>, sum: &mut SVector<S, W>) {
        for body in (0..N).filter(|body| self.is_moved(k, *body)) {
            let ([_, axis], [_, torque]) = (placed.column(k, body), pair(&wrench.data.0[0], body));
            add_pair(&mut sum.data.0[0], body, [&Vector3::zeros(), &cross(&torque, &axis)]);
        }
    }
}

/// Adds `values` to a column of `matrix`.
#[inline(always)]
fn add_column<S: Scalar, const D: usize>(matrix: &mut SMatrix<S, D, D>, k: usize, values: &SVector<S, D>) {
    for (entry, value) in matrix.data.0.get_mut(k).into_iter().flatten().zip(&values.data.0[0]) {
        *entry += *value;
    }
}
