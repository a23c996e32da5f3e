//! Why a command ends without having done its work.

use slipfit_identify::{estimate::EstimateError, record::RecordError};
use slipfit_system::files::{Coincidence, WriteError};
use slipfit_tolerance::counting::{run::RunError, study::StudyError};
use thiserror::Error;

use crate::{dynamics::simulate::SimulateError, firmware::force_table::TableError, scene::SceneError};

/// Why a command did not do its work.
#[derive(Debug, Error)]
pub enum Failure {
    /// A scene that cannot be read as one.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// Other bad input.
    #[error("{0}")]
    Input(String),
    /// The work itself failed.
    #[error("{0:#}")]
    Work(#[from] anyhow::Error),
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::Work(error.into())
    }
}

impl From<Coincidence> for Failure {
    fn from(error: Coincidence) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<SimulateError> for Failure {
    fn from(error: SimulateError) -> Self {
        match error {
            SimulateError::Parameter(_) | SimulateError::Every { .. } => Self::Input(error.to_string()),
            SimulateError::NotFinite { .. } | SimulateError::Unsolved { .. } | SimulateError::Interrupted => {
                Self::Work(error.into())
            }
        }
    }
}

impl From<RecordError> for Failure {
    fn from(error: RecordError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<EstimateError> for Failure {
    fn from(error: EstimateError) -> Self {
        match error {
            EstimateError::Model(_) => Self::Work(error.into()),
            EstimateError::NoInfluence(_) | EstimateError::Grid(_) | EstimateError::Few { .. } => {
                Self::Input(error.to_string())
            }
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Interrupted { .. }
            | RunError::Study(StudyError::Interrupted)
            | RunError::Write(_)
            | RunError::Header(_)
            | RunError::Work(_) => Self::Work(error.into()),
            bad => Self::Input(bad.to_string()),
        }
    }
}

impl From<TableError> for Failure {
    fn from(error: TableError) -> Self {
        match error {
            TableError::Simulate(error) => error.into(),
            TableError::Flash(_) | TableError::MaxError { .. } | TableError::Position(_) => {
                Self::Input(error.to_string())
            }
        }
    }
}

/// A path that was given for output and cannot be written is bad input while nothing has been done yet.
pub fn refused(error: WriteError) -> Failure {
    Failure::Input(error.to_string())
}
