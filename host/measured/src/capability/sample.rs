//! The measured values of a column.

use super::error::CapabilityError;

/// Values of which at least two differ.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Values with the indices of their parts, in the order of the parts.
    pub values: Vec<(usize, f64)>,
    /// Rising values.
    pub sorted: Vec<f64>,
    /// Mean.
    pub mean: f64,
    /// Standard deviation, of n − 1 degrees of freedom.
    pub deviation: f64,
}

impl Sample {
    /// Of the parts that were measured; the `name` of the column is for errors.
    pub fn new(name: &str, values: &[Option<f64>]) -> Result<Self, CapabilityError> {
        let values: Vec<(usize, f64)> =
            values.iter().enumerate().filter_map(|(part, value)| value.map(|value| (part, value))).collect();
        let mut sorted: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
        sorted.sort_by(f64::total_cmp);
        let (column, found) = (name.to_owned(), sorted.len());
        let (Some(first), Some(last), 2..) = (sorted.first(), sorted.last(), found) else {
            return Err(CapabilityError::FewParts { column, least: 2, found });
        };
        if first == last {
            return Err(CapabilityError::NoVariation { column, value: *first, found });
        }
        let (mean, deviation) = mean_and_deviation(&sorted);
        if !deviation.is_finite() || deviation <= 0.0 {
            return Err(CapabilityError::TooFarApart { column });
        }
        Ok(Self { mean, deviation, values, sorted })
    }

    /// Number of values.
    pub fn count(&self) -> f64 {
        self.sorted.len() as f64
    }

    /// The median.
    pub fn median(&self) -> f64 {
        let n = self.sorted.len();
        let [a, b] = [(n - 1) / 2, n / 2].map(|i| self.sorted.get(i).copied().unwrap_or_default());
        a + 0.5 * (b - a)
    }
}

/// Mean and standard deviation of two or more values, by two passes.
pub fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let first = values.first().copied().unwrap_or_default();
    let mean = first + values.iter().map(|x| (x - first) / n).sum::<f64>();
    // What rounding leaves of the sum of distances corrects that of their squares.
    let [sum, squares] = values.iter().fold([0.0; 2], |[sum, squares], x| {
        let off = x - mean;
        [sum + off, squares + off * off]
    });
    (mean, libm::sqrt((squares - sum * sum / n).max(0.0) / (n - 1.0)))
}
