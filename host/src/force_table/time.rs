//! Tables over tolerance level and time.

use slipfit_core::table::{AxisKind, Encoding};

use super::{
    Demand, ForceTable, SUBSAMPLES, TableError,
    grid::{self, Sample, SampleAxis, Samples, Stage},
    levels, scene_hash,
};
use crate::{
    flash::{self, FlashError},
    outcome::Trajectory,
    scene::Scene,
    simulate::Settings,
    sweep::{Keep, Level, Sweep, sweep},
};

/// Distance of the table's instants (s).
pub const STEP: f64 = 1e-3;

/// How runs for a table are sampled: at its instants and three times between them. Instants are [`STEP`] apart; for a full
/// table, the least multiple of it up to ten with which the table fits its region.
pub fn settings(scene: &Scene, demand: Demand) -> Settings {
    let every = |coarser: u32| STEP * f64::from(coarser) / SUBSAMPLES as f64;
    let fits = |coarser: &u32| {
        let instants = scene.run.duration / (every(*coarser) * SUBSAMPLES as f64) * (1.0 + 1e-9);
        flash::length([scene.sweep.count, instants as usize + 1], Encoding::F32) <= flash::TABLE_REGION
    };
    let coarser = match demand {
        Demand::Full => (1..=10).find(fits).unwrap_or(1),
        Demand::MaxError(_) => 1,
    };
    Settings::desk(scene, every(coarser))
}

/// Levels of `scene` and instants `at` (s) that `settings` sample.
fn axes(scene: &Scene, settings: &Settings, at: Vec<f64>) -> [SampleAxis; 2] {
    let instants = SampleAxis { kind: AxisKind::Time, at, step: settings.every, per_node: SUBSAMPLES };
    [SampleAxis::halved(AxisKind::Level, &scene.sweep), instants]
}

/// How many instants `settings` sample.
fn instants(scene: &Scene, settings: &Settings) -> usize {
    (scene.run.duration / settings.every * (1.0 + 1e-9)) as usize + 1
}

/// Whether a table of `scene` fits its region of flash, found out before any run.
///
/// # Errors
/// [`FlashError`] if not, or if there are fewer than two levels or instants.
pub fn check(scene: &Scene, demand: Demand) -> Result<(), FlashError> {
    let settings = settings(scene, demand);
    let at = (0..instants(scene, &settings)).map(|i| i as f64 * settings.every).collect();
    grid::check(&axes(scene, &settings, at), demand)
}

/// Makes the table of `scene` that `demand` asks for from a `sweep` at [`levels`] with [`settings`].
///
/// # Errors
/// If the sweep has fewer than two levels or instants, the table is larger than its region of flash, or none errs as
/// little as asked for.
fn build(scene: &Scene, sweep: &Sweep, settings: &Settings, demand: Demand) -> Result<ForceTable, TableError> {
    let at: Vec<f64> = (0..instants(scene, settings)).map(|i| i as f64 * settings.every).collect();
    let sample = |run: &Trajectory, i: usize| {
        let before = at[i] < scene.drive.ramp_start;
        // Where a slide has come to its stroke's end, the table holds what it came there with.
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
    let runs = sweep.levels.iter().map(|level| &level.trajectory);
    let values = runs.flat_map(|run| (0..at.len()).map(|i| sample(run, i)).collect::<Vec<_>>()).collect();
    let verdicts = sweep.levels.iter().map(|level| level.outcome.verdict.into()).collect();
    Samples { axes: axes(scene, settings, at), values, verdicts }.table(scene_hash(scene), demand)
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
    Sweep { levels: levels.collect() }
}

/// Sweeps and builds in one go; `done` is called after each of the [`levels`]. Gives the table and the sweep at its
/// nodes.
///
/// # Errors
/// Those of the runs; if there are fewer than two levels or instants, the table is larger than its region of flash, or none
/// errs as little as asked for.
pub fn make(scene: &Scene, demand: Demand, done: impl Fn() + Sync) -> Result<(ForceTable, Sweep), TableError> {
    let settings = settings(scene, demand);
    let sweep = sweep(scene, &levels(&scene.sweep).levels(), &settings, Keep::Samples, done)?;
    Ok((build(scene, &sweep, &settings, demand)?, nodes(&sweep)))
}
