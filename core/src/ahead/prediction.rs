//! What a prediction ahead of the clock is held to, and what it says.

use crate::Scalar;

/// What prediction ahead of the clock is held to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<S> {
    /// Time from one call to the next (s).
    pub period: S,
    /// Error of the drive's force that a step may make (N).
    pub tolerance: S,
    /// The lead that is not exceeded (s).
    pub lead: S,
    /// The lag (s) at which steps are forced: of linearly implicit Euler, over a period, whatever their error. At a quarter, a
    /// half and three quarters of it the tolerance grows fourfold each time.
    pub lag: S,
    /// Attempts at a step in each period, [`MOST_ATTEMPTS`] at most: more for commands that reverse often.
    pub attempts: u32,
}

/// The most attempts at a step in a period.
pub const MOST_ATTEMPTS: u32 = 16;

/// What a prediction says after a period.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use = "its values may be older than the present instant"]
pub struct Prediction<S> {
    /// The time (s) that the values hold for: the clock's, or the last one known where the prediction is behind.
    pub time: S,
    /// Speed along the drive (m/s).
    pub speed: S,
    /// How far the mechanism is along the drive (m).
    pub position: S,
    /// Force of the drive (N).
    pub force: S,
    /// Of a followed command: the commanded speed (m/s) minus the extrapolated one by which this instant was predicted. 0 for planned
    /// commands, where the prediction is behind, and where the instant had not been predicted before. The real speed differs by about as
    /// much.
    pub deviation: S,
    /// How far beyond the clock the motion is known (s); negative where the prediction is behind.
    pub lead: S,
    /// The tolerance (N) that the period's attempt was held to; infinite for a forced step.
    pub tolerance: S,
    /// Sum of the estimated errors (N) of all steps since the start, as far as they exceed the tolerance of [`Limits`]; without forced
    /// steps.
    pub excess: S,
    /// Forced steps since the start: their error is not known.
    pub forced: u32,
}

/// Whether a prediction is of use.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Status<S> {
    /// The value is that of the present instant; the motion is known for so long (s) beyond.
    Ahead(S),
    /// The value is so much (s) older than the present instant.
    Behind(S),
}

impl<S: Scalar> Prediction<S> {
    /// Ahead of the clock, or behind it.
    pub fn status(&self) -> Status<S>
    where
        S: PartialOrd,
    {
        if self.lead >= S::zero() { Status::Ahead(self.lead) } else { Status::Behind(-self.lead) }
    }
}
