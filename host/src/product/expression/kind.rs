//! What kind of number an expression is.

use std::fmt;

use crate::tolerance::model::Quantity;

/// Powers of length and angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    pub(super) length: f64,
    pub(super) angle: f64,
}

impl Kind {
    /// A length.
    pub const LENGTH: Self = Self { length: 1.0, angle: 0.0 };
    /// An angle.
    pub const ANGLE: Self = Self { length: 0.0, angle: 1.0 };
    /// A plain number.
    pub const PLAIN: Self = Self { length: 0.0, angle: 0.0 };

    /// The kind of a measure.
    pub fn of(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Length => Self::LENGTH,
            Quantity::Angle => Self::ANGLE,
            Quantity::Ratio => Self::PLAIN,
        }
    }

    /// As a measure, if it can be one. With a length, an angle is an arc for its radius: it does not count.
    pub fn quantity(self) -> Option<Quantity> {
        match (self.length, self.angle) {
            (1.0, _) => Some(Quantity::Length),
            (0.0, 1.0) => Some(Quantity::Angle),
            (0.0, 0.0) => Some(Quantity::Ratio),
            _ => None,
        }
    }

    /// Whether numbers of both kinds can be added.
    pub(super) fn fits(self, other: Self) -> bool {
        self.length == other.length && (self.angle == other.angle || self.length != 0.0)
    }

    pub(super) fn times(self, other: Self, power: f64) -> Self {
        Self { length: self.length + power * other.length, angle: self.angle + power * other.angle }
    }

    pub(super) fn to_the(self, power: f64) -> Self {
        Self { length: self.length * power, angle: self.angle * power }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.quantity(), self.length) {
            (Some(Quantity::Length), _) => f.write_str("a length"),
            (Some(Quantity::Angle), _) => f.write_str("an angle"),
            (Some(Quantity::Ratio), _) => f.write_str("a plain number"),
            (None, 0.0) => write!(f, "an angle to the power {}", self.angle),
            (None, power) => write!(f, "a length to the power {power}"),
        }
    }
}
