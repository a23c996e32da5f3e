//! Measures that are linear in the variables.

use super::{lanes::Lanes, model::Function};

/// Measures y = c + J·x.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// c, one a measure.
    pub constants: Vec<f64>,
    /// Rows of J, one a measure.
    pub coefficients: Vec<Vec<f64>>,
}

impl Function for Linear {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        for ((measure, constant), row) in measures.iter_mut().zip(&self.constants).zip(&self.coefficients) {
            let mut sum = Lanes::splat(*constant);
            for (variable, coefficient) in variables.iter().zip(row) {
                sum += *variable * *coefficient;
            }
            *measure = sum;
        }
    }
}
