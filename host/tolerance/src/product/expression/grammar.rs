//! From the text of an expression to its operations: recursive descent, checked for kinds on the way.

use std::ops::Range;

use crate::unit::{self, Unit};

use super::{
    fault::{ExpressionError, Fault},
    kind::Kind,
    operation::{DEPTH, Expression, One, Operation, Source, Step, Two},
};

/// The deepest nesting of parentheses, signs and powers.
const NESTING: usize = 64;
/// The functions that an expression may have.
pub const FUNCTIONS: &str = "sqrt, sin, cos, tan, asin, acos, atan, abs, min, max";
/// Units that a constant may have.
const KINDS: [(&[Unit], Kind); 6] = [
    (unit::LENGTH, Kind::LENGTH),
    (unit::ANGLE, Kind::ANGLE),
    (unit::FORCE, Kind::FORCE),
    (unit::MASS, Kind::MASS),
    (unit::SECONDS, Kind::TIME),
    (unit::PRESSURE, Kind::PRESSURE),
];
const UNITS: &str = "mm, m, cm, µm, nm, in, °, rad, mrad, N, mN, kN, g, kg, mg, s, ms, µs, MPa, Pa, kPa, GPa, or none; of a \
                     stiffness 5 N / 1 mm";
const OPERAND: &str = "a number, a name, a function or a parenthesis";

/// Reads the expression `text`; `resolve` says what a name stands for.
///
/// # Errors
/// [`ExpressionError`] points at what cannot be read, is not known, or does not fit together.
pub fn parse(text: &str, resolve: impl Fn(&str) -> Option<(Source, Kind)>) -> Result<Expression, ExpressionError> {
    let mut parser = Parser { text, at: 0, resolve, steps: Vec::new(), height: 0, nesting: 0 };
    let kind = parser.sum()?;
    parser.skip_space();
    if parser.at < text.len() {
        return Err(parser.expected("an operator", "+ - * / ^ between two values"));
    }
    if kind.quantity().is_none() {
        let place = text.len() - text.trim_start().len()..text.trim_end().len();
        let allowed =
            "a length, an angle, a plain number, a force, a stiffness, a mass, a moment, a pressure or a time";
        return Err(ExpressionError { fault: Fault::Result(kind), place, allowed });
    }
    Ok(Expression { steps: parser.steps, kind })
}

struct Parser<'t, R> {
    text: &'t str,
    at: usize,
    resolve: R,
    steps: Vec<Step>,
    height: usize,
    nesting: usize,
}

impl<'t, R: Fn(&str) -> Option<(Source, Kind)>> Parser<'t, R> {
    fn rest(&self) -> &'t str {
        &self.text[self.at..]
    }

    fn skip_space(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    /// Takes the next character if it is one of `wanted`.
    fn take(&mut self, wanted: &[char]) -> Option<(char, Range<usize>)> {
        self.skip_space();
        let character = self.rest().chars().next().filter(|c| wanted.contains(c))?;
        let start = self.at;
        self.at += character.len_utf8();
        Some((character, start..self.at))
    }

    /// Takes characters while they are of one kind.
    fn take_while(&mut self, fits: impl Fn(char) -> bool) -> &'t str {
        let text = self.rest();
        let text = &text[..text.find(|c| !fits(c)).unwrap_or(text.len())];
        self.at += text.len();
        text
    }

    /// The next word or character is not what was `expected`.
    fn expected(&mut self, expected: &'static str, allowed: &'static str) -> ExpressionError {
        self.skip_space();
        let start = self.at;
        let word = self.take_while(is_name).len();
        let length = word.max(self.text[start..].chars().next().map_or(0, char::len_utf8));
        let place = start..start + length;
        ExpressionError { fault: Fault::Expected { expected, found: self.text[place.clone()].into() }, place, allowed }
    }

    fn push(&mut self, operation: Operation, place: Range<usize>, operands: usize) -> Result<(), ExpressionError> {
        self.height = self.height + 1 - operands;
        if self.height > DEPTH {
            return Err(too_deep(place));
        }
        self.steps.push(Step { operation, place });
        Ok(())
    }

    fn sum(&mut self) -> Result<Kind, ExpressionError> {
        let kind = self.product()?;
        while let Some((sign, place)) = self.take(&['+', '-', '−']) {
            let other = self.product()?;
            let (operation, name) = match sign {
                '+' => (Two::Add, "cannot add"),
                _ => (Two::Subtract, "cannot subtract"),
            };
            if !kind.fits(other) {
                let allowed = "numbers of one kind; a constant carries its unit: 3 mm, 30°";
                return Err(kinds(name, &[kind, other], place, allowed));
            }
            self.push(Operation::Two(operation), place, 2)?;
        }
        Ok(kind)
    }

    fn product(&mut self) -> Result<Kind, ExpressionError> {
        let mut kind = self.signed()?;
        while let Some((sign, place)) = self.take(&['*', '×', '·', '/', '÷']) {
            let other = self.signed()?;
            let (operation, power) = match sign {
                '/' | '÷' => (Two::Divide, -1.0),
                _ => (Two::Multiply, 1.0),
            };
            kind = kind.times(other, power);
            self.push(Operation::Two(operation), place, 2)?;
        }
        Ok(kind)
    }

    fn signed(&mut self) -> Result<Kind, ExpressionError> {
        self.skip_space();
        self.nesting += 1;
        if self.nesting > NESTING {
            return Err(too_deep(self.at..self.at));
        }
        let kind = match self.take(&['-', '−', '+']) {
            Some(('+', _)) => self.signed()?,
            Some((_, place)) => {
                let kind = self.signed()?;
                self.push(Operation::One(One::Negate), place, 1)?;
                kind
            }
            None => self.power()?,
        };
        self.nesting -= 1;
        Ok(kind)
    }

    fn power(&mut self) -> Result<Kind, ExpressionError> {
        let base = self.operand()?;
        let Some((_, place)) = self.take(&['^']) else { return Ok(base) };
        let first = self.steps.len();
        let exponent = self.signed()?;
        let constant = match &self.steps[first..] {
            [Step { operation: Operation::Constant(value), .. }] => Some(*value),
            [
                Step { operation: Operation::Constant(value), .. },
                Step { operation: Operation::One(One::Negate), .. },
            ] => Some(-value),
            _ => None,
        };
        let kind = match constant {
            _ if exponent != Kind::PLAIN => None,
            Some(power) => Some(base.to_the(power)),
            None => (base == Kind::PLAIN).then_some(base),
        };
        let allowed = "a plain number to the power of a plain number; a length only to a constant power";
        let kind = kind.ok_or_else(|| kinds("cannot raise", &[base, exponent], place.clone(), allowed))?;
        self.push(Operation::Two(Two::Power), place, 2)?;
        Ok(kind)
    }

    fn operand(&mut self) -> Result<Kind, ExpressionError> {
        self.skip_space();
        let start = self.at;
        match self.rest().chars().next() {
            Some('0'..='9' | '.') => self.number(),
            Some('\'') => {
                self.at += 1;
                let name = self.take_while(|c| c != '\'');
                if self.take(&['\'']).is_none() {
                    let found = self.text[start..].to_owned();
                    let fault = Fault::Expected { expected: "a closing quote", found };
                    return Err(ExpressionError { fault, place: start..self.text.len(), allowed: "'a name'" });
                }
                self.named(name, start..self.at)
            }
            Some('(') => {
                self.at += 1;
                let kind = self.sum()?;
                if self.take(&[')']).is_none() {
                    return Err(self.expected("`)`", "as many closing as opening parentheses"));
                }
                Ok(kind)
            }
            Some(c) if is_name(c) => {
                let name = self.take_while(is_name);
                let place = start..self.at;
                if self.take(&['(']).is_some() { self.call(name, place) } else { self.named(name, place) }
            }
            _ => Err(self.expected(OPERAND, "such as (a + 'a name' - 3 mm) / 2")),
        }
    }

    fn named(&mut self, name: &str, place: Range<usize>) -> Result<Kind, ExpressionError> {
        match (self.resolve)(name) {
            Some((source, kind)) => {
                self.push(Operation::Read(source), place, 0)?;
                Ok(kind)
            }
            None if name == "pi" => {
                self.push(Operation::Constant(std::f64::consts::PI), place, 0)?;
                Ok(Kind::PLAIN)
            }
            None => {
                let allowed = "a dimension, a diameter (PART.AXIS.diameter), a measure that stands above, pi";
                Err(ExpressionError { fault: Fault::UnknownName(name.into()), place, allowed })
            }
        }
    }

    fn number(&mut self) -> Result<Kind, ExpressionError> {
        let start = self.at;
        self.take_while(|c| c.is_ascii_digit() || c == '.');
        let exponent = self.rest().strip_prefix(['e', 'E']).map(|rest| rest.trim_start_matches(['+', '-']));
        if exponent.is_some_and(|digits| digits.starts_with(|c: char| c.is_ascii_digit())) {
            self.at = self.text.len() - exponent.unwrap_or_default().len();
            self.take_while(|c| c.is_ascii_digit());
        }
        let (written, place) = (&self.text[start..self.at], start..self.at);
        let value: f64 = match written.parse() {
            Ok(value) => value,
            Err(_) => {
                let fault = Fault::Expected { expected: "a number", found: written.into() };
                return Err(ExpressionError { fault, place, allowed: "such as 0.5 or 1e-3" });
            }
        };
        self.skip_space();
        let unit_start = self.at;
        let unit = self.take_while(|c| is_name(c) || c == '°');
        let of = |(units, kind): (&[Unit], Kind)| Some((kind, units.iter().find(|known| known.is(unit))?.to_si(value)));
        let found = if unit.is_empty() { Some((Kind::PLAIN, value)) } else { KINDS.into_iter().find_map(of) };
        let Some((kind, value)) = found else {
            let fault = Fault::UnknownUnit(unit.into());
            return Err(ExpressionError { fault, place: unit_start..self.at, allowed: UNITS });
        };
        self.push(Operation::Constant(value), place, 0)?;
        Ok(kind)
    }

    /// A call of the function `name`, its opening parenthesis taken.
    fn call(&mut self, name: &str, place: Range<usize>) -> Result<Kind, ExpressionError> {
        let unknown =
            |place| Err(ExpressionError { fault: Fault::UnknownFunction(name.into()), place, allowed: FUNCTIONS });
        // Before its arguments, which may well look like mistakes.
        if !FUNCTIONS.split(", ").any(|known| known == name) {
            return unknown(place);
        }
        let first = self.sum()?;
        let comparison = match name {
            "min" => Some(Two::Least),
            "max" => Some(Two::Greatest),
            _ => None,
        };
        while let Some(compare) = comparison.filter(|_| self.take(&[',']).is_some()) {
            let other = self.sum()?;
            if !first.fits(other) {
                return Err(kinds("cannot compare", &[first, other], place, "numbers of one kind"));
            }
            self.push(Operation::Two(compare), place.clone(), 2)?;
        }
        if self.take(&[')']).is_none() {
            return Err(self.expected("`)`", "one argument; min and max take several, with commas"));
        }
        let angle_or_plain = [Kind::ANGLE, Kind::PLAIN].contains(&first);
        let (function, kind) = match name {
            "min" | "max" => return Ok(first),
            "abs" => (One::Absolute, first),
            "sqrt" => (One::SquareRoot, first.to_the(0.5)),
            "sin" if angle_or_plain => (One::Sine, Kind::PLAIN),
            "cos" if angle_or_plain => (One::Cosine, Kind::PLAIN),
            "tan" if angle_or_plain => (One::Tangent, Kind::PLAIN),
            "asin" if first == Kind::PLAIN => (One::ArcSine, Kind::ANGLE),
            "acos" if first == Kind::PLAIN => (One::ArcCosine, Kind::ANGLE),
            "atan" if first == Kind::PLAIN => (One::ArcTangent, Kind::ANGLE),
            "sin" | "cos" | "tan" => {
                return Err(kinds("takes an angle or a plain number, not", &[first], place, "such as sin(30°)"));
            }
            "asin" | "acos" | "atan" => {
                return Err(kinds("takes a plain number, not", &[first], place, "such as acos(a / b)"));
            }
            _ => return unknown(place),
        };
        self.push(Operation::One(function), place, 1)?;
        Ok(kind)
    }
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '.'
}

fn too_deep(place: Range<usize>) -> ExpressionError {
    ExpressionError { fault: Fault::Depth, place, allowed: "fewer parentheses: name a part of it as a measure" }
}

fn kinds(operation: &'static str, kinds: &[Kind], place: Range<usize>, allowed: &'static str) -> ExpressionError {
    ExpressionError { fault: Fault::Kinds { operation, kinds: kinds.to_vec() }, place, allowed }
}
