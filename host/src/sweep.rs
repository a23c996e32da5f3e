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
    simulate::{Settings, SimulateError, simulate},
    trust::Trust,
};

/// One level of a sweep.
#[derive(Clone, Debug)]
pub struct Level {
    /// Tolerance level, positive is tighter.
    pub n: f64,
    /// The run, sampled.
    pub trajectory: Trajectory,
    /// Its figures, the verdict confirmed at half the step.
    pub outcome: Outcome,
    /// What the run says about its step.
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

/// Runs one unit, and once more with half the step where [`confirmed`] does.
///
/// # Errors
/// See [`SimulateError`].
pub fn level(scene: &Scene, n: f64, settings: &Settings) -> Result<Level, SimulateError> {
    let gaps = scene.gaps_at(&[n; CONTACTS]);
    let run = confirmed(scene, &gaps, settings, simulate(scene, &gaps, settings)?)?;
    Ok(Level { n, trajectory: run.trajectory, outcome: run.outcome, trust: run.trust, classes: classes(&gaps) })
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
    done: impl Fn() + Sync,
) -> Result<Sweep, SimulateError> {
    let levels: Vec<Result<Level, SimulateError>> = levels
        .par_iter()
        .map(|&n| {
            let level = level(scene, n, settings);
            done();
            level
        })
        .collect();
    Ok(Sweep { levels: levels.into_iter().collect::<Result<_, _>>()? })
}
