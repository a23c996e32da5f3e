//! Drives: a P-velocity controller behind a ramp (eq. 12), as a force or as a torque.

use super::{Law, Response};
use crate::{
    SMatrix, SVector, Scalar,
    drive::{Push, Pushed},
    mechanism::Way,
};

/// A drive that pushes along the first number of its link and goes by the speed of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pusher<P>(pub P);

crate::cast::cast!([P] [] Pusher: Pusher<P> => T Pusher<P::Of<T>> { 0 });

/// A drive that turns: about the one number of its link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor<P>(pub P);

crate::cast::cast!([P] [] Motor: Motor<P> => T Motor<P::Of<T>> { 0 });

/// A law that is a drive's.
pub trait DriveLaw<S, const R: usize> {
    /// The speed (m/s, rad/s) that the drive goes by, of the rates of its link.
    fn speed(&self, rate: &SVector<S, R>) -> S;

    /// What it gives (N, N·m) at time `t` (s) and that `speed`.
    fn effort(&self, t: S, speed: S) -> S;
}

impl<S: Scalar, P: Push<S>> DriveLaw<S, 2> for Pusher<P> {
    #[inline(always)]
    fn speed(&self, rate: &SVector<S, 2>) -> S {
        rate[1]
    }

    #[inline(always)]
    fn effort(&self, t: S, speed: S) -> S {
        self.0.effort(t, speed)
    }
}

impl<S: Scalar, P: Push<S>> DriveLaw<S, 1> for Motor<P> {
    #[inline(always)]
    fn speed(&self, rate: &SVector<S, 1>) -> S {
        rate.x
    }

    #[inline(always)]
    fn effort(&self, t: S, speed: S) -> S {
        self.0.effort(t, speed)
    }
}

impl<S: Scalar, P: Push<S>> Law<S, 2> for Pusher<P> {
    type Internal = ();

    const STICKS: bool = false;

    const PLACES: usize = 0;

    const ANSWERS: [[bool; 2]; 2] = [[false, true], [false, false]];

    const TIMED: bool = true;

    #[inline(always)]
    fn fresh(&self) {}

    #[inline(always)]
    fn response(&self, t: S, _: &SVector<S, 2>, rate: &SVector<S, 2>, (): &(), _: Way<S>) -> (Response<S, 2>, ()) {
        let zero = S::zero();
        let Pushed { force, per_speed, per_time } = self.0.pushed(t, self.speed(rate));
        let response = Response {
            force: SVector::<S, 2>::new(force, zero),
            impedance: SMatrix::<S, 2, 2>::new(zero, per_speed, zero, zero),
            stiffness: SMatrix::zeros(),
            per_time: SVector::<S, 2>::new(per_time, zero),
        };
        (response, ())
    }

    #[inline(always)]
    fn shifted((): &(), (): &(), (): &(), _: S) {}

    #[inline(always)]
    fn or_old((): &(), _: S, (): &()) {}
}

impl<S: Scalar, P: Push<S>> Law<S, 1> for Motor<P> {
    type Internal = ();

    const STICKS: bool = false;

    const PLACES: usize = 0;

    const TIMED: bool = true;

    #[inline(always)]
    fn fresh(&self) {}

    #[inline(always)]
    fn response(&self, t: S, _: &SVector<S, 1>, rate: &SVector<S, 1>, (): &(), _: Way<S>) -> (Response<S, 1>, ()) {
        let Pushed { force, per_speed, per_time } = self.0.pushed(t, self.speed(rate));
        let response = Response {
            force: SVector::<S, 1>::new(force),
            impedance: SMatrix::<S, 1, 1>::new(per_speed),
            stiffness: SMatrix::zeros(),
            per_time: SVector::<S, 1>::new(per_time),
        };
        (response, ())
    }

    #[inline(always)]
    fn shifted((): &(), (): &(), (): &(), _: S) {}

    #[inline(always)]
    fn or_old((): &(), _: S, (): &()) {}
}
