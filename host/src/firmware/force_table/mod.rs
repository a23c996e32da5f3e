//! Force tables: runs at many tolerance levels on the grid of a flash table, with its interpolation error measured.
//!
//! A table is over level and [`time`], or over level and [`position`], or over level, position and commanded speed.

mod grid;
mod passage;
pub mod position;
mod reach;
mod table;
pub mod time;

use crate::setup::LevelRange;

pub use table::{Demand, ForceTable, TableError};
pub use time::{check, make};

/// Samples of a run from one node of the finest table to the next; those between serve the error only.
const SUBSAMPLES: usize = 4;

/// The levels (or speeds) that a table needs: those of its axis with one half way between each two, which only serve the
/// error.
pub fn levels(axis: &LevelRange) -> LevelRange {
    LevelRange { first: axis.first, step: axis.step / 2.0, count: 2 * axis.count - 1 }
}
