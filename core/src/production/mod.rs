//! What a controller knows of its own unit: the force that the units of a production need, and what the first strokes of this one add.
//!
//! A table of a production has the rows of [`Row`] over time or position: the mean of all units that complete their stroke, how far
//! they are from it, and the modes in which they differ. A unit is the mean and a multiple of each mode. Its first strokes tell
//! the multiples ([`Unit`]); from then on its force is known before each stroke, and a [`Watch`] compares what is measured with it.
//! How often that gives a false alarm is stated, and the limits follow from the production.
//!
//! ```
//! # use slipfit_core::production::{Production, ProductionError, Sample, Unit, Watch};
//! # fn strokes(region: &[u8], hash: u64) -> Result<(), ProductionError> {
//! let production = Production::open(region)?.expect_scene(hash)?;
//! let watch = Watch::new(production, 1e-3)?; // parameters: one false alarm in a thousand strokes
//! let mut unit = Unit::default(); // what is known of the unit; saved between strokes
//! let mut stroke = watch.start(); // state of one stroke
//! let sample = Sample { at: 0.3, force: 0.25, speed: 0.01, command: 0.02 };
//! let report = watch.step(&unit, &mut stroke, &sample); // each period; report.expected is the force
//! let end = watch.finish(&mut unit, &stroke); // after the stroke: what it says of the unit's friction
//! # Ok(()) }
//! ```

mod drift;
mod error;
mod record;
mod saved;
mod step;
mod stroke;
#[cfg(test)]
mod tests;
mod unit;
mod watch;

pub use drift::{Drift, Line, Trend};
pub use error::ProductionError;
pub use record::{MODES_MOST, RATES, Record};
pub use saved::{SAVED_SIZE, SavedError};
pub use step::HOLD;
pub use stroke::{Report, Sample, Stroke};
pub use unit::Unit;
pub use watch::{RATE_LEAST, RATE_MOST, StrokeEnd, Watch};

use crate::table::{AnyNodes, Axis, AxisKind, F32Nodes, I16Nodes, Nodes, Place, Table, TableError};

/// The rows of the table; the discriminant is the node of the first axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum Row {
    /// Mean over the units.
    Mean = 0,
    /// By how much their strokes may exceed the mean: about what one in two hundred does at a place or near it.
    Above = 1,
    /// By how much they may stay below it, likewise.
    Below = 2,
    /// By how much strokes of taught units may exceed what is expected of them, in the direction of the drive.
    Taught = 3,
    /// What the force of a stroke is weighted with, so that its sum tells the friction (no unit).
    Weight = 4,
    /// The first mode: what is added to the mean for a coefficient of 1. The others follow.
    Mode = 5,
}

/// Places between samples of more than so many nodes make a stroke unfit to learn from.
const GAP_NODES: f32 = 4.0;

/// A checked table of a production in the region it was opened from.
#[derive(Clone, Copy, Debug)]
pub struct Production<'a, V = AnyNodes<'a>> {
    table: Table<'a, 2, V>,
    record: Record,
    modes: usize,
}

impl<'a> Production<'a> {
    /// Checks the table that `region` starts with completely. Any single flipped bit is refused.
    ///
    /// # Errors
    /// [`TableError`] says what is wrong, for a table of no production too.
    pub fn open(region: &'a [u8]) -> Result<Self, TableError> {
        Self::new(Table::open(region)?)
    }

    /// The production of an open `table`.
    ///
    /// # Errors
    /// [`TableError`], if it is the table of no production.
    pub fn new(table: Table<'a, 2>) -> Result<Self, TableError> {
        let [rows, places] = table.axes();
        let asked = if places.kind() == AxisKind::Position { AxisKind::Position } else { AxisKind::Time };
        let modes = rows.count().saturating_sub(Row::Mode as usize);
        let table = table.expect_axes([AxisKind::Row, asked])?;
        if modes > MODES_MOST || rows.count() < Row::Mode as usize {
            return Err(TableError::Header("number of rows"));
        }
        let record = Record::read(table.production())?;
        Ok(Self { table, record, modes })
    }

    /// The same, if its values are i16.
    pub fn i16(self) -> Option<Production<'a, I16Nodes<'a>>> {
        let Self { table, record, modes } = self;
        Some(Production { table: table.i16()?, record, modes })
    }

    /// The same, if its values are f32.
    pub fn f32(self) -> Option<Production<'a, F32Nodes<'a>>> {
        let Self { table, record, modes } = self;
        Some(Production { table: table.f32()?, record, modes })
    }
}

impl<'a, V: Nodes> Production<'a, V> {
    /// This production, if it was made for the scene and laws that `hash` stands for.
    ///
    /// # Errors
    /// [`TableError::Scene`] if it was made for others.
    pub fn expect_scene(self, hash: u64) -> Result<Self, TableError> {
        Ok(Self { table: self.table.expect_scene(hash)?, ..self })
    }

    /// This production, if it is over time or position as asked for: a place is a bare number.
    ///
    /// # Errors
    /// [`TableError::Kind`] if it is over the other.
    pub fn expect_over(self, kind: AxisKind) -> Result<Self, TableError> {
        Ok(Self { table: self.table.expect_axes([AxisKind::Row, kind])?, ..self })
    }

    /// Its table.
    pub fn table(&self) -> &Table<'a, 2, V> {
        &self.table
    }

    /// How it was calibrated.
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// How many modes it has, at most [`MODES_MOST`].
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// Time (s) or position (m).
    pub fn places(&self) -> &Axis {
        &self.table.axes()[1]
    }

    /// Force and velocity (N, m/s) of a row at `at`, and of the nearest end outside of the axis.
    pub fn row(&self, row: usize, at: f32) -> Option<[f32; 2]> {
        let rows = Row::Mode as usize + self.modes;
        (row < rows).then(|| self.table.of_row(row, &self.places().locate(at)))
    }

    /// Force (N) at `at` that 99 % of the units which complete their stroke stay within, all along it: least and greatest.
    pub fn band(&self, at: f32) -> [f32; 2] {
        let place = self.places().locate(at);
        let [mean, above, below] = [Row::Mean, Row::Above, Row::Below].map(|row| self.force(row as usize, &place));
        [mean - self.record.band * below, mean + self.record.band * above]
    }

    #[inline(always)]
    fn force(&self, row: usize, place: &Place) -> f32 {
        let [force, _] = self.table.of_row(row, place);
        force
    }
}
