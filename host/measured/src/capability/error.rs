//! Why the capability of a column cannot be told.

use crate::families::FitError;

/// A column whose capability cannot be told.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CapabilityError {
    /// Too few parts for a standard deviation.
    #[error("\"{column}\" has {found} measured parts, but capability needs at least {least}")]
    FewParts {
        /// Name of the column.
        column: String,
        /// Parts that it needs.
        least: usize,
        /// Parts that there are.
        found: usize,
    },
    /// All values are the same.
    #[error("all {found} measured parts have \"{column}\" {value}; a finer reading is needed to tell its variation")]
    NoVariation {
        /// Name of the column.
        column: String,
        /// The value.
        value: f64,
        /// Parts.
        found: usize,
    },
    /// Values too far apart for numbers.
    #[error("the values of \"{column}\" differ by more than numbers hold")]
    TooFarApart {
        /// Name of the column.
        column: String,
    },
    /// A distribution that cannot be told.
    #[error("\"{column}\": {why}")]
    NoFigures {
        /// Name of the column.
        column: String,
        /// Why.
        why: FitError,
    },
    /// An index beyond the columns or groupings.
    #[error("there is no column or grouping {0}")]
    NoColumn(usize),
}
