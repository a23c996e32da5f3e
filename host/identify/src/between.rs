//! Estimates of several units: their mean, and how much the units differ.

use serde::Serialize;
use slipfit_measured::numeric::tails::student_quantile_above;

use crate::estimate::{Estimate, Estimated};

/// A parameter over several units, SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Between {
    /// Its name.
    pub name: String,
    /// The symbol of its unit; empty for a plain number.
    pub unit: &'static str,
    /// Units whose records determine it.
    pub units: usize,
    /// Mean of all units.
    pub mean: f64,
    /// Standard deviation of the mean.
    pub deviation: f64,
    /// Interval of 95 % for the mean.
    pub interval: [f64; 2],
    /// Standard deviation between units, beside the errors of their estimates.
    pub spread: f64,
}

/// Those of the `estimates` whose models explain their records, by their numbers; all where fewer than two do.
pub fn explained(estimates: &[&Estimate]) -> Vec<usize> {
    let all = 0..estimates.len();
    let explained: Vec<usize> = all.clone().filter(|k| estimates[*k].lack.verdict.is_none()).collect();
    if explained.len() > 1 { explained } else { all.collect() }
}

/// Each parameter that at least two of the [`explained`] `estimates` determine, in the order of the first.
pub fn between(estimates: &[&Estimate]) -> Vec<Between> {
    let estimates: Vec<&Estimate> = explained(estimates).into_iter().map(|k| estimates[k]).collect();
    let Some(first) = estimates.first() else { return Vec::new() };
    let of = |of_first: &Estimated| {
        let parameter = |estimate: &&Estimate| {
            let same = |own: &&Estimated| (&own.name, own.unit) == (&of_first.name, of_first.unit);
            let own = estimate.parameters.iter().find(same)?;
            // What is known beforehand alone is the same for all, and no record of theirs.
            own.deviation_by_autocovariance?;
            Some([own.value, own.deviation?])
        };
        let found: Vec<[f64; 2]> = estimates.iter().filter_map(parameter).collect();
        (found.len() > 1).then(|| pooled(of_first.name.clone(), of_first.unit, &found))
    };
    first.parameters.iter().filter_map(of).collect()
}

/// Values with their deviations, of units that differ: the spread by R. DerSimonian and N. Laird (1986), the deviation of the mean by
/// J. Hartung and G. Knapp (2001), no less than that of the estimates alone.
fn pooled(name: String, unit: &'static str, found: &[[f64; 2]]) -> Between {
    let count = found.len() as f64;
    let mean_of = |weights: &[f64]| {
        let sum: f64 = weights.iter().sum();
        (found.iter().zip(weights).map(|([value, _], weight)| weight * value).sum::<f64>() / sum, sum)
    };
    let scatter = |mean: f64, weights: &[f64]| -> f64 {
        found.iter().zip(weights).map(|([value, _], weight)| weight * (value - mean) * (value - mean)).sum()
    };
    // A deviation of zero would have an infinite weight.
    let least = found.iter().fold(f64::MIN_POSITIVE, |most, [_, deviation]| most.max(1e-9 * deviation));
    let variances: Vec<f64> = found.iter().map(|[_, deviation]| deviation.max(least) * deviation.max(least)).collect();
    let weights: Vec<f64> = variances.iter().map(|variance| 1.0 / variance).collect();
    let (mean, sum) = mean_of(&weights);
    let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
    let spread_square = ((scatter(mean, &weights) - (count - 1.0)) / (sum - squares / sum)).max(0.0);
    let weights: Vec<f64> = variances.iter().map(|variance| 1.0 / (variance + spread_square)).collect();
    let (mean, sum) = mean_of(&weights);
    let factor = (scatter(mean, &weights) / (count - 1.0)).max(1.0);
    let deviation = libm::sqrt(factor / sum);
    let reach = student_quantile_above(0.025, count - 1.0) * deviation;
    let interval = [mean - reach, mean + reach];
    Between { name, unit, units: found.len(), mean, deviation, interval, spread: libm::sqrt(spread_square) }
}

#[cfg(test)]
mod tests {
    use slipfit_core::sampling::stream::unit_stream;
    use slipfit_tolerance::failure::subset::normals;

    use super::pooled;

    #[test]
    fn equal_deviations_and_no_spread_give_the_mean_and_its_error() {
        let found: Vec<[f64; 2]> = [1.0, 1.1, 0.9, 1.0].map(|value| [value, 0.2]).into();
        let pooled = pooled(String::new(), "", &found);
        assert!((pooled.mean - 1.0).abs() < 1e-12 && pooled.spread == 0.0, "{pooled:?}");
        assert!((pooled.deviation - 0.1).abs() < 1e-12);
    }

    /// Ten units that differ by 0.3, each known to within 0.1 to 0.4.
    #[test]
    fn intervals_of_the_mean_hold_and_the_spread_is_found() {
        let (mut held, mut spreads) = (0, 0.0);
        for k in 0..1000 {
            let scores = normals(&mut unit_stream(k, 3), 20);
            let unit = |i: usize| {
                let deviation = 0.1 + 0.03 * i as f64;
                [5.0 + 0.3 * scores[i] + deviation * scores[10 + i], deviation]
            };
            let pooled = pooled(String::new(), "", &(0..10).map(unit).collect::<Vec<_>>());
            held += usize::from((pooled.interval[0]..=pooled.interval[1]).contains(&5.0));
            spreads += pooled.spread / 1000.0;
        }
        assert!((925..=975).contains(&held), "{held}");
        assert!((spreads - 0.28).abs() < 0.04, "{spreads}");
    }
}
