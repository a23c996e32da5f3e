//! The production that measured parts come from: a distribution per characteristic, and how they move together.

mod dependence;
mod error;
mod marginal;
mod smoothed;
#[cfg(test)]
mod tests;

use std::sync::OnceLock;

use slipfit_core::sampling::stream::{Rng, uniform, unit_stream};
use slipfit_tolerance::model::Distribution;

pub use self::error::ProductionError;
use self::{dependence::Dependence, error::LEAST_TO_SMOOTH, marginal::of_family, smoothed::Smoothing};
use crate::families::{Family, Fit, FitError, Kind, Posterior, choose, preferred};

/// What the distribution of a characteristic is taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assumed {
    /// The measured values, smoothed.
    Smoothed,
    /// The family that fits best.
    Chosen,
    /// This family.
    Family(Kind),
}

/// A characteristic, in the order of the parts.
#[derive(Clone, Debug)]
pub struct Characteristic {
    /// Values (SI); `None` where a part was not measured.
    pub values: Vec<Option<f64>>,
    /// What its distribution is taken from.
    pub assumed: Assumed,
    /// Least and greatest value that a part can have; only smoothed values could exceed them.
    pub bounds: [f64; 2],
}

/// Distributions of some characteristics that are correlated by a Gaussian copula.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// One per characteristic (SI).
    pub distributions: Vec<Distribution>,
    /// Correlations of their normal scores, as (row, column, coefficient); none is 0.
    pub correlations: Vec<(usize, usize, f64)>,
}

/// A production as its measured parts show it.
#[derive(Debug)]
pub struct Production {
    characteristics: Vec<Characteristic>,
    shapes: Vec<Shape>,
    dependence: Dependence,
    joint: Joint,
}

/// The distribution of a characteristic, with what the parts leave open of it.
#[derive(Debug)]
enum Shape {
    Smoothed(Smoothing),
    Fitted { fit: Fit, smoothing: Smoothing, values: Vec<f64>, left: OnceLock<Vec<(f64, Distribution)>> },
}

/// Parts without which no family is taken: draws from the posterior of fewer do not reach the ends of its intervals.
const LEAST_OF_FAMILY: usize = 5;

const SEED: u64 = 0x6d65_6173;

impl Production {
    /// Its characteristics, as they were measured.
    pub fn characteristics(&self) -> &[Characteristic] {
        &self.characteristics
    }

    /// Of `characteristics` of the same parts.
    ///
    /// # Errors
    /// The number of the characteristic that has no distribution, and why.
    pub fn new(characteristics: Vec<Characteristic>) -> Result<Self, (usize, ProductionError)> {
        let shape = |(i, of): (usize, &Characteristic)| Shape::of(of).map_err(|error| (i, error));
        let shapes: Vec<Shape> = characteristics.iter().enumerate().map(shape).collect::<Result<_, _>>()?;
        let values: Vec<&[Option<f64>]> = characteristics.iter().map(|of| of.values.as_slice()).collect();
        let dependence = Dependence::of(&values);
        let joint = Joint {
            distributions: shapes.iter().map(Shape::likeliest).collect(),
            correlations: dependence.coefficients(None),
        };
        Ok(Self { characteristics, shapes, dependence, joint })
    }

    /// The likeliest distributions.
    pub fn joint(&self) -> &Joint {
        &self.joint
    }

    /// What the distribution of a characteristic is: a family's name, or "smoothed".
    pub fn shape(&self, characteristic: usize) -> &'static str {
        match self.shapes.get(characteristic) {
            Some(Shape::Fitted { fit, .. }) => fit.kind.name(),
            _ => "smoothed",
        }
    }

    /// Values (SI) of a characteristic in the order of the parts.
    pub fn values(&self, characteristic: usize) -> &[Option<f64>] {
        self.characteristics.get(characteristic).map_or(&[], |of| &of.values)
    }

    /// Measured parts of a characteristic.
    pub fn parts(&self, characteristic: usize) -> usize {
        self.characteristics.get(characteristic).map_or(0, |of| of.values.iter().flatten().count())
    }

    /// Distributions that the parts leave possible, drawn with their posterior probability; a pure function of `number`.
    ///
    /// The parameters of a family are drawn from its [`Posterior`]. Smoothed values are weighted anew, all characteristics of
    /// a part alike (D. Rubin, "The Bayesian Bootstrap", 1981). Fisher's z of a correlation has the variance 1/(n − 3).
    pub fn drawn(&self, number: u64) -> Joint {
        let mut stream = unit_stream(SEED, number);
        let parts = self.characteristics.first().map_or(0, |of| of.values.len());
        let weights: Vec<f64> = (0..parts).map(|_| -libm::log(uniform(stream.next_u64()))).collect();
        let shares = self.dependence.shares(&mut stream);
        let drawn = |(shape, share): (&Shape, &f64)| shape.drawn(&weights, *share);
        let distributions = self.shapes.iter().zip(&shares).map(drawn).collect();
        Joint { distributions, correlations: self.dependence.coefficients(Some(&mut stream)) }
    }
}

impl Shape {
    fn of(characteristic: &Characteristic) -> Result<Self, ProductionError> {
        let Characteristic { values, assumed, bounds } = characteristic;
        let measured: Vec<f64> = values.iter().copied().flatten().collect();
        if let Some(value) = measured.iter().find(|value| **value < bounds[0] || **value > bounds[1]) {
            return Err(ProductionError::Bounds { value: *value });
        }
        let fit = match assumed {
            Assumed::Smoothed if measured.len() < LEAST_TO_SMOOTH => {
                return Err(ProductionError::FewParts(measured.len()));
            }
            Assumed::Smoothed => return Ok(Self::Smoothed(Smoothing::new(values, *bounds)?)),
            Assumed::Family(family) if measured.len() < LEAST_OF_FAMILY => {
                let (least, found) = (LEAST_OF_FAMILY, measured.len());
                return Err(FitError::FewParts { family: *family, least, found }.into());
            }
            Assumed::Family(kind) => kind.fit(&measured)?,
            Assumed::Chosen => {
                let (mut fits, _) = choose(&measured)?;
                let kind = preferred(&fits).map(|fit| fit.kind);
                let best = fits.iter().position(|fit| Some(fit.kind) == kind);
                best.map_or_else(|| Kind::Normal.fit(&measured), |best| Ok(fits.swap_remove(best)))?
            }
        };
        let smoothing = Smoothing::new(values, *bounds)?;
        Ok(Self::Fitted { fit, smoothing, values: measured, left: OnceLock::new() })
    }

    fn likeliest(&self) -> Distribution {
        match self {
            Self::Smoothed(smoothing) => smoothing.table(None),
            Self::Fitted { fit, values, .. } if fit.kind == Kind::Normal => {
                // The likeliest deviation is that of the parts alone.
                let n = values.len() as f64;
                let deviation = fit.family.deviation() * libm::sqrt(n / (n - 1.0));
                Distribution::Normal { mean: fit.family.mean(), deviation }
            }
            Self::Fitted { fit, .. } => of_family(fit.kind, fit.family.as_ref()),
        }
    }

    /// One that the parts leave possible: by `weights` of the parts, or at this `share` of the posterior.
    fn drawn(&self, weights: &[f64], share: f64) -> Distribution {
        match self {
            Self::Smoothed(smoothing) => smoothing.table(Some(weights)),
            Self::Fitted { fit, smoothing, values, left } => {
                let left = left.get_or_init(|| left_possible(fit, values));
                let at = left.partition_point(|(below, _)| *below < share);
                // Where the family's own cannot be drawn, the parts themselves say what they leave open.
                let drawn = left.get(at).or(left.last()).map(|(_, distribution)| distribution.clone());
                drawn.unwrap_or_else(|| smoothing.table(Some(weights)))
            }
        }
    }
}

/// Distributions that `values` leave possible with the probabilities up to each: ordered by their medians, so that
/// characteristics that are correlated have correlated means. None if none can be drawn.
fn left_possible(fit: &Fit, values: &[f64]) -> Vec<(f64, Distribution)> {
    let Ok(posterior) = Posterior::new(fit.kind, Some(fit.family.as_ref()), values) else { return Vec::new() };
    let mut draws: Vec<(f64, &dyn Family)> = posterior.draws().collect();
    draws.sort_by(|a, b| a.1.value(0.0).total_cmp(&b.1.value(0.0)));
    let sum: f64 = draws.iter().map(|(weight, _)| weight).sum();
    let mut below = 0.0;
    let of = |(weight, family): (f64, &dyn Family)| {
        below += weight / sum;
        (below, of_family(fit.kind, family))
    };
    draws.into_iter().map(of).collect()
}
