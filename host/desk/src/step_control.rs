//! Step-size control.

use slipfit_core::ParameterError;

use crate::closing::Between;

/// Greatest step (s).
pub const GREATEST_STEP: f64 = 0.02;

/// How much shorter than the estimate allows a step is.
pub const SAFETY: f64 = 0.8;

/// How much the next step may be shorter and longer. Contacts close and open too suddenly for steps that grow faster.
pub const CHANGES: [f64; 2] = [0.2, 3.0];

/// First step (s).
pub const FIRST_STEP: f64 = 2e-5;

/// Least step (s).
const LEAST_STEP: f64 = 1e-12;

/// More steps than any scene takes that can be solved; beyond, the step has stalled.
const STEPS_MOST: u32 = 2_000_000;

/// What an integration took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Effort {
    /// Accepted steps.
    pub accepted: u32,
    /// Refused steps.
    pub refused: u32,
}

/// Why an integration did not come to its end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Stopped {
    /// A parameter that core refuses: which, its value, and what is allowed.
    #[error("{0}")]
    Parameter(String),
    /// No step from this time (s) on meets the tolerance, however short.
    #[error("from t = {0} s on no step meets the tolerance, however short")]
    Unsolved(f64),
    /// The motion left the finite range.
    #[error("the motion left the finite range at t = {time} s: take a smaller step than {step} s")]
    NotFinite {
        /// When (s).
        time: f64,
        /// Step (s).
        step: f64,
    },
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl<S: std::fmt::Display> From<ParameterError<S>> for Stopped {
    fn from(error: ParameterError<S>) -> Self {
        Self::Parameter(error.to_string())
    }
}

/// Time and step length of an error-controlled integration.
#[derive(Clone, Copy, Debug)]
pub struct StepControl {
    /// Time (s).
    pub t: f64,
    /// Length (s) that its errors allow.
    h: f64,
    /// Steps so far.
    pub effort: Effort,
}

impl Default for StepControl {
    fn default() -> Self {
        Self { t: 0.0, h: FIRST_STEP, effort: Effort::default() }
    }
}

impl StepControl {
    /// Steps so far, refused ones among them.
    pub fn tried(&self) -> u32 {
        self.effort.accepted + self.effort.refused
    }

    /// The length (s) of the next step of a run of this `duration` (s) with these ascending `bends` (s), and when (s) it ends at the latest.
    pub fn next(&self, duration: f64, bends: &[f64]) -> (f64, f64) {
        let Self { t, h, .. } = *self;
        let next = bends[bends.partition_point(|bend| *bend <= t)..].first();
        let limit = next.map_or(duration, |bend| bend.min(duration));
        // A last step that would leave a splinter takes it along.
        (if t + 1.01 * h >= limit { limit - t } else { h }, limit)
    }

    /// Whether a step of this `length` (s) is good enough, of a scheme of this `order` that finds this `error`, of which 1 is allowed.
    ///
    /// # Errors
    /// [`Stopped::Unsolved`] if no shorter one would be.
    pub fn accepts_error(&mut self, error: f64, length: f64, order: u32) -> Result<bool, Stopped> {
        let error = Some(error).filter(|error| error.is_finite()).unwrap_or(1e12);
        let factor = (SAFETY / root(error.max(1e-12), order)).clamp(CHANGES[0], CHANGES[1]);
        self.h = (length * factor).clamp(LEAST_STEP, GREATEST_STEP);
        if self.tried() >= STEPS_MOST || (error > 1.0 && length <= LEAST_STEP) {
            return Err(Stopped::Unsolved(self.t));
        }
        if error > 1.0 {
            self.effort.refused += 1;
        }
        Ok(error <= 1.0)
    }

    /// Whether a good step of this `length` (s) has to be shorter because of what happens in it.
    pub fn shortens(&mut self, between: Between, length: f64) -> bool {
        let Between::Closes(share) = between else { return false };
        if length <= LEAST_STEP {
            return false;
        }
        self.h = (length * share).max(LEAST_STEP);
        self.effort.refused += 1;
        true
    }

    /// Takes a step of this `length` (s), at the latest to the time `limit` (s); the next is not longer than `most` (s).
    pub fn accept(&mut self, length: f64, limit: f64, most: f64) {
        self.h = self.h.min(most).max(LEAST_STEP);
        self.effort.accepted += 1;
        self.t = if length == limit - self.t { limit } else { self.t + length };
    }
}

/// The root of `x` of this order.
fn root(x: f64, order: u32) -> f64 {
    match order {
        1 => x,
        2 => libm::sqrt(x),
        3 => libm::cbrt(x),
        4 => libm::sqrt(libm::sqrt(x)),
        other => libm::pow(x, 1.0 / f64::from(other)),
    }
}
