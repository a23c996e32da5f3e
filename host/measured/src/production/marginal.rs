//! A fitted family as a distribution to draw from.

use slipfit_tolerance::model::Distribution;

use crate::families::{Family, Kind};

/// Values of a table that stands for a family without a distribution of its own to draw from.
const VALUES: usize = 4001;
/// Normal score beyond which such a table does not reach.
const REACH: f64 = 4.5;

/// The `family`, which is of this `kind`.
pub fn of_family(kind: Kind, family: &dyn Family) -> Distribution {
    let parameters: Vec<f64> = family.parameters().into_iter().map(|(_, value)| value).collect();
    match (kind, parameters.as_slice()) {
        (Kind::Normal, &[mean, deviation]) => Distribution::Normal { mean, deviation },
        (Kind::Weibull | Kind::ShiftedWeibull, &[location, scale, shape]) => {
            Distribution::Weibull { shape, scale, location }
        }
        (Kind::Lognormal | Kind::ShiftedLognormal, &[shift, mean, deviation]) => {
            // The moments of e^X.
            let square = deviation * deviation;
            let (growth, middle) = (libm::expm1(square), libm::exp(mean + 0.5 * square));
            let root = libm::sqrt(growth);
            Distribution::Skewed { mean: shift + middle, deviation: middle * root, skewness: (growth + 3.0) * root }
        }
        (Kind::TwoNormals, &[share, mean_1, deviation_1, mean_2, deviation_2]) => {
            let normal = |mean, deviation| Distribution::Normal { mean, deviation };
            Distribution::Mixture(vec![
                (share, normal(mean_1, deviation_1)),
                (1.0 - share, normal(mean_2, deviation_2)),
            ])
        }
        _ => {
            let last = (VALUES - 1) as f64;
            let value = |i: usize| match i {
                0 => family.value(-REACH),
                i if i + 1 == VALUES => family.value(REACH),
                i => family.quantile(i as f64 / last),
            };
            Distribution::Table((0..VALUES).map(value).collect())
        }
    }
}
