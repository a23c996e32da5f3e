//! Means and standard deviations without sampling: of a distribution in closed form, of a model's measures from their
//! derivatives.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use slipfit_core::clearance::GapStatistics;

use crate::tolerance::{
    lanes::{LANES, Lanes},
    model::{Distribution, Model, Variation, ZoneRule},
};

/// Variance of u, p and r of [`ZoneRule::Truncated`]: ∫u²φ/∫φ over |u| + |p| + |r| ≤ 1, φ the density of three
/// independent normals of standard deviation 1/(3√3).
const TRUNCATED_VARIANCE: f64 = 0.035_777_505_109_214;

/// Mean and variance of a distribution.
pub(super) fn of(distribution: &Distribution) -> (f64, f64) {
    match distribution {
        Distribution::Constant(value) => (*value, 0.0),
        Distribution::Normal { mean, deviation } | Distribution::Skewed { mean, deviation, .. } => {
            (*mean, deviation * deviation)
        }
        Distribution::TruncatedNormal { mean, deviation, limits } => truncated(*mean, *deviation, *limits),
        Distribution::Uniform { limits } => trapezoid(*limits, *limits),
        Distribution::Triangular { limits, mode } => trapezoid(*limits, [*mode; 2]),
        Distribution::Trapezoidal { limits, shoulders } => trapezoid(*limits, *shoulders),
        Distribution::Table(values) => table(values),
    }
}

fn truncated(mean: f64, deviation: f64, limits: [f64; 2]) -> (f64, f64) {
    let [a, b] = limits.map(|limit| (limit - mean) / deviation);
    let density = |x: f64| libm::exp(-x * x / 2.0) / libm::sqrt(2.0 * PI);
    let below = |x: f64| libm::erfc(-x * FRAC_1_SQRT_2) / 2.0;
    let inside = below(b) - below(a);
    let shift = (density(a) - density(b)) / inside;
    let variance = 1.0 + (a * density(a) - b * density(b)) / inside - shift * shift;
    (mean + deviation * shift, deviation * deviation * variance)
}

/// Density constant between the shoulders b and c, falling linearly to the limits 0 and d, counted from the lower one.
fn trapezoid([lower, upper]: [f64; 2], shoulders: [f64; 2]) -> (f64, f64) {
    let ([b, c], d) = (shoulders.map(|shoulder| shoulder - lower), upper - lower);
    let weight = d + c - b;
    let mean = (d * d + c * d + c * c - b * b) / (3.0 * weight);
    let square = ((d * d + c * c) * (d + c) - b * b * b) / (6.0 * weight);
    (lower + mean, square - mean * mean)
}

/// Linear between the values: a mixture of uniform pieces of equal weight.
fn table(values: &[f64]) -> (f64, f64) {
    let pieces = values.len() as f64 - 1.0;
    let over = |f: &dyn Fn(f64, f64) -> f64| values.windows(2).map(|piece| f(piece[0], piece[1])).sum::<f64>() / pieces;
    let mean = over(&|a, b| (a + b) / 2.0);
    let variance = over(&|a, b| {
        let (a, b) = (a - mean, b - mean);
        (a * a + a * b + b * b) / 3.0
    });
    (mean, variance)
}

/// Mean and standard deviation of every variable of `model`.
fn of_variables(model: &Model) -> Vec<(f64, f64)> {
    let mut moments = Vec::new();
    for contributor in &model.contributors {
        match &contributor.variation {
            Variation::Scalar { distribution, .. } => {
                let (mean, variance) = of(distribution);
                moments.push((mean, libm::sqrt(variance)));
            }
            Variation::Zone(ZoneRule::Translation) => moments.push((0.0, 1.0 / 3.0)),
            Variation::Zone(rule) => {
                let variance = match rule {
                    ZoneRule::Truncated => TRUNCATED_VARIANCE,
                    ZoneRule::UniformInZone => 0.1,
                    ZoneRule::SigmaZone | ZoneRule::Translation => 1.0 / 27.0,
                };
                moments.extend([(0.0, libm::sqrt(variance)); 3]);
            }
        }
    }
    moments
}

/// Mean (to second order in the variables) and standard deviation (to first) of every measure of `model`. SI units.
///
/// A coefficient of correlation, which is that of normal scores, is taken for that of the values.
pub fn of_measures(model: &Model) -> Vec<GapStatistics<f64>> {
    /// Standard deviations to either side.
    const STEP: f64 = 0.1;
    let variables = of_variables(model);
    let mut inputs: Vec<_> = variables.iter().map(|(mean, _)| Lanes::splat(*mean)).collect();
    let mut outputs = vec![Lanes::ZERO; model.measures.len()];
    model.function.evaluate(&inputs, &mut outputs);
    let nominal: Vec<f64> = outputs.iter().map(|measure| measure.0[0]).collect();

    // Slopes and curvatures by one standard deviation, variable by variable.
    let mut mean = nominal.clone();
    let mut slopes = vec![vec![0.0; variables.len()]; nominal.len()];
    for first in (0..variables.len()).step_by(LANES / 2) {
        let moved = first..variables.len().min(first + LANES / 2);
        for (pair, i) in moved.clone().enumerate() {
            let (middle, deviation) = variables[i];
            inputs[i].0[2 * pair] = middle + STEP * deviation;
            inputs[i].0[2 * pair + 1] = middle - STEP * deviation;
        }
        model.function.evaluate(&inputs, &mut outputs);
        for (measure, output) in outputs.iter().enumerate() {
            for (pair, i) in moved.clone().enumerate() {
                let (up, down) = (output.0[2 * pair], output.0[2 * pair + 1]);
                slopes[measure][i] = (up - down) / (2.0 * STEP);
                mean[measure] += (up - 2.0 * nominal[measure] + down) / (2.0 * STEP * STEP);
            }
        }
        for i in moved {
            inputs[i] = Lanes::splat(variables[i].0);
        }
    }

    let first = first_variables(model);
    let deviations = slopes.iter().map(|slope| {
        let independent: f64 = slope.iter().map(|s| s * s).sum();
        let joint = |(row, column, coefficient): &(usize, usize, f64)| {
            2.0 * coefficient * slope[first[*row]] * slope[first[*column]]
        };
        libm::sqrt(independent + model.correlations.iter().map(joint).sum::<f64>())
    });
    mean.iter().zip(deviations).map(|(mean, deviation)| GapStatistics { mean: *mean, deviation }).collect()
}

/// The first variable of every contributor.
fn first_variables(model: &Model) -> Vec<usize> {
    let sizes = model.contributors.iter().map(|contributor| match contributor.variation {
        Variation::Scalar { .. } | Variation::Zone(ZoneRule::Translation) => 1,
        Variation::Zone(_) => 3,
    });
    sizes.scan(0, |next, size| Some(std::mem::replace(next, *next + size))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments by the midpoint rule from a density.
    fn numeric(limits: [f64; 2], density: impl Fn(f64) -> f64) -> (f64, f64) {
        const CELLS: usize = 100_000;
        let width = (limits[1] - limits[0]) / CELLS as f64;
        let points = (0..CELLS).map(|i| limits[0] + (i as f64 + 0.5) * width);
        let sums = points.fold([0.0; 3], |[a, b, c], x| {
            let p = density(x) * width;
            [a + p, b + p * x, c + p * x * x]
        });
        let mean = sums[1] / sums[0];
        (mean, sums[2] / sums[0] - mean * mean)
    }

    #[test]
    fn closed_forms_agree_with_integrals() {
        let limits = [-1.0, 3.0];
        let normal = |x: f64| libm::exp(-(x - 0.5) * (x - 0.5) / 2.0);
        let ramp = |x: f64, b: f64, c: f64| {
            if x < b {
                (x + 1.0) / (b + 1.0)
            } else if x > c {
                (3.0 - x) / (3.0 - c)
            } else {
                1.0
            }
        };
        let piecewise = |x: f64| if x < 0.0 { 1.0 } else { 1.0 / 3.0 };
        for (distribution, expected) in [
            (Distribution::TruncatedNormal { mean: 0.5, deviation: 1.0, limits }, numeric(limits, normal)),
            (Distribution::Uniform { limits }, (1.0, 4.0 / 3.0)),
            (Distribution::Triangular { limits, mode: 0.0 }, numeric(limits, |x| ramp(x, 0.0, 0.0))),
            (Distribution::Trapezoidal { limits, shoulders: [0.0, 2.5] }, numeric(limits, |x| ramp(x, 0.0, 2.5))),
            (Distribution::Table(vec![-1.0, 0.0, 3.0]), numeric(limits, piecewise)),
            (Distribution::Skewed { mean: 1.0, deviation: 2.0, skewness: 0.5 }, (1.0, 4.0)),
            (Distribution::Constant(3.0), (3.0, 0.0)),
        ] {
            let (mean, variance) = of(&distribution);
            assert!((mean - expected.0).abs() < 1e-8 && (variance - expected.1).abs() < 1e-8, "{distribution:?}");
        }
    }

    #[test]
    fn variance_in_the_truncated_zone() {
        const CELLS: usize = 2000;
        let width = 1.0 / CELLS as f64;
        let deviation = 1.0 / (3.0 * libm::sqrt(3.0));
        let scaled = |x: f64| x / deviation;
        let density = |x: f64| libm::exp(-scaled(x) * scaled(x) / 2.0);
        let (mut weight, mut square) = (0.0, 0.0);
        for i in 0..CELLS {
            let u = (i as f64 + 0.5) * width;
            for j in 0..CELLS - i {
                let p = (j as f64 + 0.5) * width;
                let cell = density(u) * density(p) * libm::erf(scaled((1.0 - u - p).max(0.0)) * FRAC_1_SQRT_2);
                (weight, square) = (weight + cell, square + cell * u * u);
            }
        }
        assert!((square / weight - TRUNCATED_VARIANCE).abs() < 1e-7, "{}", square / weight);
    }
}
