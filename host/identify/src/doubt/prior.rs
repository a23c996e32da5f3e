//! What is known of parameters beforehand, together with what a record says of them.

use nalgebra::{DMatrix, DVector};

use super::covariance::inverse_above;
use crate::model::Parameter;

/// Values and covariance of parameters, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// Values.
    pub values: Vec<f64>,
    /// Covariance; zero along undetermined combinations.
    pub covariance: DMatrix<f64>,
}

/// An estimate with its `covariance` (zero along undetermined combinations), and the priors of the `parameters`: normal distributions, which
/// add their information. To the first order: the output is taken for linear between the estimate and the result. `units` are sizes of the
/// parameters in which their numbers are comparable.
pub fn combined(parameters: &[Parameter], record: &Known, units: &[f64]) -> Known {
    let p = parameters.len();
    let unit = |i: usize| if units[i] > 0.0 { units[i] } else { 1.0 };
    let scaled = DMatrix::from_fn(p, p, |i, k| record.covariance[(i, k)] / (unit(i) * unit(k)));
    let mut information = inverse(scaled);
    let mut pull = DVector::zeros(p);
    for (i, parameter) in parameters.iter().enumerate() {
        if let Some([mean, deviation]) = parameter.prior {
            let weight = unit(i) * unit(i) / (deviation * deviation);
            information[(i, i)] += weight;
            pull[i] = weight * (mean - record.values[i]) / unit(i);
        }
    }
    let covariance = inverse(information);
    let moved = &covariance * pull;
    let within = |i: usize, value: f64| value.clamp(parameters[i].bounds[0], parameters[i].bounds[1]);
    Known {
        values: (0..p).map(|i| within(i, record.values[i] + moved[i] * unit(i))).collect(),
        covariance: DMatrix::from_fn(p, p, |i, k| covariance[(i, k)] * unit(i) * unit(k)),
    }
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

    use super::{Known, combined};
    use crate::model::Parameter;

    fn parameter(prior: Option<[f64; 2]>) -> Parameter {
        Parameter { name: "a".into(), unit: "", bounds: [-1e9, 1e9], start: 0.0, prior }
    }

    #[test]
    fn two_sources_of_one_value_have_their_weighted_mean() {
        let record = Known { values: vec![3.0], covariance: DMatrix::from_element(1, 1, 0.04) };
        let found = combined(&[parameter(Some([2.0, 0.1]))], &record, &[0.5]);
        // Weights of 25 and 100.
        assert!((found.values[0] - 2.2).abs() < 1e-12, "{found:?}");
        assert!((found.covariance[(0, 0)] - 1.0 / 125.0).abs() < 1e-12);
    }

    /// Of two values only the sum is known from the record: what is known of one beforehand tells the other.
    #[test]
    fn a_prior_determines_what_a_record_does_not() {
        let sum = DMatrix::from_element(2, 2, 0.25) * 0.01;
        let record = Known { values: vec![1.5, 1.5], covariance: sum };
        let found = combined(&[parameter(Some([1.0, 0.1])), parameter(None)], &record, &[1.0, 1.0]);
        assert!((found.values[0] - 1.0).abs() < 1e-9 && (found.values[1] - 2.0).abs() < 1e-9, "{found:?}");
        assert!((found.covariance[(0, 0)] - 0.01).abs() < 1e-9, "{found:?}");
        assert!((found.covariance[(1, 1)] - 0.02).abs() < 1e-9, "{found:?}");
    }
}
