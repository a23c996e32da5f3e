//! What is known of parameters beforehand, as residuals beside those of a record.

use crate::{model::Parameter, signal::noise::Noise};

/// What is known of parameters beforehand: normal distributions.
///
/// Each is a residual (value − mean)/deviation beside those of the record in deviations. Samples whose noise depends on each other know less
/// than their number says; the residuals from before are heavier by as much, so that their share in the sum is their share in what is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Beforehand {
    known: Vec<Known>,
    /// Samples by each independent one.
    weight: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Known {
    parameter: usize,
    mean: f64,
    deviation: f64,
}

impl Beforehand {
    /// Of the `parameters`, beside `residuals` of a record with runs of these lengths.
    pub fn of(parameters: &[Parameter], residuals: &[f64], runs: &[usize]) -> Self {
        let of_one = |(parameter, of): (usize, &Parameter)| {
            of.prior.map(|[mean, deviation]| Known { parameter, mean, deviation })
        };
        let known: Vec<Known> = parameters.iter().enumerate().filter_map(of_one).collect();
        let samples = residuals.len();
        let effective = if known.is_empty() { samples as f64 } else { Noise::of(residuals, runs).effective(samples) };
        Self { known, weight: (samples as f64 / effective.max(1.0)).max(1.0) }
    }

    /// The same beside a record whose samples are independent.
    pub fn beside_independent(parameters: &[Parameter]) -> Self {
        Self::of(parameters, &[], &[])
    }

    /// Whether nothing is known.
    pub fn is_nothing(&self) -> bool {
        self.known.is_empty()
    }

    /// The parameters of which something is known, in the order of [`residuals`](Self::residuals).
    pub fn parameters(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.known.iter().map(|known| known.parameter)
    }

    /// Residuals of these `values` of all parameters, in deviations of the record's.
    pub fn residuals<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let root = libm::sqrt(self.weight);
        self.known.iter().map(move |known| root * (values[known.parameter] - known.mean) / known.deviation)
    }

    /// Derivatives of the residuals, each by its parameter.
    pub fn slopes(&self) -> impl Iterator<Item = f64> + '_ {
        let root = libm::sqrt(self.weight);
        self.known.iter().map(move |known| root / known.deviation)
    }

    /// What the residuals of these `values` add to the cost.
    pub fn cost(&self, values: &[f64]) -> f64 {
        self.residuals(values).map(|residual| residual * residual).sum()
    }

    /// What is added to the normal equations of the record's residuals for parameters that have these `values` and are counted in `units`: to
    /// the diagonal of the products of derivatives, and to the scores. `scale` is the deviation of the record's residuals.
    pub fn normal_equations(&self, values: &[f64], units: &[f64], scale: f64) -> Vec<[f64; 2]> {
        let mut added = vec![[0.0; 2]; values.len()];
        for ((i, residual), slope) in self.parameters().zip(self.residuals(values)).zip(self.slopes()) {
            let column = scale * slope * units[i];
            added[i] = [column * column, -column * scale * residual];
        }
        added
    }

    /// Information (inverse of a variance, SI) on parameter `i`; 0 where nothing is known.
    pub fn information(&self, i: usize) -> f64 {
        let known = self.known.iter().find(|known| known.parameter == i);
        known.map_or(0.0, |known| 1.0 / (known.deviation * known.deviation))
    }
}

#[cfg(test)]
mod tests {
    use super::Beforehand;
    use crate::model::Parameter;

    #[test]
    fn residuals_are_in_deviations_and_slopes_their_derivatives() {
        let parameter = |prior| Parameter { name: "a".into(), unit: "", bounds: [-9.0, 9.0], start: 0.0, prior };
        let white: Vec<f64> = (0..400u32).map(|k| f64::from(k.wrapping_mul(2_654_435_761) >> 16) - 32_768.0).collect();
        let found = Beforehand::of(&[parameter(None), parameter(Some([2.0, 0.5]))], &white, &[400]);
        let residuals: Vec<f64> = found.residuals(&[7.0, 3.0]).collect();
        assert!(residuals.len() == 1 && (residuals[0] - 2.0).abs() < 0.2, "{residuals:?}");
        let moved: Vec<f64> = found.residuals(&[7.0, 3.001]).collect();
        let slope = found.slopes().next().expect("a slope");
        assert!(((moved[0] - residuals[0]) / 0.001 - slope).abs() < 1e-6, "{slope}");
        assert_eq!(found.information(0), 0.0);
        assert_eq!(found.information(1), 4.0);
    }
}
