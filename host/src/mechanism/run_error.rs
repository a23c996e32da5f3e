//! Why a unit of a mechanism has no run.

use slipfit_core::ParameterError;
use thiserror::Error;

use super::{MountError, spatial};
use crate::dynamics::{error_control::Stopped, simulate::SimulateError};

/// Why a unit has no run.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RunError {
    /// The joints are no tree.
    #[error(transparent)]
    Mounts(#[from] MountError),
    /// More bodies than there is room for.
    #[error("a mechanism in space has {0} bodies, allowed are 1 to {most}", most = spatial::MOST)]
    Bodies(usize),
    /// A parameter that core refuses.
    #[error("{0}")]
    Parameter(String),
    /// No step from this time (s) on meets the tolerance.
    #[error(
        "from t = {0} s on no step meets the tolerance, however short: the contacts may be too stiff for their masses"
    )]
    Unsolved(f64),
    /// The motion left the finite range.
    #[error("the motion left the finite range at t = {time} s: take a smaller step than {step} s")]
    NotFinite {
        /// When (s).
        time: f64,
        /// Step (s).
        step: f64,
    },
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl From<RunError> for SimulateError {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Unsolved(time) => Self::Unsolved { time },
            RunError::NotFinite { time, step } => Self::NotFinite { time, step },
            RunError::Interrupted => Self::Interrupted,
            bad => Self::Parameter(bad.to_string()),
        }
    }
}

impl From<ParameterError<f64>> for RunError {
    fn from(error: ParameterError<f64>) -> Self {
        Self::Parameter(error.to_string())
    }
}

impl From<Stopped> for RunError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Parameter(what) => Self::Parameter(what),
            Stopped::Unsolved(t) => Self::Unsolved(t),
            Stopped::NotFinite { time, step } => Self::NotFinite { time, step },
            Stopped::Interrupted => Self::Interrupted,
        }
    }
}
