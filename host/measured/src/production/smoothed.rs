//! Measured values smoothed by a kernel, without changing their mean and standard deviation.

use slipfit_tolerance::{model::Distribution, numeric::normal::quantile as score_at};

use super::error::ProductionError;
use crate::families::FitError;

/// Values of the table that is drawn from.
const VALUES: usize = 2001;
/// Points that stand for the kernel of every value, at least; of few values more.
const LEAST_POINTS: usize = 8;
/// Points of all kernels together, at least.
const POINTS: usize = 4000;

/// Values (SI) of the parts and the width of their kernels.
#[derive(Debug)]
pub struct Smoothing {
    /// Number of the part, value.
    values: Vec<(usize, f64)>,
    bounds: [f64; 2],
    width: f64,
}

impl Smoothing {
    /// Of the measured of the `values`, between `bounds`.
    ///
    /// The kernel is normal with B. Silverman's width 0.9·min(s, IQR/1.34)·n^(−1/5) ("Density Estimation for Statistics and
    /// Data Analysis", 1986, eq. 3.31).
    pub fn new(values: &[Option<f64>], bounds: [f64; 2]) -> Result<Self, ProductionError> {
        let values: Vec<(usize, f64)> =
            values.iter().enumerate().filter_map(|(i, value)| Some((i, (*value)?))).collect();
        let even: Vec<(f64, f64)> = values.iter().map(|(_, value)| (*value, 1.0)).collect();
        let deviation = Moments::of(&even).deviation;
        if deviation.is_nan() || deviation <= 0.0 {
            let value = values.first().map_or(0.0, |(_, value)| *value);
            return Err(ProductionError::Fit(FitError::NoVariation(value)));
        }
        let mut sorted: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| sorted[(share * (sorted.len() - 1) as f64).round() as usize];
        let quartiles = (at(0.75) - at(0.25)) / 1.34;
        let least = if quartiles > 0.0 { deviation.min(quartiles) } else { deviation };
        let width = 0.9 * least * libm::pow(values.len() as f64, -0.2);
        Ok(Self { values, bounds, width })
    }

    /// The smoothed distribution, the parts with these `weights` or all alike. What a kernel puts beyond a bound is
    /// reflected there.
    pub fn table(&self, weights: Option<&[f64]>) -> Distribution {
        let weight = |part: usize| weights.and_then(|weights| weights.get(part)).map_or(1.0, |weight| *weight);
        let weighted: Vec<(f64, f64)> = self.values.iter().map(|(part, value)| (*value, weight(*part))).collect();
        let Moments { mean, square, deviation } = Moments::of(&weighted);
        // A kernel adds its variance to that of the values; the scale takes it away again.
        let scale = deviation / libm::sqrt(square + self.width * self.width);
        let count = LEAST_POINTS.max(POINTS / self.values.len());
        let kernel: Vec<f64> = (0..count).map(|i| score_at((i as f64 + 0.5) / count as f64)).collect();
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(count * weighted.len());
        for (value, weight) in &weighted {
            points.extend(
                kernel.iter().map(|z| (self.reflected(mean + scale * (value - mean + self.width * z)), *weight)),
            );
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Distribution::Table(quantiles(&points))
    }

    fn reflected(&self, x: f64) -> f64 {
        let [low, high] = self.bounds;
        let inside = if x < low {
            2.0 * low - x
        } else if x > high {
            2.0 * high - x
        } else {
            x
        };
        inside.clamp(low, high)
    }
}

/// Mean, mean square from it and estimated standard deviation of weighted values.
struct Moments {
    mean: f64,
    square: f64,
    deviation: f64,
}

impl Moments {
    fn of(values: &[(f64, f64)]) -> Self {
        let sum: f64 = values.iter().map(|(_, weight)| weight).sum();
        let average =
            |of: &dyn Fn(f64) -> f64| values.iter().map(|(value, weight)| of(*value) * weight).sum::<f64>() / sum;
        let mean = average(&|x| x);
        let square = average(&|x| (x - mean) * (x - mean));
        let n = values.len() as f64;
        Self { mean, square, deviation: libm::sqrt(square * n / (n - 1.0)) }
    }
}

/// Values of equal distance in probability, of weighted `points` in ascending order.
fn quantiles(points: &[(f64, f64)]) -> Vec<f64> {
    let sum: f64 = points.iter().map(|(_, weight)| weight).sum();
    let mut below = 0.0;
    let mut at = 0;
    let last = points.len() - 1;
    let mut quantile = |wanted: f64| {
        while at < last && below + points[at].1 < wanted * sum {
            below += points[at].1;
            at += 1;
        }
        points[at].0
    };
    (0..VALUES).map(|i| quantile(i as f64 / (VALUES - 1) as f64)).collect()
}
