//! The families by name, and why one is not fitted.

use std::fmt;

use serde::Serialize;

/// The families.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Normal.
    Normal,
    /// The logarithm is normal.
    Lognormal,
    /// The logarithm of the distance from a lower end is normal.
    ShiftedLognormal,
    /// Weibull, from 0 on.
    Weibull,
    /// Weibull from another lower end on.
    ShiftedWeibull,
    /// Johnson's unbounded system.
    JohnsonSu,
    /// Johnson's system with two ends.
    JohnsonSb,
    /// A mixture of two normals.
    TwoNormals,
}

/// Why a family was not fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Fewer parts than the family needs.
    #[error("{family} needs {least} measured parts, but there are {found}")]
    FewParts {
        /// The family.
        family: Kind,
        /// Parts that it needs.
        least: usize,
        /// Parts that there are.
        found: usize,
    },
    /// Fewer parts than it takes to choose among families.
    #[error("to choose a distribution takes {least} measured parts, but there are {found}")]
    FewToChoose {
        /// Parts that it takes.
        least: usize,
        /// Parts that there are.
        found: usize,
    },
    /// All values are the same.
    #[error("all measured values are {0}, so there is no variation to fit")]
    NoVariation(f64),
    /// Values that the family does not have.
    #[error("{family} has positive values alone, but one part has {value}")]
    NotPositive {
        /// The family.
        family: Kind,
        /// A value.
        value: f64,
    },
    /// Values too far apart for numbers.
    #[error("the values differ by more than numbers hold")]
    TooFarApart,
    /// A likelihood that grows towards an end of the parameters' range.
    #[error("{0} has no likeliest parameters for these values; a simpler family fits as well")]
    NoMaximum(Kind),
    /// Values of which intervals cannot be told.
    #[error("the values leave too much open of {0} for intervals; a simpler family may do")]
    NoInterval(Kind),
}

impl Kind {
    /// Every family, the simplest first.
    pub const ALL: [Self; 8] = [
        Self::Normal,
        Self::Lognormal,
        Self::Weibull,
        Self::ShiftedLognormal,
        Self::ShiftedWeibull,
        Self::JohnsonSu,
        Self::JohnsonSb,
        Self::TwoNormals,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Lognormal => "lognormal",
            Self::ShiftedLognormal => "shifted-lognormal",
            Self::Weibull => "weibull",
            Self::ShiftedWeibull => "shifted-weibull",
            Self::JohnsonSu => "johnson-su",
            Self::JohnsonSb => "johnson-sb",
            Self::TwoNormals => "two-normals",
        }
    }

    /// Number of parameters.
    pub fn parameters(self) -> usize {
        match self {
            Self::Normal | Self::Lognormal | Self::Weibull => 2,
            Self::ShiftedLognormal | Self::ShiftedWeibull => 3,
            Self::JohnsonSu | Self::JohnsonSb => 4,
            Self::TwoNormals => 5,
        }
    }

    /// Measured parts without which it is refused, as its intervals would not hold: two for the normal, whose intervals are
    /// exact; five for the other families of two parameters; 30 above, and 100 for Johnson's system with two ends, whose
    /// ends fewer parts do not tell.
    pub fn least_parts(self) -> usize {
        match self {
            Self::Normal => 2,
            Self::Lognormal | Self::Weibull => 5,
            Self::JohnsonSb => 100,
            _ => 30,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
