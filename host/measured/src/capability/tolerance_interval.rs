//! Statistical tolerance intervals by ISO 16269-6: they hold a stated share of the production, with 95 % confidence.

use serde::Serialize;
use slipfit_tolerance::{
    numeric::{
        normal::{quantile, tail},
        root::zero,
    },
    statistics::interval::CONFIDENCE,
};
use statrs::function::beta::checked_beta_reg;

use super::indices::Known;
use crate::numeric::{noncentral_t::NoncentralT, scale::scores, tails::chi_squared_above};

/// Intervals with at least a `share` of the production, with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ToleranceInterval {
    /// Share of the production.
    pub share: f64,
    /// Factor k of the two-sided normal interval mean ± k·s.
    pub factor: f64,
    /// That interval.
    pub normal: [f64; 2],
    /// Factor of the one-sided normal intervals.
    pub one_sided_factor: f64,
    /// Ends of the one-sided normal intervals: all but `share` lie above the first; or below the second.
    pub one_sided: [f64; 2],
    /// The interval of two measured values, of any continuous distribution; `None` where there are too few parts.
    pub any_distribution: Option<[f64; 2]>,
    /// Parts that the interval of any distribution needs.
    pub parts_for_any: usize,
}

impl ToleranceInterval {
    /// For a `share` between 0 and 1 of a production of which rising values were measured.
    pub fn new(share: f64, known: &Known, sorted: &[f64]) -> Self {
        let factor = two_sided_factor(known.parts, known.freedom, share, CONFIDENCE);
        let one_sided_factor = one_sided_factor(known.parts, known.freedom, share, CONFIDENCE);
        let about = |factor: f64| [-factor, factor].map(|k| known.mean + k * known.deviation);
        let n = sorted.len();
        let any_distribution =
            trimmed(n, share, CONFIDENCE).and_then(|rank| Some([*sorted.get(rank - 1)?, *sorted.get(n - rank)?]));
        Self {
            share,
            factor,
            normal: about(factor),
            one_sided_factor,
            one_sided: about(one_sided_factor),
            any_distribution,
            parts_for_any: parts_for_any(share, CONFIDENCE),
        }
    }
}

/// The factor of mean ± k·s that holds a `share` with some `confidence`, exact: by integration over the mean's error, for
/// each of which the share grows with s. (The simpler factor of W. Howe, 1969, is up to a few per cent off for few parts.)
pub fn two_sided_factor(parts: f64, freedom: f64, share: f64, confidence: f64) -> f64 {
    let outside = 1.0 - share;
    let [whole, halved] = [-quantile(outside), -quantile(0.5 * outside)];
    // For each error of the mean the half width, in σ, of the interval with this share.
    let points: Vec<[f64; 2]> = (scores().iter())
        .map(|&[error, weight]| {
            let error = error.abs() / libm::sqrt(parts);
            let excess = |half: f64| {
                let left = tail(half - error) + tail(half + error);
                (outside - left) / (outside + left)
            };
            [zero((error + whole).max(0.0), error + halved, excess), weight]
        })
        .collect();
    let chance = |factor: f64| -> f64 {
        let held = |half: f64| chi_squared_above(freedom * half * half / (factor * factor), freedom);
        points.iter().map(|[half, weight]| weight * held(*half)).sum()
    };
    let mut high = 2.0 * halved.max(1.0);
    while chance(high) < confidence && high < 1e12 {
        high *= 2.0;
    }
    zero(0.0, high, |factor| if factor > 0.0 { chance(factor) - confidence } else { -confidence })
}

/// The factor of mean + k·s below which a `share` lies with some `confidence`, exact by the noncentral t distribution.
pub fn one_sided_factor(parts: f64, freedom: f64, share: f64, confidence: f64) -> f64 {
    let root = libm::sqrt(parts);
    NoncentralT::new(freedom).quantile_above(quantile(share) * root, 1.0 - confidence) / root
}

/// The confidence with which a `share` of any continuous distribution lies between the values of the same `rank` (from 1)
/// from both ends (S. Wilks, "Determination of sample sizes for setting tolerance limits", 1941).
fn confidence_of(parts: usize, rank: usize, share: f64) -> f64 {
    if 2 * rank > parts {
        return 0.0;
    }
    let (a, b) = ((parts + 1 - 2 * rank) as f64, (2 * rank) as f64);
    checked_beta_reg(b, a, 1.0 - share).unwrap_or(0.0)
}

/// The greatest rank from both ends between which a `share` lies with a `confidence`.
fn trimmed(parts: usize, share: f64, confidence: f64) -> Option<usize> {
    let is_enough = |rank: usize| confidence_of(parts, rank, share) >= confidence;
    if !is_enough(1) {
        return None;
    }
    let (mut low, mut high) = (1, parts / 2 + 1);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if is_enough(middle) { low = middle } else { high = middle }
    }
    Some(low)
}

/// Parts between whose least and greatest value a `share` of any continuous distribution lies with a `confidence`.
pub fn parts_for_any(share: f64, confidence: f64) -> usize {
    let is_enough = |parts: usize| confidence_of(parts, 1, share) >= confidence;
    let (mut low, mut high) = (1, 2);
    while !is_enough(high) && high < 1 << 40 {
        (low, high) = (high, 2 * high);
    }
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if is_enough(middle) { high = middle } else { low = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::{one_sided_factor, parts_for_any, trimmed, two_sided_factor};

    #[test]
    fn two_sided_factors_as_published() {
        // P. Berthouex and L. Brown, "Statistics for Environmental Engineers", 2002, table 21.1: 95 % confidence of shares of
        // 90, 95 and 99 %.
        for (parts, published) in [
            (4.0, [5.37, 6.34, 8.22]),
            (5.0, [4.29, 5.08, 6.60]),
            (6.0, [3.73, 4.42, 5.76]),
            (10.0, [2.86, 3.39, 4.44]),
            (20.0, [2.32, 2.76, 3.62]),
            (30.0, [2.15, 2.55, 3.35]),
            (60.0, [1.96, 2.34, 3.07]),
        ] {
            for (share, expected) in [0.9, 0.95, 0.99].into_iter().zip(published) {
                let found = two_sided_factor(parts, parts - 1.0, share, 0.95);
                assert!((found - expected).abs() <= 0.0051, "{parts} {share}: {found} {expected}");
            }
        }
        // NIST/SEMATECH e-Handbook of Statistical Methods, 7.2.6.3: 43 wafers, 90 % with 99 % confidence; 2.217 by Howe's
        // approximation.
        assert!((two_sided_factor(43.0, 42.0, 0.9, 0.99) / 2.217 - 1.0).abs() < 5e-3);
        assert!((one_sided_factor(43.0, 42.0, 0.9, 0.99) - 1.8740).abs() < 5e-5);
    }

    #[test]
    fn parts_for_any_distribution_as_tabled() {
        // Wilks' numbers, as in ISO 16269-6, annex: least and greatest of 93 and 473 values.
        assert_eq!([0.9, 0.95, 0.99].map(|share| parts_for_any(share, 0.95)), [46, 93, 473]);
        assert_eq!([0.9, 0.95, 0.99].map(|share| parts_for_any(share, 0.99)), [64, 130, 662]);
        assert_eq!([trimmed(92, 0.95, 0.95), trimmed(93, 0.95, 0.95)], [None, Some(1)]);
    }
}
