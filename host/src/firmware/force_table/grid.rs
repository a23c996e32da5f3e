//! A grid picked out of finer samples: which of them are nodes, the table's bytes, and what interpolating costs.

use slipfit_core::table::{AxisKind, Encoding, MotionVerdict, Table, motions};

use super::{
    levels,
    table::{Demand, ForceTable, TableError},
};
use crate::{
    firmware::flash::{self, AxisSpec, ChannelSpec, FlashError, TableSpec},
    setup::LevelRange,
};

/// Equidistant samples along an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SampleAxis {
    /// What varies.
    pub kind: AxisKind,
    /// Where the samples are, in the unit of the kind.
    pub at: Vec<f64>,
    /// Their distance.
    pub step: f64,
    /// Samples from one node of the finest table to the next.
    pub per_node: usize,
}

impl SampleAxis {
    /// A node at each of `range` and a sample half way between each two.
    pub fn halved(kind: AxisKind, range: &LevelRange) -> Self {
        let fine = levels(range);
        Self { kind, at: fine.levels(), step: fine.step, per_node: 2 }
    }

    /// The node's axis that takes every `stride`-th sample.
    fn nodes(&self, stride: usize) -> AxisSpec {
        let first = self.at.first().map_or(0.0, |first| *first as f32);
        let step = (self.step * stride as f64) as f32;
        AxisSpec { kind: self.kind, first, step, count: self.at.len().div_ceil(stride) }
    }

    /// Strides, shortest first, whose last node is the last sample; of two cells at least, unless the finest has one.
    fn strides(&self) -> impl Iterator<Item = usize> {
        let intervals = self.at.len().saturating_sub(1);
        let divides = move |stride: &usize| intervals.is_multiple_of(*stride) && stride.is_multiple_of(self.per_node);
        (1..=self.per_node.max(intervals / 2)).filter(divides)
    }
}

/// What a sample stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stage {
    /// What comes before the table is used.
    Before,
    /// What it is used for.
    InUse,
    /// Nothing the slide did: it has stopped short.
    Beyond,
}

/// Force (N) and velocity (m/s), and what they stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Force and velocity.
    pub values: [f64; 2],
    /// What they stand for.
    pub stage: Stage,
}

/// Samples over a lattice of axes, slowest first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Samples<const N: usize> {
    /// The axes.
    pub axes: [SampleAxis; N],
    /// One sample a point of the lattice, the last axis fastest.
    pub values: Vec<Sample>,
    /// The verdict on every motion sampled: a point of the lattice without its second axis.
    pub verdicts: Vec<MotionVerdict>,
}

/// Which samples are nodes of a table, and how it stores them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Grid<const N: usize> {
    /// Every so many samples along each axis.
    strides: [usize; N],
    encoding: Encoding,
}

impl<const N: usize> Grid<N> {
    /// Every node of the finest table, in f32.
    fn full(axes: &[SampleAxis; N]) -> Self {
        Self { strides: axes.each_ref().map(|axis| axis.per_node), encoding: Encoding::F32 }
    }

    fn axes(self, axes: &[SampleAxis; N]) -> Vec<AxisSpec> {
        axes.iter().zip(self.strides).map(|(axis, stride)| axis.nodes(stride)).collect()
    }

    /// The number of nodes.
    fn nodes(self, axes: &[SampleAxis; N]) -> usize {
        self.axes(axes).iter().fold(1, |nodes, axis| nodes.saturating_mul(axis.count))
    }

    /// Size of the table (bytes).
    fn size(self, axes: &[SampleAxis; N]) -> usize {
        let axes = self.axes(axes);
        flash::length(axes.iter().map(|axis| axis.count), self.encoding)
    }

    /// Every grid that ends where the samples end and may fit its region of flash, the smallest first.
    fn all(axes: &[SampleAxis; N]) -> Vec<Self> {
        let mut strides = vec![[1; N]];
        // The last axis outermost.
        for (i, axis) in axes.iter().enumerate().rev() {
            let longer = |before: &[usize; N]| {
                let before = *before;
                axis.strides().map(move |stride| {
                    let mut strides = before;
                    strides[i] = stride;
                    strides
                })
            };
            strides = strides.iter().flat_map(longer).collect();
        }
        let encoded = |strides: [usize; N]| Encoding::ALL.map(|encoding| Self { strides, encoding });
        let mut all: Vec<_> = strides.into_iter().flat_map(encoded).collect();
        all.retain(|grid| grid.size(axes) <= flash::TABLE_REGION);
        all.sort_by_key(|grid| grid.size(axes));
        all
    }
}

fn spec(
    scene_hash: u64,
    axes: Vec<AxisSpec>,
    encoding: Encoding,
    values: [Vec<f32>; 2],
    verdicts: Vec<MotionVerdict>,
) -> TableSpec {
    let [force, velocity] = values.map(|values| ChannelSpec { values, worst_error: 0.0, rms_error: 0.0 });
    TableSpec { scene_hash, axes, encoding, force, velocity, verdicts, production: None }
}

/// Whether a table with nodes on `axes` fits its region of flash, found out before any run.
///
/// # Errors
/// [`FlashError`] if not, or if an axis has fewer than two nodes.
pub(super) fn check<const N: usize>(axes: &[SampleAxis; N], demand: Demand) -> Result<(), FlashError> {
    let full = Grid::full(axes);
    // The smallest that there may be.
    let grid = if demand == Demand::Full { full } else { Grid::all(axes).first().copied().unwrap_or(full) };
    let nodes = grid.nodes(axes);
    // Too many to encode.
    if nodes > flash::TABLE_REGION {
        return Err(FlashError::TooLarge { bytes: grid.size(axes), region: flash::TABLE_REGION });
    }
    let (axes, zeros) = (grid.axes(axes), vec![0.0; nodes]);
    let motions = motions(axes.iter().map(|axis| axis.count)).unwrap_or(0);
    let verdicts = vec![MotionVerdict::default(); motions];
    flash::encode(&spec(0, axes, grid.encoding, [zeros.clone(), zeros], verdicts)).map(drop)
}

impl<const N: usize> Samples<N> {
    /// The table that `demand` asks for.
    ///
    /// # Errors
    /// If an axis has fewer than two nodes, the table is larger than its region of flash, or none errs as little as asked
    /// for.
    pub fn table(&self, scene_hash: u64, demand: Demand) -> Result<ForceTable, TableError> {
        let full = Grid::full(&self.axes);
        let Demand::MaxError(asked) = demand else { return Ok(self.built(scene_hash, full)?) };
        let mut best: Option<ForceTable> = None;
        for grid in Grid::all(&self.axes) {
            let table = self.built(scene_hash, grid)?;
            let error = |table: &ForceTable| table.worst_error_in_use[0];
            if error(&table) <= asked {
                return Ok(table);
            }
            if best.as_ref().is_none_or(|best| error(&table) < error(best)) {
                best = Some(table);
            }
        }
        match best {
            Some(best) => {
                let (error, bytes) = (best.worst_error_in_use[0], best.bytes.len());
                Err(TableError::MaxError { asked, best: error, bytes })
            }
            // No grid divides the samples or fits: the whole one says what is wrong.
            None => Ok(self.built(scene_hash, full)?),
        }
    }

    fn built(&self, scene_hash: u64, grid: Grid<N>) -> Result<ForceTable, FlashError> {
        let is_node = |place: &[usize; N]| place.iter().zip(grid.strides).all(|(i, stride)| i.is_multiple_of(stride));
        let nodes = || (0..self.values.len()).filter(|i| is_node(&self.place(*i))).map(|i| self.values[i].values);
        let values = [0, 1].map(|k| nodes().map(|values| values[k] as f32).collect());
        let axes = grid.axes(&self.axes);
        let verdicts = self.verdicts_at(&grid);
        let mut spec = spec(scene_hash, axes.clone(), grid.encoding, values, verdicts.clone());
        let bytes = flash::encode(&spec)?;
        let table = Table::<N>::open(&bytes).expect("the encoder's own table");

        let (mut worst_error, mut worst_error_in_use) = ([0.0f64; 2], [0.0f64; 2]);
        let (mut squares, mut count) = ([0.0f64; 2], 0u32);
        let (mut worst_at_levels, mut running, mut greatest) = (0.0f64, 0.0f64, 0.0f64);
        let speeds = self.axes.get(2).map_or(1, |axis| axis.at.len());
        for (i, sample) in self.values.iter().enumerate() {
            let Some(in_use) = self.in_use(i, &grid) else { continue };
            let place = self.place(i);
            let found = table.lookup(std::array::from_fn(|axis| self.axes[axis].at[place[axis]] as f32));
            let [force, velocity] = sample.values;
            let error = [f64::from(found.force) - force, f64::from(found.velocity) - velocity].map(f64::abs);
            count += u32::from(in_use);
            if in_use {
                greatest = greatest.max(force.abs());
                let motion = place[0] * speeds + place.get(2).copied().unwrap_or(0);
                if self.verdicts.get(motion) == Some(&MotionVerdict::Runs) {
                    running = running.max(force.abs());
                }
            }
            if in_use && place[0].is_multiple_of(grid.strides[0]) {
                worst_at_levels = worst_at_levels.max(error[0]);
            }
            for (k, error) in error.into_iter().enumerate() {
                worst_error[k] = worst_error[k].max(error);
                if in_use {
                    worst_error_in_use[k] = worst_error_in_use[k].max(error);
                    squares[k] += error * error;
                }
            }
        }
        let rms_error = squares.map(|sum| libm::sqrt(sum / f64::from(count.max(1))));
        for (channel, k) in [&mut spec.force, &mut spec.velocity].into_iter().zip(0..) {
            channel.worst_error = worst_error[k] as f32;
            channel.rms_error = rms_error[k] as f32;
        }
        let bytes = flash::encode(&spec)?;
        let running_force = if running > 0.0 { running } else { greatest };
        Ok(ForceTable {
            bytes,
            axes,
            encoding: grid.encoding,
            verdicts,
            worst_error,
            worst_error_in_use,
            rms_error,
            worst_at_levels,
            running_force,
        })
    }

    /// The verdicts on the motions that are nodes of `grid`.
    fn verdicts_at(&self, grid: &Grid<N>) -> Vec<MotionVerdict> {
        let speeds = self.axes.get(2).map_or(1, |axis| axis.at.len());
        let speed_stride = grid.strides.get(2).copied().unwrap_or(1);
        let levels = self.verdicts.chunks(speeds).step_by(grid.strides[0]);
        levels.flat_map(|level| level.iter().step_by(speed_stride)).copied().collect()
    }

    /// The place along each axis of the `i`-th sample.
    fn place(&self, mut i: usize) -> [usize; N] {
        let mut place = [0; N];
        for (place, axis) in place.iter_mut().zip(&self.axes).rev() {
            *place = i % axis.at.len();
            i /= axis.at.len();
        }
        place
    }

    /// Whether the `i`-th sample counts as one in use: it is, and no node of the finest table that it is interpolated from
    /// lies beyond where a slide stopped, so that a coarser one is judged by the same samples. `None` beyond the last nodes
    /// of `grid`.
    fn in_use(&self, i: usize, grid: &Grid<N>) -> Option<bool> {
        let place = self.place(i);
        let upper = |axis: usize, stride: usize| place[axis].div_ceil(stride) * stride;
        if (0..N).any(|axis| upper(axis, grid.strides[axis]) >= self.axes[axis].at.len()) {
            return None;
        }
        let node = |axis: usize, is_upper: bool| {
            let stride = self.axes[axis].per_node;
            if is_upper { upper(axis, stride) } else { place[axis] / stride * stride }
        };
        // A bit an axis says which end of the cell a corner has there.
        let mut corners = (0..1 << N).map(|corner: usize| {
            (0..N).fold(0, |index, axis| index * self.axes[axis].at.len() + node(axis, corner >> axis & 1 == 1))
        });
        let is_passed = |corner: usize| self.values[corner].stage != Stage::Beyond;
        Some(self.values[i].stage == Stage::InUse && corners.all(is_passed))
    }
}

#[cfg(test)]
mod tests {
    use slipfit_core::table::{AxisKind, Encoding, MotionVerdict};

    use super::{Grid, Sample, SampleAxis, Samples, Stage};
    use crate::{
        firmware::force_table::{Demand, TableError},
        setup::LevelRange,
    };

    const LEVELS: LevelRange = LevelRange { first: -1.0, step: 0.5, count: 3 };
    const SPEEDS: LevelRange = LevelRange { first: 0.5, step: 0.25, count: 2 };

    /// 5 by 17 by 3 samples, 3 by 5 by 2 nodes.
    fn samples(force: impl Fn([f64; 3]) -> f64, stage: impl Fn([f64; 3]) -> Stage) -> Samples<3> {
        let at = (0..17).map(|i| f64::from(i) * 0.25).collect();
        let axes = [
            SampleAxis::halved(AxisKind::Level, &LEVELS),
            SampleAxis { kind: AxisKind::Position, at, step: 0.25, per_node: 4 },
            SampleAxis::halved(AxisKind::Velocity, &SPEEDS),
        ];
        let [n, z, v] = axes.each_ref().map(|axis| axis.at.clone());
        let points = n.iter().flat_map(|n| z.iter().flat_map(|z| v.iter().map(|v| [*n, *z, *v])));
        let values = points.map(|at| Sample { values: [force(at), 2.0 * force(at)], stage: stage(at) }).collect();
        let verdicts = vec![MotionVerdict::Runs; 5 * 3];
        Samples { axes, values, verdicts }
    }

    #[test]
    fn what_units_need_is_told_by_those_that_run() {
        let force = |[n, _, _]: [f64; 3]| if n > -0.4 { 4.0 } else { 1.0 + n };
        let mut samples = samples(force, |[_, z, _]| if z < 1.0 { Stage::Before } else { Stage::InUse });
        // The tightest two levels jam, at every speed.
        samples.verdicts[3 * 3..].fill(MotionVerdict::Jammed);
        assert_eq!(samples.table(1, Demand::Full).unwrap().running_force, 0.5);
        samples.verdicts.fill(MotionVerdict::Jammed);
        assert_eq!(samples.table(1, Demand::Full).unwrap().running_force, 4.0);
    }

    #[test]
    fn what_is_linear_along_every_axis_costs_nothing() {
        let samples = samples(|[n, z, v]| (1.0 + n) * (2.0 - z) * v, |_| Stage::InUse);
        let table = samples.table(1, Demand::Full).unwrap();
        let counts: Vec<_> = table.axes.iter().map(|axis| (axis.first, axis.step, axis.count)).collect();
        assert_eq!(counts, [(-1.0, 0.5, 3), (0.0, 1.0, 5), (0.5, 0.25, 2)]);
        assert_eq!((table.worst_error, table.rms_error), ([0.0; 2], [0.0; 2]));
        // Stored as i16, half a unit of the greatest of 4 N at most.
        let small = samples.table(1, Demand::MaxError(1e-3)).unwrap();
        assert_eq!(
            (small.encoding, small.axes.iter().map(|axis| axis.count).collect()),
            (Encoding::I16, vec![3, 3, 2])
        );
        // A parabola is missed by a quarter half way between nodes a unit apart.
        let refused = self::samples(|[_, z, _]| z * z, |_| Stage::InUse).table(1, Demand::MaxError(0.24)).unwrap_err();
        assert!(matches!(refused, TableError::MaxError { best: 0.25, .. }), "{refused}");
    }

    #[test]
    fn errors_are_counted_where_they_belong() {
        // A bump at one sample between nodes.
        let at = |place: [f64; 3]| place == [-0.75, 1.25, 0.5];
        let bumpy = |stage: fn([f64; 3]) -> Stage| {
            let samples = samples(|place| if at(place) { 3.0 } else { 1.0 }, stage);
            samples.table(1, Demand::Full).unwrap()
        };
        let in_use = bumpy(|_| Stage::InUse);
        assert_eq!((in_use.worst_error, in_use.worst_error_in_use), ([2.0, 4.0], [2.0, 4.0]));
        let rms = 2.0 / libm::sqrt(f64::from(5 * 17 * 3));
        assert!((in_use.rms_error[0] - rms).abs() < 1e-12);
        // Before its use, and where a slide nearby has stopped, it counts for the whole table only.
        let before = bumpy(|[_, z, _]| if z < 1.5 { Stage::Before } else { Stage::InUse });
        assert_eq!((before.worst_error, before.worst_error_in_use), ([2.0, 4.0], [0.0; 2]));
        let beside = bumpy(|[n, z, _]| if n == -1.0 && z >= 1.5 { Stage::Beyond } else { Stage::InUse });
        assert_eq!((beside.worst_error, beside.worst_error_in_use), ([2.0, 4.0], [0.0; 2]));
        let elsewhere = bumpy(|[n, z, _]| if n == -1.0 && z > 2.0 { Stage::Beyond } else { Stage::InUse });
        assert_eq!(elsewhere.worst_error_in_use, [2.0, 4.0]);
        // A coarser table counts what the finest does, though it interpolates the bump from where the slide has stopped.
        let beyond = |[n, z, _]: [f64; 3]| if n == -1.0 && z > 2.0 { Stage::Beyond } else { Stage::InUse };
        let samples = samples(|place| if at(place) { 3.0 } else { 1.0 }, beyond);
        assert!(matches!(samples.table(1, Demand::MaxError(1.5)), Err(TableError::MaxError { best: 2.0, .. })));
    }

    #[test]
    fn verdicts_are_those_of_the_nodes() {
        use MotionVerdict::{Crawls, Jammed, Runs};
        let mut samples = samples(|_| 1.0, |_| Stage::InUse);
        // Levels are halved, and so are speeds: every second one is a node.
        samples.verdicts = vec![Runs; 15];
        samples.verdicts[6] = Crawls;
        samples.verdicts[8] = Jammed;
        samples.verdicts[7] = Jammed;
        let table = samples.table(1, Demand::Full).unwrap();
        assert_eq!(table.verdicts, [Runs, Runs, Crawls, Jammed, Runs, Runs]);
        assert_eq!(table.mixed(), [[-1.0, -0.5], [-0.5, 0.0]]);
    }

    #[test]
    fn grids_end_where_the_samples_do() {
        let [level, position, _] = samples(|_| 0.0, |_| Stage::InUse).axes;
        let grids = Grid::all(&[level, position]);
        assert_eq!(grids.len(), 2 * 2);
        assert!(grids.iter().all(|grid| 4 % grid.strides[0] == 0 && 16 % grid.strides[1] == 0 && grid.strides[1] >= 4));
        let sizes: Vec<_> = grids.iter().map(|grid| (grid.strides, grid.encoding)).collect();
        assert_eq!(sizes[0], ([2, 8], Encoding::I16));
    }
}
