//! Covariance of estimates whose residuals depend on each other.

use nalgebra::{DMatrix, DVector};

use crate::{beforehand::Beforehand, fit::Fit, signal::noise::Noise};

/// An estimate as one of least squares: derivatives, and residuals that a robust loss has cut.
#[derive(Clone, Debug)]
pub struct Linearised {
    /// Derivatives of the output by each parameter, divided by [`units`](Self::units) of it.
    pub columns: Vec<Vec<f64>>,
    /// Residuals.
    pub residuals: Vec<f64>,
    /// Number of samples of each run.
    pub runs: Vec<usize>,
    /// Parameters in which the columns have the length 1; 0 for one without influence.
    pub units: Vec<f64>,
    /// Inverse of the columns' products, of their combinations that are determined.
    pub inverse: DMatrix<f64>,
    /// Combinations, of parameters in their units, that are not determined.
    pub undetermined: Vec<DVector<f64>>,
}

/// Singular values, of columns of length 1, below which a combination is not determined.
const LEAST_SINGULAR: f64 = 1e-4;

impl Linearised {
    /// About a `fit` of `runs` of these lengths.
    pub fn of(fit: &Fit, runs: Vec<usize>) -> Self {
        let n = fit.residuals.len();
        let slope =
            fit.residuals.iter().map(|residual| fit.loss.psi_slope(residual / fit.scale)).sum::<f64>() / n as f64;
        let cut = |residual: &f64| fit.scale * fit.loss.psi(residual / fit.scale) / slope.max(0.1);
        Self::new(&fit.sensitivities, fit.residuals.iter().map(cut).collect(), runs)
    }

    /// Of these derivatives and residuals.
    pub fn new(sensitivities: &[Vec<f64>], residuals: Vec<f64>, runs: Vec<usize>) -> Self {
        let length = |column: &Vec<f64>| libm::sqrt(column.iter().map(|value| value * value).sum());
        let units: Vec<f64> = sensitivities
            .iter()
            .map(|column| {
                let length: f64 = length(column);
                if length > 0.0 { 1.0 / length } else { 0.0 }
            })
            .collect();
        let columns: Vec<Vec<f64>> = sensitivities
            .iter()
            .zip(&units)
            .map(|(column, unit)| column.iter().map(|value| value * unit).collect())
            .collect();
        let (inverse, undetermined) = pseudo_inverse(gram(&columns));
        Self { columns, residuals, runs, units, inverse, undetermined }
    }

    /// The covariance of the parameters with this `noise`.
    ///
    /// The fit takes part of the noise away: its variance is raised until what is left is that of the residuals.
    pub fn covariance(&self, noise: &Noise) -> DMatrix<f64> {
        let middle = self.middle(noise);
        let taken = (&self.inverse * &middle).trace();
        let all = self.residuals.len() as f64 * noise.covariances[0];
        let factor = if all > 0.0 { all / (all - taken).max(0.1 * all) } else { 1.0 };
        self.in_si(&(&self.inverse * middle * &self.inverse)) * factor
    }

    /// A covariance of parameters in their units as one of parameters in SI units.
    pub fn in_si(&self, of_units: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(of_units.nrows(), of_units.ncols(), |i, k| of_units[(i, k)] * self.units[i] * self.units[k])
    }

    /// The sum over all pairs of samples of a run of their derivatives and the covariance of their noise.
    fn middle(&self, noise: &Noise) -> DMatrix<f64> {
        let p = self.columns.len();
        let mut sum = DMatrix::zeros(p, p);
        let mut at = 0;
        for length in &self.runs {
            for (lag, covariance) in noise.covariances.iter().enumerate().take_while(|(lag, _)| lag < length) {
                for i in 0..p {
                    let early = &self.columns[i][at..at + length - lag];
                    for k in 0..p {
                        let late = &self.columns[k][at + lag..at + length];
                        let product = covariance * early.iter().zip(late).map(|(a, b)| a * b).sum::<f64>();
                        sum[(i, k)] += product;
                        if lag > 0 {
                            sum[(k, i)] += product;
                        }
                    }
                }
            }
            at += length;
        }
        sum
    }
}

/// The products of `columns` with each other.
pub fn gram(columns: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(columns.len(), columns.len(), |i, k| columns[i].iter().zip(&columns[k]).map(|(a, b)| a * b).sum())
}

/// The inverse of products of columns of length 1, and the directions without one.
pub fn pseudo_inverse(products: DMatrix<f64>) -> (DMatrix<f64>, Vec<DVector<f64>>) {
    inverse_above(LEAST_SINGULAR * LEAST_SINGULAR, products)
}

/// The inverse of a symmetric matrix without the directions of eigenvalues up to `least`, and these directions.
pub fn inverse_above(least: f64, products: DMatrix<f64>) -> (DMatrix<f64>, Vec<DVector<f64>>) {
    let p = products.nrows();
    if p == 0 {
        return (products, Vec::new());
    }
    let eigen = products.symmetric_eigen();
    let (mut inverse, mut undetermined) = (DMatrix::zeros(p, p), Vec::new());
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > least {
            inverse += vector * vector.transpose() / *value;
        } else {
            undetermined.push(vector.into_owned());
        }
    }
    (inverse, undetermined)
}

/// The covariance with what is known `beforehand`, to that by a record alone (zero along undetermined combinations). `units` are sizes of the
/// parameters in which their numbers are comparable.
pub fn with_known(beforehand: &Beforehand, of_record: &DMatrix<f64>, units: &[f64]) -> DMatrix<f64> {
    let p = units.len();
    let unit = |i: usize| if units[i] > 0.0 { units[i] } else { 1.0 };
    let mut information = inverse(DMatrix::from_fn(p, p, |i, k| of_record[(i, k)] / (unit(i) * unit(k))));
    for i in 0..p {
        information[(i, i)] += unit(i) * unit(i) * beforehand.information(i);
    }
    let covariance = inverse(information);
    DMatrix::from_fn(p, p, |i, k| covariance[(i, k)] * unit(i) * unit(k))
}

/// Share of the greatest eigenvalue below which one is rounding. What is known beforehand may be worth little beside a record.
const ROUNDING: f64 = 1e-13;

/// The inverse of a symmetric matrix of any size without the directions in which it is zero.
fn inverse(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let size = matrix.diagonal().iter().fold(f64::MIN_POSITIVE, |most, one| most.max(*one));
    inverse_above(ROUNDING, matrix / size).0 / size
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::{Beforehand, Linearised, Noise, with_known};
    use crate::model::Parameter;

    #[test]
    fn white_noise_gives_the_textbook_error() {
        // A straight line: the variance of its slope is σ²/Σ(x − x̄)².
        let n = 50;
        let x: Vec<f64> = (0..n).map(|i| 0.1 * i as f64).collect();
        let mean = x.iter().sum::<f64>() / n as f64;
        let residuals: Vec<f64> = (0..n).map(|i| if i % 2 == 0 { 0.3 } else { -0.3 }).collect();
        let linearised = Linearised::new(&[vec![1.0; n], x.clone()], residuals, vec![n]);
        let covariance = linearised.covariance(&Noise { covariances: vec![0.09] });
        let slope = 0.09 * n as f64 / (n - 2) as f64 / x.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
        assert!((covariance[(1, 1)] / slope - 1.0).abs() < 1e-9, "{covariance} {slope}");
    }

    #[test]
    fn correlated_noise_widens_the_mean() {
        let n = 4000;
        let noise = Noise { covariances: (0..200).map(|lag| libm::pow(0.9, f64::from(lag))).collect() };
        let linearised = Linearised::new(&[vec![1.0; n]], vec![0.0; n], vec![n]);
        // (1 + ρ)/(1 − ρ) times the variance of white noise.
        let ratio = linearised.covariance(&noise)[(0, 0)] * n as f64 / (1.9 / 0.1);
        assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    }

    fn known(parameters: &[Option<[f64; 2]>]) -> Beforehand {
        let parameter = |prior: &Option<[f64; 2]>| Parameter {
            name: "a".into(),
            unit: "",
            bounds: [-1e9, 1e9],
            start: 0.0,
            prior: *prior,
        };
        Beforehand::beside_independent(&parameters.iter().map(parameter).collect::<Vec<_>>())
    }

    #[test]
    fn two_sources_of_one_value_add_their_information() {
        let of_record = DMatrix::from_element(1, 1, 0.04);
        let found = with_known(&known(&[Some([2.0, 0.1])]), &of_record, &[0.5]);
        assert!((found[(0, 0)] - 1.0 / 125.0).abs() < 1e-12, "{found}");
    }

    /// Of two values only the sum is known from the record: what is known of one beforehand tells the other.
    #[test]
    fn what_is_known_beforehand_determines_what_a_record_does_not() {
        let sum = DMatrix::from_element(2, 2, 0.25) * 0.01;
        let found = with_known(&known(&[Some([1.0, 0.1]), None]), &sum, &[1.0, 1.0]);
        assert!((found[(0, 0)] - 0.01).abs() < 1e-9 && (found[(1, 1)] - 0.02).abs() < 1e-9, "{found}");
    }
}
