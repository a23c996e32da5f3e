//! What a force law of an element is; the laws, one a file.

mod contour;
mod drive;
mod journal;
mod line_spring;
mod pin;
mod ring;
mod slot;
mod spring;
mod stopped;
mod wall;

pub use contour::{Contour, Contoured};
pub use drive::{DriveLaw, Motor, Pusher};
pub use journal::Journal;
pub use line_spring::LineSpring;
pub use pin::{Fitted, Pin};
pub use ring::Ring;
pub use slot::Slot;
pub use spring::Spring;
pub use stopped::Stopped;
pub use wall::{Axis, Pad, Wall};

use crate::{
    SMatrix, SVector, Scalar,
    law::{Friction, Normal, NormalResponse, friction::Traction},
    mechanism::Way,
};

/// What a law answers: forces along what it sees and how they change.
#[derive(Clone, Copy, Debug)]
pub struct Response<S, const R: usize> {
    /// φ (N, N·m): its power is φ·ẋ.
    pub force: SVector<S, R>,
    /// −∂φ/∂ẋ of rates that also move the places over the time [`Way::over`], if one is given; rows are forces.
    pub impedance: SMatrix<S, R, R>,
    /// −∂φ/∂x; rows are forces.
    pub stiffness: SMatrix<S, R, R>,
    /// ∂φ/∂t.
    pub per_time: SVector<S, R>,
}

impl<S: Scalar, const R: usize> Response<S, R> {
    /// The same for rates that also move the first `places` numbers `over` a time (s), if one is given: for laws that find damping
    /// and stiffness apart.
    #[inline(always)]
    #[must_use]
    pub fn moving(mut self, over: Option<S>, places: usize) -> Self {
        if let Some(a) = over {
            for (column, by_place) in self.impedance.data.0.iter_mut().zip(&self.stiffness.data.0).take(places) {
                for (entry, by_place) in column.iter_mut().zip(by_place) {
                    *entry += *by_place * a;
                }
            }
        }
        self
    }
}

/// A force law of `R` lengths and angles.
pub trait Law<S: Scalar, const R: usize> {
    /// Its internal variables, kept from one step to the next; `()` where it has none.
    type Internal: Copy + core::fmt::Debug + PartialEq;

    /// Whether it can hold bodies at rest.
    const STICKS: bool;

    /// How many of the numbers, the first ones, it answers to by their place, not by their rate alone: the other columns of its
    /// stiffness are zero and not looked at.
    const PLACES: usize;

    /// Which force answers to which rate: `ANSWERS[i][j]` where entry (i, j) of the impedance is not zero. The others are not
    /// looked at.
    const ANSWERS: [[bool; R]; R] = [[true; R]; R];

    /// Whether it changes with time where nothing moves; where not, [`Response::per_time`] is zero and not looked at.
    const TIMED: bool = false;

    /// The internal variables of a law that nothing has happened to yet.
    fn fresh(&self) -> Self::Internal;

    /// The least distance (m) at `place` of what may touch, negative where it penetrates. Where it is positive the law exerts nothing,
    /// at any rate. Zero of a law whose bodies always act on each other.
    #[inline(always)]
    fn gap(&self, _place: &SVector<S, R>) -> S {
        S::zero()
    }

    /// Shows `see` the distance (m) of each pair of surfaces that may touch, of which [`gap`](Self::gap) is the least, and how fast
    /// (m/s) it grows. Nothing of a law whose bodies always act on each other; a law that has a gap has to show it here as well, or steps
    /// under error control may pass it over.
    #[inline(always)]
    fn each_gap(&self, _place: &SVector<S, R>, _rate: &SVector<S, R>, _see: impl FnMut(S, S)) {}

    /// The forces at `place` and `rate` at time `t` (s), and the internal variables if the motion is accepted.
    fn response(
        &self,
        t: S,
        place: &SVector<S, R>,
        rate: &SVector<S, R>,
        internal: &Self::Internal,
        way: Way<S>,
    ) -> (Response<S, R>, Self::Internal);

    /// The internal variables after a step that led to `place`, of a scheme that takes no response there: for laws that remember places
    /// alone.
    #[inline(always)]
    fn remembered(_place: &SVector<S, R>, internal: &Self::Internal) -> Self::Internal {
        *internal
    }

    /// `base + weight·(to − from)`.
    fn shifted(base: &Self::Internal, from: &Self::Internal, to: &Self::Internal, weight: S) -> Self::Internal;

    /// `new` where it is finite and `condition` > 0, else `old`, number by number.
    fn or_old(new: &Self::Internal, condition: S, old: &Self::Internal) -> Self::Internal;
}

/// The laws of a contact: along its normal and along its tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<N, F> {
    /// Along the normal.
    pub normal: N,
    /// Along the tangents.
    pub friction: F,
}

crate::cast::cast!([N F] [] Contact: Contact<N, F> => T Contact<N::Of<T>, F::Of<T>> { normal, friction });

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
