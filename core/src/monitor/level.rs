//! Which tolerance level a unit has, from the force of one motion: least squares over all levels of the table at once.
//!
//! Between two levels the table is linear in n, so that the sum of squared residuals is a parabola there, known from
//! three sums: of the squares at either level and of the products. Kept for every level of the table, they give the best
//! level whatever it is, without a first guess and without the samples. Between two levels whose units end differently there
//! is no unit, so that only the levels themselves count there. Noise of unknown strength is estimated from what
//! the best level leaves, and widened if neighbouring residuals are correlated: then the model errs, not the sensor.

use crate::table::{AxisKind, Nodes, Place, Table, TableError};

/// χ² of one degree of freedom that 95 % stay below.
const CHI_SQUARED: f32 = 3.841_459;

/// Samples of a batch, which tells how correlated residuals are.
const BATCH: u32 = 32;

/// Over how many samples the table's own interpolation error counts as correlated.
const TABLE_SAMPLES: f32 = 20.0;

/// Why a bank cannot be made for a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BankError {
    /// The table is not one over tolerance level and time.
    Table(TableError),
    /// The table has more levels than the bank.
    Levels {
        /// Levels of the table.
        found: usize,
        /// Levels that the bank has room for.
        most: usize,
    },
}

impl core::fmt::Display for BankError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Table(error) => write!(f, "no table over tolerance level and time: {error}"),
            Self::Levels { found, most } => write!(f, "the table has {found} levels, allowed are at most {most}"),
        }
    }
}

impl core::error::Error for BankError {}

/// A level and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Estimate {
    /// The level n that fits best.
    pub level: f32,
    /// Its standard error: the interval's width over 2·1.96, infinite if any level of the table would do.
    pub deviation: f32,
    /// Where n lies with 95 % confidence; ends at the table's ends.
    pub interval: [f32; 2],
    /// Standard deviation (N) of the force from the table's at that level.
    pub residual: f32,
}

/// Running sums for a table of up to `LEVELS` levels, which the bank keeps: sums of residuals mean nothing to another one.
#[derive(Clone, Copy, Debug)]
pub struct LevelBank<'a, V, const LEVELS: usize> {
    table: Table<'a, 2, V>,
    sums: [Sums; LEVELS],
    /// Levels of the table.
    count: usize,
    samples: u32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Residuals of the batch so far (N).
    batch: f32,
    /// Of squared residuals (N²).
    squares: f32,
    /// Of residuals times those of the next level (N²).
    products: f32,
    /// Of squared sums over whole batches (N²).
    batches: f32,
}

impl<'a, V: Nodes, const LEVELS: usize> LevelBank<'a, V, LEVELS> {
    /// A bank for `table`, without samples.
    ///
    /// # Errors
    /// [`BankError`] if the table is not over level and time or has more levels.
    pub fn new(table: Table<'a, 2, V>) -> Result<Self, BankError> {
        let table = table.expect_axes([AxisKind::Level, AxisKind::Time]).map_err(BankError::Table)?;
        let [levels, _] = table.axes();
        let (found, most) = (levels.count(), LEVELS);
        if found > most {
            return Err(BankError::Levels { found, most });
        }
        Ok(Self { table, sums: [Sums::default(); LEVELS], count: found, samples: 0 })
    }

    /// Adds the `force` (N) measured at `time` (s) of a motion; one beyond 10⁶ N, not finite or not in the table is passed
    /// over. The same work for every sample, in proportion to the levels.
    #[inline]
    pub fn add(&mut self, time: f32, force: f32) {
        let Some(forces) = self.table.forces(time).filter(|_| force.abs() <= 1e6) else { return };
        self.samples = self.samples.saturating_add(1);
        let ends = self.samples.is_multiple_of(BATCH);
        let mut before: Option<(&mut Sums, f32)> = None;
        for (sums, expected) in self.sums.iter_mut().zip(forces) {
            let residual = force - expected;
            if let Some((lower, lower_residual)) = before {
                lower.products += lower_residual * residual;
            }
            sums.squares += residual * residual;
            sums.batch += residual;
            if ends {
                sums.batches += sums.batch * sums.batch;
                sums.batch = 0.0;
            }
            before = Some((sums, residual));
        }
    }

    /// The level that fits best; none before the tenth sample.
    pub fn estimate(&self) -> Option<Estimate> {
        let [levels, _] = self.table.axes();
        let cells = || {
            let sums = self.sums.get(..self.count).unwrap_or_default();
            sums.windows(2).zip(0usize..).filter_map(|(pair, i)| {
                let [lower, upper] = pair else { return None };
                let parabola = Parabola::of(lower, upper, self.table.is_mixed(&[Place::after(i), Place::default()]));
                Some((parabola, levels.node(i), lower, upper))
            })
        };
        if self.samples < 10 {
            return None;
        }
        let mut best: Option<(f32, f32, f32, f32)> = None;
        for (parabola, first, lower, upper) in cells() {
            let at = parabola.lowest();
            let least = parabola.value(at);
            if best.is_none_or(|(other, ..)| least < other) {
                let near = if at < 0.5 { lower } else { upper };
                best = Some((least, first + levels.step() * at, near.batches, near.squares));
            }
        }
        let (least, level, batches, squares) = best?;
        let degrees = (self.samples - 1) as f32;
        let variance = least / degrees;
        // Correlated residuals add up: sums over a batch vary more than those of independent ones.
        let whole = (self.samples / BATCH * BATCH) as f32;
        let together = if whole > 0.0 { batches * degrees / (whole * squares) } else { BATCH as f32 };
        let together = if together > 1.0 { together } else { 1.0 };
        let [force, _] = self.table.channels();
        let table_error = force.rms_error;
        let limit = least + CHI_SQUARED * (variance * together + TABLE_SAMPLES * table_error * table_error);

        let (mut low, mut high) = (level, level);
        for (parabola, first, ..) in cells() {
            if let Some([from, to]) = parabola.below(limit) {
                let (from, to) = (first + levels.step() * from, first + levels.step() * to);
                low = if from < low { from } else { low };
                high = if to > high { to } else { high };
            }
        }
        let any = low <= levels.first() && high >= levels.last();
        let deviation = if any { f32::INFINITY } else { (high - low) / (2.0 * 1.959_964) };
        Some(Estimate { level, deviation, interval: [low, high], residual: crate::Scalar::sqrt(variance) })
    }
}

/// A sum of squares over a cell: c − 2·b·x + a·x², x from 0 at its lower level to 1 at its upper one.
struct Parabola {
    a: f32,
    b: f32,
    c: f32,
    /// Only the ends count, see [`Lookup::mixed`](crate::table::Lookup::mixed).
    is_mixed: bool,
}

impl Parabola {
    fn of(lower: &Sums, upper: &Sums, is_mixed: bool) -> Self {
        let a = lower.squares - 2.0 * lower.products + upper.squares;
        // A sum of squares, but for rounding.
        Self { a: if a > 0.0 { a } else { 0.0 }, b: lower.squares - lower.products, c: lower.squares, is_mixed }
    }

    fn value(&self, x: f32) -> f32 {
        let value = self.c + x * (self.a * x - 2.0 * self.b);
        if value > 0.0 { value } else { 0.0 }
    }

    /// Where it is least, within the cell.
    fn lowest(&self) -> f32 {
        if self.is_mixed {
            // The upper end is 2·b − a lower than the other.
            if self.a < 2.0 * self.b { 1.0 } else { 0.0 }
        } else if self.b <= 0.0 {
            0.0
        } else if self.b < self.a {
            self.b / self.a
        } else {
            1.0
        }
    }

    /// Where it is at most `limit`, within the cell.
    fn below(&self, limit: f32) -> Option<[f32; 2]> {
        let lowest = self.lowest();
        if self.value(lowest) > limit {
            return None;
        }
        Some([0.0, 1.0].map(|end| self.crossing(lowest, end, limit)))
    }

    /// Where it crosses `limit` on the way from `inside` to `end`; `end` if it does not. One copy in the code serves both ends.
    #[inline(never)]
    fn crossing(&self, mut inside: f32, end: f32, limit: f32) -> f32 {
        if self.value(end) <= limit {
            return end;
        }
        if self.is_mixed {
            return inside;
        }
        let mut outside = end;
        for _ in 0..20 {
            let middle = 0.5 * (inside + outside);
            if self.value(middle) <= limit {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        outside
    }
}

#[cfg(test)]
mod tests;
