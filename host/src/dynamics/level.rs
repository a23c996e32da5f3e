//! One level of a sweep.

use slipfit_core::{clearance::GapClass, slide::ABSENT};

use super::{outcome::Outcome, run::Solved, trajectory::Trajectory, trust::Trust};

/// One level of a sweep.
#[derive(Clone, Debug)]
pub struct Level {
    /// Tolerance level, positive is tighter.
    pub n: f64,
    /// The run, sampled.
    pub trajectory: Trajectory,
    /// Its figures, the verdict confirmed by a better run.
    pub outcome: Outcome,
    /// What computed it.
    pub solved: Solved,
    /// How far the run can be trusted.
    pub trust: Trust,
    /// What speaks against the run, if anything.
    pub doubts: Vec<String>,
    /// Class of each gap in the order of [`Sweep::gaps`](super::sweep::Sweep::gaps); `None` where there is no contact.
    pub classes: Vec<Option<GapClass>>,
}

impl Level {
    /// How many gaps are compressed, zero and free.
    pub fn class_counts(&self) -> [usize; 3] {
        [GapClass::Compressed, GapClass::Zero, GapClass::Free]
            .map(|class| self.classes.iter().flatten().filter(|&&found| found == class).count())
    }
}

/// The class of every gap (m); `None` where there is no contact.
pub fn classes(gaps: &[f64]) -> Vec<Option<GapClass>> {
    gaps.iter().map(|gap| (*gap < ABSENT / 2.0).then(|| GapClass::of(*gap))).collect()
}
