//! Confidence intervals of 95 %.

use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

use super::{binomial, normal::quantile};

/// Confidence of every interval.
pub const CONFIDENCE: f64 = 0.95;
/// Probability left out on either side.
const SIDE: f64 = 0.5 * (1.0 - CONFIDENCE);

/// Half the width of an interval of a normal estimate, in standard errors.
pub fn normal_factor() -> f64 {
    -quantile(SIDE)
}

/// Half the width of an interval in standard errors that were found from `count` ≥ 2 replicates.
pub fn student_factor(count: usize) -> f64 {
    StudentsT::new(0.0, 1.0, (count - 1) as f64).map_or(f64::INFINITY, |t| t.inverse_cdf(1.0 - SIDE))
}

/// Of the standard deviation of normal data: s·√((n − 1)/χ²).
pub fn deviation(deviation: f64, units: f64) -> [f64; 2] {
    let freedom = units - 1.0;
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

/// Of Cpk (Bissell 1990): its standard error is √(1/(9n) + Cpk²/(2(n − 1))).
pub fn capability_error(capability: f64, units: f64) -> f64 {
    libm::sqrt(1.0 / (9.0 * units) + capability * capability / (2.0 * (units - 1.0)))
}

/// Of a probability of which `hits` of `units` were seen (Clopper and Pearson 1934): never too short.
pub fn proportion(hits: u64, units: u64) -> [f64; 2] {
    binomial::limits(hits, units, SIDE)
}

/// How many of `units` values lie below the lower and the upper end of an interval of the `probability` point, by the
/// normal approximation of the binomial distribution; beyond the values where the sample says nothing.
pub fn ranks(probability: f64, units: u64) -> [f64; 2] {
    let n = units as f64;
    let half = normal_factor() * libm::sqrt(n * probability * (1.0 - probability));
    [(n * probability - half).floor(), (n * probability + half).ceil() + 1.0]
}

#[cfg(test)]
mod tests {
    use super::{capability_error, deviation, normal_factor, proportion, student_factor};

    #[test]
    fn tabulated_intervals() {
        assert!((normal_factor() - 1.959_963_985).abs() < 1e-9);
        assert!((student_factor(8) - 2.364_624).abs() < 1e-5);
        // χ² with 9 degrees of freedom: 19.0228 and 2.7004.
        let [low, high] = deviation(1.0, 10.0);
        assert!((low - 0.687_83).abs() < 1e-4 && (high - 1.825_6).abs() < 1e-3, "{low} {high}");
        // No hit: 1 − 0.025^(1/n).
        let [low, high] = proportion(0, 100);
        assert!(low == 0.0 && (high - 0.036_217).abs() < 1e-6, "{high}");
        let [low, high] = proportion(100, 100);
        assert!(high == 1.0 && (low - 0.963_783).abs() < 1e-6, "{low}");
        // Of 60 hits of 1000: the exact one-sided chances are 2.5 %.
        let [low, high] = proportion(60, 1000);
        assert!((low - 0.046_095_035).abs() < 1e-9 && (high - 0.076_560_490).abs() < 1e-9, "{low} {high}");
        assert!((capability_error(1.0, 50.0) - libm::sqrt(1.0 / 450.0 + 1.0 / 98.0)).abs() < 1e-12);
    }

    /// χ² quantiles by both ways where they meet, and the limit for many units, (1.96/√(2n)).
    #[test]
    fn any_number_of_units_has_intervals() {
        let [few, many] = [1001.0, 1001.5].map(|units| deviation(1.0, units));
        for (few, many) in few.into_iter().zip(many) {
            assert!((few - many).abs() < 2e-5, "{few} {many}");
        }
        for power in 4..=12 {
            let units = libm::pow(10.0, f64::from(power));
            let half = 1.959_963_985 / libm::sqrt(2.0 * units);
            let [low, high] = deviation(1.0, units);
            assert!(
                ((1.0 - low) / half - 1.0).abs() < 0.02 && ((high - 1.0) / half - 1.0).abs() < 0.02,
                "{low} {high}"
            );
        }
        let factors: Vec<f64> = (2..=1024).map(student_factor).collect();
        assert!((factors[0] - 12.706_205).abs() < 1e-5 && factors.is_sorted_by(|a, b| a > b));
        assert!((factors[1022] - 1.962_286).abs() < 1e-5, "{}", factors[1022]);
    }
}
