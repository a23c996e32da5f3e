//! Arithmetic expressions of dimensions and measures, such as `acos((a + c) / (e - c))`.
//!
//! Lengths, angles, plain numbers, forces, masses, times and what they make are told apart: a length cannot be added to an
//! angle, `sqrt(a * b)` of two lengths is a length, a force over a length a stiffness. A constant carries its unit (`3 mm`,
//! `30°`) or is a plain number. A name with spaces stands in single quotes.

mod affine;
mod grammar;
#[cfg(test)]
pub(crate) mod interpreted;
mod kind;
mod tape;

use std::ops::Range;

use crate::{model::Quantity, numeric::lanes::Lanes};

pub use affine::Affine;
pub use grammar::FUNCTIONS;
pub use grammar::parse;
pub use kind::Kind;
pub use tape::Tape;

/// Values (SI) from here on are refused: sums of squares and products of many units are no numbers.
const GREATEST: f64 = 1e100;

/// The most intermediate results that wait for an operation.
const DEPTH: usize = 16;

/// A validated expression: operations on a stack.
#[derive(Clone, Debug)]
pub struct Expression {
    steps: Vec<Step>,
    kind: Kind,
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
struct Step {
    operation: Operation,
    place: Range<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Constant(f64),
    Read(Source),
    One(One),
    Two(Two),
}

/// Operations on one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum One {
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
enum Two {
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
    fn of(self, x: Lanes) -> Lanes {
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
    fn of(self, a: Lanes, b: Lanes) -> Lanes {
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

/// What is wrong with an expression.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Something else was expected.
    #[error("expected {expected}, found {}", quoted(found))]
    Expected {
        /// What.
        expected: &'static str,
        /// What stands there; empty at the end.
        found: String,
    },
    /// No dimension and no earlier measure has this name.
    #[error("there is no dimension and no measure above called `{0}`")]
    UnknownName(String),
    /// No such function.
    #[error("there is no function `{0}`")]
    UnknownFunction(String),
    /// No such unit.
    #[error("`{0}` is no unit of a constant")]
    UnknownUnit(String),
    /// Kinds that do not go together.
    #[error("{operation} {}", one_or_both(kinds))]
    Kinds {
        /// What cannot be done.
        operation: &'static str,
        /// With what.
        kinds: Vec<Kind>,
    },
    /// Not of a kind that measures have.
    #[error("the result is {0}, which is no measure")]
    Result(Kind),
    /// Nested too deeply.
    #[error("the expression is nested too deeply")]
    Depth,
    /// Not finite at the nominal values.
    #[error("{what} at the nominal values")]
    NotFinite {
        /// What happens.
        what: &'static str,
    },
}

fn quoted(text: &str) -> String {
    if text.is_empty() { "the end".into() } else { format!("`{text}`") }
}

fn one_or_both(kinds: &[Kind]) -> String {
    kinds.iter().map(Kind::to_string).collect::<Vec<_>>().join(" and ")
}

/// A [`Fault`], where it is, and what is allowed.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpressionError {
    /// What is wrong.
    pub fault: Fault,
    /// Bytes of the expression.
    pub place: Range<usize>,
    /// What is allowed there, as a phrase.
    pub allowed: &'static str,
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Variables: a 2 mm, b 3 mm, φ 60°; measure `the gap` 0.5 mm.
    fn value(text: &str) -> Result<(f64, Quantity), ExpressionError> {
        let resolve = |name: &str| match name {
            "a" => Some((Source::Variable(0), Kind::LENGTH)),
            "b.c" => Some((Source::Variable(1), Kind::LENGTH)),
            "φ" => Some((Source::Variable(2), Kind::ANGLE)),
            "the gap" => Some((Source::Measure(0), Kind::LENGTH)),
            _ => None,
        };
        let variables = [2e-3, 3e-3, std::f64::consts::FRAC_PI_3].map(Lanes::splat);
        let measures = [Lanes::splat(0.5e-3)];
        let expression = parse(text, resolve)?;
        expression.check(&variables, &measures)?;
        let value = expression.evaluate(&variables, &measures);
        assert_eq!(value.0[0].to_bits(), value.0[7].to_bits());
        Ok((value.0[0], expression.quantity()))
    }

    #[test]
    fn arithmetic() {
        for (text, expected, quantity) in [
            ("a + b.c", 5e-3, Quantity::Length),
            ("a - b.c - 'the gap'", -1.5e-3, Quantity::Length),
            ("-a + 3 * b.c ÷ 2 × 1", 2.5e-3, Quantity::Length),
            ("a − 1 mm + 10 µm + 0.001 cm + 1e-6 m", 1.021e-3, Quantity::Length),
            ("2^3^2 / 2^-1", 1024.0, Quantity::Ratio),
            ("-2^2", -4.0, Quantity::Ratio),
            ("sqrt(a^2 + b.c * b.c)", libm::sqrt(13.0) * 1e-3, Quantity::Length),
            ("(a * b.c)^0.5", libm::sqrt(6.0) * 1e-3, Quantity::Length),
            ("sin(φ) * a", libm::sqrt(3.0) * 1e-3, Quantity::Length),
            ("cos(60 deg) + tan(45°) - sin(0.5 rad) / sin(0.5)", 0.5, Quantity::Ratio),
            ("acos(a / b.c) - asin(2 / 3) + atan(0)", libm::acos(2.0 / 3.0) - libm::asin(2.0 / 3.0), Quantity::Angle),
            ("1 in - 25.4 mm + a", 2e-3, Quantity::Length),
            ("abs(a - b.c)", 1e-3, Quantity::Length),
            ("min(a, b.c, 'the gap') + max(a, b.c)", 3.5e-3, Quantity::Length),
            ("pi * 2 * a / a", std::f64::consts::TAU, Quantity::Ratio),
            ("φ * a", 2e-3 * std::f64::consts::FRAC_PI_3, Quantity::Length),
            ("φ / 1°", 60.0, Quantity::Ratio),
            ("2 kg * 3 m / 1 s^2 - 5 N", 1.0, Quantity::Force),
            ("0.5 kN / 2 mm", 250e3, Quantity::Stiffness),
            ("5 N * a", 0.01, Quantity::Moment),
            ("8 N / a^2 - 1.5 MPa", 0.5e6, Quantity::Pressure),
            ("2 * 3 g", 6e-3, Quantity::Mass),
            ("sqrt(1 kg * a / 5 N)", 0.02, Quantity::Time),
            ("8 N / a^2 / 1 MPa", 2.0, Quantity::Ratio),
        ] {
            let (found, kind) = value(text).unwrap_or_else(|error| panic!("{text}: {}", error.fault));
            assert!((found - expected).abs() < 1e-14 * expected.abs().max(1.0), "{text}: {found}, not {expected}");
            assert_eq!(kind, quantity, "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_pointed_at() {
        for (text, marked, message) in [
            ("", "", "expected a number, a name, a function or a parenthesis, found the end"),
            ("a +", "", "expected a number, a name, a function or a parenthesis, found the end"),
            ("a * / 2", "/", "found `/`"),
            ("(a", "", "expected `)`, found the end"),
            ("a b.c", "b.c", "expected an operator, found `b.c`"),
            ("a ? 2", "?", "found `?`"),
            ("'the gap", "'the gap", "expected a closing quote"),
            ("a + c", "c", "no measure above called `c`"),
            ("sinus(φ)", "sinus", "no function `sinus`"),
            ("hypot(a, b.c)", "hypot", "no function `hypot`"),
            ("if(a > 1, a, b.c)", "if", "no function `if`"),
            ("min()", ")", "found `)`"),
            ("3 inch + a", "inch", "`inch` is no unit"),
            ("1.2.3", "1.2.3", "expected a number"),
            ("a + 3", "+", "cannot add a length and a plain number"),
            ("a - φ", "-", "cannot subtract a length and an angle"),
            ("sin(a)", "sin", "takes an angle or a plain number, not a length"),
            ("acos(a)", "acos", "takes a plain number, not a length"),
            ("a ^ b.c", "^", "cannot raise"),
            ("max(a, 1)", "max", "cannot compare a length and a plain number"),
            ("a * a", "a * a", "the result is a length to the power 2"),
            ("a + 5 N", "+", "cannot add a length and a force"),
            ("5 N * 1 s", "5 N * 1 s", "the result is a number in m·kg·s^-1"),
            ("a / (b.c - 3 mm)", "/", "divides by zero at the nominal"),
            ("acos(b.c / a)", "acos", "is not a finite number at the nominal"),
            ("sqrt(a - b.c) / sqrt(a)", "sqrt", "is not a finite number"),
            ("a * 1e200", "1e200", "is 1e100 or more at the nominal"),
            ("a * 1e60 * 1e60", "*", "is 1e100 or more at the nominal"),
        ] {
            let error = value(text).unwrap_err();
            assert!(error.fault.to_string().contains(message), "{text}: {}", error.fault);
            assert_eq!(&text[error.place.clone()], marked, "{text}");
        }
        for deep in ["(".repeat(10_000), "-".repeat(10_000), "a+(".repeat(20) + "a", "2^".repeat(10_000)] {
            assert_eq!(value(&deep).unwrap_err().fault, Fault::Depth);
        }
    }

    proptest::proptest! {
        #[test]
        fn no_text_panics(text in "[a-z0-9+*/^()', .φ°-]{0,40}|.*") {
            if let Err(error) = value(&text) {
                assert!(text.get(error.place).is_some());
            }
        }
    }
}
