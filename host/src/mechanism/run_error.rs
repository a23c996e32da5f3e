//! Why a unit of a mechanism has no run.

use slipfit_core::ParameterError;
use thiserror::Error;

use super::{MountError, spatial};
use crate::dynamics::{error_control::Stopped, simulate::SimulateError};

/// Why a unit has no run.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RunError {
    /// A unit for co-simulation cannot have this.
    #[error(
        "a co-simulation unit cannot have {0}: it sets gaps, gains and commands itself; take `simulate`, or a kernel"
    )]
    NoUnit(String),
    /// A kernel cannot have this.
    #[error("a kernel cannot have {0}; `simulate`, `sweep`, `population` and `table` can")]
    NoKernel(String),
    /// The joints are no tree.
    #[error(transparent)]
    Mounts(#[from] MountError),
    /// More bodies than there is room for.
    #[error("a mechanism in space has {0} bodies, allowed are 1 to {most}", most = spatial::MOST)]
    Bodies(usize),
    /// The integration did not come to its end.
    #[error("{stopped}{}", cause(.stopped))]
    Stopped {
        /// Why.
        #[from]
        stopped: Stopped,
    },
}

/// What may have stopped the integration of a mechanism.
fn cause(stopped: &Stopped) -> &'static str {
    if matches!(stopped, Stopped::Unsolved(_)) { ": the contacts may be too stiff for their masses" } else { "" }
}

impl From<RunError> for SimulateError {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Stopped { stopped } => stopped.into(),
            bad => Self::Parameter(bad.to_string()),
        }
    }
}

impl From<ParameterError<f64>> for RunError {
    fn from(error: ParameterError<f64>) -> Self {
        Self::Stopped { stopped: error.into() }
    }
}
