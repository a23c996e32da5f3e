//! Records: what a drive measured over time, in SI units, checked.

mod check;
mod columns;
mod error;
mod read;
#[cfg(test)]
mod tests;

pub use self::columns::{Columns, ForceConstant};
pub use self::error::{RecordError, RecordProblem};
pub use self::read::{Needs, read, read_file};

/// A record of one run, sampled at equal intervals. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// What it is called in messages, such as the name of its file.
    pub name: String,
    /// Time of the first sample (s).
    pub start: f64,
    /// Interval of the samples (s), positive.
    pub step: f64,
    /// Number of samples.
    pub samples: usize,
    /// Position (m) of each sample.
    pub position: Option<Vec<f64>>,
    /// Speed (m/s) of each sample.
    pub speed: Option<Vec<f64>>,
    /// Force (N) of each sample.
    pub force: Option<Vec<f64>>,
}

impl Record {
    /// How long it lasts (s).
    pub fn duration(&self) -> f64 {
        self.step * (self.samples - 1) as f64
    }
}
