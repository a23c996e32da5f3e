//! The measures of assembled units as a function of their variables.

use crate::tolerance::{lanes::Lanes, model::Function};

use super::expression::Expression;

/// How one measure is computed.
#[derive(Clone, Debug)]
pub enum Formula {
    /// From dimensions and the measures before it.
    Expression(Expression),
}

/// All measures of a product, in order.
#[derive(Clone, Debug, Default)]
pub struct Measures {
    /// One a measure.
    pub formulas: Vec<Formula>,
}

impl Function for Measures {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        for (i, formula) in self.formulas.iter().enumerate() {
            let (before, after) = measures.split_at_mut(i);
            after[0] = match formula {
                Formula::Expression(expression) => expression.evaluate(variables, before),
            };
        }
    }
}
