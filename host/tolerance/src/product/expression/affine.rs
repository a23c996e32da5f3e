//! Which expressions are linear in the variables.

use super::operation::{Expression, One, Operation, Source, Two};
use crate::numeric::lanes::Lanes;

/// c + Σ coefficient · variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Affine {
    /// c.
    pub constant: f64,
    /// Variables in ascending order, and their coefficients.
    pub terms: Vec<(usize, f64)>,
}

impl Affine {
    /// Of an expression of sums of variables times constants; `known` are the measures before it, where they are such sums.
    /// `None` of others, and where operation by operation takes less time: of few operations on measures with many terms.
    ///
    /// The value is that of the expression within n·2⁻⁵²·(|c| + Σ|coefficient · variable|), over all intermediate results, for
    /// n operations.
    pub fn of(expression: &Expression, known: &[Option<Self>]) -> Option<Self> {
        let mut stack: Vec<Self> = Vec::new();
        for step in &expression.steps {
            let value = match step.operation {
                Operation::Constant(constant) => Self::of_constant(constant),
                Operation::Read(Source::Variable(variable)) => Self { constant: 0.0, terms: vec![(variable, 1.0)] },
                Operation::Read(Source::Measure(measure)) => known.get(measure)?.clone()?,
                Operation::One(one) => {
                    let operand = stack.pop()?;
                    match (one, operand.is_constant()) {
                        (One::Negate, _) => operand.map(|x| -x),
                        (_, true) => Self::of_constant(one.of(Lanes::splat(operand.constant)).0[0]),
                        _ => return None,
                    }
                }
                Operation::Two(two) => {
                    let (b, a) = (stack.pop()?, stack.pop()?);
                    match (two, a.is_constant(), b.is_constant()) {
                        (_, true, true) => {
                            Self::of_constant(two.of(Lanes::splat(a.constant), Lanes::splat(b.constant)).0[0])
                        }
                        (Two::Add, ..) => a.plus(&b),
                        (Two::Subtract, ..) => a.plus(&b.map(|x| -x)),
                        (Two::Multiply, _, true) => a.map(|x| x * b.constant),
                        (Two::Multiply, true, _) => b.map(|x| a.constant * x),
                        (Two::Divide, _, true) => a.map(|x| x / b.constant),
                        _ => return None,
                    }
                }
            };
            stack.push(value);
        }
        let found = stack.pop()?;
        let finite = found.constant.is_finite() && found.terms.iter().all(|(_, coefficient)| coefficient.is_finite());
        (finite && found.terms.len() <= TERMS_A_STEP * expression.steps.len()).then_some(found)
    }

    fn of_constant(constant: f64) -> Self {
        Self { constant, terms: Vec::new() }
    }

    fn is_constant(&self) -> bool {
        self.terms.is_empty()
    }

    fn map(mut self, of: impl Fn(f64) -> f64) -> Self {
        self.constant = of(self.constant);
        self.terms.iter_mut().for_each(|(_, coefficient)| *coefficient = of(*coefficient));
        self
    }

    fn plus(mut self, other: &Self) -> Self {
        self.constant += other.constant;
        for (variable, coefficient) in &other.terms {
            match self.terms.binary_search_by_key(variable, |(variable, _)| *variable) {
                Ok(place) => self.terms[place].1 += coefficient,
                Err(place) => self.terms.insert(place, (*variable, *coefficient)),
            }
        }
        self
    }
}

/// Terms of a product that take as long as an operation by itself.
const TERMS_A_STEP: usize = 4;
