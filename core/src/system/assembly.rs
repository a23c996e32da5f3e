//! What elements add up to: forces alone, with the balance of a stage, or with all derivatives.

use super::{Bodies, Law, Link, Response};
use crate::{SVector, Scalar};

/// Takes what elements of bodies `B` do.
pub trait Assembly<S: Scalar, B: Bodies<S, D>, const D: usize> {
    /// Whether it takes derivatives, not the force alone.
    const DIFFERENTIATES: bool = true;

    /// Adds the `response` of a law at `link`.
    fn add<L: Link<S, B, D, R>, W: Law<S, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        response: &Response<S, R>,
    );
}

/// The generalised force (N, N·m).
pub(crate) struct Sum<S, const D: usize>(pub SVector<S, D>);

/// The force, and how M·V/a − force goes by velocities that also move the bodies over the time a.
pub(super) struct StageSum<S, J, const D: usize> {
    pub force: SVector<S, D>,
    pub matrix: J,
    pub a: S,
}

/// The force and its derivatives by time, velocity and place, the last two negated.
#[derive(Clone, Copy)]
pub(crate) struct Derivatives<S, J, const D: usize> {
    pub force: SVector<S, D>,
    pub per_time: SVector<S, D>,
    pub damping: J,
    pub stiffness: J,
}

impl<S: Scalar, B: Bodies<S, D>, const D: usize> Assembly<S, B, D> for Sum<S, D> {
    const DIFFERENTIATES: bool = false;

    #[inline(always)]
    fn add<L: Link<S, B, D, R>, W: Law<S, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        response: &Response<S, R>,
    ) {
        link.add_force(at, view, &response.force, &mut self.0);
    }
}

impl<S: Scalar, B: Bodies<S, D>, const D: usize> Assembly<S, B, D> for StageSum<S, B::Jacobian, D> {
    #[inline(always)]
    fn add<L: Link<S, B, D, R>, W: Law<S, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        response: &Response<S, R>,
    ) {
        link.add_force(at, view, &response.force, &mut self.force);
        link.add_impedance::<W>(at, view, response, self.a, &mut self.matrix);
    }
}

impl<S: Scalar, B: Bodies<S, D>, const D: usize> Assembly<S, B, D> for Derivatives<S, B::Jacobian, D> {
    #[inline(always)]
    fn add<L: Link<S, B, D, R>, W: Law<S, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        response: &Response<S, R>,
    ) {
        link.add_force(at, view, &response.force, &mut self.force);
        if W::TIMED {
            link.add_force(at, view, &response.per_time, &mut self.per_time);
        }
        link.add_derivatives::<W>(at, view, response, &mut self.damping, &mut self.stiffness);
    }
}
