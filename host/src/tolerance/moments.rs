//! Moments of second order: of the quadratic that touches a measure at the means of its variables.
//!
//! The cumulants of a quadratic b·z + ½ zᵀAz of independent standard normals are known in closed form: ½ tr A, b² +
//! ½ tr A², 3 bᵀAb + tr A³, 12 bᵀA²b + 3 tr A⁴. A contributor that is not normal then has the cumulants of its own part of the
//! quadratic exchanged for those by quadrature. So they are exact for normal variables, and for a linear measure whatever
//! its variables are.
//!
//! A quadratic knows nothing of a kink or a fold, such as that of a radius or an angle at 0. Where it does not describe units
//! drawn at random, their own moments are taken.

use nalgebra::{DMatrix, DVector};

use super::{
    derivative::{Expansion, evaluate, expansion, mixed},
    draw::Draw,
    lanes::{LANES, Lanes},
    model::{Distribution, Model, Variation, ZoneRule},
    quadrature::{Node, mean_and_deviation, nodes},
    sampler::{Method, Sampler},
    sobol::MOST_DIMENSIONS,
};

/// Moments of one measure (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: f64,
    /// How far the mean lies from the value at the means of the variables.
    pub shift: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Skewness.
    pub skewness: f64,
    /// Kurtosis; 3 for a normal.
    pub kurtosis: f64,
    /// Share of the curvature in the variance: 0 for a linear measure.
    pub curved: f64,
    /// Whether the quadratic describes units drawn at random: not where the measure has a kink or a fold.
    pub described: bool,
}

/// Means and standard deviations of all variables.
pub fn spreads(model: &Model) -> (Vec<f64>, Vec<f64>) {
    let spreads = model.contributors.iter().flat_map(|contributor| mean_and_deviation(&contributor.variation));
    spreads.map(|[mean, deviation]| (mean, deviation)).unzip()
}

/// Of every measure; drawn where the quadratic does not describe it.
pub fn of_measures(model: &Model) -> Vec<Moments> {
    let (means, deviations) = spreads(model);
    moments(model, &expansion(model, &means, &deviations), &means, &deviations)
}

/// Units whose moments are taken where there is no formula.
const DRAWN: u64 = 1 << 16;
/// Units that show whether the quadratic describes a measure.
const WITNESSES: u64 = 128;
/// How far the quadratic may be off, root mean square over the spread of the measure.
const OFF: f64 = 0.05;
/// What they are drawn with.
const SEED: u64 = 1;

/// Variables of `count` units by scrambled Sobol' points, where these have coordinates enough; none if none can be drawn.
fn units(model: &Model, count: u64) -> Vec<Vec<f64>> {
    let Ok(draw) = Draw::new(model, SEED) else { return Vec::new() };
    let dimensions = draw.dimensions();
    let method = if dimensions > MOST_DIMENSIONS { Method::PseudoRandom } else { Method::ScrambledSobol };
    let sampler = Sampler::new(method, SEED, dimensions, 1, count);
    let mut bits = vec![[0; LANES]; dimensions];
    let mut variables = vec![Lanes::ZERO; dimensions];
    let mut units = Vec::with_capacity(count as usize);
    for first in (0..count).step_by(LANES) {
        sampler.fill(first, &mut bits);
        draw.variables(first, &bits, &mut variables);
        units.extend((0..LANES).map(|lane| variables.iter().map(|variable| variable.0[lane]).collect()));
    }
    units
}

/// Mean, standard deviation, skewness and kurtosis of the values that are numbers.
fn of_values(values: impl Iterator<Item = f64> + Clone) -> [f64; 4] {
    let values = values.filter(|value| value.is_finite());
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let [second, third, fourth] =
        [2, 3, 4].map(|power| values.clone().map(|x| libm::pow(x - mean, f64::from(power))).sum::<f64>() / count);
    let deviation = libm::sqrt(second);
    [mean, deviation, third / (second * deviation), fourth / (second * second)]
}

/// Of every measure, drawn where the quadratic does not describe it; `around` is expanded around `means`.
pub fn moments(model: &Model, around: &Expansion, means: &[f64], deviations: &[f64]) -> Vec<Moments> {
    let mixed = mixed(model, means, deviations);
    let factor = factor(model);
    let groups: Vec<Group> = groups(model, means);
    let witnesses = units(model, WITNESSES);
    let witnessed = evaluate(model, &witnesses);
    let apart = DMatrix::from_fn(means.len(), witnesses.len(), |k, unit| witnesses[unit][k] - means[k]);
    let measure = |i: usize| {
        let count = means.len();
        let mut hessian = DMatrix::from_diagonal(&DVector::from_column_slice(&around.curvatures[i]));
        for (j, k, derivatives) in &mixed {
            hessian[(*j, *k)] = derivatives[i];
            hessian[(*k, *j)] = derivatives[i];
        }
        let slopes = DVector::from_column_slice(&around.slopes[i]);
        let bent = &hessian * &apart;
        let error = |unit: usize| {
            let (x, bent) = (apart.column(unit), bent.column(unit));
            let found = witnessed[unit][i] - (around.values[i] + slopes.dot(&x) + 0.5 * x.dot(&bent));
            found * found
        };
        let square = (0..witnesses.len()).map(error).sum::<f64>() / witnesses.len().max(1) as f64;
        let [_, spread, ..] = of_values(witnessed.iter().map(|unit| unit[i]));
        // What varies by rounding alone is described well enough.
        let least = 1e-12 * around.values[i].abs();
        let described = witnesses.is_empty() || libm::sqrt(square) <= (OFF * spread).max(least);
        let b = DVector::from_fn(count, |k, _| slopes[k] * deviations[k]);
        let a = DMatrix::from_fn(count, count, |j, k| hessian[(j, k)] * deviations[j] * deviations[k]);
        let (b, a) = match &factor {
            Some(factor) => (factor.transpose() * b, factor.transpose() * a * factor),
            None => (b, a),
        };
        let curved = 0.5 * a.norm_squared();
        let mut cumulants = gaussian(&b, &a);
        for group in &groups {
            let (b, a) = (
                b.rows(group.at, group.count).into_owned(),
                a.view((group.at, group.at), (group.count, group.count)).into_owned(),
            );
            let h = hessian.view((group.at, group.at), (group.count, group.count)).into_owned();
            let g = slopes.rows(group.at, group.count).into_owned();
            let (own, gaussian) = (group.cumulants(&g, &h), gaussian(&b, &a));
            for ((cumulant, own), gaussian) in cumulants.iter_mut().zip(own).zip(gaussian) {
                *cumulant += own - gaussian;
            }
        }
        let [shift, variance, third, fourth] = cumulants;
        Moments {
            mean: around.values[i] + shift,
            shift,
            deviation: libm::sqrt(variance),
            skewness: third / (variance * libm::sqrt(variance)),
            kurtosis: 3.0 + fourth / (variance * variance),
            curved: if variance > 0.0 { curved / variance } else { 0.0 },
            described,
        }
    };
    let mut moments: Vec<Moments> = (0..model.measures.len()).map(measure).collect();
    if moments.iter().any(|moments| !moments.described) {
        let values = evaluate(model, &units(model, DRAWN));
        for (i, found) in moments.iter_mut().enumerate().filter(|(_, found)| !found.described) {
            let [mean, deviation, skewness, kurtosis] = of_values(values.iter().map(|unit| unit[i]));
            *found = Moments { mean, shift: mean - around.values[i], deviation, skewness, kurtosis, ..*found };
        }
    }
    moments
}

/// The first four cumulants of b·z + ½ zᵀAz.
fn gaussian(b: &DVector<f64>, a: &DMatrix<f64>) -> [f64; 4] {
    let square = a * a;
    let turned = a * b;
    [
        0.5 * a.trace(),
        b.norm_squared() + 0.5 * square.trace(),
        3.0 * b.dot(&turned) + square.dot(a),
        12.0 * turned.norm_squared() + 3.0 * square.norm_squared(),
    ]
}

/// Variables of a contributor that are not independent normals.
struct Group {
    at: usize,
    count: usize,
    /// Nodes about the mean.
    nodes: Vec<Node>,
}

impl Group {
    /// The first four cumulants of g·x + ½ xᵀHx.
    fn cumulants(&self, g: &DVector<f64>, h: &DMatrix<f64>) -> [f64; 4] {
        let value = |x: &[f64; 3]| {
            let row = |j: usize| x[j] * (g[j] + 0.5 * (0..self.count).map(|k| h[(j, k)] * x[k]).sum::<f64>());
            (0..self.count).map(row).sum::<f64>()
        };
        let values: Vec<(f64, f64)> = self.nodes.iter().map(|node| (node.weight, value(&node.at))).collect();
        let mean: f64 = values.iter().map(|(weight, value)| weight * value).sum();
        let [mut m2, mut m3, mut m4] = [0.0; 3];
        for (weight, value) in values {
            let d = value - mean;
            m2 += weight * d * d;
            m3 += weight * d * d * d;
            m4 += weight * d * d * d * d;
        }
        [mean, m2, m3, m4 - 3.0 * m2 * m2]
    }
}

fn groups(model: &Model, means: &[f64]) -> Vec<Group> {
    let correlated = |contributor: usize| {
        model.correlations.iter().any(|(one, other, _)| *one == contributor || *other == contributor)
    };
    let group = |(number, (contributor, at)): (usize, (&super::model::Contributor, usize))| {
        let normal = matches!(
            &contributor.variation,
            Variation::Scalar { distribution: Distribution::Normal { .. } | Distribution::Constant(_), .. }
                | Variation::Zone(ZoneRule::SigmaZone | ZoneRule::Translation)
                | Variation::Disc(ZoneRule::SigmaZone | ZoneRule::Translation)
        );
        if normal || correlated(number) {
            return None;
        }
        let count = contributor.variation.variables();
        let mut nodes = nodes(&contributor.variation);
        for node in &mut nodes {
            node.at.iter_mut().zip(&means[at..at + count]).for_each(|(x, mean)| *x -= mean);
        }
        Some(Group { at, count, nodes })
    };
    model.contributors.iter().zip(model.offsets()).enumerate().filter_map(group).collect()
}

/// The Cholesky factor of the correlations, if there are any.
fn factor(model: &Model) -> Option<DMatrix<f64>> {
    if model.correlations.is_empty() {
        return None;
    }
    let rows = model.correlation();
    let matrix = DMatrix::from_fn(rows.len(), rows.len(), |j, k| rows[j][k]);
    matrix.cholesky().map(|factor| factor.l())
}
