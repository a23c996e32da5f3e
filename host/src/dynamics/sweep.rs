//! The same product at many tolerance levels.

use rayon::prelude::*;
use slipfit_core::{clearance::GapClass, slide::ABSENT};

use super::{
    driven::{DriveKind, Driven},
    outcome::Outcome,
    simulate::{SimulateError, Solved},
    trajectory::Trajectory,
    trust::Trust,
};

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
    /// Class of each gap in the order of [`Sweep::gaps`]; `None` where there is no contact.
    pub classes: Vec<Option<GapClass>>,
}

impl Level {
    /// How many gaps are compressed, zero and free.
    pub fn class_counts(&self) -> [usize; 3] {
        [GapClass::Compressed, GapClass::Zero, GapClass::Free]
            .map(|class| self.classes.iter().flatten().filter(|&&found| found == class).count())
    }
}

/// A sweep over tolerance levels.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What the drive gives.
    pub kind: DriveKind,
    /// Names of the gaps.
    pub gaps: Vec<String>,
    /// Equidistant levels, ascending.
    pub levels: Vec<Level>,
}

/// The class of every gap (m); `None` where there is no contact.
pub fn classes(gaps: &[f64]) -> Vec<Option<GapClass>> {
    gaps.iter().map(|gap| (*gap < ABSENT / 2.0).then(|| GapClass::of(*gap))).collect()
}

/// What a sweep keeps of each run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// Figures and samples.
    Samples,
    /// Figures alone.
    Figures,
}

/// Runs the `unit` of every level of `levels`, on all threads of the current pool; `done` is called after each. The result
/// does not depend on the number of threads.
///
/// # Errors
/// The first level's [`SimulateError`], in the order of levels.
pub fn sweep(
    driven: &dyn Driven,
    levels: &[f64],
    keep: Keep,
    unit: impl Fn(f64) -> Result<Level, SimulateError> + Sync,
    done: impl Fn() + Sync,
) -> Result<Sweep, SimulateError> {
    let levels: Vec<Result<Level, SimulateError>> = levels
        .par_iter()
        .map(|&n| {
            let mut level = unit(n)?;
            if keep == Keep::Figures {
                level.trajectory = Trajectory::default();
            }
            done();
            Ok(level)
        })
        .collect();
    Ok(Sweep { kind: driven.kind(), gaps: driven.gap_names(), levels: levels.into_iter().collect::<Result<_, _>>()? })
}
