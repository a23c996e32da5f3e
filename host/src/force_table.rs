//! The force table: a sweep on a grid of tolerance level and time, with its interpolation error measured.

use anyhow::Context;
use slipfit_core::{
    slide::CONTACTS,
    table::{AxisKind, Table},
};

use crate::{
    flash::{self, AxisSpec, TableSpec},
    outcome::Trajectory,
    scene::{LevelRange, RunSpec, Scene},
    simulate::{ScalarKind, Settings, SimulateError},
    sweep::Sweep,
};

/// Distance of the table's instants (s), unless the step asks for more.
pub const TIME_STEP: f64 = 1e-3;

/// A finished table and how well it does.
#[derive(Clone, Debug)]
pub struct ForceTable {
    /// As flashed.
    pub bytes: Vec<u8>,
    /// Levels by instants.
    pub shape: [usize; 2],
    /// Worst interpolation error over the whole run: force (N), velocity (m/s).
    pub worst_error: [f64; 2],
    /// The same from the ramp's start on, after the release of stored compression.
    pub worst_error_after_ramp_start: [f64; 2],
}

/// How runs for a table are sampled: at the table's instants and half way between them.
pub fn settings(run: RunSpec, scalar: ScalarKind) -> Settings {
    let per_half = (TIME_STEP / (2.0 * run.step) - 1e-9).ceil().max(1.0);
    Settings { run, every: per_half * run.step, scalar }
}

/// The levels a table needs: those of its axis with one half way between each two, which only serve the error.
pub fn levels(axis: &LevelRange) -> LevelRange {
    LevelRange { first: axis.first, step: axis.step / 2.0, count: 2 * axis.count - 1 }
}

/// Makes the table of `scene` from a `sweep` at [`levels`] with [`settings`].
///
/// # Errors
/// If the sweep has fewer than two levels or instants, or the table is larger than its region of flash.
pub fn build(scene: &Scene, axis: &LevelRange, sweep: &Sweep, settings: &Settings) -> anyhow::Result<ForceTable> {
    let instants = sweep.levels.first().map_or(0, |level| level.trajectory.t.len().div_ceil(2));
    let nodes = || sweep.levels.iter().step_by(2).map(|level| &level.trajectory);
    let channel = |pick: fn(&Trajectory) -> &Vec<f64>| -> Vec<f32> {
        nodes().flat_map(|run| pick(run).iter().step_by(2).map(|&x| x as f32)).collect()
    };
    let mut spec = TableSpec {
        scene_hash: scene_hash(scene),
        axes: vec![
            AxisSpec { kind: AxisKind::Level, first: axis.first as f32, step: axis.step as f32, count: axis.count },
            AxisSpec { kind: AxisKind::Time, first: 0.0, step: (2.0 * settings.every) as f32, count: instants },
        ],
        force: channel(|run| &run.force),
        velocity: channel(|run| &run.vz),
        worst_error: [0.0; 2],
    };
    let bytes = flash::encode(&spec)?;
    let table = Table::open(&bytes).context("the table just made")?;
    let (mut worst_error, mut worst_error_after_ramp_start) = ([0.0f64; 2], [0.0f64; 2]);
    for level in &sweep.levels {
        let run = &level.trajectory;
        for (i, &t) in run.t.iter().enumerate().take(2 * instants - 1) {
            let found = table.lookup([level.n as f32, t as f32]);
            let error = [f64::from(found.force) - run.force[i], f64::from(found.velocity) - run.vz[i]].map(f64::abs);
            for (k, error) in error.into_iter().enumerate() {
                worst_error[k] = worst_error[k].max(error);
                if t >= scene.drive.ramp_start {
                    worst_error_after_ramp_start[k] = worst_error_after_ramp_start[k].max(error);
                }
            }
        }
    }
    spec.worst_error = worst_error.map(|error| error as f32);
    let bytes = flash::encode(&spec)?;
    Ok(ForceTable { bytes, shape: [axis.count, instants], worst_error, worst_error_after_ramp_start })
}

/// What a table of `scene` is stamped with.
pub fn scene_hash(scene: &Scene) -> u64 {
    let deviations: Vec<f64> = scene
        .pins
        .iter()
        .flat_map(|pin| pin.gaps.map(|gap| gap.map_or(0.0, |gap| gap.deviation)))
        .collect();
    let mut all = [0.0; CONTACTS];
    all.iter_mut().zip(deviations).for_each(|(slot, deviation)| *slot = deviation);
    let data = scene.slide_data::<f64>(&scene.gaps_at(&[0.0; CONTACTS]));
    flash::scene_hash(&data, &all, scene.run.integrator.name(), scene.run.step)
}

/// The sweep at the nodes only, sampled at the table's instants: what is shown to people.
pub fn nodes(sweep: &Sweep) -> Sweep {
    let thin = |values: &[f64]| values.iter().step_by(2).copied().collect();
    let levels = sweep.levels.iter().step_by(2).map(|level| {
        let run = &level.trajectory;
        let trajectory = Trajectory {
            t: thin(&run.t),
            vz: thin(&run.vz),
            force: thin(&run.force),
            x: thin(&run.x),
            y: thin(&run.y),
            worst_residual: run.worst_residual,
        };
        crate::sweep::Level { trajectory, ..level.clone() }
    });
    Sweep { levels: levels.collect() }
}

/// Sweeps and builds in one go; `done` is called after each of the [`levels`].
///
/// # Errors
/// Those of the runs and of [`build`].
pub fn make(
    scene: &Scene,
    axis: &LevelRange,
    scalar: ScalarKind,
    done: impl Fn() + Sync,
) -> Result<anyhow::Result<(ForceTable, Sweep)>, SimulateError> {
    let settings = settings(scene.run, scalar);
    let sweep = crate::sweep::sweep(scene, &levels(axis).levels(), &settings, done)?;
    Ok(build(scene, axis, &sweep, &settings).map(|table| (table, nodes(&sweep))))
}
