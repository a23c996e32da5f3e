//! What can be wrong with an expression, and where.

use std::ops::Range;

use super::kind::Kind;

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
