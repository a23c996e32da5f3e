//! Root of the sum of squares, and what every contributor has in it.

use super::{derivative::Expansion, worst_case::reaches};
use crate::model::{Model, Variation};

/// Root sum of squares of one measure (SI).
#[derive(Clone, Debug, PartialEq)]
pub struct RootSumSquare {
    /// Value at the middle of all limits.
    pub middle: f64,
    /// √ΣΣ ρᵢⱼ·pᵢ·pⱼ of the parts p = slope · half the tolerance, with the model's correlations ρ; of a plane, three standard
    /// deviations of its variables are half the tolerance.
    pub tolerance: f64,
    /// The same by the factors that practice found wanting: parts drift and are not normal.
    pub modified: Modified,
    /// Standard deviation of first order, with the contributors' own deviations and correlations.
    pub deviation: f64,
    /// Share of every contributor in the variance of first order. With correlations a share can be negative; all add up
    /// to 1.
    pub shares: Vec<f64>,
}

/// The factor of A. Bender ("Statistical tolerancing as it relates to quality control and the designer", SAE 680490, 1968).
pub const BENDER: f64 = 1.5;
/// The factor of J. Gilson (*A new approach to engineering tolerances*, 1951), for means that shift.
pub const GILSON: f64 = 1.6;

/// A root sum of squares multiplied by factors of practice (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modified {
    /// [`BENDER`] times it.
    pub bender: f64,
    /// [`GILSON`] times it.
    pub gilson: f64,
    /// With the factor 1 + ½(worst case − RSS)/(RSS·(√n − 1)) of n tolerances: 1.5 for equal ones, but
    /// never more than the worst case, which two equal ones reach.
    pub by_count: f64,
}

impl Modified {
    /// Of a root sum of squares, the worst case beside it, and the number of tolerances that take part.
    fn new(tolerance: f64, worst: f64, count: usize) -> Self {
        let more = libm::sqrt(count as f64) - 1.0;
        let by_count = if count > 1 { tolerance + 0.5 * (worst - tolerance) / more } else { worst };
        Self { bender: BENDER * tolerance, gilson: GILSON * tolerance, by_count: by_count.min(worst) }
    }
}

/// Of every measure: `middle` is expanded around the middle of the limits, `mean` around the mean of the variables with
/// the given `deviations`.
pub fn root_sum_square(model: &Model, middle: &Expansion, mean: &Expansion, deviations: &[f64]) -> Vec<RootSumSquare> {
    let offsets = model.offsets();
    let correlation = model.correlation();
    let halves: Vec<f64> = model
        .contributors
        .iter()
        .zip(&offsets)
        .flat_map(|(contributor, at)| match &contributor.variation {
            Variation::Scalar { limits: [low, high], .. } => vec![0.5 * (high - low)],
            zone @ (Variation::Zone(_) | Variation::Disc(_) | Variation::Nested(_)) => {
                deviations[*at..at + zone.variables()].iter().map(|d| 3.0 * d).collect()
            }
        })
        .collect();
    let measure = |i: usize| {
        let parts = |slopes: &[f64], spreads: &[f64]| -> Vec<f64> {
            let moves: Vec<f64> = slopes.iter().zip(spreads).map(|(slope, spread)| slope * spread).collect();
            correlation.times(&moves).iter().zip(&moves).map(|(with, own)| with * own).collect()
        };
        let square: f64 = parts(&middle.slopes[i], &halves).iter().sum();
        let parts = parts(&mean.slopes[i], deviations);
        let variance: f64 = parts.iter().sum();
        let share = |(contributor, at): (&crate::model::Contributor, &usize)| {
            let own: f64 = parts[*at..at + contributor.variation.variables()].iter().sum();
            if variance > 0.0 { own / variance } else { 0.0 }
        };
        let tolerance = libm::sqrt(square.max(0.0));
        let reaches = reaches(model, &middle.slopes[i]).into_iter().map(|[down, up]| 0.5 * (down + up));
        let reaches: Vec<f64> = reaches.filter(|reach| *reach > 0.0).collect();
        RootSumSquare {
            middle: middle.values[i],
            tolerance,
            modified: Modified::new(tolerance, reaches.iter().sum(), reaches.len()),
            deviation: libm::sqrt(variance),
            shares: model.contributors.iter().zip(&offsets).map(share).collect(),
        }
    };
    (0..model.measures.len()).map(measure).collect()
}

#[cfg(test)]
mod tests {
    use super::Modified;

    #[test]
    fn factors_of_practice() {
        // Four equal tolerances of 0.1: worst case 0.4, RSS 0.2, half of the difference over √4 − 1.
        let found = Modified::new(0.2, 0.4, 4);
        assert!((found.bender - 0.3).abs() < 1e-15 && (found.gilson - 0.32).abs() < 1e-15);
        assert!((found.by_count - 0.3).abs() < 1e-15);
        assert_eq!(Modified::new(0.1, 0.1, 1).by_count, 0.1);
    }
}
