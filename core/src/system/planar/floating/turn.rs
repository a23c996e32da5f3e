//! The turn of a floating body.

use crate::{
    SVector, Scalar, Vector2,
    system::{Axes, half_turn::less_and_sine},
};

/// Rᵀ − I by its diagonal and the sine: what carries a vector of the frame into the body, less the vector itself.
///
/// Kept as the difference, because near the nominal pose R would leave f32 few digits of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn<S> {
    less: S,
    sine: S,
}

impl<S: Scalar> Default for Turn<S> {
    #[inline(always)]
    fn default() -> Self {
        Self { less: S::zero(), sine: S::zero() }
    }
}

impl<S: Scalar> Turn<S> {
    /// The turn by twice the angle whose cosine and sine, to some scale, are given.
    #[inline(always)]
    pub(super) fn of(half: [S; 2]) -> Self {
        let [less, sine] = less_and_sine(half);
        Self { less, sine }
    }

    /// What `p` changes by on the way into the body.
    #[inline(always)]
    pub(super) fn change(&self, p: &Vector2<S>) -> Vector2<S> {
        Vector2::new(self.sine * p.y - self.less * p.x, -self.less * p.y - self.sine * p.x)
    }

    /// `p` in the body's axes.
    #[inline(always)]
    pub(super) fn to_body(self, p: &Vector2<S>) -> Vector2<S> {
        p + self.change(p)
    }
}

impl<S: Scalar> Axes<S, 3> for Turn<S> {
    #[inline(always)]
    fn to_sum(&self, v: &SVector<S, 3>) -> SVector<S, 3> {
        let turned = self.to_body(&Vector2::new(v.x, v.y));
        SVector::<S, 3>::new(turned.x, turned.y, v.z)
    }

    #[inline(always)]
    fn to_velocities(&self, v: &SVector<S, 3>) -> SVector<S, 3> {
        Self { sine: -self.sine, ..*self }.to_sum(v)
    }
}
