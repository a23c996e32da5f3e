//! Values of a scalar contributor from standard normal scores.

mod beta;
#[cfg(test)]
mod by_name_tests;
pub(crate) mod cumulative;
mod extreme;
pub mod quadrature;

use self::{
    beta::Beta,
    extreme::{Gumbel, Weibull},
};
use crate::{
    model::Distribution,
    numeric::{
        lanes::Lanes,
        normal::{quantile, tail},
        root::{excess, zero},
    },
};

/// A distribution made ready for drawing.
#[derive(Clone, Debug)]
pub enum Marginal {
    /// A straight line of the score: constant or normal.
    Line {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        deviation: f64,
    },
    /// A normal between two tails, mirrored if it lies above its mean.
    Truncated {
        /// Mean before it was cut off.
        mean: f64,
        /// Standard deviation before, negative if it is mirrored.
        deviation: f64,
        /// Chances beyond the nearer and the farther limit, before.
        tails: [f64; 2],
    },
    /// Uniform, triangular, trapezoidal: rising over a first share of the probability, level, falling over the last.
    Trapezoid {
        /// Least and greatest value.
        limits: [f64; 2],
        /// Between which it is level.
        shoulders: [f64; 2],
        /// Shares of the probability up to each shoulder.
        shares: [f64; 2],
    },
    /// Shifted log-normal.
    Skewed(Skewing),
    /// Weibull's.
    Weibull(Weibull),
    /// Gumbel's.
    Gumbel(Gumbel),
    /// Beta.
    Beta(Beta),
    /// Of several ones.
    Mixture(Mixture),
    /// Linear between values.
    Table(Vec<f64>),
}

/// The shifted log-normal x = mean ± e^μ·(e^(s·z) − e^(s²/2)) of a given skewness.
#[derive(Clone, Copy, Debug)]
pub struct Skewing {
    pub(super) mean: f64,
    pub(super) scale: f64,
    pub(super) spread: f64,
    /// e^(s²/2) − 1.
    pub(super) shift: f64,
}

impl Skewing {
    /// Of these moments; `skewness` is not 0.
    pub fn new(mean: f64, deviation: f64, skewness: f64) -> Self {
        // The skewness of a log-normal is q³ + 3q with q² = e^(s²) − 1.
        let q = 2.0 * libm::sinh(libm::asinh(skewness.abs() / 2.0) / 3.0);
        let growth = libm::sqrt(1.0 + q * q);
        let scale = (deviation / (growth * q)).copysign(skewness);
        Self { mean, scale, spread: libm::sqrt(libm::log1p(q * q)).copysign(skewness), shift: q * q / (1.0 + growth) }
    }

    /// The value at a score; it grows with the score.
    pub fn value(&self, score: f64) -> f64 {
        self.mean + self.scale * (libm::expm1(self.spread * score) - self.shift)
    }
}

/// The distribution of a unit that is of one of several distributions, such as those of several machines or lots.
#[derive(Clone, Debug)]
pub struct Mixture {
    /// Shares, which add up to 1, and distributions.
    parts: Vec<(f64, Marginal)>,
}

impl Mixture {
    /// Of distributions with their shares, which add up to 1.
    pub fn new(parts: Vec<(f64, Marginal)>) -> Self {
        Self { parts }
    }

    /// The value at a standard normal score. It lies between the values that the parts have at the same score, and is solved for
    /// there, by the smaller of both tails.
    pub fn value(&self, score: f64) -> f64 {
        let values = self.parts.iter().map(|(_, part)| part.value(score));
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let [below, above] = [tail(-score), tail(score)].map(|tail| tail.max(f64::MIN_POSITIVE));
        zero(low, high, |x| {
            let found = self.tails(x);
            if below < above { excess(found[0], below) } else { -excess(found[1], above) }
        })
    }

    /// P(X ≤ x) and P(X > x).
    pub fn tails(&self, x: f64) -> [f64; 2] {
        self.parts.iter().fold([0.0; 2], |[below, above], (share, part)| {
            let found = part.tails(x);
            [below + share * found[0], above + share * found[1]]
        })
    }
}

impl Distribution {
    /// The 0.135 % and the 99.865 % point: those of a normal lie three standard deviations from its mean.
    pub fn points(&self) -> [f64; 2] {
        let marginal = Marginal::new(self);
        [-3.0, 3.0].map(|score| marginal.value(score))
    }
}

impl Marginal {
    /// Of a distribution.
    pub fn new(distribution: &Distribution) -> Self {
        match distribution {
            Distribution::Constant(value) => Self::Line { mean: *value, deviation: 0.0 },
            Distribution::Normal { mean, deviation } => Self::Line { mean: *mean, deviation: *deviation },
            Distribution::TruncatedNormal { mean, deviation, limits } => {
                let [low, high] = limits.map(|limit| (limit - mean) / deviation);
                // Upper tails are the accurate ones: a zone that lies below the mean is mirrored.
                if low + high >= 0.0 {
                    Self::Truncated { mean: *mean, deviation: *deviation, tails: [tail(low), tail(high)] }
                } else {
                    Self::Truncated { mean: *mean, deviation: -deviation, tails: [tail(-high), tail(-low)] }
                }
            }
            Distribution::Uniform { limits } => Self::trapezoid(*limits, *limits),
            Distribution::Triangular { limits, mode } => Self::trapezoid(*limits, [*mode; 2]),
            Distribution::Trapezoidal { limits, shoulders } => Self::trapezoid(*limits, *shoulders),
            Distribution::Skewed { mean, deviation, skewness } => {
                Self::Skewed(Skewing::new(*mean, *deviation, *skewness))
            }
            Distribution::Weibull { shape, scale, location } => {
                Self::Weibull(Weibull { shape: *shape, scale: *scale, location: *location })
            }
            Distribution::Gumbel { mode, scale } => Self::Gumbel(Gumbel { mode: *mode, scale: *scale }),
            Distribution::Beta { limits, shapes } => Self::Beta(Beta { limits: *limits, shapes: *shapes }),
            Distribution::Mixture(parts) => {
                Self::Mixture(Mixture::new(parts.iter().map(|(share, part)| (*share, Self::new(part))).collect()))
            }
            Distribution::Table(values) => Self::Table(values.clone()),
        }
    }

    fn trapezoid(limits: [f64; 2], shoulders: [f64; 2]) -> Self {
        let area = 0.5 * (limits[1] - limits[0] + shoulders[1] - shoulders[0]);
        let shares = [shoulders[0] - limits[0], limits[1] - shoulders[1]].map(|ramp| 0.5 * ramp / area);
        Self::Trapezoid { limits, shoulders, shares }
    }

    /// Values at standard normal scores.
    #[inline(always)]
    pub fn values(&self, scores: Lanes) -> Lanes {
        match self {
            Self::Line { mean, deviation } => scores * *deviation + Lanes::splat(*mean),
            other => scores.map(|score| other.value(score)),
        }
    }

    /// The value at a standard normal score.
    pub fn value(&self, score: f64) -> f64 {
        match self {
            Self::Line { mean, deviation } => mean + deviation * score,
            Self::Truncated { mean, deviation, tails: [from, to] } => {
                let upwards = if *deviation > 0.0 { tail(score) } else { tail(-score) };
                mean - deviation * quantile(to + upwards * (from - to))
            }
            Self::Trapezoid { limits: [low, high], shoulders: [left, right], shares: [rising, falling] } => {
                let (below, above) = (tail(-score), tail(score));
                if below < *rising {
                    low + (left - low) * libm::sqrt(below / rising)
                } else if above < *falling {
                    high - (high - right) * libm::sqrt(above / falling)
                } else if right > left {
                    left + (right - left) * (below - rising) / (1.0 - rising - falling)
                } else {
                    *left
                }
            }
            Self::Skewed(skewing) => skewing.value(score),
            Self::Weibull(weibull) => weibull.value(score),
            Self::Gumbel(gumbel) => gumbel.value(score),
            Self::Beta(beta) => beta.value(score),
            Self::Mixture(mixture) => mixture.value(score),
            Self::Table(values) => {
                let place = tail(-score) * (values.len() - 1) as f64;
                let piece = (place as usize).min(values.len() - 2);
                values[piece] + (values[piece + 1] - values[piece]) * (place - piece as f64)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Marginal, Mixture};
    use crate::{
        distribution::quadrature::mean_and_deviation,
        model::{Distribution, Variation},
        numeric::normal::{quantile, tail},
    };

    /// Integrating the values over the probability gives the moments that the density has.
    #[test]
    fn values_have_the_moments_of_their_distribution() {
        let limits = [-1.0, 3.0];
        for distribution in [
            Distribution::Normal { mean: 1.0, deviation: 0.5 },
            Distribution::TruncatedNormal { mean: 1.0, deviation: 2.0, limits },
            Distribution::TruncatedNormal { mean: -6.0, deviation: 2.0, limits },
            Distribution::TruncatedNormal { mean: 8.0, deviation: 2.0, limits },
            Distribution::Uniform { limits },
            Distribution::Triangular { limits, mode: 3.0 },
            Distribution::Triangular { limits, mode: 0.5 },
            Distribution::Trapezoidal { limits, shoulders: [0.0, 2.5] },
            Distribution::Skewed { mean: 4.0, deviation: 0.3, skewness: -0.7 },
            Distribution::Weibull { shape: 1.5, scale: 0.3, location: 1.0 },
            Distribution::Beta { limits, shapes: [2.0, 3.5] },
            Distribution::Mixture(vec![
                (0.3, Distribution::Uniform { limits }),
                (0.7, Distribution::Normal { mean: 0.5, deviation: 0.2 }),
            ]),
            Distribution::Table(vec![0.0, 1.0, 1.0, 3.0]),
        ] {
            let marginal = Marginal::new(&distribution);
            let count = 20_000;
            let values: Vec<f64> =
                (0..count).map(|i| marginal.value(quantile((f64::from(i) + 0.5) / f64::from(count)))).collect();
            assert!(values.is_sorted(), "{distribution:?}");
            let mean = values.iter().sum::<f64>() / f64::from(count);
            let square = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / f64::from(count);
            let [expected, deviation] =
                mean_and_deviation(&Variation::Scalar { distribution: distribution.clone(), limits })[0];
            assert!((mean - expected).abs() < 1e-5 * deviation, "{distribution:?}: {mean} {expected}");
            assert!((libm::sqrt(square) / deviation - 1.0).abs() < 3e-4, "{distribution:?}");
        }
    }

    #[test]
    fn points_of_mixtures() {
        let normal = |mean, deviation| Marginal::new(&Distribution::Normal { mean, deviation });
        let uniform = |low, high| Marginal::new(&Distribution::Uniform { limits: [low, high] });
        // Two lots far apart: a tenth of the units is the whole lower lot's.
        let lots = Mixture::new(vec![(0.1, uniform(0.0, 1.0)), (0.9, uniform(5.0, 6.0))]);
        for (p, expected) in [(0.01, 0.1), (0.05, 0.5), (0.1 + 0.09, 5.1), (0.55, 5.5)] {
            assert!((lots.value(quantile(p)) - expected).abs() < 1e-12, "{p}");
        }
        // The wide part has the tails: a hundredth of it beyond 6 of its deviations.
        let wide = Mixture::new(vec![(0.99, normal(0.0, 1.0)), (0.01, normal(0.0, 5.0))]);
        for score in [-quantile(0.01 * tail(6.0)), quantile(0.01 * tail(6.0))] {
            assert!((wide.value(score) - 30.0f64.copysign(score)).abs() < 1e-9, "{}", wide.value(score));
        }
        let equal = Mixture::new(vec![(0.5, normal(1.0, 2.0)), (0.5, normal(1.0, 2.0))]);
        assert_eq!(equal.value(1.5), 4.0);
    }
}
