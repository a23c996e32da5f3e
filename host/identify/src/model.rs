//! What is fitted: parameters with bounds, and the output that a model computes for them.

use serde::Serialize;
use slipfit_system::parallel;

/// A parameter that is sought.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Its name, such as `friction.coefficient`.
    pub name: String,
    /// The symbol of its SI unit; empty for a plain number.
    pub unit: &'static str,
    /// The least and the greatest value; infinite for one without bounds.
    pub bounds: [f64; 2],
    /// Where the search starts.
    pub start: f64,
    /// Mean and standard deviation of what is known of it beforehand, if anything is.
    pub prior: Option<[f64; 2]>,
}

/// Why a model has no output for some parameters.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("with {values}: {why}")]
pub struct ModelError {
    /// The parameters.
    pub values: String,
    /// Why not.
    pub why: String,
}

/// A model of a record.
pub trait Model: Sync {
    /// What is sought.
    fn parameters(&self) -> &[Parameter];

    /// What was measured, sample by sample, all runs one after another.
    fn measured(&self) -> &[f64];

    /// The number of samples of each run; they add up to those measured.
    fn runs(&self) -> Vec<usize> {
        vec![self.measured().len()]
    }

    /// When (s) each of them was measured.
    fn times(&self) -> Vec<f64>;

    /// What should have been measured with these `values` of the parameters.
    ///
    /// # Errors
    /// [`ModelError`] where the model cannot be computed.
    fn simulate(&self, values: &[f64]) -> Result<Vec<f64>, ModelError>;

    /// The derivatives of the `output` for the `values` by each parameter, computed side by side by differences of a
    /// ten-thousandth of its scale.
    ///
    /// # Errors
    /// As [`simulate`](Self::simulate).
    fn sensitivities(&self, values: &[f64], output: &[f64]) -> Result<Vec<Vec<f64>>, ModelError> {
        let column = |i: &usize| {
            let (i, parameter) = (*i, &self.parameters()[*i]);
            let step = 1e-4 * parameter.scale(values[i]);
            // Away from the nearer bound.
            let step = if values[i] + step > parameter.bounds[1] { -step } else { step };
            let mut moved = values.to_vec();
            moved[i] += step;
            let moved = self.simulate(&moved)?;
            Ok(moved.iter().zip(output).map(|(moved, output)| (moved - output) / step).collect())
        };
        parallel::try_map(&Vec::from_iter(0..self.parameters().len()), column)
    }
}

impl Parameter {
    /// The size of a change that matters: a share of the bounds, or of the value where there are none.
    pub fn scale(&self, value: f64) -> f64 {
        let [low, high] = self.bounds;
        if self.is_bounded() { high - low } else { value.abs().max(self.start.abs()).max(1e-3) }
    }

    /// Whether it has two bounds.
    pub fn is_bounded(&self) -> bool {
        self.bounds.iter().all(|bound| bound.is_finite())
    }

    /// Whether `value` lies at one of the bounds, to a millionth of their distance.
    pub fn is_at_bound(&self, value: f64) -> bool {
        let [low, high] = self.bounds;
        self.is_bounded() && (value - low).min(high - value) <= 1e-6 * (high - low)
    }

    /// `value` with the parameter's unit.
    pub fn written(&self, value: &str) -> String {
        format!("{value} {}", self.unit).trim_end().to_owned()
    }
}
