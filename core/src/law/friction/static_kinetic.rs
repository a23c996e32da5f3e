//! Coulomb friction that holds more than it slides with: static above kinetic friction, a law of its own.

use super::{Exact, Friction, SlidingContact, Traction, exact::return_mapping};
use crate::{ParameterError, Scalar, error::bounded};

/// True stick up to the static coefficient, sliding with the kinetic one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticKinetic<S> {
    at_rest: S,
    sliding: S,
}

impl<S: Scalar + PartialOrd> StaticKinetic<S> {
    /// Friction that holds up to `at_rest` μ_s and slides with `sliding` μ_k ≤ μ_s.
    ///
    /// # Errors
    /// If μ_k is negative or above μ_s, or μ_s above 100 or not finite.
    pub fn new(at_rest: S, sliding: S) -> Result<Self, ParameterError<S>> {
        let at_rest = bounded("friction.static_coefficient", at_rest, [0.0, 100.0])?;
        Ok(Self { at_rest, sliding: bounded("friction.coefficient", sliding, [0.0, at_rest.to_f64()])? })
    }
}

impl<S: Scalar> Friction<S> for StaticKinetic<S> {
    /// The friction force on the body along the two tangents (N).
    type Internal = [S; 2];

    const STICKS: bool = true;

    #[inline(always)]
    fn fresh() -> [S; 2] {
        Exact::<S>::fresh()
    }

    #[inline(always)]
    fn traction(&self, internal: &[S; 2], contact: &SlidingContact<S>) -> (Traction<S>, [S; 2]) {
        return_mapping(internal, contact, [self.at_rest, self.sliding])
    }

    #[inline(always)]
    fn shifted(base: &[S; 2], from: &[S; 2], to: &[S; 2], weight: S) -> [S; 2] {
        Exact::<S>::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn or_old(new: &[S; 2], condition: S, old: &[S; 2]) -> [S; 2] {
        Exact::<S>::or_old(new, condition, old)
    }
}
