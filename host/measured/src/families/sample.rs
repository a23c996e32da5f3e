//! A sample, as fits start from it.

use super::kind::{FitError, Kind};

/// A sample as fits start from it.
pub struct Sample {
    pub sorted: Vec<f64>,
    pub mean: f64,
    /// The root of the mean square from the mean, which is the likeliest standard deviation.
    pub deviation: f64,
}

impl Sample {
    pub fn new(values: &[f64]) -> Result<Self, FitError> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else {
            return Err(FitError::FewParts { family: Kind::Normal, least: 2, found: 0 });
        };
        if first == last {
            return Err(FitError::NoVariation(*first));
        }
        let (mean, square) = mean_and_square(&sorted);
        let deviation = libm::sqrt(square);
        if !deviation.is_finite() || deviation <= 0.0 {
            return Err(FitError::TooFarApart);
        }
        Ok(Self { mean, deviation, sorted })
    }

    pub fn least(&self) -> f64 {
        self.sorted.first().copied().unwrap_or_default()
    }

    pub fn greatest(&self) -> f64 {
        self.sorted.last().copied().unwrap_or_default()
    }

    pub fn median(&self) -> f64 {
        self.sorted.get(self.sorted.len() / 2).copied().unwrap_or_default()
    }
}

/// The mean of `values` and their mean square from it.
pub fn mean_and_square(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let first = values.first().copied().unwrap_or_default();
    let mean = first + values.iter().map(|x| (x - first) / n).sum::<f64>();
    (mean, values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n)
}
