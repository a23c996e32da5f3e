//! Tables over tolerance level and position, and over commanded speed as well: for a drive that knows where its slide is,
//! not when it started.
//!
//! *Position* z is how far the slide's centre of mass has come along the drive's direction from its start; for a drive that
//! turns it is an angle (rad), and all that is said here of m and N holds for rad and N·m. A node holds the
//! force with which a slide, started from rest at z = 0, first passes it. The node at z = 0 holds the greatest force until
//! the slide has come by [`SAMPLE`] ([`TURN_SAMPLE`]), its breakaway: before that the force rises while the slide stays where it is. Where a
//! slide jams or its run ends, the nodes beyond hold its last force and velocity 0; there force is no function of place, and
//! what is interpolated from such nodes counts towards the worst error but not towards the error in use.
//!
//! *Commanded speed* is the scene's `drive.speed`, set for each run; the ramp takes as long as the scene has it.

use slipfit_core::table::{AxisKind, Encoding};

use slipfit_system::parallel;

use super::{
    SUBSAMPLES,
    grid::{self, Sample, SampleAxis, Samples, Stage},
    levels,
    passage::Passage,
    reach::RUNS_MOST,
    table::{Demand, ForceTable, TableError},
};
use crate::{
    dynamics::{
        driven::{DriveKind, Driven, Motion},
        outcome::Verdict,
        simulate::SimulateError,
    },
    firmware::flash,
    setup::{LevelRange, RunSpec},
};

pub use super::reach::{PositionError, Reach, SAMPLE, STEP, TURN_SAMPLE, TURN_STEP};

/// Interval (s) of the samples of a run, between which it is taken as straight.
const EVERY: f64 = 50e-6;

/// Steps of which an axis without a given end has a whole multiple if it is longer, 5 mm or 5°: a number with many divisors, for
/// coarser tables.
const WHOLE: usize = 20;

/// A table over position, and what there is to say of it.
#[derive(Clone, Debug)]
pub struct PositionTable {
    /// The table.
    pub table: ForceTable,
    /// Units of the table's levels (and speeds) that do not come to the end of its axis, by level, then by speed.
    pub short: Vec<Reach>,
    /// Levels at which the desk's tolerance is too loose, by the warning of the first.
    pub warning: Option<String>,
}

/// What a table over position is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish<'a> {
    /// Commanded speeds (m/s), if it is to be over these as well.
    pub speeds: Option<&'a LevelRange>,
    /// Where its axis ends (m), up to a step farther. If not given: where the slowest unit is that runs at least at half its
    /// commanded speed when its run ends, at most at the end of the scene's stroke, in whole multiples of 5 mm or 5° and at most 1 m
    /// or ten times around; or where the farthest is if none runs.
    pub stroke: Option<f64>,
    /// Its size.
    pub demand: Demand,
}

/// The speeds that runs are made at: with those between, or the scene's alone.
fn run_speeds(driven: &dyn Driven, speeds: Option<&LevelRange>) -> Vec<f64> {
    speeds.map_or_else(|| vec![driven.drive().speed], |speeds| levels(speeds).levels())
}

/// How many runs a table takes.
pub fn runs(driven: &dyn Driven, speeds: Option<&LevelRange>) -> usize {
    levels(driven.levels()).count.saturating_mul(speeds.map_or(1, |speeds| levels(speeds).count))
}

fn position_axis(kind: DriveKind, samples: usize, per_node: usize) -> SampleAxis {
    let step = kind.sample();
    let at = (0..samples).map(|i| i as f64 * step).collect();
    SampleAxis { kind: AxisKind::Position, at, step, per_node }
}

/// Whether there can be the table of `driven` that is wished for, found out before any run.
///
/// # Errors
/// [`TableError`] if the run ends before the drive's ramp, speeds have no common direction, the stroke is out of bounds,
/// there are too many runs, fewer than two levels or speeds, or two positions are too many for the region of flash.
pub fn check(driven: &dyn Driven, &Wish { speeds, stroke, demand }: &Wish<'_>) -> Result<(), TableError> {
    let kind = driven.kind();
    if let Some(speeds) = speeds {
        let (first, last) = (speeds.first, speeds.level(speeds.count - 1));
        if first * last <= 0.0 {
            return Err(PositionError::Direction { kind, first, last }.into());
        }
    }
    if let Some(stroke) = stroke.filter(|stroke| !(kind.step()..=kind.most()).contains(stroke)) {
        return Err(PositionError::Stroke { kind, stroke }.into());
    }
    if driven.has_segments() {
        return Err(PositionError::Segments.into());
    }
    let (duration, ramp_end) = (driven.run().duration, driven.drive().ramp_end);
    if duration <= ramp_end {
        return Err(PositionError::Ramp { duration, ramp_end }.into());
    }
    let runs = runs(driven, speeds);
    if runs > RUNS_MOST {
        return Err(PositionError::TooMany(runs).into());
    }
    let level = SampleAxis::halved(AxisKind::Level, driven.levels());
    let shortest = position_axis(kind, SUBSAMPLES + 1, SUBSAMPLES);
    match speeds {
        None => grid::check(&[level, shortest], demand)?,
        Some(speeds) => grid::check(&[level, shortest, SampleAxis::halved(AxisKind::Velocity, speeds)], demand)?,
    }
    Ok(())
}

/// Simulates the stroke of every level and speed (m/s, rad/s) of `driven` and makes the table of them that is wished for; `done` is
/// called after each of the [`runs`].
///
/// # Errors
/// Those of [`check`] and of the runs; if no slide comes far enough; if no table errs as little as asked for.
pub fn make(driven: &dyn Driven, wish: &Wish<'_>, done: impl Fn() + Sync) -> Result<PositionTable, TableError> {
    check(driven, wish)?;
    let &Wish { speeds, stroke, demand } = wish;
    let speeds_of_runs = run_speeds(driven, speeds);
    let units: Vec<_> = levels(driven.levels())
        .levels()
        .into_iter()
        .flat_map(|n| speeds_of_runs.iter().map(move |speed| (n, *speed)))
        .collect();
    // Past the stroke's end, so that the last node is passed.
    let run = RunSpec { stroke: None, ..driven.run() };
    let (kind, sweep) = (driven.kind(), *driven.levels());
    let runs = parallel::try_map(&units, |&(n, speed)| {
        let run = driven.level(n, Motion { speed, run, every: EVERY })?;
        done();
        let passage = Passage::of(&run.trajectory, speed, kind.sample(), kind.most());
        let reach = Reach { n, speed, z: passage.reach, verdict: run.outcome.verdict };
        Ok::<_, SimulateError>((passage, (reach, run.doubts.into_iter().next())))
    })?;
    let (passages, judged): (Vec<Passage>, Vec<_>) = runs.into_iter().unzip();
    let (reaches, warnings): (Vec<Reach>, Vec<Option<String>>) = judged.into_iter().unzip();
    let steps = steps(kind, &reaches, [stroke, driven.run().stroke], driven.run().duration)?;
    let per_node = per_node([Some(sweep.count), speeds.map(|speeds| speeds.count)], steps, demand);
    // Up to the first node that is not short of the end.
    let samples = (steps * SUBSAMPLES).next_multiple_of(per_node) + 1;

    let sample = |passage: &Passage, k: usize| match passage.passed.get(k) {
        Some(values) => Sample { values: *values, stage: Stage::InUse },
        None => Sample { values: [passage.last_force, 0.0], stage: Stage::Beyond },
    };
    let level = |speeds: &[Passage]| -> Vec<Sample> {
        (0..samples).flat_map(|k| speeds.iter().map(move |passage| sample(passage, k))).collect()
    };
    let values = passages.chunks(speeds_of_runs.len()).flat_map(level).collect();
    let verdicts = reaches.iter().map(|reach| reach.verdict.into()).collect();
    let position = position_axis(kind, samples, per_node);
    let (hash, level) = (driven.hash(), SampleAxis::halved(AxisKind::Level, &sweep));
    let table = match speeds {
        None => Samples { axes: [level, position], values, verdicts }.table(hash, demand)?,
        Some(speeds) => {
            let axes = [level, position, SampleAxis::halved(AxisKind::Velocity, speeds)];
            Samples { axes, values, verdicts }.table(hash, demand)?
        }
    };

    let short = reaches.iter().zip(&passages).enumerate().filter(|(i, (_, passage))| {
        let [level, speed] = [i / speeds_of_runs.len(), i % speeds_of_runs.len()];
        level.is_multiple_of(2) && speed.is_multiple_of(2) && passage.passed.len() < samples
    });
    let short = short.map(|(_, (reach, _))| *reach).collect();
    Ok(PositionTable { table, short, warning: warnings.into_iter().flatten().next() })
}

/// How many steps an axis has, see [`Wish::stroke`]: to where it is `asked` to end, or as far as units run, at most to the end
/// of the scene's `stroke` (m).
fn steps(
    kind: DriveKind,
    reaches: &[Reach],
    [asked, stroke]: [Option<f64>; 2],
    duration: f64,
) -> Result<usize, PositionError> {
    let by_place = |one: &&Reach, other: &&Reach| one.z.total_cmp(&other.z);
    let farthest = *reaches.iter().max_by(by_place).expect("there are levels");
    let slowest = reaches.iter().filter(|reach| reach.verdict == Verdict::Runs).min_by(by_place);
    // Margins for rounding.
    let (step, most) = (kind.step(), stroke.unwrap_or(kind.most()).min(kind.most()));
    let steps = match asked {
        Some(asked) => (asked / step - 1e-9).ceil() as usize,
        None => match (slowest.unwrap_or(&farthest).z.min(most) / step + 1e-9) as usize {
            short if short < WHOLE => short,
            long => long / WHOLE * WHOLE,
        },
    };
    let asked = asked.unwrap_or(step);
    if steps == 0 || farthest.z < asked {
        return Err(PositionError::TooFar { kind, asked, farthest, duration });
    }
    Ok(steps)
}

/// Samples from a position of the finest table to the next: for a full one, the least whole number of steps with which
/// nodes of so many `levels` and speeds at each of the positions over `steps` fit their region.
fn per_node([levels, speeds]: [Option<usize>; 2], steps: usize, demand: Demand) -> usize {
    let fits = |coarser: &usize| {
        let positions = Some(steps.div_ceil(*coarser) + 1);
        flash::length([levels, positions, speeds].into_iter().flatten(), Encoding::F32) <= flash::TABLE_REGION
    };
    let coarser = match demand {
        Demand::Full => (1..=steps).find(fits).unwrap_or(1),
        Demand::MaxError(_) => 1,
    };
    coarser * SUBSAMPLES
}
