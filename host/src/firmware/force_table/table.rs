//! A finished force table, what one is to be, and why there is none.

use slipfit_core::table::{Encoding, MotionVerdict};
use slipfit_tolerance::number::three_digits;
use thiserror::Error;

use super::reach::PositionError;
use crate::{
    dynamics::simulate::SimulateError,
    firmware::flash::{AxisSpec, FlashError},
};

/// A finished table and how well it does.
#[derive(Clone, Debug)]
pub struct ForceTable {
    /// As flashed.
    pub bytes: Vec<u8>,
    /// Its axes, slowest first.
    pub axes: Vec<AxisSpec>,
    /// How values are stored.
    pub encoding: Encoding,
    /// The verdict on every motion: one a level, or a level and a speed, speeds fastest.
    pub verdicts: Vec<MotionVerdict>,
    /// Worst interpolation error: force (N), velocity (m/s); looked for at every level (and speed) and half way between,
    /// at every instant or position and at least three times between.
    pub worst_error: [f64; 2],
    /// The same where the table is used: over time from the ramp's start on, after the release of stored compression;
    /// over position where every slide nearby comes to.
    pub worst_error_in_use: [f64; 2],
    /// Root mean square of the error where the table is used.
    pub rms_error: [f64; 2],
    /// Worst error of the force (N) at the levels themselves, where the table is used: what no finer levels help against.
    pub worst_at_levels: f64,
    /// The greatest force (N) of motions that run, where the table is used; of all, if none runs.
    pub running_force: f64,
}

impl ForceTable {
    /// The longest row of neighbouring levels with this verdict: the first and the last.
    pub fn longest(&self, verdict: MotionVerdict) -> Option<[f32; 2]> {
        let (levels, speeds) = (self.axes[0], self.axes.get(2).map_or(1, |axis| axis.count));
        let by_level: Vec<_> = self.verdicts.chunks(speeds).zip(0u16..).collect();
        let all = |verdicts: &[MotionVerdict]| verdicts.iter().all(|found| *found == verdict);
        let rows = by_level.chunk_by(|one, next| all(one.0) == all(next.0)).filter(|row| all(row[0].0));
        let row = rows.max_by_key(|row| row.len())?;
        Some([row[0].1, row[row.len() - 1].1].map(|i| levels.first + levels.step * f32::from(i)))
    }

    /// Neighbouring levels between which a verdict changes: what is looked up there is no unit's.
    pub fn mixed(&self) -> Vec<[f32; 2]> {
        let (levels, speeds) = (self.axes[0], self.axes.get(2).map_or(1, |axis| axis.count));
        let by_level: Vec<_> = self.verdicts.chunks(speeds).collect();
        let pairs = by_level.windows(2).zip(0..).filter(|(pair, _)| pair[0] != pair[1]);
        pairs.map(|(_, i)| [i, i + 1].map(|i| levels.first + levels.step * i as f32)).collect()
    }
}

/// What a table is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Demand {
    /// Every level and, if its region of flash has room, every [`time::STEP`](super::time::STEP) or [`position::STEP`](super::position::STEP), in f32.
    Full,
    /// The smallest table whose force errs by this much (N) at most where it is used.
    MaxError(f64),
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
        "no table errs by at most {asked} N; the best that fits the TABLE region errs by {} N in {bytes} bytes",
        three_digits(*.best)
    )]
    MaxError {
        /// The greatest error asked for (N).
        asked: f64,
        /// The least error found (N).
        best: f64,
        /// Length of that table.
        bytes: usize,
    },
    /// There are no runs that a table over position can be made of.
    #[error(transparent)]
    Position(#[from] PositionError),
}
