//! Lack of fit: whether the residuals are noise, or something that the model does not know.

use serde::Serialize;

use crate::signal::noise::split;

/// Share of the measured force, about zero, beyond which correlated residuals are more than noise.
const GREAT_ERROR: f64 = 0.1;
/// Lag-1 correlation beyond which residuals are correlated.
const CORRELATED: f64 = 0.5;
/// How much greater the error of a part that was held out may be.
const HELD_OUT_RATIO: f64 = 1.5;

/// What the residuals say of the model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lack {
    /// Root of the residuals' squares over that of the measured values.
    pub relative_error: f64,
    /// Correlation of neighbouring residuals.
    pub lag_1_correlation: f64,
    /// Relative error in the last quarter, for the estimate from the rest.
    pub held_out_error: Option<f64>,
    /// Why the model does not explain the record; `None` where nothing speaks against it.
    pub verdict: Option<String>,
}

impl Lack {
    /// Of `residuals` of what was `measured`, in runs of these lengths; `held_out_error` of the part held out, if one was.
    pub fn new(measured: &[f64], residuals: &[f64], runs: &[usize], held_out_error: Option<f64>) -> Self {
        let relative_error = relative(residuals, measured);
        let lag_1_correlation = lag_1(residuals, runs);
        let mut reasons = Vec::new();
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        if relative_error > GREAT_ERROR && lag_1_correlation > CORRELATED {
            reasons.push(format!(
                "its residuals are {} of the force and follow each other (lag-1 correlation {lag_1_correlation:.2}), so they are not \
                 noise",
                percent(relative_error)
            ));
        }
        if let Some(error) = held_out_error
            && error > HELD_OUT_RATIO * relative_error.max(0.1 * GREAT_ERROR)
        {
            reasons.push(format!(
                "in the part that was held out its error is {}, and {} where it was fitted",
                percent(error),
                percent(relative_error)
            ));
        }
        let verdict = (!reasons.is_empty()).then(|| reasons.join("; "));
        Self { relative_error, lag_1_correlation, held_out_error, verdict }
    }
}

/// Root of the sum of the squares of `residuals` over that of the `measured` values.
pub fn relative(residuals: &[f64], measured: &[f64]) -> f64 {
    let squares = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    libm::sqrt(squares(residuals) / squares(measured).max(f64::MIN_POSITIVE))
}

/// Correlation of neighbouring residuals within runs of these lengths.
pub fn lag_1(residuals: &[f64], runs: &[usize]) -> f64 {
    let squares: f64 = residuals.iter().map(|residual| residual * residual).sum();
    let products: f64 =
        split(residuals, runs).flat_map(|run| run.windows(2).map(|pair| pair[0] * pair[1]).collect::<Vec<_>>()).sum();
    products / squares.max(f64::MIN_POSITIVE)
}
