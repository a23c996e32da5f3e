//! What can be wrong with a record, and where.

use std::io;

use slipfit_measured::csv::{CsvError, FileError, Place};
use slipfit_tolerance::number::ten_digits;

/// A record that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The system does not give the file.
    #[error("{name}: {error}")]
    Io {
        /// The file.
        name: String,
        /// Why.
        error: io::Error,
    },
    /// The text is wrong.
    #[error("{name}:{}:{}: {}", error.place.line, error.place.column, error.problem)]
    Csv {
        /// The file.
        name: String,
        /// What, and where.
        error: Box<CsvError>,
    },
    /// The numbers are wrong.
    #[error("{name}:{}:{}: {problem}", place.line, place.column)]
    Content {
        /// The file.
        name: String,
        /// Where.
        place: Place,
        /// What.
        problem: RecordProblem,
    },
}

impl RecordError {
    pub(super) fn of_file(name: &str, error: FileError) -> Self {
        let name = name.to_owned();
        match error {
            FileError::Io(error) => Self::Io { name, error },
            FileError::Csv(error) => Self::Csv { name, error: Box::new(error) },
        }
    }
}

/// What is wrong with the numbers of a record.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordProblem {
    /// A column that the fit needs.
    #[error("there is no column for {role}; {hint}")]
    Missing {
        /// What for, such as "the time".
        role: &'static str,
        /// What to do.
        hint: &'static str,
    },
    /// Too few samples.
    #[error("the record has {found} samples, and a fit needs at least {least}")]
    Few {
        /// Samples.
        found: usize,
        /// The fewest allowed.
        least: usize,
    },
    /// A time that is not after the one before.
    #[error("the time is {} s, not after the {} s of the row before; times must increase", ten_digits(*time), ten_digits(*before))]
    NotIncreasing {
        /// Time (s).
        time: f64,
        /// The time before (s).
        before: f64,
    },
    /// Samples that are missing.
    #[error(
        "the record has a gap from {} to {} s, and its other samples are {} s apart; cut it there into two records",
        ten_digits(*before), ten_digits(*time), ten_digits(*step)
    )]
    Gap {
        /// Time before the gap (s).
        before: f64,
        /// Time after the gap (s).
        time: f64,
        /// The usual interval (s).
        step: f64,
    },
    /// Samples at unequal intervals.
    #[error("the sample at {} s is {} s off a grid of {} s; samples must be at equal intervals", ten_digits(*time), ten_digits(*off), ten_digits(*step))]
    Uneven {
        /// Time (s).
        time: f64,
        /// Distance from the grid (s).
        off: f64,
        /// Mean interval (s).
        step: f64,
    },
    /// A column of one number only.
    #[error("{role} is {} in every row, which determines nothing", ten_digits(*value))]
    Constant {
        /// What the column is for.
        role: &'static str,
        /// The number (SI).
        value: f64,
    },
    /// A current without what turns it into a force.
    #[error(
        "the column gives {role}, and nothing says which force it makes; state force_constant, such as \"12 N/A\" or \"35 N/V\""
    )]
    NoForceConstant {
        /// What the column is for.
        role: &'static str,
    },
}
