//! How the correlation of two measures spreads from sample to sample.

use crate::{
    model::Model,
    numeric::lanes::{LANES, Lanes},
    theory::moments::drawn,
};

/// Units whose joint moments are taken.
const UNITS: u64 = 1 << 14;
/// The most random numbers for that: wide models have fewer units.
const MOST_NUMBERS: u64 = 1 << 23;

/// Correlations of all measures and their spread.
#[derive(Clone, Debug, Default)]
pub struct Pairs {
    /// Of measures j < i, row after row: the coefficient, and its standard error times the root of the number of units.
    spreads: Vec<[f64; 2]>,
}

impl Pairs {
    /// Of the measures of `model`, from units drawn for it: of the influence function xy − ½ρ(x² + y²) of standardised
    /// measures the mean square.
    pub fn new(model: &Model) -> Self {
        let count = model.measures.len();
        if count < 2 {
            return Self::default();
        }
        let most = (MOST_NUMBERS / model.variables().max(1) as u64).max(64);
        let units = UNITS.min(1 << most.ilog2());
        let mut rows = vec![Vec::with_capacity(units as usize); count];
        let mut measures = vec![Lanes::ZERO; count];
        drawn(model, units, |variables| {
            model.function.evaluate(variables, &mut measures);
            if (0..LANES).all(|lane| measures.iter().all(|measure| measure.0[lane].is_finite())) {
                rows.iter_mut().zip(&measures).for_each(|(row, measure)| row.extend(measure.0));
            }
        });
        rows.iter_mut().for_each(|row| standardise(row));
        let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
        Self { spreads: pairs.map(|(i, j)| spread(&rows[i], &rows[j])).collect() }
    }

    /// The coefficient of measures j < i and its standard error in a sample of `units`.
    pub fn error(&self, i: usize, j: usize, units: f64) -> [f64; 2] {
        let [correlation, spread] = self.spreads[i * (i - 1) / 2 + j];
        [correlation, spread / libm::sqrt(units)]
    }
}

fn standardise(row: &mut [f64]) {
    let n = row.len() as f64;
    let mean = row.iter().sum::<f64>() / n;
    let deviation = libm::sqrt(row.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n);
    row.iter_mut().for_each(|x| *x = (*x - mean) / deviation);
}

fn spread(one: &[f64], other: &[f64]) -> [f64; 2] {
    let n = one.len() as f64;
    let rho = one.iter().zip(other).map(|(x, y)| x * y).sum::<f64>() / n;
    let influence = |(x, y): (&f64, &f64)| x * y - 0.5 * rho * (x * x + y * y);
    let square = one.iter().zip(other).map(influence).map(|psi| psi * psi).sum::<f64>() / n;
    [rho, libm::sqrt(square)]
}

#[cfg(test)]
mod tests {
    use super::Pairs;
    use crate::examples::{linear, normals};

    #[test]
    fn normal_pairs_have_the_known_error() {
        let mut model = normals(&[1.0, 1.0]);
        model = linear(model.contributors, vec![vec![1.0, 0.0], vec![0.6, 0.8], vec![0.0, 1.0]]);
        let pairs = Pairs::new(&model);
        for (i, j, rho) in [(1, 0, 0.6), (2, 0, 0.0), (2, 1, 0.8)] {
            // (1 − ρ²)/√n.
            let [found, error] = pairs.error(i, j, 100.0);
            assert!((found - rho).abs() < 1e-3 && (error - 0.1 * (1.0 - rho * rho)).abs() < 1e-3, "{found} {error}");
        }
    }
}
