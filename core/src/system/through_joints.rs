//! Elements of free bodies, where these are on joints.

use super::{Assembly, Elements, Reduced};
use crate::{Scalar, mechanism::Way};

/// Elements of free bodies with `W` velocities, as such of bodies on joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThroughJoints<E, const W: usize>(pub E);

impl<S, B, E, const W: usize, const D: usize> Elements<S, B, D> for ThroughJoints<E, W>
where
    S: Scalar,
    B: Reduced<S, D, W>,
    E: Elements<S, B::Free, W>,
{
    type Internal = E::Internal;

    const STICKS: bool = E::STICKS;

    #[inline(always)]
    fn fresh(&self) -> E::Internal {
        self.0.fresh()
    }

    #[inline(always)]
    fn act(
        &self,
        way: (S, Way<S>),
        at: (&B, &B::Placed),
        internal: &E::Internal,
        updated: Option<&mut E::Internal>,
        sum: &mut impl Assembly<S, B, D>,
    ) {
        sum.add_through_joints::<E, W>(&self.0, way, at, internal, updated);
    }

    #[inline(always)]
    fn remembered(&self, (bodies, placed): (&B, &B::Placed), internal: &E::Internal) -> E::Internal {
        self.0.remembered(bodies.free(placed), internal)
    }

    #[inline(always)]
    fn shifted(&self, base: &E::Internal, from: &E::Internal, to: &E::Internal, weight: S) -> E::Internal {
        self.0.shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &E::Internal, kept: &mut E::Internal) {
        self.0.accept(condition, next, kept);
    }
}
