//! What every analysis works on: contributors that vary, and the measures that follow from them.

pub mod extent;
pub mod linear;
pub mod loss;
pub mod nested;
pub mod widening;
mod zone;

use std::sync::Arc;

pub use self::zone::{SIGMA_DISC, SIGMA_ZONE, ZoneRule};
use self::{loss::Loss, nested::Nested, widening::Widening};
use crate::numeric::lanes::Lanes;

/// A product whose measures are a function of independent (or correlated) random variables.
pub struct Model {
    /// What varies. A contributor's variables follow those of the contributor before it.
    pub contributors: Vec<Contributor>,
    /// Correlations of scalar contributors, as (row, column, coefficient) of their normal scores; none is 0.
    pub correlations: Vec<(usize, usize, f64)>,
    /// What is measured, in the order in which `function` writes it.
    pub measures: Vec<Measure>,
    /// Sums of measures whose closing is asked for.
    pub sums: Vec<Sum>,
    /// Measures of the variables.
    pub function: Arc<dyn Function>,
}

impl Model {
    /// How many variables its function takes.
    pub fn variables(&self) -> usize {
        self.contributors.iter().map(|contributor| contributor.variation.variables()).sum()
    }

    /// The first variable of every contributor.
    pub fn offsets(&self) -> Vec<usize> {
        let counts = self.contributors.iter().map(|contributor| contributor.variation.variables());
        counts.scan(0, |at, count| Some(std::mem::replace(at, *at + count))).collect()
    }

    /// The variables in the middle of all limits and zones.
    pub fn middles(&self) -> Vec<f64> {
        self.contributors.iter().flat_map(|contributor| contributor.variation.middle()).collect()
    }
}

/// The measures of assembled units as a function of their variables.
pub trait Function: Send + Sync {
    /// Writes all `measures` (SI: m, rad) of the units whose `variables` these are. A measure that cannot be computed,
    /// or is infinite, is not a number.
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]);

    /// Whether `measure` is a constant and a weighted sum of the variables.
    fn is_linear(&self, _measure: usize) -> bool {
        false
    }

    /// What decides on which side of a kink a unit is: arguments of `abs`, differences of those of `min` and `max`. The
    /// measures change their slopes where one of them is 0.
    fn kinks(&self, _variables: &[Lanes]) -> Vec<Lanes> {
        Vec::new()
    }

    /// The variables (SI) as a drawing has them, where there is one.
    fn nominal(&self) -> Option<&[f64]> {
        None
    }

    /// What kind of number a scalar `variable` is.
    fn quantity(&self, _variable: usize) -> Quantity {
        Quantity::Length
    }

    /// Zones that grow with sizes.
    fn widenings(&self) -> &[Widening] {
        &[]
    }

    /// What it costs that `measure` is off its target, where that is said.
    fn loss(&self, _measure: usize) -> Option<Loss> {
        None
    }
}

/// One tolerance or toleranced dimension.
#[derive(Clone, Debug, PartialEq)]
pub struct Contributor {
    /// Name, such as "slide.left-rail flatness".
    pub name: String,
    /// How it varies.
    pub variation: Variation,
}

/// How a contributor varies.
#[derive(Clone, Debug, PartialEq)]
pub enum Variation {
    /// One variable in SI units.
    Scalar {
        /// Its distribution.
        distribution: Distribution,
        /// Lower and upper limit, for the worst case.
        limits: [f64; 2],
    },
    /// A plane in its zone of width t: offset u = 2w/t and tilts p = αb/t, r = βa/t, with |u| + |p| + |r| ≤ 1 inside
    /// the zone. Three variables u, p, r (one, u, for [`ZoneRule::Translation`]).
    Zone(ZoneRule),
    /// The axis of a pin or hole in its cylindrical zone of diameter t: offsets x, y over t/2 (or tilts, measured at its
    /// end), with x² + y² ≤ 1 inside the zone. Two variables.
    Disc(ZoneRule),
    /// A plane or an axis in its zone, with tilts that another tolerance narrows: place, then two tilts.
    Nested(Nested),
}

/// Distribution of a scalar contributor. SI units.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// Always this value.
    Constant(f64),
    /// Normal.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        deviation: f64,
    },
    /// Normal, sorted out beyond its limits. `mean` and `deviation` are those before.
    TruncatedNormal {
        /// Mean before truncation.
        mean: f64,
        /// Standard deviation before truncation.
        deviation: f64,
        /// Lower and upper limit.
        limits: [f64; 2],
    },
    /// Uniform between its limits.
    Uniform {
        /// Lower and upper limit.
        limits: [f64; 2],
    },
    /// Triangular.
    Triangular {
        /// Lower and upper limit.
        limits: [f64; 2],
        /// Most frequent value, within the limits.
        mode: f64,
    },
    /// Trapezoidal: constant density between the shoulders, falling linearly to the limits.
    Trapezoidal {
        /// Lower and upper limit.
        limits: [f64; 2],
        /// Lower and upper shoulder, within the limits.
        shoulders: [f64; 2],
    },
    /// Skewed: the shifted log-normal of these moments.
    Skewed {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        deviation: f64,
        /// Skewness, not 0: positive has its long tail upwards.
        skewness: f64,
    },
    /// Weibull's: F(x) = 1 − exp(−((x − location)/scale)^shape).
    Weibull {
        /// Shape, positive: 1 is exponential, 2 Rayleigh's.
        shape: f64,
        /// Scale, positive.
        scale: f64,
        /// Least value.
        location: f64,
    },
    /// Gumbel's of a largest value: F(x) = exp(−exp(−(x − mode)/scale)); its mirror image for a negative scale.
    Gumbel {
        /// Most frequent value.
        mode: f64,
        /// Scale, not 0: positive has its long tail upwards.
        scale: f64,
    },
    /// Beta: density ∝ u^(a−1)·(1−u)^(b−1) of the place u, from 0 to 1, within the limits.
    Beta {
        /// Lower and upper limit.
        limits: [f64; 2],
        /// a and b, positive.
        shapes: [f64; 2],
    },
    /// One of several distributions: shares, which add up to 1, and distributions.
    Mixture(Vec<(f64, Distribution)>),
    /// Measured data: values in ascending order, at least two; linear between them.
    Table(Vec<f64>),
}

/// One measure of the assembled product.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Name.
    pub name: String,
    /// What kind of number it is.
    pub quantity: Quantity,
    /// Lower and upper specification limit (SI), where given.
    pub limits: [Option<f64>; 2],
}

/// Kind of a measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// m; reported in mm.
    Length,
    /// rad; reported in degrees.
    Angle,
    /// Reported as it is.
    Ratio,
    /// N.
    Force,
    /// N/m; reported in N/mm.
    Stiffness,
    /// kg; reported in g.
    Mass,
    /// N·m; reported in N·mm.
    Moment,
    /// Pa; reported in MPa.
    Pressure,
    /// s.
    Time,
}

/// A sum of measures that must stay positive, such as the two gaps of a pin.
#[derive(Clone, Debug, PartialEq)]
pub struct Sum {
    /// Name, such as "left front across".
    pub name: String,
    /// Indices of its measures.
    pub measures: Vec<usize>,
}

impl Variation {
    /// How many variables it has.
    pub fn variables(&self) -> usize {
        match self {
            Self::Scalar { .. } | Self::Zone(ZoneRule::Translation) => 1,
            Self::Disc(_) => 2,
            Self::Nested(zone) => zone.variables(),
            Self::Zone(_) => 3,
        }
    }
}
