//! The same slide at many tolerance levels.

use slipfit_core::{clearance::GapClass, slide::CONTACTS};

use crate::outcome::{Outcome, Trajectory};

/// One level of a sweep.
#[derive(Clone, Debug)]
pub struct Level {
    /// Tolerance level, positive is tighter.
    pub n: f64,
    /// The run, every millisecond.
    pub trajectory: Trajectory,
    /// Its figures, the verdict confirmed at half the step.
    pub outcome: Outcome,
    /// Class of each gap in the order of Table 2; `None` where there is no contact.
    pub classes: [Option<GapClass>; CONTACTS],
}

/// A sweep over tolerance levels.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Equidistant levels, ascending.
    pub levels: Vec<Level>,
}
