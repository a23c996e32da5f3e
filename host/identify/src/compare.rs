//! Models of one record side by side.

use serde::Serialize;

use crate::{
    estimate::{Estimate, EstimateError, estimate},
    fit::Options,
    model::Model,
};

/// A model and what it makes of the record.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// Its name.
    pub name: String,
    /// How much worse it is than the best one, by G. Schwarz's criterion (1978) with the effective number of samples: above 10 decisively.
    pub behind: f64,
    /// What it makes of the record.
    #[serde(flatten)]
    pub estimate: Estimate,
}

/// Fits all `models`, of which there is at least one; they are in the order in which they are given.
///
/// # Errors
/// That of the first model without an estimate.
pub fn compare(models: &[(&str, &dyn Model)], options: &Options) -> Result<Vec<Compared>, EstimateError> {
    let estimates = models.iter().map(|(_, model)| estimate(*model, options)).collect::<Result<Vec<_>, _>>()?;
    // Residuals of the richest model are nearest to noise.
    let count = |estimate: &Estimate| estimate.parameters.len() - estimate.undetermined.len();
    let effective = estimates.iter().max_by_key(|estimate| count(estimate)).map_or(1.0, |of| of.effective_samples);
    let criterion = |estimate: &Estimate| {
        let squares: f64 = estimate.residuals.iter().map(|residual| residual * residual).sum();
        effective * libm::log(squares.max(f64::MIN_POSITIVE)) + count(estimate) as f64 * libm::log(effective.max(1.0))
    };
    let least = estimates.iter().map(criterion).fold(f64::INFINITY, f64::min);
    let of = |((name, _), estimate): (&(&str, _), Estimate)| {
        let behind = criterion(&estimate) - least;
        Compared { name: (*name).to_owned(), behind, estimate }
    };
    Ok(models.iter().zip(estimates).map(of).collect())
}

/// The best of the `compared` models.
pub fn best(compared: &[Compared]) -> Option<&Compared> {
    compared.iter().min_by(|a, b| a.behind.total_cmp(&b.behind))
}
