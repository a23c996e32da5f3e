//! The same product at many tolerance levels.

use slipfit_system::parallel;

use super::{
    driven::{DriveKind, Driven},
    run::SimulateError,
    trajectory::Trajectory,
};

pub use super::level::{Level, classes};

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
    let levels = parallel::try_map(levels, |n| {
        let mut level = unit(*n)?;
        if keep == Keep::Figures {
            level.trajectory = Trajectory::default();
        }
        done();
        Ok::<_, SimulateError>(level)
    })?;
    Ok(Sweep { kind: driven.kind(), gaps: driven.gap_names(), levels })
}
