//! Root of the sum of squares, and what every contributor has in it.

use super::{
    derivative::Expansion,
    model::{Model, Variation},
};

/// Root sum of squares of one measure (SI).
#[derive(Clone, Debug, PartialEq)]
pub struct RootSumSquare {
    /// Value at the middle of all limits.
    pub middle: f64,
    /// √Σ(slope · half the tolerance)²; of a plane, three standard deviations of its variables are half the tolerance.
    pub tolerance: f64,
    /// Standard deviation of first order, with the contributors' own deviations and correlations.
    pub deviation: f64,
    /// Share of every contributor in the variance of first order. With correlations a share can be negative; all add up
    /// to 1.
    pub shares: Vec<f64>,
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
        let square = |(slope, half): (&f64, &f64)| slope * half * (slope * half);
        let moves: Vec<f64> =
            mean.slopes[i].iter().zip(deviations).map(|(slope, deviation)| slope * deviation).collect();
        let parts: Vec<f64> = correlation.times(&moves).iter().zip(&moves).map(|(with, own)| with * own).collect();
        let variance: f64 = parts.iter().sum();
        let share = |(contributor, at): (&super::model::Contributor, &usize)| {
            let own: f64 = parts[*at..at + contributor.variation.variables()].iter().sum();
            if variance > 0.0 { own / variance } else { 0.0 }
        };
        RootSumSquare {
            middle: middle.values[i],
            tolerance: libm::sqrt(middle.slopes[i].iter().zip(&halves).map(square).sum()),
            deviation: libm::sqrt(variance),
            shares: model.contributors.iter().zip(&offsets).map(share).collect(),
        }
    };
    (0..model.measures.len()).map(measure).collect()
}
