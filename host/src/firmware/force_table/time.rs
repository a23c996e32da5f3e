//! Tables over tolerance level and time.
//!
//! Where a unit has come to its stroke's end before the table's last instant, it goes on as the drive goes on pushing it, and the table
//! holds what it does then. Its verdict, and what is shown of it, end with the stroke.

use std::borrow::Cow;

use slipfit_core::table::{AxisKind, Encoding};

use slipfit_system::parallel;

use super::{
    SUBSAMPLES,
    grid::{self, Sample, SampleAxis, Samples, Stage},
    levels,
    table::{Demand, ForceTable, TableError},
};
use crate::{
    dynamics::{
        driven::{Driven, Motion},
        simulate::SimulateError,
        sweep::{Keep, Level, Sweep, sweep},
        trajectory::Trajectory,
    },
    firmware::flash::{self, FlashError},
    setup::RunSpec,
};

/// Distance of the table's instants (s).
pub const STEP: f64 = 1e-3;

/// How often (s) runs for a table are sampled: at its instants and three times between them. Instants are [`STEP`] apart; for
/// a full table, the least multiple of it up to ten with which the table fits its region.
pub fn every(driven: &dyn Driven, demand: Demand) -> f64 {
    let every = |coarser: u32| STEP * f64::from(coarser) / SUBSAMPLES as f64;
    let fits = |coarser: &u32| {
        let instants = driven.run().duration / (every(*coarser) * SUBSAMPLES as f64) * (1.0 + 1e-9);
        flash::length([driven.levels().count, instants as usize + 1], Encoding::F32) <= flash::TABLE_REGION
    };
    every(match demand {
        Demand::Full => (1..=10).find(fits).unwrap_or(1),
        Demand::MaxError(_) => 1,
    })
}

/// Levels of `driven` and instants sampled `every` (s).
fn axes(driven: &dyn Driven, every: f64) -> [SampleAxis; 2] {
    let count = (driven.run().duration / every * (1.0 + 1e-9)) as usize + 1;
    let at = (0..count).map(|i| i as f64 * every).collect();
    let instants = SampleAxis { kind: AxisKind::Time, at, step: every, per_node: SUBSAMPLES };
    [SampleAxis::halved(AxisKind::Level, driven.levels()), instants]
}

/// Whether a table of `driven` fits its region of flash, found out before any run.
///
/// # Errors
/// [`FlashError`] if not, or if there are fewer than two levels or instants.
pub fn check(driven: &dyn Driven, demand: Demand) -> Result<(), FlashError> {
    grid::check(&axes(driven, every(driven, demand)), demand)
}

/// The runs of a `sweep` of `driven`, those that end with their stroke beyond it.
///
/// # Errors
/// Those of the runs.
fn whole<'a>(driven: &dyn Driven, sweep: &'a Sweep, motion: Motion) -> Result<Vec<Cow<'a, Trajectory>>, SimulateError> {
    let run = RunSpec { stroke: None, ..motion.run };
    let beyond = |level: &'a Level| -> Result<Cow<'a, Trajectory>, SimulateError> {
        let ends_early = level.outcome.stroke_reached == Some(true) && level.outcome.end.t < run.duration;
        if !ends_early {
            return Ok(Cow::Borrowed(&level.trajectory));
        }
        Ok(Cow::Owned(driven.level(level.n, Motion { run, ..motion })?.trajectory))
    };
    parallel::try_map(&sweep.levels, beyond)
}

/// Makes the table of `driven` that `demand` asks for from the `runs` of a `sweep` at [`levels`], sampled `every` (s).
///
/// # Errors
/// If the sweep has fewer than two levels or instants, the table is larger than its region of flash, or none errs as
/// little as asked for.
fn build(
    driven: &dyn Driven,
    sweep: &Sweep,
    runs: &[Cow<'_, Trajectory>],
    every: f64,
    demand: Demand,
) -> Result<ForceTable, TableError> {
    let axes = axes(driven, every);
    let at = &axes[1].at;
    let sample = |run: &Trajectory, i: usize| {
        let before = at[i] < driven.drive().ramp_start;
        // A run that is over before the last instant: the table holds what it ended with.
        let Some(last) = run.t.len().checked_sub(1) else {
            return Sample { values: [0.0; 2], stage: Stage::Beyond };
        };
        let stage = match (i > last, before) {
            (true, _) => Stage::Beyond,
            (false, true) => Stage::Before,
            (false, false) => Stage::InUse,
        };
        Sample { values: [run.force[i.min(last)], run.vz[i.min(last)]], stage }
    };
    let values = runs.iter().flat_map(|run| (0..at.len()).map(|i| sample(run, i)).collect::<Vec<_>>()).collect();
    let verdicts = sweep.levels.iter().map(|level| level.outcome.verdict.into()).collect();
    Samples { axes, values, verdicts }.table(driven.hash(), demand)
}

/// The sweep at the nodes only, sampled at the table's instants: what is shown to people.
fn nodes(sweep: &Sweep) -> Sweep {
    let thin = |values: &[f64]| values.iter().step_by(SUBSAMPLES).copied().collect();
    let levels = sweep.levels.iter().step_by(2).map(|level| {
        let run = &level.trajectory;
        let trajectory = Trajectory {
            t: thin(&run.t),
            vz: thin(&run.vz),
            force: thin(&run.force),
            x: thin(&run.x),
            y: thin(&run.y),
            z: thin(&run.z),
        };
        Level { trajectory, ..level.clone() }
    });
    Sweep { levels: levels.collect(), gaps: sweep.gaps.clone(), ..*sweep }
}

/// Sweeps and builds in one go; `done` is called after each of the [`levels`]. Gives the table and the sweep at its
/// nodes.
///
/// # Errors
/// Those of the runs; if there are fewer than two levels or instants, the table is larger than its region of flash, or none
/// errs as little as asked for.
pub fn make(driven: &dyn Driven, demand: Demand, done: impl Fn() + Sync) -> Result<(ForceTable, Sweep), TableError> {
    let every = every(driven, demand);
    let (levels, motion) = (levels(driven.levels()).levels(), driven.motion(every));
    let sweep = sweep(driven, &levels, Keep::Samples, |n| driven.level(n, motion), done)?;
    let runs = whole(driven, &sweep, motion)?;
    Ok((build(driven, &sweep, &runs, every, demand)?, nodes(&sweep)))
}
