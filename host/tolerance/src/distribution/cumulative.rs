//! Probabilities below and above a value of a scalar contributor.

use super::{Marginal, Skewing};
use crate::numeric::normal::tail;

impl Skewing {
    /// The score at which the value is x: infinite from the end on.
    pub fn score(&self, x: f64) -> f64 {
        libm::log1p(((x - self.mean) / self.scale + self.shift).max(-1.0)) / self.spread
    }
}

impl Marginal {
    /// P(X ≤ x) and P(X > x), each to its own last digits.
    pub fn tails(&self, x: f64) -> [f64; 2] {
        let normal = |score: f64| [tail(-score), tail(score)];
        match self {
            Self::Line { mean, deviation: 0.0 } => {
                if x < *mean {
                    [0.0, 1.0]
                } else {
                    [1.0, 0.0]
                }
            }
            Self::Line { mean, deviation } => normal((x - mean) / deviation),
            Self::Truncated { mean, deviation, tails: [from, to] } => {
                let at = tail((x - mean) / deviation).clamp(*to, *from);
                let [rest, beyond] = [(from - at) / (from - to), (at - to) / (from - to)];
                if *deviation > 0.0 { [rest, beyond] } else { [beyond, rest] }
            }
            Self::Trapezoid { limits: [low, high], shoulders: [left, right], shares: [rising, falling] } => {
                let x = x.clamp(*low, *high);
                let square = |share: f64| share * share;
                if x < *left {
                    let below = rising * square((x - low) / (left - low));
                    [below, 1.0 - below]
                } else if x > *right {
                    let above = falling * square((high - x) / (high - right));
                    [1.0 - above, above]
                } else if right > left {
                    let level = 1.0 - rising - falling;
                    [rising + level * (x - left) / (right - left), falling + level * (right - x) / (right - left)]
                } else {
                    [*rising, *falling]
                }
            }
            Self::Skewed(skewing) => normal(skewing.score(x)),
            Self::Weibull(weibull) => weibull.tails(x),
            Self::Gumbel(gumbel) => gumbel.tails(x),
            Self::Beta(beta) => beta.tails(x),
            Self::Mixture(mixture) => mixture.tails(x),
            Self::Table(values) => {
                let last = values.len() - 1;
                let place = match values.partition_point(|value| *value <= x) {
                    0 => 0.0,
                    after if after > last => last as f64,
                    after => {
                        let [from, to] = [values[after - 1], values[after]];
                        (after - 1) as f64 + (x - from) / (to - from)
                    }
                };
                [place / last as f64, (last as f64 - place) / last as f64]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{distribution::Marginal, model::Distribution, numeric::normal::tail};

    /// The tails of a value are those of the score that it was made of, at 6σ as in the middle.
    #[test]
    fn tails_are_the_inverse_of_values() {
        let limits = [-1.0, 3.0];
        let normal = |mean, deviation| Distribution::Normal { mean, deviation };
        for distribution in [
            normal(1.0, 0.5),
            Distribution::TruncatedNormal { mean: -6.0, deviation: 2.0, limits },
            Distribution::TruncatedNormal { mean: 8.0, deviation: 2.0, limits },
            Distribution::Uniform { limits },
            Distribution::Triangular { limits, mode: 0.5 },
            Distribution::Triangular { limits, mode: 3.0 },
            Distribution::Trapezoidal { limits, shoulders: [0.0, 2.5] },
            Distribution::Skewed { mean: 0.4, deviation: 0.3, skewness: -0.7 },
            Distribution::Skewed { mean: 0.4, deviation: 0.3, skewness: 2.0 },
            Distribution::Weibull { shape: 2.0, scale: 0.3, location: 0.0 },
            Distribution::Weibull { shape: 0.7, scale: 0.3, location: 0.0 },
            Distribution::Gumbel { mode: 0.1, scale: 0.2 },
            Distribution::Gumbel { mode: 0.1, scale: -0.2 },
            Distribution::Beta { limits: [0.0, 3.0], shapes: [2.0, 5.0] },
            Distribution::Beta { limits: [0.0, 3.0], shapes: [0.5, 1.5] },
            Distribution::Mixture(vec![(0.7, normal(-1.0, 0.1)), (0.3, normal(0.5, 0.4))]),
            Distribution::Mixture(vec![
                (0.2, Distribution::Uniform { limits }),
                (0.8, Distribution::Gumbel { mode: 0.0, scale: 0.1 }),
            ]),
            Distribution::Table(vec![0.0, 1.0, 1.5, 3.0]),
        ] {
            let marginal = Marginal::new(&distribution);
            for score in [-6.0, -3.0, -1.0, -0.1, 0.0, 0.5, 1.5, 3.0, 6.0] {
                let found = marginal.tails(marginal.value(score));
                // A value near an end that is not 0 keeps fewer digits of its distance from there.
                for (found, expected) in found.into_iter().zip([tail(-score), tail(score)]) {
                    let error = (found / expected - 1.0).abs();
                    assert!(
                        error < 1e-12 + 1e-15 / expected,
                        "{distribution:?} at {score}: {found:e}, not {expected:e}"
                    );
                }
            }
        }
        // Beyond the ends there is nothing.
        for (distribution, x) in [
            (Distribution::Weibull { shape: 2.0, scale: 1.0, location: 1.0 }, 0.5),
            (Distribution::Skewed { mean: 0.0, deviation: 1.0, skewness: 2.0 }, -10.0),
            (Distribution::Beta { limits, shapes: [2.0, 3.0] }, -1.5),
            (Distribution::Table(vec![0.0, 1.0]), -0.1),
            (Distribution::Constant(2.0), 1.9),
        ] {
            assert_eq!(Marginal::new(&distribution).tails(x), [0.0, 1.0], "{distribution:?}");
        }
    }
}
