//! The response of a law along a contact's normal: a force and how it changes.

use crate::Scalar;

/// A normal force and how it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalResponse<S> {
    /// Force (N), ≥ 0: surfaces push, they never pull.
    pub force: S,
    /// The force (N) of a law that could pull.
    either_way: S,
    /// ∂F/∂δ (N/m) where they push.
    pushing_stiffness: S,
    /// ∂F/∂δ̇ (N·s/m) where they push.
    pushing_damping: S,
}

impl<S: Scalar> NormalResponse<S> {
    /// The response whose force is `force` (N) where that is positive, with its derivatives by penetration (N/m) and rate (N·s/m)
    /// there; zero elsewhere.
    #[inline(always)]
    pub fn new(force: S, stiffness: S, damping: S) -> Self {
        Self {
            force: force.at_least(S::zero()),
            either_way: force,
            pushing_stiffness: stiffness,
            pushing_damping: damping,
        }
    }

    /// ∂F/∂δ (N/m).
    #[inline(always)]
    pub fn stiffness(&self) -> S {
        self.if_pushing(self.pushing_stiffness)
    }

    /// ∂F/∂δ̇ (N·s/m), at a rate that also changes the penetration `over` a time (s) if one is given.
    #[inline(always)]
    pub fn impedance(&self, over: Option<S>) -> S {
        self.if_pushing(match over {
            Some(a) => self.pushing_damping + a * self.pushing_stiffness,
            None => self.pushing_damping,
        })
    }

    #[inline(always)]
    fn if_pushing(&self, slope: S) -> S {
        S::zero().select_gt(self.either_way, S::zero(), slope)
    }
}
