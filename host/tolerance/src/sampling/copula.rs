//! Correlations of values and those of the normal scores behind them.
//!
//! Contributors are correlated by a Gaussian copula: their scores are jointly normal. With the Hermite coefficients aₖ of a
//! value as a function of its score, the covariance of two values whose scores have correlation r is Σ aₖ·bₖ·rᵏ (Mehler);
//! ranks have 6/π·asin(r/2). (Nataf 1962; Liu and Der Kiureghian 1986.)

use std::f64::consts::PI;

use crate::{distribution::Marginal, distribution::quadrature::scores, model::Distribution};

/// Terms of the series.
const TERMS: usize = 80;
/// Pieces a standard deviation: mixtures of lots that lie far apart jump.
const PIECES: u32 = 16;
/// Halvings of the interval that a correlation of scores lies in.
const HALVINGS: usize = 60;

/// What a stated coefficient of correlation is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coefficient {
    /// Of the values, Pearson's.
    Values,
    /// Of their ranks, Spearman's.
    Ranks,
}

/// Hermite coefficients from the first on, over the standard deviation.
fn coefficients(distribution: &Distribution) -> [f64; TERMS] {
    let scores = scores(PIECES);
    let marginal = Marginal::new(distribution);
    let mean: f64 = scores.iter().map(|node| node.weight * marginal.value(node.at[0])).sum();
    let mut sums = [0.0; TERMS];
    let mut square = 0.0;
    for node in &scores {
        let (z, value) = (node.at[0], marginal.value(node.at[0]) - mean);
        square += node.weight * value * value;
        // Hermite polynomials of norm 1.
        let (mut before, mut current) = (1.0, z);
        for (k, sum) in (1..).zip(&mut sums) {
            *sum += node.weight * value * current;
            let k = f64::from(k);
            (before, current) = (current, (z * current - libm::sqrt(k) * before) / libm::sqrt(k + 1.0));
        }
    }
    let deviation = libm::sqrt(square);
    sums.map(|sum| sum / deviation)
}

/// The correlation of the values of two distributions whose scores have correlation `r`.
pub fn of_values(one: &Distribution, other: &Distribution, r: f64) -> f64 {
    let is_normal = |distribution: &Distribution| matches!(distribution, Distribution::Normal { .. });
    if is_normal(one) && is_normal(other) {
        return r;
    }
    series(&coefficients(one), &coefficients(other), r)
}

fn series(one: &[f64; TERMS], other: &[f64; TERMS], r: f64) -> f64 {
    one.iter().zip(other).rev().fold(0.0, |sum, (a, b)| r * (a * b + sum))
}

/// The correlation of the scores of two distributions whose values, or ranks, are to have the given one.
///
/// # Errors
/// The least and the greatest correlation that these distributions can have.
pub fn of_scores(
    one: &Distribution,
    other: &Distribution,
    coefficient: Coefficient,
    correlation: f64,
) -> Result<f64, [f64; 2]> {
    let is_normal = |distribution: &Distribution| matches!(distribution, Distribution::Normal { .. });
    if coefficient == Coefficient::Ranks {
        return Ok(2.0 * libm::sin(PI / 6.0 * correlation));
    }
    if is_normal(one) && is_normal(other) {
        return Ok(correlation);
    }
    let (one, other) = (coefficients(one), coefficients(other));
    let range = [-1.0, 1.0].map(|r| series(&one, &other, r));
    if !(range[0] < correlation && correlation < range[1]) {
        return Err(range);
    }
    let [mut low, mut high] = [-1.0, 1.0];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if series(&one, &other, middle) < correlation { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::{Coefficient, of_scores, of_values};
    use crate::model::Distribution;

    #[track_caller]
    fn close(found: f64, expected: f64, bound: f64) {
        assert!((found - expected).abs() <= bound, "{found}, not {expected}");
    }

    #[test]
    fn known_pairs() {
        let normal = Distribution::Normal { mean: 3.0, deviation: 2.0 };
        let uniform = Distribution::Uniform { limits: [-1.0, 3.0] };
        // The rank of a uniform value is the value.
        for rho in [-0.9, -0.3, 0.2, 0.75] {
            let r = 2.0 * libm::sin(PI * rho / 6.0);
            close(of_scores(&uniform, &uniform, Coefficient::Values, rho).unwrap(), r, 1e-6);
            close(of_scores(&uniform, &normal, Coefficient::Ranks, rho).unwrap(), r, 1e-12);
            close(of_values(&uniform, &uniform, r), rho, 1e-6);
            close(of_values(&normal, &normal, rho), rho, 0.0);
            // A straight line on one side leaves the first term: √(3/π) of r.
            close(of_values(&uniform, &normal, rho), rho * libm::sqrt(3.0 / PI), 1e-6);
        }
        // Log-normals of spread s: (e^(r·s²) − 1)/(e^(s²) − 1); skewness 2 is s² = ln(1 + q²), q³ + 3q = 2.
        let skewed = Distribution::Skewed { mean: 0.0, deviation: 1.0, skewness: 2.0 };
        let q: f64 = 0.596_071_637_983_321_5;
        let square = libm::log1p(q * q);
        for r in [-1.0, -0.4, 0.7] {
            close(of_values(&skewed, &skewed, r), libm::expm1(r * square) / libm::expm1(square), 1e-9);
        }
        // Two lots, three tenths of the units in one: the density of the normal where they part over √(0.3·0.7).
        let lot = |at: f64| Distribution::Uniform { limits: [at, at + 1e-6] };
        let lots = Distribution::Mixture(vec![(0.3, lot(0.0)), (0.7, lot(1.0))]);
        close(of_values(&lots, &normal, 1.0), 0.347_692_614_2 / libm::sqrt(0.21), 1e-3);
        let [least, greatest] = of_scores(&skewed, &skewed, Coefficient::Values, -0.9).unwrap_err();
        close(least, libm::expm1(-square) / libm::expm1(square), 1e-9);
        close(greatest, 1.0, 1e-9);
    }
}
