//! Toleranced numbers: a dimension's nominal value, its limits, and how it is distributed between them.

use crate::{
    distribution::Marginal,
    distribution::quadrature::mean_and_deviation,
    model::{Contributor, Distribution, Variation, ZoneRule},
};

/// A number of the drawing and its variation. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Toleranced {
    /// As the drawing states it; a tolerance such as +0.3/−0.1 puts it off the middle of its limits.
    pub nominal: f64,
    /// Least and greatest value.
    pub limits: [f64; 2],
    /// Distribution.
    pub distribution: Distribution,
}

/// The shape of a distribution; the tolerance gives its place and its width.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Always the nominal value.
    Constant,
    /// Normal.
    Normal(Spread),
    /// The same, sorted out at the limits.
    TruncatedNormal(Spread),
    /// Uniform.
    Uniform,
    /// Triangular; `mode` is the deviation (SI) of the most frequent value from the nominal one, or the middle.
    Triangular {
        /// Deviation.
        mode: Option<f64>,
    },
    /// Trapezoidal; deviations (SI) of its shoulders from the nominal value.
    Trapezoidal {
        /// Lower and upper.
        shoulders: [f64; 2],
    },
    /// Shifted log-normal.
    Skewed {
        /// Mean and standard deviation.
        spread: Spread,
        /// Skewness.
        skewness: f64,
    },
    /// Beta between the limits.
    Beta {
        /// a and b, positive.
        shapes: [f64; 2],
    },
    /// Weibull's, with a width of its own.
    Weibull {
        /// Shape, positive.
        shape: f64,
        /// Scale (SI), positive.
        scale: f64,
        /// Deviation (SI) of its least value from the nominal one.
        location: f64,
    },
    /// Gumbel's, with a width of its own.
    Gumbel {
        /// Deviation (SI) of the most frequent value from the nominal one.
        mode: f64,
        /// Scale (SI), not 0: positive is that of a largest value, negative that of a smallest one.
        scale: f64,
    },
    /// Log-normal, with a width of its own.
    Lognormal {
        /// Deviation (SI) of the mean from the nominal value.
        mean: f64,
        /// Standard deviation (SI), positive.
        deviation: f64,
        /// Deviation (SI) of its least value from the nominal one, below that of the mean.
        location: f64,
    },
    /// A unit is of one of several shapes.
    Mixture(Vec<Component>),
    /// Measured deviations (SI) from the nominal value, ascending.
    Table(Vec<f64>),
}

/// Mean and standard deviation of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean: Mean,
    /// Standard deviation.
    pub deviation: Deviation,
}

/// Where the mean of a shape is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mean {
    /// At this distance (SI) above the nominal value.
    FromNominal(f64),
    /// At this distance (SI) above the middle of the limits.
    FromMiddle(f64),
}

/// How large the standard deviation of a shape is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deviation {
    /// Half the distance of the limits over this number.
    Sigmas(f64),
    /// Stated (SI), positive.
    Stated(f64),
    /// The distance of the mean from the nearer limit over three times this number.
    Cpk(f64),
}

impl Spread {
    /// About the middle of the limits, half of whose distance is `sigma` standard deviations.
    pub fn sigmas(sigma: f64) -> Self {
        Self { mean: Mean::FromMiddle(0.0), deviation: Deviation::Sigmas(sigma) }
    }

    /// Mean and standard deviation (SI) around `nominal` within `limits`.
    fn within(&self, nominal: f64, limits: [f64; 2]) -> Result<[f64; 2], ShapeError> {
        let [lower, upper] = limits;
        let mean = match self.mean {
            Mean::FromNominal(mean) => nominal + mean,
            Mean::FromMiddle(shift) => (lower + upper) / 2.0 + shift,
        };
        let deviation = match self.deviation {
            Deviation::Sigmas(sigma) => (upper - lower) / 2.0 / sigma,
            Deviation::Stated(deviation) => deviation,
            Deviation::Cpk(cpk) => (mean - lower).min(upper - mean) / (3.0 * cpk),
        };
        if deviation > 0.0 { Ok([mean, deviation]) } else { Err(ShapeError::Mean) }
    }
}

/// One of the shapes of a mixture.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its share of the units over the weights of all.
    pub weight: f64,
    /// Lower and upper deviation (SI) from the nominal value.
    pub deviations: [f64; 2],
    /// Its shape between them.
    pub shape: Shape,
}

impl Shape {
    /// Whether it has a width of its own: its tolerance, if it has one, is what the worst case goes by, and nothing else.
    pub fn has_width(&self) -> bool {
        match self {
            Self::Weibull { .. } | Self::Gumbel { .. } | Self::Lognormal { .. } | Self::Mixture(_) => true,
            Self::Normal(spread) | Self::Skewed { spread, .. } => matches!(spread.deviation, Deviation::Stated(_)),
            _ => false,
        }
    }

    /// Whether it stands without a tolerance beside it.
    pub fn is_whole(&self) -> bool {
        matches!(self, Self::Constant | Self::Table(_))
    }
}

/// Why a shape does not fit its limits.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// No room between the limits.
    #[error("the tolerance has no width")]
    Width,
    /// Limits in the wrong order.
    #[error("the lower limit is above the upper one")]
    Reversed,
    /// A mode outside of the limits.
    #[error("the mode is not within the tolerance")]
    Mode,
    /// Shoulders that are out of order or outside of the limits.
    #[error("the shoulders are not in order within the tolerance")]
    Shoulders,
    /// A Cpk of a mean that is outside of the limits.
    #[error("the mean is not within the tolerance, so that its Cpk is not positive")]
    Mean,
    /// A truncated normal of which nothing is left.
    #[error(
        "the mean is {0:.1} standard deviations outside of the tolerance: nothing is left within it, 30 are allowed"
    )]
    Truncated(f64),
    /// A log-normal whose mean is not above its least value.
    #[error("the mean is not above the location")]
    Location,
    /// Nothing to mix.
    #[error("a mixture has two or more parts")]
    Parts,
    /// A skewness of zero.
    #[error("the skewness is 0: that is the normal distribution")]
    Skewness,
    /// A tolerance beside a distribution that has its own limits.
    #[error("the distribution has its own limits")]
    Excess,
    /// Fewer than two different values, or values that are not in order.
    #[error("the table needs two or more values in ascending order, not all of them the same")]
    Table,
}

/// How many standard deviations the mean of a truncated normal may be outside: beyond, its share within has no digits.
const MOST_TRUNCATED: f64 = 30.0;

impl Toleranced {
    /// `nominal` with the lower and upper `deviations` from it and a `shape`. A shape with a width of its own and deviations of 0 has
    /// its 0.135 % and 99.865 % points as limits, a mixture the outermost limits of its parts.
    ///
    /// # Errors
    /// [`ShapeError`] if the tolerance has no width or is reversed, or the shape does not fit in.
    pub fn new(nominal: f64, deviations: [f64; 2], shape: &Shape) -> Result<Self, ShapeError> {
        let mut limits = deviations.map(|deviation| nominal + deviation);
        let [lower, upper] = limits;
        let mean = (lower + upper) / 2.0;
        let within = |value: f64| lower <= value && value <= upper;
        if deviations[0] > deviations[1] {
            return Err(ShapeError::Reversed);
        }
        let is_stated = deviations != [0.0; 2];
        let needs_width = if shape.has_width() { is_stated } else { !shape.is_whole() };
        if needs_width && (deviations[0] >= deviations[1] || lower >= upper) {
            return Err(ShapeError::Width);
        }
        let distribution = match *shape {
            Shape::Constant => {
                limits = [nominal; 2];
                Distribution::Constant(nominal)
            }
            Shape::Normal(spread) => {
                let [mean, deviation] = spread.within(nominal, limits)?;
                Distribution::Normal { mean, deviation }
            }
            Shape::TruncatedNormal(spread) => {
                let [mean, deviation] = spread.within(nominal, limits)?;
                let beyond = (lower - mean).max(mean - upper) / deviation;
                if beyond > MOST_TRUNCATED {
                    return Err(ShapeError::Truncated(beyond));
                }
                Distribution::TruncatedNormal { mean, deviation, limits }
            }
            Shape::Uniform => Distribution::Uniform { limits },
            Shape::Triangular { mode } => {
                let mode = mode.map_or(mean, |mode| nominal + mode);
                if !within(mode) {
                    return Err(ShapeError::Mode);
                }
                Distribution::Triangular { limits, mode }
            }
            Shape::Trapezoidal { shoulders } => {
                let shoulders = shoulders.map(|shoulder| nominal + shoulder);
                if !(within(shoulders[0]) && within(shoulders[1]) && shoulders[0] <= shoulders[1]) {
                    return Err(ShapeError::Shoulders);
                }
                Distribution::Trapezoidal { limits, shoulders }
            }
            Shape::Skewed { skewness: 0.0, .. } => return Err(ShapeError::Skewness),
            Shape::Skewed { spread, skewness } => {
                let [mean, deviation] = spread.within(nominal, limits)?;
                Distribution::Skewed { mean, deviation, skewness }
            }
            Shape::Beta { shapes } => Distribution::Beta { limits, shapes },
            Shape::Weibull { shape, scale, location } => {
                Distribution::Weibull { shape, scale, location: nominal + location }
            }
            Shape::Gumbel { mode, scale } => Distribution::Gumbel { mode: nominal + mode, scale },
            Shape::Lognormal { mean, location, .. } if mean <= location => return Err(ShapeError::Location),
            Shape::Lognormal { mean, deviation, location } => {
                // A log-normal of the coefficient of variation v has the skewness v³ + 3v.
                let variation = deviation / (mean - location);
                let skewness = variation * (variation * variation + 3.0);
                Distribution::Skewed { mean: nominal + mean, deviation, skewness }
            }
            Shape::Mixture(ref components) if components.len() < 2 => return Err(ShapeError::Parts),
            Shape::Mixture(ref components) => {
                let total: f64 = components.iter().map(|component| component.weight).sum();
                let mut parts = Vec::new();
                let mut outermost = [f64::INFINITY, f64::NEG_INFINITY];
                for Component { weight, deviations, shape } in components {
                    let part = Self::new(nominal, *deviations, shape)?;
                    outermost = [outermost[0].min(part.limits[0]), outermost[1].max(part.limits[1])];
                    parts.push((weight / total, part.distribution));
                }
                if !is_stated {
                    limits = outermost;
                }
                Distribution::Mixture(parts)
            }
            Shape::Table(ref values) => {
                let values: Vec<f64> = values.iter().map(|value| nominal + value).collect();
                let (Some(least), Some(greatest)) = (values.first().copied(), values.last().copied()) else {
                    return Err(ShapeError::Table);
                };
                if least >= greatest || !values.is_sorted() {
                    return Err(ShapeError::Table);
                }
                limits = [least, greatest];
                Distribution::Table(values)
            }
        };
        if shape.has_width() && limits[0] >= limits[1] {
            limits = distribution.points();
        }
        Ok(Self { nominal, limits, distribution })
    }

    /// How far a feature is off along one direction in a zone of `width` (m), by a `rule`; `deviation` (m) is the standard
    /// deviation where it is normal, before it is truncated.
    pub fn in_zone(width: f64, rule: ZoneRule, deviation: f64) -> Self {
        let limits = [-width / 2.0, width / 2.0];
        let distribution = match rule {
            ZoneRule::SigmaZone | ZoneRule::Translation => Distribution::Normal { mean: 0.0, deviation },
            ZoneRule::Truncated => Distribution::TruncatedNormal { mean: 0.0, deviation, limits },
            ZoneRule::UniformInZone => Distribution::Uniform { limits },
        };
        Self { nominal: 0.0, limits, distribution }
    }

    /// The share of production outside of the limits.
    pub fn outside(&self) -> f64 {
        if matches!(self.distribution, Distribution::Constant(_)) {
            return 0.0;
        }
        let marginal = Marginal::new(&self.distribution);
        marginal.tails(self.limits[0])[0] + marginal.tails(self.limits[1])[1]
    }

    /// As a contributor called `name`.
    pub fn contributor(&self, name: String) -> Contributor {
        let variation = Variation::Scalar { distribution: self.distribution.clone(), limits: self.limits };
        Contributor { name, variation }
    }

    /// Mean of the distribution.
    pub fn mean(&self) -> f64 {
        mean_and_deviation(&self.contributor(String::new()).variation)[0][0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tolerance_gives_place_and_width() {
        let make = |shape| Toleranced::new(10.0, [-0.5, 1.0], &shape).unwrap();
        let normal = make(Shape::Normal(Spread::sigmas(3.0)));
        assert_eq!(normal.distribution, Distribution::Normal { mean: 10.25, deviation: 0.25 });
        assert_eq!((normal.nominal, normal.limits, normal.mean()), (10.0, [9.5, 11.0], 10.25));
        let limits = [9.5, 11.0];
        assert_eq!(
            make(Shape::Triangular { mode: None }).distribution,
            Distribution::Triangular { limits, mode: 10.25 }
        );
        let mode = Shape::Triangular { mode: Some(0.0) };
        assert_eq!(make(mode).distribution, Distribution::Triangular { limits, mode: 10.0 });
        let table = make(Shape::Table(vec![-2.0, 0.0, 3.0]));
        assert_eq!((table.limits, table.distribution), ([8.0, 13.0], Distribution::Table(vec![8.0, 10.0, 13.0])));
        assert_eq!(Toleranced::new(1.0, [0.0, 0.0], &Shape::Constant).unwrap().limits, [1.0, 1.0]);
    }

    #[test]
    fn shapes_with_a_width_of_their_own() {
        let lognormal = Shape::Lognormal { mean: 0.0, deviation: 0.5, location: -1.0 };
        let made = Toleranced::new(1.0, [0.0; 2], &lognormal).unwrap();
        // A log-normal from 0 on with mean 1: its median is 1/√(1 + 0.25), its logarithm has the variance ln 1.25.
        let spread = libm::sqrt(libm::log(1.25));
        for (found, sign) in made.limits.into_iter().zip([-3.0, 3.0]) {
            assert!((found - libm::exp(sign * spread) / libm::sqrt(1.25)).abs() < 1e-13);
        }
        assert_eq!(Toleranced::new(1.0, [-0.9, 2.0], &lognormal).unwrap().limits, [1.0 - 0.9, 3.0]);
        let part = |weight, deviations, shape| Component { weight, deviations, shape };
        let lots =
            vec![part(3.0, [-0.2, 0.1], Shape::Uniform), part(1.0, [0.0, 0.3], Shape::Normal(Spread::sigmas(3.0)))];
        let mixed = Toleranced::new(1.0, [0.0; 2], &Shape::Mixture(lots)).unwrap();
        assert_eq!(mixed.limits, [0.8, 1.3]);
        assert!((mixed.mean() - (0.75 * 0.95 + 0.25 * 1.15)).abs() < 1e-14);
    }

    #[test]
    fn shapes_that_do_not_fit_are_refused() {
        let error = |deviations, shape| Toleranced::new(1.0, deviations, &shape).unwrap_err();
        assert_eq!(error([0.0, 0.0], Shape::Uniform), ShapeError::Width);
        assert_eq!(error([0.1, -0.1], Shape::Normal(Spread::sigmas(3.0))), ShapeError::Reversed);
        assert_eq!(error([-1e-20, 1e-20], Shape::Uniform), ShapeError::Width);
        assert_eq!(error([-0.1, 0.1], Shape::Triangular { mode: Some(0.2) }), ShapeError::Mode);
        assert_eq!(error([-0.1, 0.1], Shape::Trapezoidal { shoulders: [0.05, -0.05] }), ShapeError::Shoulders);
        assert_eq!(
            error([-0.1, 0.1], Shape::Skewed { spread: Spread::sigmas(3.0), skewness: 0.0 }),
            ShapeError::Skewness
        );
        let lognormal = Shape::Lognormal { mean: 0.1, deviation: 0.5, location: 0.1 };
        assert_eq!(error([0.0, 0.0], lognormal), ShapeError::Location);
        assert_eq!(error([0.1, 0.1], Shape::Gumbel { mode: 0.0, scale: 1.0 }), ShapeError::Width);
        assert_eq!(error([0.0, 0.0], Shape::Mixture(vec![])), ShapeError::Parts);
        for values in [vec![], vec![1.0], vec![1.0, 1.0], vec![1.0, 0.0]] {
            assert_eq!(error([0.0; 2], Shape::Table(values)), ShapeError::Table);
        }
    }
}
