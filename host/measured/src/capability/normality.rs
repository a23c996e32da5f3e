//! T. Anderson and D. Darling's test of normality.

use serde::Serialize;
use slipfit_tolerance::numeric::normal::tail;

use super::sample::Sample;

/// The test of normality with mean and standard deviation from the sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Normality {
    /// A².
    pub statistic: f64,
    /// A²·(1 + 0.75/n + 2.25/n²), which the p-value is of.
    pub adjusted: f64,
    /// The probability of so great a statistic if the production is normal.
    pub p: f64,
}

/// Parts below which the approximation of the p-value is not made.
pub const LEAST_PARTS: usize = 8;

impl Normality {
    /// Of a sample of at least [`LEAST_PARTS`], otherwise `None`.
    pub fn new(sample: &Sample) -> Option<Self> {
        if sample.sorted.len() < LEAST_PARTS {
            return None;
        }
        let n = sample.count();
        // Logarithms of both tails; beyond 37 standard deviations they stop, as the tail is no number.
        let ln_tail = |score: f64| libm::log(tail(score).max(f64::MIN_POSITIVE));
        let score = |x: &f64| (x - sample.mean) / sample.deviation;
        let sum: f64 = (sample.sorted.iter().zip(sample.sorted.iter().rev()).enumerate())
            .map(|(i, (x, mirrored))| (2.0 * i as f64 + 1.0) * (ln_tail(-score(x)) + ln_tail(score(mirrored))))
            .sum();
        let statistic = -n - sum / n;
        let adjusted = statistic * (1.0 + 0.75 / n + 2.25 / (n * n));
        Some(Self { statistic, adjusted, p: p_value(adjusted) })
    }
}

/// R. D'Agostino and M. Stephens, "Goodness-of-Fit Techniques", 1986, table 4.9. Their exponent has its minimum beyond 150,
/// where the probability is no more than at 10.
fn p_value(a: f64) -> f64 {
    let a = a.min(10.0);
    if a < 0.2 {
        -libm::expm1(-13.436 + 101.14 * a - 223.73 * a * a)
    } else if a < 0.34 {
        -libm::expm1(-8.318 + 42.796 * a - 59.938 * a * a)
    } else if a < 0.6 {
        libm::exp(0.9177 - 4.279 * a - 1.38 * a * a)
    } else {
        libm::exp(1.2937 - 5.709 * a + 0.0186 * a * a)
    }
}

#[cfg(test)]
mod tests {
    use super::{Normality, p_value};
    use crate::{
        capability::sample::Sample,
        examples::{BALL_BEARINGS, HEAT_FLOW, ROSNER},
    };

    fn normality(values: &[f64]) -> Normality {
        let values: Vec<_> = values.iter().copied().map(Some).collect();
        let sample = Sample::new("a", &values).expect("a sample");
        Normality::new(&sample).expect("enough parts")
    }

    #[test]
    fn published_statistics() {
        // NIST/SEMATECH e-Handbook of Statistical Methods, 1.4.2.8.3: 0.129 of the heat flow meter, which is A² with the
        // correction 1 + 4/n − 25/n² of M. Stephens (1974).
        let heat_flow = normality(&HEAT_FLOW);
        let n = HEAT_FLOW.len() as f64;
        let corrected = heat_flow.statistic * (1.0 + 4.0 / n - 25.0 / (n * n));
        assert!((corrected - 0.129).abs() < 5e-4, "{heat_flow:?}");
        assert!(heat_flow.p > 0.9);
        // Weights of eleven men (S. Shapiro and M. Wilk, 1965), Rosner's data and the ball bearings by SciPy 1.17.
        let weights = [148.0, 154.0, 158.0, 160.0, 161.0, 162.0, 166.0, 170.0, 182.0, 195.0, 236.0];
        for (values, statistic) in [
            (weights.as_slice(), 0.946_771_879_598_886_2),
            (&ROSNER, 1.735_689_162_843_428_3),
            (&BALL_BEARINGS, 0.604_014_556_256_558_4),
        ] {
            assert!((normality(values).statistic - statistic).abs() < 1e-12, "{statistic}");
        }
    }

    #[test]
    fn p_values_meet_the_table() {
        // Upper points of A²(1 + 0.75/n + 2.25/n²): D'Agostino and Stephens, table 4.7.
        for (p, point) in
            [(0.5, 0.341), (0.25, 0.470), (0.15, 0.561), (0.10, 0.631), (0.05, 0.752), (0.025, 0.873), (0.01, 1.035)]
        {
            assert!((p_value(point) / p - 1.0).abs() < 0.02, "{point}: {} {p}", p_value(point));
        }
        assert!(p_value(1e6) < 1e-20 && p_value(0.0) > 0.999);
    }
}
