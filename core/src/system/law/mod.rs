//! Force laws of elements, one a file.

mod drive;
mod journal;
mod pin;
mod ring;
mod slot;
mod spring;
mod stopped;
mod wall;

pub use drive::{DriveLaw, Motor, Pusher};
pub use journal::Journal;
pub use pin::{Fitted, Pin};
pub use ring::Ring;
pub use slot::Slot;
pub use spring::Spring;
pub use stopped::Stopped;
pub use wall::{Axis, Pad, Wall};

use super::{Law, Response};
use crate::{
    SMatrix, SVector, Scalar,
    law::{Friction, Normal, NormalResponse, friction::Traction},
    mechanism::Way,
};

/// The laws of a contact: along its normal and along its tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<N, F> {
    /// Along the normal.
    pub normal: N,
    /// Along the tangents.
    pub friction: F,
}

/// A contact at one motion and its derivatives by `K` numbers.
struct Touch<S, M, const K: usize> {
    force: S,
    force_slope: SVector<S, K>,
    /// Friction on the body that slides, along two tangents.
    traction: [S; 2],
    traction_slopes: [SVector<S, K>; 2],
    internal: M,
}

/// A contact in the plane at one motion, with one tangent.
struct Rub<S, M> {
    /// Normal force (N), and its derivatives by penetration (N/m) and rate (N·s/m).
    force: S,
    stiffness: S,
    damping: S,
    /// Friction (N) on the body that slides.
    traction: S,
    /// −∂traction/∂force and −∂traction/∂sliding (N·s/m).
    per_force: S,
    per_sliding: S,
    internal: M,
}

impl<N, F> Contact<N, F> {
    /// The normal force at `penetration` and its `rate`, and friction at the `sliding` velocities along two tangents.
    #[inline(always)]
    fn meet<S: Scalar>(
        &self,
        internal: &F::Internal,
        way: Way<S>,
        [penetration, rate]: [S; 2],
        sliding: [S; 2],
    ) -> (NormalResponse<S>, Traction<S>, F::Internal)
    where
        N: Normal<S>,
        F: Friction<S>,
    {
        let pressed = self.normal.response(penetration, rate);
        let (mut traction, internal) = self.friction.traction(internal, &way.sliding(sliding, pressed.force));
        // A law that sticks also does so without load, which counts for nothing.
        let zero = S::zero();
        let [own, mixed, other] = traction.impedance;
        traction.impedance = [
            pressed.force.select_gt(zero, own, zero),
            pressed.force.select_gt(zero, mixed, zero),
            pressed.force.select_gt(zero, other, zero),
        ];
        (pressed, traction, internal)
    }

    /// The forces at `penetration` and its `rate` and at the `sliding` velocity along the one tangent that there is in a plane.
    #[inline(always)]
    fn rub<S: Scalar>(
        &self,
        internal: &F::Internal,
        way: Way<S>,
        [penetration, rate]: [S; 2],
        sliding: S,
    ) -> Rub<S, F::Internal>
    where
        N: Normal<S>,
        F: Friction<S>,
    {
        let (pressed, traction, internal) = self.meet(internal, way, [penetration, rate], [sliding, S::zero()]);
        Rub {
            force: pressed.force,
            stiffness: pressed.stiffness(),
            damping: pressed.impedance(None),
            traction: traction.force[0],
            per_force: traction.per_normal[0],
            per_sliding: traction.impedance[0],
            internal,
        }
    }

    /// The forces at `penetration` and its `rate` and at the `sliding` velocities, whose derivatives by `K` numbers are given.
    #[inline(always)]
    fn touch<S: Scalar, const K: usize>(
        &self,
        internal: &F::Internal,
        way: Way<S>,
        [penetration, rate]: [(S, SVector<S, K>); 2],
        [first, second]: [(S, SVector<S, K>); 2],
    ) -> Touch<S, F::Internal, K>
    where
        N: Normal<S>,
        F: Friction<S>,
    {
        let (pressed, traction, internal) = self.meet(internal, way, [penetration.0, rate.0], [first.0, second.0]);
        let force_slope = penetration.1 * pressed.stiffness() + rate.1 * pressed.impedance(None);
        let [own, mixed, other] = traction.impedance;
        let [by_first, by_second] = traction.per_normal;
        let traction_slopes = [
            -(force_slope * by_first + first.1 * own + second.1 * mixed),
            -(force_slope * by_second + first.1 * mixed + second.1 * other),
        ];
        Touch { force: pressed.force, force_slope, traction: traction.force, traction_slopes, internal }
    }
}

/// The unit vector along `k` of `K` numbers, `value` long.
#[inline(always)]
fn along<S: Scalar, const K: usize>(k: usize, value: S) -> SVector<S, K> {
    let mut vector = SVector::zeros();
    vector[k] = value;
    vector
}

/// A response without change with time.
#[inline(always)]
fn steady<S: Scalar, const R: usize>(
    force: SVector<S, R>,
    impedance: SMatrix<S, R, R>,
    stiffness: SMatrix<S, R, R>,
) -> Response<S, R> {
    Response { force, impedance, stiffness, per_time: SVector::zeros() }
}
