//! Parameters with one unknown value in the whole production.

use slipfit_tolerance::numeric::normal::{normal_factor, quantile};

use super::SlideParameter;

/// Standard deviations beyond which a value is held to be impossible.
pub const REACH: f64 = 4.0;

/// What is known of a value (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Belief {
    /// Any value between two is as probable as any other.
    Between([f64; 2]),
    /// Normal, cut off at [`REACH`].
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        deviation: f64,
    },
    /// Lognormal, cut off likewise: with 95 % it is between median / factor and median · factor.
    Factor {
        /// Median.
        median: f64,
        /// More than 1.
        factor: f64,
    },
}

impl Belief {
    /// The value that is exceeded with the probability 1 − `share`.
    pub fn value(&self, share: f64) -> f64 {
        let score = || quantile(share).clamp(-REACH, REACH);
        match *self {
            Self::Between([low, high]) => low + share * (high - low),
            Self::Normal { mean, deviation } => mean + score() * deviation,
            Self::Factor { median, factor } => median * libm::pow(factor, score() / normal_factor()),
        }
    }

    /// The least and the greatest value.
    pub fn bounds(&self) -> [f64; 2] {
        match *self {
            Self::Between(ends) => ends,
            Self::Normal { mean, deviation } => [mean - REACH * deviation, mean + REACH * deviation],
            Self::Factor { median, factor } => {
                let most = libm::pow(factor, REACH / normal_factor());
                [median / most, median * most]
            }
        }
    }
}

/// How values (SI) are shown.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownIn {
    /// The unit; empty for a plain number.
    pub unit: String,
    /// Its size (SI).
    pub size: f64,
}

/// An unknown parameter: of a slide, or of another menu `P`.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertain<P = SlideParameter> {
    /// Which.
    pub parameter: P,
    /// Its name, such as friction.coefficient.
    pub name: String,
    /// What is known of its value.
    pub belief: Belief,
    /// How its values are shown.
    pub shown_in: ShownIn,
    /// Correlations: the row of Cholesky's factor of the normal scores' correlations, which weighs independent scores of the unknowns up to
    /// this one. Empty where none is correlated.
    pub weights: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::Belief;

    #[test]
    fn values_have_the_stated_shares() {
        let close = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
        close(Belief::Between([0.2, 0.3]).value(0.25), 0.225);
        let normal = Belief::Normal { mean: 0.25, deviation: 0.02 };
        close(normal.value(0.975), 0.25 + 0.02 * 1.959_963_985);
        close(normal.value(1e-12), 0.17);
        let factor = Belief::Factor { median: 100.0, factor: 3.0 };
        close(factor.value(0.025), 100.0 / 3.0);
        close(factor.value(0.5), 100.0);
        for belief in [Belief::Between([1.0, 2.0]), normal, factor] {
            let [low, high] = belief.bounds();
            assert!(low <= belief.value(1e-9) && belief.value(1.0 - 1e-9) <= high, "{belief:?}");
        }
    }
}
