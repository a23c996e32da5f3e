//! Reading the value of one key: type, unit and range.

use std::ops::Range;

use slipfit_tolerance::unit::Quantity;

use super::{
    Problem, SceneError,
    diagnostic::Found,
    tree::{Node, Value},
};

/// A value and the full name of its key.
#[derive(Clone)]
pub struct Field<'t, 's> {
    /// The key, such as `slide.mass`.
    pub key: String,
    /// The value.
    pub node: &'t Node<'s>,
}

/// One number for all, or one for each.
pub enum OneOrEach<const N: usize> {
    /// For all.
    One(f64),
    /// For each.
    Each([f64; N]),
}

/// A number as it stands in the scene.
pub struct Measure<'t> {
    /// The number, finite.
    pub number: f64,
    /// Its unit, empty if it has none; `None` where the key's is meant.
    pub unit: Option<&'t str>,
}

impl<'t, 's> Field<'t, 's> {
    /// The value of `key` in the table `self`, if it is there.
    pub fn get(&self, key: &str) -> Option<Field<'t, 's>> {
        let name = if self.key.is_empty() { key.into() } else { format!("{}.{key}", self.key) };
        let entry = self.node.entry(key)?;
        entry.read.set(true);
        Some(Field { key: name, node: &entry.node })
    }

    /// The value of `key` in the table `self`; `allowed` says what it could be if it is missing.
    pub fn require(&self, key: &str, allowed: &str) -> Result<Field<'t, 's>, SceneError> {
        let name = if self.key.is_empty() { key.into() } else { format!("{}.{key}", self.key) };
        self.get(key).ok_or_else(|| self.error(Problem::Missing(name), allowed))
    }

    /// The table `key` in the table `self`.
    pub fn table(&self, key: &str) -> Result<Field<'t, 's>, SceneError> {
        let table = self.require(key, &format!("a table [{key}]"))?;
        table.expect_table()?;
        Ok(table)
    }

    /// Refuses what is not a table.
    pub fn expect_table(&self) -> Result<(), SceneError> {
        if matches!(self.node.value, Value::Table(_)) { Ok(()) } else { Err(self.wrong_type("a table")) }
    }

    /// What is found wrong with the scene.
    pub fn found(&self) -> &'s Found {
        self.node.place.found()
    }

    /// The number `key` (SI) in the table `self`; where it is missing, that is noted and another stands for it.
    pub fn number(&self, key: &str, quantity: &Quantity) -> Result<f64, SceneError> {
        match self.require(key, &quantity.units()) {
            Ok(field) => field.to_number(quantity),
            Err(error) => Ok(self.found().recover(Err(error), quantity.some())),
        }
    }

    /// The list of numbers `key` (SI) in the table `self`.
    pub fn numbers<const N: usize>(&self, key: &str, quantity: &Quantity) -> Result<[f64; N], SceneError> {
        self.require(key, &list_of::<N>(quantity))?.to_numbers(quantity)
    }

    /// This as a number (SI). What is wrong with it is noted, and another number stands for it.
    pub fn to_number(&self, quantity: &Quantity) -> Result<f64, SceneError> {
        Ok(self.found().recover(self.as_number(quantity), quantity.some()))
    }

    /// The same, without a note of what is wrong with it.
    pub fn as_number(&self, quantity: &Quantity) -> Result<f64, SceneError> {
        let measure = self.measure(&quantity.units())?;
        let unit = match measure.unit {
            None => quantity.units.first(),
            Some(text) => quantity.units.iter().find(|unit| unit.is(text)),
        };
        let unit = unit.ok_or_else(|| {
            self.error(Problem::Unit { key: self.key.clone(), written: self.written("") }, quantity.units())
        })?;
        let value = unit.to_si(measure.number);
        if quantity.covers(value) { Ok(value) } else { Err(self.out_of_range(unit.symbol, quantity.limits())) }
    }

    /// This as a list of numbers (SI).
    pub fn to_numbers<const N: usize>(&self, quantity: &Quantity) -> Result<[f64; N], SceneError> {
        let Value::List(nodes) = &self.node.value else { return Err(self.wrong_type(list_of::<N>(quantity))) };
        if nodes.len() != N {
            let problem = Problem::Length { key: self.key.clone(), found: nodes.len() };
            return Err(self.error(problem, list_of::<N>(quantity)));
        }
        let mut numbers = [0.0; N];
        for (number, node) in numbers.iter_mut().zip(nodes) {
            *number = Field { key: self.key.clone(), node }.to_number(quantity)?;
        }
        Ok(numbers)
    }

    /// This as a number (SI), or as a list of them.
    pub fn one_or_each<const N: usize>(&self, quantity: &Quantity) -> Result<OneOrEach<N>, SceneError> {
        match &self.node.value {
            Value::List(_) => self.to_numbers(quantity).map(OneOrEach::Each),
            Value::Number(_) | Value::Text(_) => self.to_number(quantity).map(OneOrEach::One),
            _ => Err(self.wrong_type(format!("{}, or {}", quantity.units(), list_of::<N>(quantity)))),
        }
    }

    /// This as a text.
    pub fn to_text(&self) -> Result<&'t str, SceneError> {
        match &self.node.value {
            Value::Text(text) => Ok(text),
            _ => Err(self.wrong_type("a text in quotes")),
        }
    }

    /// This as a number that may have a unit.
    pub fn measure(&self, allowed: &str) -> Result<Measure<'t>, SceneError> {
        let measure = match &self.node.value {
            Value::Number(number) => Measure { number: *number, unit: None },
            Value::Text(text) => {
                let text = text.trim();
                let end = text.find(|c: char| !matches!(c, '0'..='9' | '+' | '-' | '.' | 'e' | 'E'));
                let (number, unit) = text.split_at(end.unwrap_or(text.len()));
                let number = number.parse().map_err(|_| {
                    self.error(Problem::NotANumber { key: self.key.clone(), written: self.written("") }, allowed)
                })?;
                Measure { number, unit: Some(unit.trim()) }
            }
            _ => return Err(self.wrong_type(allowed)),
        };
        if measure.number.is_finite() {
            Ok(measure)
        } else {
            Err(self.error(Problem::NotFinite { key: self.key.clone(), written: self.written("") }, allowed))
        }
    }

    /// The value as it was typed, a bare number with the `unit` that is meant.
    pub fn written(&self, unit: &str) -> String {
        const LONGEST: usize = 40;
        let text = match &self.node.value {
            Value::Text(text) => text.to_string(),
            _ => format!("{} {unit}", self.node.place.text()).trim_end().into(),
        };
        match text.char_indices().nth(LONGEST) {
            Some((end, _)) => format!("{}…", &text[..end]),
            None => text,
        }
    }

    /// Takes note of a warning about this value, with its place.
    pub fn warn(&self, warning: &str) {
        self.found().warn(format!("{}: {warning}", self.node.place.position()));
    }

    /// This value changes nothing `place`.
    pub fn no_effect(&self, place: impl Into<String>, allowed: impl Into<String>) -> SceneError {
        self.error(Problem::NoEffect { key: self.key.clone(), place: place.into() }, allowed)
    }

    /// A `problem` with this value.
    pub fn error(&self, problem: Problem, allowed: impl Into<String>) -> SceneError {
        self.node.place.error(problem, allowed)
    }

    /// A `problem` with the bytes `within` of this text.
    pub fn error_within(&self, within: Range<usize>, problem: Problem, allowed: impl Into<String>) -> SceneError {
        let text = match &self.node.value {
            Value::Text(text) => text,
            _ => "",
        };
        self.node.place.within(text, within).error(problem, allowed)
    }

    /// This value is not in its range; `unit` is meant if it has none.
    pub fn out_of_range(&self, unit: &str, allowed: impl Into<String>) -> SceneError {
        self.error(Problem::OutOfRange { key: self.key.clone(), written: self.written(unit) }, allowed)
    }

    /// This value is not of the type that is `allowed`.
    pub fn wrong_type(&self, allowed: impl Into<String>) -> SceneError {
        self.error(Problem::Type { key: self.key.clone(), found: self.node.kind() }, allowed)
    }
}

fn list_of<const N: usize>(quantity: &Quantity) -> String {
    format!("a list of {N}, each {}", quantity.units())
}
