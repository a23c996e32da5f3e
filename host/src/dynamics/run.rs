//! A finished run, what computed it, and why a run may not finish.

use std::time::Duration;

use serde::Serialize;
use slipfit_core::ParameterError;
use slipfit_tolerance::number::ten_digits;
use thiserror::Error;

use super::{
    audit::Audit,
    error_control::{Effort, Stopped},
    outcome::Outcome,
    scheme::ScalarKind,
    trajectory::Trajectory,
    trust::Trust,
};

/// What computed a run, and what it took.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Solved {
    /// "desk" or "controller".
    pub by: &'static str,
    /// Scheme.
    pub integrator: &'static str,
    /// Number type.
    pub scalar: ScalarKind,
    /// Step (s) of a controller.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_s: Option<f64>,
    /// Error of force (N) that a step of the desk may make.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance_n: Option<f64>,
    /// Error of speed (m/s) that a step of the desk may make, for mechanisms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance_m_per_s: Option<f64>,
    /// Stick band (m/s) that stands for true stick at the desk; exact friction only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stick_band_m_per_s: Option<f64>,
    /// Steps.
    #[serde(flatten)]
    pub effort: Effort,
    /// Worst imbalance (N·s) that a step was left with.
    pub worst_residual: f64,
}

/// `x` rounded to nine digits, so that products are shown as they are meant.
fn nine_digits(x: f64) -> f64 {
    format!("{x:.8e}").parse().unwrap_or(x)
}

impl Solved {
    /// How the run was computed, in words.
    pub fn describe(&self) -> String {
        let Effort { accepted, refused } = self.effort;
        let tolerance = match (self.tolerance_n, self.tolerance_m_per_s) {
            (Some(force), _) => Some(format!("{:e} N", nine_digits(force))),
            (None, Some(speed)) => Some(format!("{speed:.1e} m/s")),
            (None, None) => None,
        };
        match tolerance {
            Some(tolerance) => format!(
                "the desk, error-controlled to {tolerance} a step ({}, {accepted} steps, {refused} refused)",
                self.integrator
            ),
            None => format!(
                "the controller, in {accepted} steps of {} µs ({}, {})",
                ten_digits(self.step_s.unwrap_or_default() * 1e6),
                self.integrator,
                self.scalar.name()
            ),
        }
    }
}

/// A finished run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Samples.
    pub trajectory: Trajectory,
    /// Figures.
    pub outcome: Outcome,
    /// What computed it.
    pub solved: Solved,
    /// The energy account, if asked for.
    pub audit: Option<Audit>,
    /// How far the run can be trusted.
    pub trust: Trust,
    /// Wall time of the integration alone.
    pub integration: Duration,
}

/// Why a run did not finish.
#[derive(Debug, Error)]
pub enum SimulateError {
    /// A parameter is out of bounds.
    #[error("{0}")]
    Parameter(String),
    /// Samples do not fall on steps.
    #[error("samples every {every} s do not fall on steps of {step} s: --every has to be a multiple of the step")]
    Every {
        /// Interval of the samples (s).
        every: f64,
        /// Step (s).
        step: f64,
    },
    /// The motion left the range of the number type.
    #[error("the motion left the finite range at t = {time} s: take a smaller step than {step} s")]
    NotFinite {
        /// When (s).
        time: f64,
        /// Step (s).
        step: f64,
    },
    /// No step is short enough.
    #[error(
        "no step from t = {time} s on meets the tolerance, however short: look at gaps, stiffness and friction, \
         or allow a greater run.error"
    )]
    Unsolved {
        /// When (s).
        time: f64,
    },
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl<S: std::fmt::Display> From<ParameterError<S>> for SimulateError {
    fn from(error: ParameterError<S>) -> Self {
        Self::Parameter(error.to_string())
    }
}

impl From<Stopped> for SimulateError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Parameter(what) => Self::Parameter(what),
            Stopped::Unsolved(time) => Self::Unsolved { time },
            Stopped::NotFinite { time, step } => Self::NotFinite { time, step },
            Stopped::Interrupted => Self::Interrupted,
        }
    }
}
