//! The fit: bounded Levenberg–Marquardt with a robust loss from several starts, or a grid where the model jumps.

mod bounds;
pub mod grid;
mod least_squares;
pub mod loss;
mod search;

use serde::Serialize;

pub use self::least_squares::Cost;
pub use self::loss::Loss;
pub use self::search::{Options, fit};

/// How a fit ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Estimates of the parameters.
    pub values: Vec<f64>,
    /// Computed output at the estimate.
    pub output: Vec<f64>,
    /// Measured minus computed.
    pub residuals: Vec<f64>,
    /// Derivatives of the output by each parameter.
    pub sensitivities: Vec<Vec<f64>>,
    /// Standard deviation of the residuals, by their median where the loss is robust.
    pub scale: f64,
    /// Loss with which it was found.
    pub loss: Loss,
    /// How it was found.
    pub by: By,
}

/// What found an estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum By {
    /// Levenberg–Marquardt.
    Gradient,
    /// The best point of a grid that was refined: the output jumps with the parameters.
    Grid,
}
