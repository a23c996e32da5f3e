//! One stroke of a unit: what became of it, and its force and speed over time.

use crate::dynamics::{
    outcome::{Outcome, Verdict},
    trajectory::Trajectory,
};

/// Error of the drive's force that a step of a slide may make, as a share of its greatest force, unless the scene allows more.
pub const ERROR: f64 = 1e-5;

/// One stroke of a unit.
#[derive(Clone, Debug)]
pub struct Stroke {
    /// What became of it.
    pub outcome: Outcome,
    /// Its samples.
    pub trajectory: Trajectory,
}

impl Stroke {
    /// Whether it is one of a unit that does its job: it runs, to the end of the stroke where one is stated.
    pub fn is_complete(&self) -> bool {
        self.outcome.verdict == Verdict::Runs && self.outcome.stroke_reached != Some(false)
    }
}
