//! Whether a unit malfunctions, how, and on which side of the production.

use serde::Serialize;

use super::{subject::Subject, unit::Unit};
use crate::dynamics::outcome::Verdict;

/// Whether a unit malfunctions: it crawls, jams, or needs more than the `limit` (N).
pub fn malfunctions(unit: &Unit, limit: Option<f64>) -> bool {
    unit.outcome.verdict.is_malfunction() || is_over(unit, limit)
}

/// Whether a unit needs more than the `limit` (N).
pub fn is_over(unit: &Unit, limit: Option<f64>) -> bool {
    unit.outcome.peak_force.zip(limit).is_some_and(|(force, limit)| force > limit)
}

/// How a unit malfunctions. No unit does so in two ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// It crawls.
    Crawls,
    /// It jams.
    Jams,
    /// It overruns its command.
    Overruns,
    /// It does its job, but with more than the motor's force.
    OverLimit,
}

impl Kind {
    /// Of a `unit`, with a motor's force `limit` (N); none if it does not malfunction.
    pub fn of(unit: &Unit, limit: Option<f64>) -> Option<Self> {
        match unit.outcome.verdict {
            Verdict::Crawls => Some(Self::Crawls),
            Verdict::Jammed => Some(Self::Jams),
            Verdict::Overruns => Some(Self::Overruns),
            Verdict::Runs | Verdict::Undecided => is_over(unit, limit).then_some(Self::OverLimit),
        }
    }
}

/// Half of a production.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Units that are tighter than the mean one.
    Tight,
    /// The others.
    Loose,
    /// All, where no gap varies.
    Any,
}

impl Side {
    /// Those that a production of `subject` has.
    pub fn all(subject: &dyn Subject) -> &'static [Self] {
        if subject.has_levels() { &[Self::Tight, Self::Loose] } else { &[Self::Any] }
    }

    /// Whether a unit with these `gaps` (m) is on it.
    pub fn has(self, subject: &dyn Subject, gaps: &[f64]) -> bool {
        match self {
            Self::Tight => subject.tightness(gaps) > 0.0,
            Self::Loose => subject.tightness(gaps) <= 0.0,
            Self::Any => true,
        }
    }
}
