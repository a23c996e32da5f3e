//! Coulomb friction in the contact plane, as a menu of types so that a frictionless scene pays nothing.

mod exact;
mod regularised;
mod static_kinetic;
mod stribeck;

pub use exact::Exact;
pub use regularised::Regularised;
pub use static_kinetic::StaticKinetic;
pub use stribeck::{Stribeck, StribeckData};

use crate::Scalar;

/// What friction does to the body along the two tangents of a contact, and how that changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traction<S> {
    /// Force on the body (N).
    pub force: [S; 2],
    /// −∂force/∂sliding (N·s/m), near enough for Newton: a symmetric matrix as its first, mixed and second entry.
    pub impedance: [S; 3],
    /// −∂force/∂normal.
    pub per_normal: [S; 2],
}

/// What friction acts upon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingContact<S> {
    /// Velocity of the body along the two tangents (m/s).
    pub sliding: [S; 2],
    /// Normal force (N).
    pub normal: S,
    /// Mass of the body over the implicit part of the step (kg/s = N·s/m).
    pub mass_rate: S,
    /// How the impedance is to change along the sliding direction: 1 the tangent of the law, 0 its secant.
    pub tangent_share: S,
}

impl<S: Scalar> SlidingContact<S> {
    /// The traction of a coefficient μ(s) that depends on the sliding speed s alone, from μ(s)/s and d(μ(s)/s)/d(s²).
    #[inline(always)]
    fn along_the_motion(&self, (ratio, ratio_slope): (S, S)) -> Traction<S> {
        let Self { sliding: [x, y], normal, tangent_share, .. } = *self;
        let along = ratio * normal;
        let turn = (tangent_share + tangent_share) * ratio_slope * normal;
        let (turn_x, turn_y) = (turn * x, turn * y);
        Traction {
            force: [-along * x, -along * y],
            impedance: [along + turn_x * x, turn_x * y, along + turn_y * y],
            per_normal: [ratio * x, ratio * y],
        }
    }
}

/// A friction law.
pub trait Friction<S>: Copy {
    /// What the law remembers of a contact from one step to the next.
    type Internal: Copy + core::fmt::Debug + PartialEq;

    /// Whether there is any friction.
    const RUBS: bool = true;

    /// Whether the law can hold a body at rest.
    const STICKS: bool;

    /// The internal variables of a contact that nothing has touched yet.
    fn fresh() -> Self::Internal;

    /// The traction, and the internal variables if the motion is accepted.
    fn traction(&self, internal: &Self::Internal, contact: &SlidingContact<S>) -> (Traction<S>, Self::Internal);

    /// `base + weight·(to − from)`.
    fn shifted(base: &Self::Internal, from: &Self::Internal, to: &Self::Internal, weight: S) -> Self::Internal;

    /// `new` where it is finite and `condition` > 0, else `old`, number by number.
    fn or_old(new: &Self::Internal, condition: S, old: &Self::Internal) -> Self::Internal;
}

/// No friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frictionless;

impl<S: Scalar> Friction<S> for Frictionless {
    type Internal = ();

    const RUBS: bool = false;

    const STICKS: bool = false;

    #[inline(always)]
    fn fresh() {}

    #[inline(always)]
    fn traction(&self, (): &(), _: &SlidingContact<S>) -> (Traction<S>, ()) {
        let zero = S::zero();
        (Traction { force: [zero; 2], impedance: [zero; 3], per_normal: [zero; 2] }, ())
    }

    #[inline(always)]
    fn shifted((): &(), (): &(), (): &(), _: S) {}

    #[inline(always)]
    fn or_old((): &(), _: S, (): &()) {}
}
