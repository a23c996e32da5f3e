//! Expressions as operations on a stack, and their values operation by operation.

use std::ops::Range;

use super::{
    fault::{ExpressionError, Fault},
    kind::Kind,
};
use crate::{model::Quantity, numeric::lanes::Lanes};

/// Values (SI) from here on are refused: sums of squares and products of many units are no numbers.
const GREATEST: f64 = 1e100;

/// The most intermediate results that wait for an operation.
pub(super) const DEPTH: usize = 16;

/// A validated expression: operations on a stack.
#[derive(Clone, Debug)]
pub struct Expression {
    pub(super) steps: Vec<Step>,
    pub(super) kind: Kind,
}

/// What a name in an expression stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A variable of the model.
    Variable(usize),
    /// An earlier measure.
    Measure(usize),
}

/// An operation and the bytes of the text that it came from.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub operation: Operation,
    pub place: Range<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Operation {
    Constant(f64),
    Read(Source),
    One(One),
    Two(Two),
}

/// Operations on one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum One {
    Negate,
    Absolute,
    SquareRoot,
    Sine,
    Cosine,
    Tangent,
    ArcSine,
    ArcCosine,
    ArcTangent,
}

/// Operations on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Two {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Least,
    Greatest,
}

impl One {
    #[inline(always)]
    pub fn of(self, x: Lanes) -> Lanes {
        match self {
            Self::Negate => -x,
            Self::Absolute => x.map(f64::abs),
            Self::SquareRoot => x.sqrt(),
            Self::Sine => x.map(libm::sin),
            Self::Cosine => x.map(libm::cos),
            Self::Tangent => x.map(libm::tan),
            Self::ArcSine => x.map(libm::asin),
            Self::ArcCosine => x.map(libm::acos),
            Self::ArcTangent => x.map(libm::atan),
        }
    }
}

impl Two {
    #[inline(always)]
    pub fn of(self, a: Lanes, b: Lanes) -> Lanes {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            // A square is by far the most frequent power.
            Self::Power if b == Lanes::splat(2.0) => a * a,
            Self::Power => a.zip(b, libm::pow),
            Self::Least => a.zip(b, |a, b| if a.is_nan() || a < b { a } else { b }),
            Self::Greatest => a.zip(b, |a, b| if a.is_nan() || a > b { a } else { b }),
        }
    }
}

impl Expression {
    /// What kind of number it gives.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// What kind of measure it is.
    pub fn quantity(&self) -> Quantity {
        self.kind.quantity().unwrap_or(Quantity::Ratio)
    }

    /// The variables that it reads.
    pub fn variables(&self) -> impl Iterator<Item = usize> {
        self.steps.iter().filter_map(|step| match step.operation {
            Operation::Read(Source::Variable(variable)) => Some(variable),
            _ => None,
        })
    }

    /// Its value for the `variables` and the earlier `measures` (SI), operation by operation: what faster ways are
    /// compared with.
    #[cfg(test)]
    pub fn evaluate(&self, variables: &[Lanes], measures: &[Lanes]) -> Lanes {
        self.trace(variables, measures, |_, _| ())
    }

    /// Whether the result and everything on the way to it is finite for these values, and its square as well.
    ///
    /// # Errors
    /// [`ExpressionError`] points at the first operation whose result is not.
    pub fn check(&self, variables: &[Lanes], measures: &[Lanes]) -> Result<(), ExpressionError> {
        let mut first = None;
        self.trace(variables, measures, |step, value| {
            let value = value.0[0];
            if (value.is_nan() || value.abs() >= GREATEST) && first.is_none() {
                let what = match step.operation {
                    Operation::Two(Two::Divide) if !value.is_finite() => "divides by zero",
                    _ if value.is_finite() => "is 1e100 or more",
                    _ => "is not a finite number",
                };
                let allowed = "an expression that is finite at the nominal values";
                first = Some(ExpressionError { fault: Fault::NotFinite { what }, place: step.place.clone(), allowed });
            }
        });
        first.map_or(Ok(()), Err)
    }

    fn trace(&self, variables: &[Lanes], measures: &[Lanes], mut look: impl FnMut(&Step, Lanes)) -> Lanes {
        // Parsing has checked that no more than DEPTH wait and that every operation finds its operands.
        let mut stack = [Lanes::ZERO; DEPTH];
        let mut height = 0;
        for step in &self.steps {
            let (operands, value) = match step.operation {
                Operation::Constant(value) => (0, Lanes::splat(value)),
                Operation::Read(Source::Variable(i)) => (0, variables[i]),
                Operation::Read(Source::Measure(i)) => (0, measures[i]),
                Operation::One(one) => (1, one.of(stack[height - 1])),
                Operation::Two(two) => (2, two.of(stack[height - 2], stack[height - 1])),
            };
            height -= operands;
            stack[height] = value;
            height += 1;
            look(step, value);
        }
        stack[0]
    }
}
