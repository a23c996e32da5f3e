//! Why there is no watch by a production.

use crate::{ParameterError, table::TableError};

/// Why there is no watch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ProductionError {
    /// There is no table of a production.
    Table(TableError),
    /// The false-alarm rate is out of bounds.
    Parameter(ParameterError<f32>),
}

impl From<TableError> for ProductionError {
    fn from(error: TableError) -> Self {
        Self::Table(error)
    }
}

impl From<ParameterError<f32>> for ProductionError {
    fn from(error: ParameterError<f32>) -> Self {
        Self::Parameter(error)
    }
}

impl core::fmt::Display for ProductionError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Table(error) => write!(f, "no table of a production: {error}"),
            Self::Parameter(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ProductionError {}
