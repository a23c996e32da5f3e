//! The force table: a sweep on a grid of tolerance level and time, with its interpolation error measured.

use slipfit_core::{
    slide::CONTACTS,
    table::{AxisKind, Encoding, Table, layout},
};
use thiserror::Error;

use crate::{
    flash::{self, AxisSpec, ChannelSpec, FlashError, TableSpec},
    outcome::Trajectory,
    scene::{LevelRange, RunSpec, Scene},
    simulate::{ScalarKind, Settings, SimulateError},
    sweep::{Level, Sweep, sweep},
};

/// Distance of the table's instants (s), unless the step asks for more.
pub const TIME_STEP: f64 = 1e-3;

/// Samples of a run from one instant of the table to the next; those between serve the error only.
const SUBSAMPLES: usize = 4;

/// A finished table and how well it does.
#[derive(Clone, Debug)]
pub struct ForceTable {
    /// As flashed.
    pub bytes: Vec<u8>,
    /// Levels by instants.
    pub shape: [usize; 2],
    /// Worst interpolation error over the whole run: force (N), velocity (m/s); looked for at every level and half way
    /// between levels, at every instant and three times between instants.
    pub worst_error: [f64; 2],
    /// The same from the ramp's start on, after the release of stored compression.
    pub worst_error_after_ramp_start: [f64; 2],
}

/// How runs for a table are sampled: at its instants and three times between them. Instants are
/// [`TIME_STEP`] apart, or the least multiple of it up to ten with which the table fits its region.
pub fn settings(scene: &Scene, scalar: ScalarKind) -> Settings {
    let RunSpec { duration, step, .. } = scene.run;
    let every = |coarser: u32| {
        let between = TIME_STEP * f64::from(coarser) / SUBSAMPLES as f64;
        (between / step - 1e-9).ceil().max(1.0) * step
    };
    let fits = |coarser: &u32| {
        let instants = duration / (every(*coarser) * SUBSAMPLES as f64) + 1.0;
        let bytes = instants * scene.sweep.count as f64 * (2 * size_of::<f32>()) as f64;
        bytes + (layout::HEADER_SIZE + layout::CHECKSUM_SIZE) as f64 <= flash::TABLE_REGION as f64
    };
    let coarser = (1..=10).find(fits).unwrap_or(1);
    Settings::fixed(scene.run, every(coarser), scalar)
}

/// The levels a table needs: those of its axis with one half way between each two, which only serve the error.
pub fn levels(axis: &LevelRange) -> LevelRange {
    LevelRange { first: axis.first, step: axis.step / 2.0, count: 2 * axis.count - 1 }
}

/// Why there is no table.
#[derive(Debug, Error)]
pub enum TableError {
    /// A unit could not be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The format cannot hold it.
    #[error(transparent)]
    Flash(#[from] FlashError),
}

/// Whether a table of `scene` fits its region of flash, found out before any run.
///
/// # Errors
/// [`FlashError`] if not, or if there are fewer than two levels or instants.
pub fn check(scene: &Scene) -> Result<(), FlashError> {
    let settings = settings(scene, ScalarKind::F64);
    let samples = (scene.run.duration / settings.every * (1.0 + 1e-9)) as usize + 1;
    let instants = samples.div_ceil(SUBSAMPLES);
    let nodes = scene.sweep.count.saturating_mul(instants);
    if nodes > flash::TABLE_REGION {
        let bytes = nodes.saturating_mul(2 * size_of::<f32>());
        return Err(FlashError::TooLarge { bytes, region: flash::TABLE_REGION });
    }
    let zeros = vec![0.0; nodes];
    flash::encode(&spec(scene, &settings, instants, zeros.clone(), zeros)).map(drop)
}

fn spec(scene: &Scene, settings: &Settings, instants: usize, force: Vec<f32>, velocity: Vec<f32>) -> TableSpec {
    let LevelRange { first, step, count } = scene.sweep;
    let channel = |values| ChannelSpec { values, encoding: Encoding::F32, worst_error: 0.0 };
    TableSpec {
        scene_hash: scene_hash(scene),
        axes: vec![
            AxisSpec { kind: AxisKind::Level, first: first as f32, step: step as f32, count },
            AxisSpec {
                kind: AxisKind::Time,
                first: 0.0,
                step: (SUBSAMPLES as f64 * settings.every) as f32,
                count: instants,
            },
        ],
        force: channel(force),
        velocity: channel(velocity),
    }
}

/// Makes the table of `scene` from a `sweep` at [`levels`] with [`settings`].
///
/// # Errors
/// If the sweep has fewer than two levels or instants, or the table is larger than its region of flash.
pub fn build(scene: &Scene, sweep: &Sweep, settings: &Settings) -> Result<ForceTable, FlashError> {
    let instants = sweep.levels.first().map_or(0, |level| level.trajectory.t.len().div_ceil(SUBSAMPLES));
    let channel = |pick: fn(&Trajectory) -> &Vec<f64>| -> Vec<f32> {
        let nodes = sweep.levels.iter().step_by(2).map(|level| pick(&level.trajectory));
        nodes.flat_map(|values| values.iter().step_by(SUBSAMPLES).map(|&x| x as f32)).collect()
    };
    let mut spec = spec(scene, settings, instants, channel(|run| &run.force), channel(|run| &run.vz));
    let bytes = flash::encode(&spec)?;
    let table = Table::open(&bytes).expect("the encoder's own table");
    let (mut worst_error, mut worst_error_after_ramp_start) = ([0.0f64; 2], [0.0f64; 2]);
    for level in &sweep.levels {
        let run = &level.trajectory;
        for (i, &t) in run.t.iter().enumerate().take(SUBSAMPLES * (instants - 1) + 1) {
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
    spec.force.worst_error = worst_error[0] as f32;
    spec.velocity.worst_error = worst_error[1] as f32;
    let bytes = flash::encode(&spec)?;
    Ok(ForceTable { bytes, shape: [scene.sweep.count, instants], worst_error, worst_error_after_ramp_start })
}

/// What a table of `scene` is stamped with.
pub fn scene_hash(scene: &Scene) -> u64 {
    let deviations: Vec<f64> =
        scene.pins.iter().flat_map(|pin| pin.gaps.map(|gap| gap.map_or(0.0, |gap| gap.deviation))).collect();
    let mut all = [0.0; CONTACTS];
    all.iter_mut().zip(deviations).for_each(|(slot, deviation)| *slot = deviation);
    let data = scene.slide_data::<f64>(&scene.gaps_at(&[0.0; CONTACTS]));
    flash::scene_hash(&data, &all, scene.run.integrator.name(), scene.run.step)
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
/// Those of the runs and of [`build`].
pub fn make(scene: &Scene, scalar: ScalarKind, done: impl Fn() + Sync) -> Result<(ForceTable, Sweep), TableError> {
    let settings = settings(scene, scalar);
    let sweep = sweep(scene, &levels(&scene.sweep).levels(), &settings, done)?;
    Ok((build(scene, &sweep, &settings)?, nodes(&sweep)))
}
