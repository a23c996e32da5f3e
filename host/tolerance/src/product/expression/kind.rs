//! What kind of number an expression is.

use std::fmt;

use crate::model::Quantity;

/// Powers of length, mass, time and angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    /// Of length, mass and time.
    powers: [f64; 3],
    angle: f64,
}

/// Kinds that a measure can be of.
const MEASURED: [(Quantity, Kind, &str); 9] = [
    (Quantity::Length, Kind::LENGTH, "a length"),
    (Quantity::Angle, Kind::ANGLE, "an angle"),
    (Quantity::Ratio, Kind::PLAIN, "a plain number"),
    (Quantity::Force, Kind::FORCE, "a force"),
    (Quantity::Stiffness, Kind::mechanical([0.0, 1.0, -2.0]), "a stiffness"),
    (Quantity::Mass, Kind::MASS, "a mass"),
    (Quantity::Moment, Kind::mechanical([2.0, 1.0, -2.0]), "a moment"),
    (Quantity::Pressure, Kind::PRESSURE, "a pressure"),
    (Quantity::Time, Kind::TIME, "a time"),
];

impl Kind {
    /// A length.
    pub const LENGTH: Self = Self::mechanical([1.0, 0.0, 0.0]);
    /// An angle.
    pub const ANGLE: Self = Self { powers: [0.0; 3], angle: 1.0 };
    /// A plain number.
    pub const PLAIN: Self = Self::mechanical([0.0; 3]);
    /// A force.
    pub const FORCE: Self = Self::mechanical([1.0, 1.0, -2.0]);
    /// A mass.
    pub const MASS: Self = Self::mechanical([0.0, 1.0, 0.0]);
    /// A pressure.
    pub const PRESSURE: Self = Self::mechanical([-1.0, 1.0, -2.0]);
    /// A time.
    pub const TIME: Self = Self::mechanical([0.0, 0.0, 1.0]);

    const fn mechanical(powers: [f64; 3]) -> Self {
        Self { powers, angle: 0.0 }
    }

    /// The kind of a measure.
    pub fn of(quantity: Quantity) -> Self {
        MEASURED.iter().find(|(known, ..)| *known == quantity).map_or(Self::PLAIN, |(_, kind, _)| *kind)
    }

    /// As a measure, if it can be one.
    pub fn quantity(self) -> Option<Quantity> {
        self.measured().map(|(quantity, ..)| quantity)
    }

    fn measured(self) -> Option<(Quantity, Self, &'static str)> {
        MEASURED.into_iter().find(|(_, kind, _)| self.fits(*kind))
    }

    /// Whether numbers of both kinds can be added. With anything else, an angle is an arc for its radius: it does not count.
    pub(super) fn fits(self, other: Self) -> bool {
        self.powers == other.powers && (self.angle == other.angle || self.powers != [0.0; 3])
    }

    pub(super) fn times(self, other: Self, power: f64) -> Self {
        let sum = |i: usize| self.powers[i] + power * other.powers[i];
        Self { powers: [sum(0), sum(1), sum(2)], angle: self.angle + power * other.angle }
    }

    pub(super) fn to_the(self, power: f64) -> Self {
        Self { powers: self.powers.map(|own| own * power), angle: self.angle * power }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.measured(), self.powers) {
            (Some((.., name)), _) => f.write_str(name),
            (None, [0.0, 0.0, 0.0]) => write!(f, "an angle to the power {}", self.angle),
            (None, [power, 0.0, 0.0]) => write!(f, "a length to the power {power}"),
            (None, powers) => {
                let units = ["m", "kg", "s"].into_iter().zip(powers).filter(|(_, power)| *power != 0.0);
                let symbol =
                    |(unit, power): (&str, f64)| if power == 1.0 { unit.into() } else { format!("{unit}^{power}") };
                write!(f, "a number in {}", units.map(symbol).collect::<Vec<String>>().join("·"))
            }
        }
    }
}
