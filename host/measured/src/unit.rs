//! Units of measured values.

use std::{fmt, str::FromStr};

use serde::Serialize;

/// Unit of a column: all of its values, its nominal value and its limits are in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub enum Unit {
    /// mm.
    #[serde(rename = "mm")]
    Millimetre,
    /// µm.
    #[serde(rename = "µm")]
    Micrometre,
    /// m.
    #[serde(rename = "m")]
    Metre,
    /// in, 25.4 mm.
    #[serde(rename = "in")]
    Inch,
    /// °.
    #[serde(rename = "°")]
    Degree,
    /// rad.
    #[serde(rename = "rad")]
    Radian,
    /// A plain number, or a unit that is not known.
    #[default]
    #[serde(rename = "")]
    None,
}

/// A text that is not a unit of measured values.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{0}\" is not a unit of measured values, which are mm, µm (um), m, in (inch), ° (deg) and rad")]
pub struct UnitError(pub String);

impl Unit {
    /// Every unit.
    pub const ALL: [Self; 7] =
        [Self::Millimetre, Self::Micrometre, Self::Metre, Self::Inch, Self::Degree, Self::Radian, Self::None];

    /// Its symbol; empty for a plain number.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Micrometre => "µm",
            Self::Metre => "m",
            Self::Inch => "in",
            Self::Degree => "°",
            Self::Radian => "rad",
            Self::None => "",
        }
    }

    /// `value` in this unit as metres, radians or a plain number. Of multiplication and division, the one by an exact
    /// factor is used, so that a decimal is rounded only once.
    pub fn to_si(self, value: f64) -> f64 {
        match self {
            Self::Millimetre => value / 1e3,
            Self::Micrometre => value / 1e6,
            Self::Inch => value * 0.0254,
            Self::Degree => value * (std::f64::consts::PI / 180.0),
            Self::Metre | Self::Radian | Self::None => value,
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.symbol())
    }
}

impl FromStr for Unit {
    type Err = UnitError;

    /// From its symbol or another common spelling, whatever the case of its letters.
    fn from_str(text: &str) -> Result<Self, UnitError> {
        Ok(match text.trim().to_lowercase().as_str() {
            "mm" | "millimetre" | "millimeter" | "millimetres" | "millimeters" => Self::Millimetre,
            // Micro sign and Greek letter.
            "µm" | "μm" | "um" | "micron" | "microns" | "micrometre" | "micrometer" => Self::Micrometre,
            "m" | "metre" | "meter" | "metres" | "meters" => Self::Metre,
            "in" | "inch" | "inches" | "\"" | "″" => Self::Inch,
            "°" | "deg" | "degree" | "degrees" => Self::Degree,
            "rad" | "radian" | "radians" => Self::Radian,
            "" | "1" => Self::None,
            _ => return Err(UnitError(text.trim().to_owned())),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Unit;

    #[test]
    fn units_are_read_as_they_are_shown() {
        for unit in Unit::ALL {
            assert_eq!(unit.to_string().parse(), Ok(unit));
        }
        assert_eq!("Inch".parse(), Ok(Unit::Inch));
        assert_eq!("um".parse(), Ok(Unit::Micrometre));
        assert!("furlong".parse::<Unit>().is_err());
        assert_eq!(Unit::Inch.to_si(1.0), 0.0254);
    }
}
