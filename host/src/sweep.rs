//! The same slide at many tolerance levels.

use rayon::prelude::*;
use slipfit_core::{
    clearance::GapClass,
    slide::{ABSENT, CONTACTS},
};

use crate::{
    confirm::confirmed,
    outcome::{Outcome, Trajectory},
    scene::Scene,
    simulate::{Run, Settings, SimulateError, Solved, simulate},
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
    /// Class of each gap in the order of Table 2; `None` where there is no contact.
    pub classes: [Option<GapClass>; CONTACTS],
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
    /// Equidistant levels, ascending.
    pub levels: Vec<Level>,
}

/// The class of every gap (m); `None` where there is no contact.
pub fn classes(gaps: &[f64; CONTACTS]) -> [Option<GapClass>; CONTACTS] {
    gaps.map(|gap| (gap < ABSENT / 2.0).then(|| GapClass::of(gap)))
}

/// Runs one unit, and once more as [`confirmed`] does.
///
/// # Errors
/// See [`SimulateError`].
pub fn level(scene: &Scene, n: f64, settings: &Settings) -> Result<Level, SimulateError> {
    let n_each = [n; CONTACTS];
    let gaps = settings.gaps(scene, &n_each);
    let run = confirmed(scene, &gaps, settings, simulate(scene, &gaps, settings)?)?;
    let Run { trajectory, outcome, solved, trust, .. } = run;
    Ok(Level { n, trajectory, outcome, solved, trust, classes: classes(&scene.gaps_at(&n_each)) })
}

/// What a sweep keeps of each run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// Figures and samples.
    Samples,
    /// Figures alone.
    Figures,
}

/// Runs every level of `levels`, on all threads of the current pool; `done` is called after each. The result does
/// not depend on the number of threads.
///
/// # Errors
/// The first level's [`SimulateError`], in the order of levels.
pub fn sweep(
    scene: &Scene,
    levels: &[f64],
    settings: &Settings,
    keep: Keep,
    done: impl Fn() + Sync,
) -> Result<Sweep, SimulateError> {
    let levels: Vec<Result<Level, SimulateError>> = levels
        .par_iter()
        .map(|&n| {
            let mut level = level(scene, n, settings)?;
            if keep == Keep::Figures {
                level.trajectory = Trajectory::default();
            }
            done();
            Ok(level)
        })
        .collect();
    Ok(Sweep { levels: levels.into_iter().collect::<Result<_, _>>()? })
}
