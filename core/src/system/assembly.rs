//! What sets of elements are, and what they add up to: forces alone, with the balance of a stage, or with all derivatives.

use super::{Bodies, Jacobian, Law, Link, Reduced, Response};
use crate::{SVector, Scalar, mechanism::Way};

/// Elements that act on bodies `B`: one, an array, a slice, or a tuple of such.
pub trait Elements<S: Scalar, B: Bodies<S, D>, const D: usize> {
    /// The internal variables of their laws.
    type Internal: Copy;

    /// Whether one of them can hold bodies at rest.
    const STICKS: bool;

    /// The internal variables of laws that nothing has happened to yet.
    fn fresh(&self) -> Self::Internal;

    /// Adds the forces at time `t` (s) to `sum`, and writes the internal variables if the motion is accepted.
    fn act(
        &self,
        way: (S, Way<S>),
        at: (&B, &B::Placed),
        internal: &Self::Internal,
        updated: Option<&mut Self::Internal>,
        sum: &mut impl Assembly<S, B, D>,
    );

    /// The internal variables after a step that led to where the bodies are placed, see [`Law::remembered`].
    #[inline(always)]
    fn remembered(&self, _at: (&B, &B::Placed), internal: &Self::Internal) -> Self::Internal {
        *internal
    }

    /// `base + weight·(to − from)`.
    fn shifted(&self, base: &Self::Internal, from: &Self::Internal, to: &Self::Internal, weight: S) -> Self::Internal;

    /// Makes `kept` `next`, number by number where it is finite and `condition` > 0.
    fn accept(&self, condition: S, next: &Self::Internal, kept: &mut Self::Internal);
}

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

    /// Adds what `elements` of the bodies do, taken as free ones, whose joints reduce it.
    fn add_through_joints<E: Elements<S, B::Free, W>, const W: usize>(
        &mut self,
        elements: &E,
        way: (S, Way<S>),
        at: (&B, &B::Placed),
        internal: &E::Internal,
        updated: Option<&mut E::Internal>,
    ) where
        B: Reduced<S, D, W>;
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

    #[inline(always)]
    fn add_through_joints<E: Elements<S, B::Free, W>, const W: usize>(
        &mut self,
        elements: &E,
        way: (S, Way<S>),
        (bodies, placed): (&B, &B::Placed),
        internal: &E::Internal,
        updated: Option<&mut E::Internal>,
    ) where
        B: Reduced<S, D, W>,
    {
        let free = bodies.free(placed);
        let mut sum = Sum(SVector::<S, W>::zeros());
        elements.act(way, free, internal, updated, &mut sum);
        self.0 += bodies.reduced_force(placed, &sum.0);
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

    #[inline(always)]
    fn add_through_joints<E: Elements<S, B::Free, W>, const W: usize>(
        &mut self,
        elements: &E,
        way: (S, Way<S>),
        (bodies, placed): (&B, &B::Placed),
        internal: &E::Internal,
        updated: Option<&mut E::Internal>,
    ) where
        B: Reduced<S, D, W>,
    {
        let free = bodies.free(placed);
        let matrix = <B::Free as Bodies<S, W>>::Jacobian::zero();
        let mut sum = StageSum { force: SVector::<S, W>::zeros(), matrix, a: self.a };
        elements.act(way, free, internal, updated, &mut sum);
        self.force += bodies.reduced_force(placed, &sum.force);
        bodies.add_reduced_impedance(placed, (&sum.force, &sum.matrix), self.a, &mut self.matrix);
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

    #[inline(always)]
    fn add_through_joints<E: Elements<S, B::Free, W>, const W: usize>(
        &mut self,
        elements: &E,
        way: (S, Way<S>),
        (bodies, placed): (&B, &B::Placed),
        internal: &E::Internal,
        updated: Option<&mut E::Internal>,
    ) where
        B: Reduced<S, D, W>,
    {
        let free = bodies.free(placed);
        let zero = <B::Free as Bodies<S, W>>::Jacobian::zero();
        let (force, per_time) = (SVector::<S, W>::zeros(), SVector::zeros());
        let mut sum = Derivatives { force, per_time, damping: zero, stiffness: zero };
        elements.act(way, free, internal, updated, &mut sum);
        self.force += bodies.reduced_force(placed, &sum.force);
        self.per_time += bodies.reduced_force(placed, &sum.per_time);
        let of_free = [&sum.damping, &sum.stiffness];
        bodies.add_reduced_derivatives(placed, &sum.force, of_free, &mut self.damping, &mut self.stiffness);
    }
}
