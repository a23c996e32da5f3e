//! What is known of a finished run.

use std::time::Duration;

use slipfit_core::integrator::{Integrator, Rodas4};

use super::{BodyMotion, sunk::Sunk};
use crate::dynamics::{error_control, outcome::Outcome, scheme::ScalarKind, simulate::Solved, trajectory::Trajectory};

/// The scheme by which the desk integrates.
pub const SCHEME: &str = Rodas4::NAME;

/// What is told of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Names with units.
    pub columns: Vec<String>,
    /// Values, one row a sample.
    pub rows: Vec<Vec<f64>>,
}

/// Where all bodies are at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// When (s).
    pub t: f64,
    /// How each body has moved.
    pub motions: Vec<BodyMotion>,
    /// What each drive gives (N, N·m).
    pub efforts: Vec<f64>,
}

/// A finished run.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanismRun {
    /// Samples.
    pub samples: Samples,
    /// Figures of each drive: forces and travel along its axis, or torques and angles about it.
    pub outcomes: Vec<Outcome>,
    /// What each drive does over time, likewise; x and y are its body's.
    pub trajectories: Vec<Trajectory>,
    /// Moments that show the motion, from rest to the end; none unless [`super::film`] asks for them.
    pub film: Vec<Moment>,
    /// Energy that neither the start, nor gravity, nor a drive supplied, as a share of the greatest energy: an error of the computation.
    pub energy_excess: f64,
    /// The contact that yielded most beyond what is usual, if one did at the desk.
    pub sunk: Option<Sunk>,
    /// Error of speed (m/s) that a step was allowed.
    pub tolerance: f64,
    /// The same as a share of the mechanism's own speed: the key run.error, or less where a finer run was needed.
    pub error: f64,
    /// Steps.
    pub effort: error_control::Effort,
    /// Time of the integration, with what is recorded after each step.
    pub integration: Duration,
}

impl MechanismRun {
    /// What computed it.
    pub fn solved(&self) -> Solved {
        Solved {
            by: "desk",
            integrator: SCHEME,
            scalar: ScalarKind::F64,
            step_s: None,
            tolerance_n: None,
            tolerance_m_per_s: Some(self.tolerance),
            stick_band_m_per_s: None,
            effort: self.effort,
            worst_residual: 0.0,
        }
    }
}
