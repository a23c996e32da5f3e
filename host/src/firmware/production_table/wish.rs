//! What a table of a production is to be, and why there is none.

use thiserror::Error;

use super::samples::Over;
use crate::{dynamics::simulate::SimulateError, firmware::flash::FlashError};

/// The fewest units that complete their stroke of which there is a table.
pub const UNITS_LEAST: usize = 100;

/// What a table of a production is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// What it is over.
    pub over: Over,
    /// Units to simulate.
    pub units: u64,
    /// Seed of the friction of strokes and of the noise.
    pub seed: u64,
    /// Standard deviation of the white noise of a measured force, as a share of the greatest mean force.
    pub noise: f64,
    /// Standard deviation of the friction of a unit from stroke to stroke, as a share of it.
    pub friction: f64,
    /// Interval (s) of the controller's samples.
    pub period: f64,
    /// Its greatest size (bytes).
    pub bytes: usize,
}

/// Why there is no table of a production.
#[derive(Debug, Error)]
pub enum ProductionTableError {
    /// Too few units complete their stroke.
    #[error(
        "{complete} of {units} units complete their stroke; a table of the production takes at least {UNITS_LEAST}"
    )]
    TooFew {
        /// How many complete it.
        complete: usize,
        /// How many were simulated.
        units: u64,
    },
    /// The strokes are over before there is anything to tell.
    #[error("the shortest stroke is over at {end}, before the drive has started at {start} (s, or m over position)")]
    TooShort {
        /// Where the drive starts (s, m).
        start: f64,
        /// Where the shortest stroke is over.
        end: f64,
    },
    /// Too small.
    #[error("--bytes is {bytes}, the rows of a production take at least {least}")]
    Bytes {
        /// The size asked for.
        bytes: usize,
        /// The least.
        least: usize,
    },
    /// It has no place in the format.
    #[error(transparent)]
    Flash(#[from] FlashError),
    /// A run failed.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}
