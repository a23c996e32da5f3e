//! Tables over tolerance level and time.

use slipfit_core::table::{AxisKind, layout};

use super::{
    Demand, ForceTable, SUBSAMPLES, TableError,
    grid::{self, Sample, SampleAxis, Samples, Stage},
    levels, scene_hash,
};
use crate::{
    flash::{self, FlashError},
    outcome::Trajectory,
    scene::{RunSpec, Scene},
    simulate::{ScalarKind, Settings},
    sweep::{Level, Sweep, sweep},
};

/// Distance of the table's instants (s), unless the step asks for more.
pub const STEP: f64 = 1e-3;

/// How runs for a table are sampled: at its instants and three times between them. Instants are [`STEP`] apart; for a full
/// table, the least multiple of it up to ten with which the table fits its region.
pub fn settings(scene: &Scene, scalar: ScalarKind, demand: Demand) -> Settings {
    let RunSpec { duration, step, .. } = scene.run;
    let every = |coarser: u32| {
        let between = STEP * f64::from(coarser) / SUBSAMPLES as f64;
        (between / step - 1e-9).ceil().max(1.0) * step
    };
    let fits = |coarser: &u32| {
        let instants = duration / (every(*coarser) * SUBSAMPLES as f64) + 1.0;
        let bytes = instants * scene.sweep.count as f64 * (2 * size_of::<f32>()) as f64;
        bytes + (layout::HEADER_SIZE + layout::CHECKSUM_SIZE) as f64 <= flash::TABLE_REGION as f64
    };
    let coarser = match demand {
        Demand::Full => (1..=10).find(fits).unwrap_or(1),
        Demand::MaxError(_) => 1,
    };
    Settings::fixed(scene.run, every(coarser), scalar)
}

/// Levels of `scene` and instants `at` (s) that `settings` sample.
fn axes(scene: &Scene, settings: &Settings, at: Vec<f64>) -> [SampleAxis; 2] {
    let instants = SampleAxis { kind: AxisKind::Time, at, step: settings.every, per_node: SUBSAMPLES };
    [SampleAxis::halved(AxisKind::Level, &scene.sweep), instants]
}

/// Whether a table of `scene` fits its region of flash, found out before any run.
///
/// # Errors
/// [`FlashError`] if not, or if there are fewer than two levels or instants.
pub fn check(scene: &Scene, demand: Demand) -> Result<(), FlashError> {
    let settings = settings(scene, ScalarKind::F64, demand);
    let samples = (scene.run.duration / settings.every * (1.0 + 1e-9)) as usize + 1;
    let at = (0..samples).map(|i| i as f64 * settings.every).collect();
    grid::check(&axes(scene, &settings, at), demand)
}

/// Makes the table of `scene` that `demand` asks for from a `sweep` at [`levels`] with [`settings`].
///
/// # Errors
/// If the sweep has fewer than two levels or instants, the table is larger than its region of flash, or none errs as
/// little as asked for.
fn build(scene: &Scene, sweep: &Sweep, settings: &Settings, demand: Demand) -> Result<ForceTable, TableError> {
    let sample = |run: &Trajectory, i: usize| {
        let stage = if run.t[i] >= scene.drive.ramp_start { Stage::InUse } else { Stage::Before };
        Sample { values: [run.force[i], run.vz[i]], stage }
    };
    let runs = || sweep.levels.iter().map(|level| &level.trajectory);
    let at = runs().next().map_or_else(Vec::new, |run| run.t.clone());
    let values = runs().flat_map(|run| (0..run.t.len()).map(move |i| sample(run, i))).collect();
    Samples { axes: axes(scene, settings, at), values }.table(scene_hash(scene), demand)
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
            worst_residual: run.worst_residual,
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
pub fn make(
    scene: &Scene,
    scalar: ScalarKind,
    demand: Demand,
    done: impl Fn() + Sync,
) -> Result<(ForceTable, Sweep), TableError> {
    let settings = settings(scene, scalar, demand);
    let sweep = sweep(scene, &levels(&scene.sweep).levels(), &settings, done)?;
    Ok((build(scene, &sweep, &settings, demand)?, nodes(&sweep)))
}
