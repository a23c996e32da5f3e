//! Correlations of a model's variables, and what makes independent scores correlated.

use super::{copula, error::DrawError};
use crate::model::{Model, Variation};

/// Row of the Cholesky factor: a variable, and the weights of variables up to it.
pub(crate) type Row = (usize, Vec<(usize, f64)>);

impl Model {
    /// Correlations of the variables themselves.
    pub fn correlation(&self) -> Correlation {
        let offsets = self.offsets();
        let of = |(one, other, coefficient): &(usize, usize, f64)| {
            let value = match [*one, *other].map(|contributor| &self.contributors[contributor].variation) {
                [Variation::Scalar { distribution: one, .. }, Variation::Scalar { distribution: other, .. }] => {
                    copula::of_values(one, other, *coefficient)
                }
                // Zones are normal where they are correlated at all.
                _ => *coefficient,
            };
            (offsets[*one], offsets[*other], value)
        };
        Correlation(self.correlations.iter().map(of).collect())
    }
}

/// A correlation matrix: ones on its diagonal, and few other entries that are not 0.
pub struct Correlation(Vec<(usize, usize, f64)>);

impl Correlation {
    /// Pairs of variables and their coefficients.
    pub fn pairs(&self) -> &[(usize, usize, f64)] {
        &self.0
    }

    /// The matrix times a vector.
    pub fn times(&self, vector: &[f64]) -> Vec<f64> {
        let mut product = vector.to_vec();
        for (one, other, coefficient) in &self.0 {
            product[*one] += coefficient * vector[*other];
            product[*other] += coefficient * vector[*one];
        }
        product
    }
}

/// Rows of the factor L of the correlation matrix L·Lᵀ that differ from those of the unit matrix.
pub(crate) fn cholesky(model: &Model) -> Result<Vec<Row>, DrawError> {
    let offsets = model.offsets();
    let name = |variable: usize| {
        let contributor = offsets.iter().rposition(|offset| *offset <= variable).unwrap_or(0);
        model.contributors[contributor].name.clone()
    };
    let mut members: Vec<usize> = Vec::new();
    for (one, other, _) in &model.correlations {
        for contributor in [*one, *other] {
            if model.contributors[contributor].variation.variables() != 1 {
                return Err(DrawError::NotScalar(model.contributors[contributor].name.clone()));
            }
            members.push(offsets[contributor]);
        }
    }
    members.sort_unstable();
    members.dedup();
    let place = |contributor: usize| members.binary_search(&offsets[contributor]).unwrap_or(0);
    let mut matrix = vec![vec![0.0; members.len()]; members.len()];
    for (one, other, coefficient) in &model.correlations {
        let (i, j) = (place(*one), place(*other));
        (matrix[i][j], matrix[j][i]) = (*coefficient, *coefficient);
    }
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (i, variable) in members.iter().enumerate() {
        let mut row = Vec::with_capacity(i + 1);
        for (j, above) in rows.iter().enumerate() {
            let known: f64 = row.iter().zip(above).map(|(a, b): (&f64, &f64)| a * b).sum();
            row.push((matrix[i][j] - known) / above[j]);
        }
        let rest = 1.0 - row.iter().map(|a| a * a).sum::<f64>();
        if rest.is_nan() || rest <= 1e-12 {
            return Err(DrawError::NotPositiveDefinite(name(*variable)));
        }
        row.push(libm::sqrt(rest));
        rows.push(row);
    }
    let weighted = |row: Vec<f64>| members.iter().copied().zip(row).collect();
    Ok(members.iter().copied().zip(rows.into_iter().map(weighted)).collect())
}
