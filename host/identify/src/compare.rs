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

/// A model without an estimate, and why there is none.
pub type Refused<'m> = (&'m str, EstimateError);

/// Fits all `models`; those with an estimate and those without, in the order in which they are given.
pub fn compare<'m>(models: &[(&'m str, &dyn Model)], options: &Options) -> (Vec<Compared>, Vec<Refused<'m>>) {
    let (mut estimates, mut refused) = (Vec::new(), Vec::new());
    for (name, model) in models {
        match estimate(*model, options) {
            Ok(estimate) => estimates.push((*name, estimate)),
            Err(error) => refused.push((*name, error)),
        }
    }
    // Residuals of the richest model are nearest to noise.
    let count = |estimate: &Estimate| estimate.parameters.len() - estimate.undetermined.len();
    let richest = estimates.iter().max_by_key(|(_, estimate)| count(estimate));
    let effective = richest.map_or(1.0, |(_, estimate)| estimate.effective_samples);
    let criterion = |estimate: &Estimate| {
        let squares: f64 = estimate.residuals.iter().map(|residual| residual * residual).sum();
        effective * libm::log(squares.max(f64::MIN_POSITIVE)) + count(estimate) as f64 * libm::log(effective.max(1.0))
    };
    let least = estimates.iter().map(|(_, estimate)| criterion(estimate)).fold(f64::INFINITY, f64::min);
    let compared = estimates
        .into_iter()
        .map(|(name, estimate)| Compared { name: name.to_owned(), behind: criterion(&estimate) - least, estimate })
        .collect();
    (compared, refused)
}

/// The best of the `compared` models.
pub fn best(compared: &[Compared]) -> Option<&Compared> {
    compared.iter().min_by(|a, b| a.behind.total_cmp(&b.behind))
}
