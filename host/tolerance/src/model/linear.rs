//! Measures that are linear in the variables, as one product of a matrix.

use super::Function;
use crate::numeric::lanes::{Lanes, widest};

/// Measures that share the reading of their variables: their sums fit the registers.
const ROWS: usize = 4;

/// Measures y = c + J·x. A sum goes over the variables in their order, so that its bits depend on nothing else.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linear {
    blocks: Vec<Block>,
}

/// Some rows of J, which may have many zeros.
#[derive(Clone, Debug, Default, PartialEq)]
struct Block {
    measures: Vec<usize>,
    constants: [f64; ROWS],
    /// Variables in ascending order, and their coefficients in all rows.
    terms: Vec<(usize, [f64; ROWS])>,
}

impl Linear {
    /// Measures of constants c, one a measure, and rows of J.
    pub fn new(constants: &[f64], coefficients: &[Vec<f64>]) -> Self {
        let mut made = Self::default();
        for (measure, (constant, row)) in constants.iter().zip(coefficients).enumerate() {
            let terms: Vec<_> =
                row.iter().copied().enumerate().filter(|(_, coefficient)| *coefficient != 0.0).collect();
            made.push(measure, *constant, &terms);
        }
        made
    }

    /// Adds the measure with number `measure`: `terms` are variables in ascending order and their coefficients.
    pub fn push(&mut self, measure: usize, constant: f64, terms: &[(usize, f64)]) {
        let open = self.blocks.pop_if(|block| block.measures.len() < ROWS);
        let mut block = open.unwrap_or_default();
        let row = block.measures.len();
        block.measures.push(measure);
        block.constants[row] = constant;
        for (variable, coefficient) in terms {
            let place = block.terms.binary_search_by_key(variable, |(variable, _)| *variable);
            let place = place.unwrap_or_else(|place| {
                block.terms.insert(place, (*variable, [0.0; ROWS]));
                place
            });
            block.terms[place].1[row] = *coefficient;
        }
        self.blocks.push(block);
    }
}

impl Block {
    #[inline(always)]
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        let [a, b, c, d] = self.constants;
        let mut sums = [Lanes::splat(a), Lanes::splat(b), Lanes::splat(c), Lanes::splat(d)];
        for (variable, coefficients) in &self.terms {
            let x = variables[*variable];
            for row in 0..ROWS {
                sums[row] += x * coefficients[row];
            }
        }
        for (measure, sum) in self.measures.iter().zip(sums) {
            measures[*measure] = sum;
        }
    }
}

impl Function for Linear {
    fn is_linear(&self, _measure: usize) -> bool {
        true
    }

    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        widest(
            #[inline(always)]
            || {
                for block in &self.blocks {
                    block.evaluate(variables, measures);
                }
            },
        );
    }
}
