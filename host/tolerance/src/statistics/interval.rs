//! Confidence intervals of 95 %.

use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

use super::binomial;
use crate::numeric::normal::{SIDE, normal_factor, quantile};

/// Values below a point beyond which their number counts as normal.
const MANY: f64 = 500.0;
/// Confidence of every interval.
pub const CONFIDENCE: f64 = 1.0 - 2.0 * SIDE;

/// Half the width of an interval in standard errors that were found from `count` ≥ 2 replicates.
pub fn student_factor(count: usize) -> f64 {
    StudentsT::new(0.0, 1.0, (count - 1) as f64).map_or(f64::INFINITY, |t| t.inverse_cdf(1.0 - SIDE))
}

/// Of a standard deviation whose variance has some degrees of `freedom`, n − 1 for normal data: s·√(ν/χ²).
pub fn deviation(deviation: f64, freedom: f64) -> [f64; 2] {
    [1.0 - SIDE, SIDE].map(|p| deviation * libm::sqrt(freedom / chi_squared(freedom, p)))
}

/// The quantile of χ². Beyond a thousand degrees of freedom Wilson and Hilferty's cube root (1931) is good to 2e-6 and
/// takes no iteration.
fn chi_squared(freedom: f64, probability: f64) -> f64 {
    const MANY: f64 = 1000.0;
    if freedom > MANY {
        let variance = 2.0 / (9.0 * freedom);
        let root = 1.0 - variance + quantile(probability) * libm::sqrt(variance);
        return freedom * root * root * root;
    }
    ChiSquared::new(freedom).map_or(f64::NAN, |chi| chi.inverse_cdf(probability))
}

/// Of a figure with these equally probable values in ascending order, at least one: each is in the middle of as many equal parts of the
/// probability, and between them it is linear.
pub fn of_values(sorted: &[f64]) -> [f64; 2] {
    let last = sorted.len() - 1;
    [SIDE, 1.0 - SIDE].map(|share| {
        let place = (share * sorted.len() as f64 - 0.5).clamp(0.0, last as f64);
        let below = place as usize;
        sorted[below] + (place - below as f64) * (sorted[last.min(below + 1)] - sorted[below])
    })
}

/// Of a probability of which `hits` of `units` were seen (Clopper and Pearson 1934): never too short.
pub fn proportion(hits: u64, units: u64) -> [f64; 2] {
    binomial::limits(hits, units, SIDE)
}

/// Of a correlation: symmetric in Fisher's atanh ρ, with the standard `error` of ρ where it is `known`.
pub fn correlation(correlation: f64, known: f64, error: f64) -> [f64; 2] {
    let half = normal_factor() * error / (1.0 - known * known);
    [-half, half].map(|by| libm::tanh(libm::atanh(correlation) + by))
}

/// The ranks (from 1 on, between two where that hits the confidence better) of the values that enclose the `probability`
/// point of `units` values; below 1 or above `units` where the sample does not bound it.
pub fn ranks(probability: f64, units: u64) -> [f64; 2] {
    [SIDE, 1.0 - SIDE].map(|chance| {
        // The rarer outcome is the accurate one.
        if probability <= 0.5 {
            rank(probability, units, chance)
        } else {
            units as f64 + 1.0 - rank(1.0 - probability, units, 1.0 - chance)
        }
    })
}

/// The rank r for which fewer than r of `units` values have a `probability` ≤ ½ with this `chance`, linear between whole
/// ranks (Beran and Hall 1993).
fn rank(probability: f64, units: u64, chance: f64) -> f64 {
    let n = units as f64;
    if n * probability > MANY {
        // Cornish and Fisher's series, with half a rank for the step of whole numbers.
        let (z, spread) = (quantile(chance), libm::sqrt(n * probability * (1.0 - probability)));
        return n * probability + z * spread + (1.0 - 2.0 * probability) * (z * z - 1.0) / 6.0 + 0.5;
    }
    // The chances of none, one, two and so on.
    let mut term = libm::exp(n * libm::log1p(-probability));
    let (mut before, mut below, mut rank) = (0.0, term, 1.0);
    while below <= chance && rank <= n {
        term *= (n - rank + 1.0) / rank * probability / (1.0 - probability);
        (before, below, rank) = (below, below + term, rank + 1.0);
    }
    rank - 1.0 + (chance - before) / (below - before)
}

#[cfg(test)]
mod tests {
    use super::{correlation, deviation, normal_factor, proportion, ranks, student_factor};

    #[test]
    fn tabulated_intervals() {
        assert!((normal_factor() - 1.959_963_985).abs() < 1e-9);
        assert!((student_factor(8) - 2.364_624).abs() < 1e-5);
        // χ² with 9 degrees of freedom: 19.0228 and 2.7004.
        let [low, high] = deviation(1.0, 9.0);
        assert!((low - 0.687_83).abs() < 1e-4 && (high - 1.825_6).abs() < 1e-3, "{low} {high}");
        // No hit: 1 − 0.025^(1/n).
        let [low, high] = proportion(0, 100);
        assert!(low == 0.0 && (high - 0.036_217).abs() < 1e-6, "{high}");
        let [low, high] = proportion(100, 100);
        assert!(high == 1.0 && (low - 0.963_783).abs() < 1e-6, "{low}");
        // Of 60 hits of 1000: the exact one-sided chances are 2.5 %.
        let [low, high] = proportion(60, 1000);
        assert!((low - 0.046_095_035).abs() < 1e-9 && (high - 0.076_560_490).abs() < 1e-9, "{low} {high}");
        // Of 103 normal pairs with ρ = 0.5 the error of atanh ρ is 0.0985.
        let [low, high] = correlation(0.5, 0.5, 0.75 / libm::sqrt(103.0));
        assert!((low - 0.341_85).abs() < 1e-5 && (high - 0.630_61).abs() < 1e-5, "{low} {high}");
    }

    /// χ² quantiles by both ways where they meet, and the limit for many units, (1.96/√(2n)).
    #[test]
    fn any_number_of_units_has_intervals() {
        let [few, many] = [1000.0, 1000.5].map(|freedom| deviation(1.0, freedom));
        for (few, many) in few.into_iter().zip(many) {
            assert!((few - many).abs() < 2e-5, "{few} {many}");
        }
        for power in 4..=12 {
            let units = libm::pow(10.0, f64::from(power));
            let half = 1.959_963_985 / libm::sqrt(2.0 * units);
            let [low, high] = deviation(1.0, units - 1.0);
            assert!(
                ((1.0 - low) / half - 1.0).abs() < 0.02 && ((high - 1.0) / half - 1.0).abs() < 0.02,
                "{low} {high}"
            );
        }
        let factors: Vec<f64> = (2..=1024).map(student_factor).collect();
        assert!((factors[0] - 12.706_205).abs() < 1e-5 && factors.is_sorted_by(|a, b| a > b));
        assert!((factors[1022] - 1.962_286).abs() < 1e-5, "{}", factors[1022]);
    }
    /// The chance that a point lies between the values of these ranks, whole ones.
    fn held(probability: f64, units: u64, [low, high]: [f64; 2]) -> f64 {
        let mut term = libm::exp(units as f64 * libm::log1p(-probability));
        let mut sum = 0.0;
        for below in 0..=units {
            let k = below as f64;
            // Linear between two ranks.
            let share = |rank: f64| (k + 1.0 - rank).clamp(0.0, 1.0);
            sum += term * (share(low) - share(high)).max(0.0);
            term *= (units as f64 - k) / (k + 1.0) * probability / (1.0 - probability);
        }
        sum
    }

    #[test]
    fn ranks_enclose_their_point() {
        for (probability, units) in [(0.5, 100), (0.5, 900), (0.1, 60), (0.001_35, 5000), (0.001_35, 400_000)] {
            let found = ranks(probability, units);
            let held = held(probability, units, found);
            assert!((held - 0.95).abs() < 2e-3, "{probability} of {units}: {found:?} {held}");
            let mirrored = ranks(1.0 - probability, units);
            assert!((mirrored[0] - (units as f64 + 1.0 - found[1])).abs() < 1e-6, "{found:?} {mirrored:?}");
        }
        // None of a thousand values need lie below a point that rare.
        assert!(ranks(0.001_35, 1000)[0] < 1.0);
    }
}
