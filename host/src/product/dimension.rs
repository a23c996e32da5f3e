//! Toleranced numbers: a dimension's nominal value, its limits, and how it is distributed between them.

use crate::tolerance::{
    model::{Contributor, Distribution, Variation},
    quadrature::mean_and_deviation,
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
    /// Normal about the middle of the limits, half of whose distance is `sigma` standard deviations.
    Normal {
        /// Standard deviations.
        sigma: f64,
    },
    /// The same, sorted out at the limits.
    TruncatedNormal {
        /// Standard deviations.
        sigma: f64,
    },
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
    /// Shifted log-normal about the middle of the limits.
    Skewed {
        /// Standard deviations in half of the limits' distance.
        sigma: f64,
        /// Skewness.
        skewness: f64,
    },
    /// Measured deviations (SI) from the nominal value, ascending.
    Table(Vec<f64>),
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

impl Toleranced {
    /// `nominal` with the lower and upper `deviations` from it and a `shape`.
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
        if !matches!(shape, Shape::Constant | Shape::Table(_)) && (deviations[0] >= deviations[1] || lower >= upper) {
            return Err(ShapeError::Width);
        }
        let deviation = |sigma: f64| (deviations[1] - deviations[0]) / 2.0 / sigma;
        let distribution = match *shape {
            Shape::Constant => {
                limits = [nominal; 2];
                Distribution::Constant(nominal)
            }
            Shape::Normal { sigma } => Distribution::Normal { mean, deviation: deviation(sigma) },
            Shape::TruncatedNormal { sigma } => {
                Distribution::TruncatedNormal { mean, deviation: deviation(sigma), limits }
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
            Shape::Skewed { sigma, skewness } => Distribution::Skewed { mean, deviation: deviation(sigma), skewness },
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
        Ok(Self { nominal, limits, distribution })
    }

    /// How far a point is off in a zone of `width` (m): normal with a sixth of the width.
    pub fn in_zone(width: f64) -> Self {
        let limits = [-width / 2.0, width / 2.0];
        let distribution = Distribution::Normal { mean: 0.0, deviation: width / 6.0 };
        Self { nominal: 0.0, limits, distribution }
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
        let normal = make(Shape::Normal { sigma: 3.0 });
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
    fn shapes_that_do_not_fit_are_refused() {
        let error = |deviations, shape| Toleranced::new(1.0, deviations, &shape).unwrap_err();
        assert_eq!(error([0.0, 0.0], Shape::Uniform), ShapeError::Width);
        assert_eq!(error([0.1, -0.1], Shape::Normal { sigma: 3.0 }), ShapeError::Reversed);
        assert_eq!(error([-1e-20, 1e-20], Shape::Uniform), ShapeError::Width);
        assert_eq!(error([-0.1, 0.1], Shape::Triangular { mode: Some(0.2) }), ShapeError::Mode);
        assert_eq!(error([-0.1, 0.1], Shape::Trapezoidal { shoulders: [0.05, -0.05] }), ShapeError::Shoulders);
        assert_eq!(error([-0.1, 0.1], Shape::Skewed { sigma: 3.0, skewness: 0.0 }), ShapeError::Skewness);
        for values in [vec![], vec![1.0], vec![1.0, 1.0], vec![1.0, 0.0]] {
            assert_eq!(error([0.0; 2], Shape::Table(values)), ShapeError::Table);
        }
    }
}
