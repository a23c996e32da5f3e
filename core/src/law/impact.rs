//! IMPACT: a progressive spring with a damper that fades in with depth (eq. 10, corrected).
//!
//! Deviation from the paper: eq. 10 as printed takes a negative base to a fractional power, loses its damper beyond
//! the depth `d`, lets the sum pull, and signs the damper so that it feeds energy. The law here is the one of the
//! solver the authors ran, F = max(0, k·δ^e + c·S(δ/d)·δ̇) for δ > 0 with S clamped: full damping beyond `d`, no pull.

use super::{Elastic, Normal, NormalResponse, step::risen};
use crate::{ParameterError, Scalar, error::bounded};

/// A one-sided contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact<S, E> {
    elastic: E,
    damping: S,
    /// 1/m: the inverse of the depth of full damping.
    per_depth: S,
    /// Six times the damping over that depth (N·s/m²): with S' = 6s(1 − s) how fast the damper fades in.
    fade_in: S,
}

crate::cast::cast!([E] [] Impact: Impact<f64, E> => T Impact<T, E::Of<T>> { elastic, damping, per_depth, fade_in });

impl<S: Scalar + PartialOrd, E: Elastic<S>> Impact<S, E> {
    /// A contact with the spring `elastic` and a damper that reaches `damping` c (N·s/m) at the `depth` d (m).
    ///
    /// # Errors
    /// If c is negative or d not positive, or either out of bounds or not finite.
    pub fn new(elastic: E, damping: S, depth: S) -> Result<Self, ParameterError<S>> {
        let damping = bounded("contact.damping", damping, [0.0, 1e12])?;
        let depth = bounded("contact.depth", depth, [1e-9, 1e3])?;
        let per_depth = S::one() / depth;
        Ok(Self { elastic, damping, per_depth, fade_in: S::from_f64(6.0) * damping * per_depth })
    }
}

impl<S: Scalar, E: Elastic<S>> Impact<S, E> {
    /// The response at `penetration` δ (m, positive inside) and `rate` δ̇ (m/s, positive while approaching).
    #[inline(always)]
    pub fn response(&self, penetration: S, rate: S) -> NormalResponse<S> {
        let zero = S::zero();
        // At depth 0 spring, damper and their slopes all vanish, so that no second test is needed outside contact.
        let depth = penetration.at_least(zero);
        let (spring, spring_slope) = self.elastic.force(depth);
        let (fade, rest) = risen(depth * self.per_depth);
        let damper = self.damping * fade;
        let force = spring + damper * rate;
        let stiffness = spring_slope + rest * (self.fade_in * rate);
        NormalResponse::new(force, stiffness, damper)
    }

    /// Power (W, ≥ 0) lost at `penetration` δ (m) and `rate` δ̇ (m/s): (F − k·δ^e)·δ̇. Where surfaces part faster than the
    /// spring can follow, F is clipped at zero, and what the spring gives up is lost.
    pub fn loss(&self, penetration: S, rate: S) -> S {
        let (spring, _) = self.elastic.force(penetration.max_of(S::zero()));
        (self.response(penetration, rate).force - spring) * rate
    }
}

impl<S: Scalar, E: Elastic<S>> Normal<S> for Impact<S, E> {
    #[inline(always)]
    fn response(&self, penetration: S, rate: S) -> NormalResponse<S> {
        self.response(penetration, rate)
    }

    fn energy(&self, penetration: S) -> S {
        self.elastic.energy(penetration.max_of(S::zero()))
    }
}
