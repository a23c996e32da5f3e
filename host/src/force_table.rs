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
    /// How values are stored.
    pub encoding: Encoding,
    /// Worst interpolation error over the whole run: force (N), velocity (m/s); looked for at every level and half way
    /// between levels, at every instant and three times between instants.
    pub worst_error: [f64; 2],
    /// The same from the ramp's start on, after the release of stored compression.
    pub worst_error_after_ramp_start: [f64; 2],
}

/// What a table is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Demand {
    /// Every level and, if its region of flash has room, every [`TIME_STEP`], in f32.
    Full,
    /// The smallest table whose force errs by this much (N) at most from the ramp's start on.
    MaxError(f64),
}

/// How runs for a table are sampled: at its instants and three times between them. Instants are
/// [`TIME_STEP`] apart; for a full table, the least multiple of it up to ten with which the table fits its region.
pub fn settings(scene: &Scene, scalar: ScalarKind, demand: Demand) -> Settings {
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
    let coarser = match demand {
        Demand::Full => (1..=10).find(fits).unwrap_or(1),
        Demand::MaxError(_) => 1,
    };
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
    /// No table of the scene's levels errs so little.
    #[error(
        "no table errs by at most {asked} N; the best that fits the TABLE region errs by {best} N in {bytes} bytes"
    )]
    MaxError {
        /// The greatest error asked for (N).
        asked: f64,
        /// The least error found (N).
        best: f64,
        /// Length of that table.
        bytes: usize,
    },
}

/// Which of a sweep's levels and samples are nodes of a table, and how it stores them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Grid {
    /// Every so many levels of the scene's sweep.
    levels: usize,
    /// Every so many samples of a run.
    samples: usize,
    encoding: Encoding,
}

impl Grid {
    const FULL: Self = Self { levels: 1, samples: SUBSAMPLES, encoding: Encoding::F32 };

    /// Levels by instants of a table of `scene` whose runs have `samples`.
    fn shape(self, scene: &Scene, samples: usize) -> [usize; 2] {
        [scene.sweep.count.div_ceil(self.levels), samples.div_ceil(self.samples)]
    }

    /// Every grid that ends where the sweep and its runs of `samples` end, the smallest table first.
    fn all(scene: &Scene, samples: usize) -> Vec<Self> {
        let divisors = |n: usize| (1..=n / 2).filter(move |d| n.is_multiple_of(*d));
        let [intervals, levels] = [samples.saturating_sub(1), scene.sweep.count.saturating_sub(1)];
        let mut all: Vec<_> = divisors(intervals)
            .filter(|samples| samples.is_multiple_of(SUBSAMPLES))
            .flat_map(|samples| divisors(levels).map(move |levels| (levels, samples)))
            .flat_map(|(levels, samples)| Encoding::ALL.map(|encoding| Self { levels, samples, encoding }))
            .collect();
        let size = |grid: &Self| grid.shape(scene, samples).iter().product::<usize>() * grid.encoding.size();
        all.retain(|grid| 2 * size(grid) <= flash::TABLE_REGION);
        all.sort_by_key(size);
        all
    }
}

/// Whether a table of `scene` fits its region of flash, found out before any run.
///
/// # Errors
/// [`FlashError`] if not, or if there are fewer than two levels or instants.
pub fn check(scene: &Scene, demand: Demand) -> Result<(), FlashError> {
    let settings = settings(scene, ScalarKind::F64, demand);
    let samples = (scene.run.duration / settings.every * (1.0 + 1e-9)) as usize + 1;
    // The smallest that there may be.
    let grid = Grid::all(scene, samples).first().copied().filter(|_| demand != Demand::Full).unwrap_or(Grid::FULL);
    let nodes = grid.shape(scene, samples).into_iter().fold(1, usize::saturating_mul);
    if nodes > flash::TABLE_REGION {
        let bytes = nodes.saturating_mul(2 * size_of::<f32>());
        return Err(FlashError::TooLarge { bytes, region: flash::TABLE_REGION });
    }
    let zeros = vec![0.0; nodes];
    flash::encode(&spec(scene, &settings, grid, samples, [zeros.clone(), zeros])).map(drop)
}

fn spec(scene: &Scene, settings: &Settings, grid: Grid, samples: usize, values: [Vec<f32>; 2]) -> TableSpec {
    let LevelRange { first, step, .. } = scene.sweep;
    let [levels, instants] = grid.shape(scene, samples);
    let [force, velocity] = values.map(|values| ChannelSpec { values, worst_error: 0.0, rms_error: 0.0 });
    TableSpec {
        scene_hash: scene_hash(scene),
        axes: vec![
            AxisSpec {
                kind: AxisKind::Level,
                first: first as f32,
                step: (step * grid.levels as f64) as f32,
                count: levels,
            },
            AxisSpec {
                kind: AxisKind::Time,
                first: 0.0,
                step: (grid.samples as f64 * settings.every) as f32,
                count: instants,
            },
        ],
        encoding: grid.encoding,
        force,
        velocity,
    }
}

/// Makes the table of `scene` that `demand` asks for from a `sweep` at [`levels`] with [`settings`].
///
/// # Errors
/// If the sweep has fewer than two levels or instants, the table is larger than its region of flash, or none errs as
/// little as asked for.
pub fn build(scene: &Scene, sweep: &Sweep, settings: &Settings, demand: Demand) -> Result<ForceTable, TableError> {
    let Demand::MaxError(asked) = demand else { return Ok(built(scene, sweep, settings, Grid::FULL)?) };
    let samples = sweep.levels.first().map_or(0, |level| level.trajectory.t.len());
    let mut best: Option<ForceTable> = None;
    for grid in Grid::all(scene, samples) {
        let table = built(scene, sweep, settings, grid)?;
        let error = |table: &ForceTable| table.worst_error_after_ramp_start[0];
        if error(&table) <= asked {
            return Ok(table);
        }
        if best.as_ref().is_none_or(|best| error(&table) < error(best)) {
            best = Some(table);
        }
    }
    match best {
        Some(best) => {
            let (error, bytes) = (best.worst_error_after_ramp_start[0], best.bytes.len());
            Err(TableError::MaxError { asked, best: error, bytes })
        }
        // No grid divides the run: the whole one says what is wrong.
        None => Ok(built(scene, sweep, settings, Grid::FULL)?),
    }
}

fn built(scene: &Scene, sweep: &Sweep, settings: &Settings, grid: Grid) -> Result<ForceTable, FlashError> {
    let samples = sweep.levels.first().map_or(0, |level| level.trajectory.t.len());
    let channel = |pick: fn(&Trajectory) -> &Vec<f64>| -> Vec<f32> {
        let nodes = sweep.levels.iter().step_by(2 * grid.levels).map(|level| pick(&level.trajectory));
        nodes.flat_map(|values| values.iter().step_by(grid.samples).map(|&x| x as f32)).collect()
    };
    let values = [channel(|run| &run.force), channel(|run| &run.vz)];
    let mut spec = spec(scene, settings, grid, samples, values);
    let bytes = flash::encode(&spec)?;
    let table = Table::open(&bytes).expect("the encoder's own table");
    let shape @ [_, instants] = grid.shape(scene, samples);
    let (mut worst_error, mut worst_error_after_ramp_start) = ([0.0f64; 2], [0.0f64; 2]);
    let (mut squares, mut count) = ([0.0f64; 2], 0u32);
    for level in &sweep.levels {
        let run = &level.trajectory;
        for (i, &t) in run.t.iter().enumerate().take(grid.samples * (instants - 1) + 1) {
            let found = table.lookup([level.n as f32, t as f32]);
            let error = [f64::from(found.force) - run.force[i], f64::from(found.velocity) - run.vz[i]].map(f64::abs);
            let in_use = t >= scene.drive.ramp_start;
            count += u32::from(in_use);
            for (k, error) in error.into_iter().enumerate() {
                worst_error[k] = worst_error[k].max(error);
                if in_use {
                    worst_error_after_ramp_start[k] = worst_error_after_ramp_start[k].max(error);
                    squares[k] += error * error;
                }
            }
        }
    }
    for (channel, k) in [&mut spec.force, &mut spec.velocity].into_iter().zip(0..) {
        channel.worst_error = worst_error[k] as f32;
        channel.rms_error = libm::sqrt(squares[k] / f64::from(count.max(1))) as f32;
    }
    let bytes = flash::encode(&spec)?;
    Ok(ForceTable { bytes, shape, encoding: grid.encoding, worst_error, worst_error_after_ramp_start })
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
