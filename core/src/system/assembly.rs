//! What elements add up to: forces alone, with the balance of a stage, or with all derivatives.

use super::{Bodies, Link, Response, Seen};
use crate::{SMatrix, SVector, Scalar};

/// Takes what elements do.
pub trait Assembly<S: Scalar, const D: usize> {
    /// Adds the `response` of a law at `link`.
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        seen: &Seen<S, R, D>,
        response: &Response<S, R>,
    );
}

/// The generalised force (N, N·m).
pub(super) struct Sum<S, const D: usize>(pub SVector<S, D>);

/// The force, and how M·V/a − force goes by velocities that also move the bodies over the time a.
pub(super) struct Balance<S, const D: usize> {
    pub force: SVector<S, D>,
    pub matrix: SMatrix<S, D, D>,
    pub a: S,
}

/// The force and its derivatives by time, velocity and place, the last two negated.
pub(super) struct Derivatives<S, const D: usize> {
    pub force: SVector<S, D>,
    pub per_time: SVector<S, D>,
    pub damping: SMatrix<S, D, D>,
    pub stiffness: SMatrix<S, D, D>,
}

impl<S: Scalar, const D: usize> Assembly<S, D> for Sum<S, D> {
    #[inline(always)]
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize>(
        &mut self,
        _: &L,
        _: (&B, &B::Placed),
        seen: &Seen<S, R, D>,
        response: &Response<S, R>,
    ) {
        self.0 += seen.gradient.tr_mul(&response.force);
    }
}

impl<S: Scalar, const D: usize> Assembly<S, D> for Balance<S, D> {
    #[inline(always)]
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize>(
        &mut self,
        link: &L,
        (bodies, placed): (&B, &B::Placed),
        seen: &Seen<S, R, D>,
        response: &Response<S, R>,
    ) {
        self.force += seen.gradient.tr_mul(&response.force);
        let along = (response.impedance + response.stiffness * self.a) * seen.gradient;
        let swept = response.impedance * link.swept(bodies, placed) * self.a;
        self.matrix += seen.gradient.tr_mul(&(along + swept));
        link.add_carried((bodies, placed), seen, &(response.force * self.a), &mut self.matrix);
    }
}

impl<S: Scalar, const D: usize> Assembly<S, D> for Derivatives<S, D> {
    #[inline(always)]
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize>(
        &mut self,
        link: &L,
        (bodies, placed): (&B, &B::Placed),
        seen: &Seen<S, R, D>,
        response: &Response<S, R>,
    ) {
        self.force += seen.gradient.tr_mul(&response.force);
        self.per_time += seen.gradient.tr_mul(&response.per_time);
        self.damping += seen.gradient.tr_mul(&(response.impedance * seen.gradient));
        let changed = response.stiffness * seen.gradient + response.impedance * link.swept(bodies, placed);
        self.stiffness += seen.gradient.tr_mul(&changed);
        link.add_carried((bodies, placed), seen, &response.force, &mut self.stiffness);
    }
}
