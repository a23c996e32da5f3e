//! Moments of second order: of the quadratic that touches a measure at the means of its variables.
//!
//! The cumulants of a quadratic b·z + ½ zᵀAz of independent standard normals are known in closed form: ½ tr A, b² +
//! ½ tr A², 3 bᵀAb + tr A³, 12 bᵀA²b + 3 tr A⁴. A contributor that is not normal then has the cumulants of its own part of the
//! quadratic exchanged for those by quadrature. So they are exact for normal variables, and for a linear measure whatever
//! its variables are.

use nalgebra::{DMatrix, DVector};

use super::{
    derivative::{Expansion, expansion, mixed},
    model::{Distribution, Model, Variation, ZoneRule},
    quadrature::{Node, mean_and_deviation, nodes},
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
}

/// Means and standard deviations of all variables.
pub fn spreads(model: &Model) -> (Vec<f64>, Vec<f64>) {
    let spreads = model.contributors.iter().flat_map(|contributor| mean_and_deviation(&contributor.variation));
    spreads.map(|[mean, deviation]| (mean, deviation)).unzip()
}

/// Of every measure.
pub fn of_measures(model: &Model) -> Vec<Moments> {
    let (means, deviations) = spreads(model);
    moments(model, &expansion(model, &means, &deviations), &means, &deviations)
}

/// Of every measure; `around` is expanded around `means`.
pub fn moments(model: &Model, around: &Expansion, means: &[f64], deviations: &[f64]) -> Vec<Moments> {
    let mixed = mixed(model, means, deviations);
    let factor = factor(model);
    let groups: Vec<Group> = groups(model, means);
    let measure = |i: usize| {
        let count = means.len();
        let mut hessian = DMatrix::from_diagonal(&DVector::from_column_slice(&around.curvatures[i]));
        for (j, k, derivatives) in &mixed {
            hessian[(*j, *k)] = derivatives[i];
            hessian[(*k, *j)] = derivatives[i];
        }
        let slopes = DVector::from_column_slice(&around.slopes[i]);
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
        }
    };
    (0..model.measures.len()).map(measure).collect()
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
