//! Mean and modes as rows of a table.

use slipfit_core::{
    production::{Record, Row},
    table::{AxisKind, Encoding, MotionVerdict},
};

use super::{
    modes::{Grid, Modes},
    samples::{Over, Samples},
};
use crate::firmware::flash::{AxisSpec, ChannelSpec, TableSpec};

/// Mean and modes on a grid, and how well they show the strokes that they are made of.
pub struct Rows {
    pub grid: Grid,
    pub kind: AxisKind,
    pub modes: Modes,
    /// Root mean square (N) of what they leave.
    pub fit: f64,
}

impl Rows {
    pub fn of(grid: Grid, over: Over, firsts: &[Samples], count: usize) -> Self {
        let places = grid.places();
        let of = |values: fn(&Samples) -> &[f32]| -> Vec<Vec<f64>> {
            firsts.iter().map(|samples| samples.at_places(values(samples), &places)).collect()
        };
        let (forces, speeds) = (of(|samples| &samples.force), of(|samples| &samples.speed));
        let modes = Modes::of(&grid, &forces, &speeds, count);
        let kind = match over {
            Over::Time => AxisKind::Time,
            Over::Position => AxisKind::Position,
        };
        let mut rows = Self { grid, kind, modes, fit: 0.0 };
        rows.fit = rows.left(firsts);
        rows
    }

    /// Root mean square (N) of what mean and modes that fit each stroke best leave of it, at its own samples.
    fn left(&self, firsts: &[Samples]) -> f64 {
        let last = self.grid.first + self.grid.step * (self.grid.count - 1) as f64;
        let (mut squares, mut lengths) = (0.0, 0.0);
        // A part of them will do.
        for samples in firsts.iter().step_by(firsts.len().div_ceil(500)) {
            let inside = |at: f64| at >= self.grid.first && at <= last;
            let mut pieces = Vec::new();
            let mut sums = vec![0.0; self.modes.modes.len()];
            for (k, pair) in samples.at.windows(2).enumerate() {
                let [from, to] = [f64::from(pair[0]), f64::from(pair[1])];
                if to > from && inside(from) && inside(to) {
                    let values = self.values(to);
                    let above = f64::from(samples.force[k + 1]) - values.0;
                    for (sum, mode) in sums.iter_mut().zip(&values.1) {
                        *sum += above * mode * (to - from);
                    }
                    pieces.push((to - from, above, values.1));
                }
            }
            for (length, above, modes) in pieces {
                let fitted: f64 = modes.iter().zip(&sums).zip(&self.modes.norms).map(|((m, s), n)| m * s / n).sum();
                squares += length * (above - fitted) * (above - fitted);
                lengths += length;
            }
        }
        libm::sqrt(squares / f64::max(lengths, f64::MIN_POSITIVE))
    }

    /// Mean and modes at `at`.
    fn values(&self, at: f64) -> (f64, Vec<f64>) {
        let steps = ((at - self.grid.first) / self.grid.step).clamp(0.0, (self.grid.count - 1) as f64);
        let node = (steps as usize).min(self.grid.count.saturating_sub(2));
        let part = steps - node as f64;
        let value = |row: &[f64]| row[node] + part * (row[node + 1] - row[node]);
        (value(&self.modes.mean[0]), self.modes.modes.iter().map(|[force, _]| value(force)).collect())
    }

    /// The table with these widths, weights and record.
    pub fn spec(&self, hash: u64, widths: [Vec<f64>; 3], weight: Vec<f64>, record: Record) -> TableSpec {
        let zeros = vec![0.0; self.grid.count];
        let [mean, speed] = &self.modes.mean;
        let [above, below, taught] = &widths;
        let forces =
            [mean, above, below, taught, &weight].into_iter().chain(self.modes.modes.iter().map(|[force, _]| force));
        let speeds =
            [speed, &zeros, &zeros, &zeros, &zeros].into_iter().chain(self.modes.modes.iter().map(|[_, speed]| speed));
        let values = |rows: Vec<&Vec<f64>>| rows.into_iter().flatten().map(|x| *x as f32).collect::<Vec<f32>>();
        let channel =
            |values: Vec<f32>, error: f64| ChannelSpec { values, worst_error: error as f32, rms_error: error as f32 };
        let rows = Row::Mode as usize + self.modes.modes.len();
        let axis =
            |kind, first: f64, step: f64, count| AxisSpec { kind, first: first as f32, step: step as f32, count };
        TableSpec {
            scene_hash: hash,
            axes: vec![
                axis(AxisKind::Row, 0.0, 1.0, rows),
                axis(self.kind, self.grid.first, self.grid.step, self.grid.count),
            ],
            encoding: Encoding::I16,
            force: channel(values(forces.collect()), f64::from(record.residual)),
            velocity: channel(values(speeds.collect()), 0.0),
            verdicts: vec![MotionVerdict::Runs; rows],
            production: Some(record),
        }
    }
}
