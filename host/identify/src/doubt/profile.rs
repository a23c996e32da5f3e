//! Intervals by profile likelihood: one parameter is moved, the others follow, until the loss has risen by too much.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::covariance::{Linearised, pseudo_inverse};
use crate::{
    beforehand::Beforehand,
    fit::{Cost, Fit},
    model::{Model, ModelError},
};

/// How far the record, with what is known beforehand, bounds a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// From both sides.
    Bounded,
    /// From one side only: on the other the loss does not rise enough before the bound.
    OneSided,
    /// Not at all: every value within the bounds explains the record.
    Flat,
}

/// An interval by profile likelihood.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Profile {
    /// Where the interval ends (SI); `None` on a side without an end before the bound.
    pub ends: [Option<f64>; 2],
    /// How far the record bounds the parameter.
    pub shape: Shape,
    /// Points of the profile, by ascending value (SI): how much the loss rises there, as a share of the rise that ends the interval.
    pub points: Vec<[f64; 2]>,
}

/// Points that the search for an end may take.
const POINTS: usize = 8;
/// Share of the rise to which an end is found.
const CLOSE: f64 = 0.03;
/// Steps by which the other parameters follow, and the share of the rise below which a step gains nothing.
const STEPS: usize = 6;
const GAIN: f64 = 0.01;

/// The profile of parameter `i` about a `fit`. The loss may rise by as much as an exact parabola would over a distance of `reach` (SI) from
/// the estimate: the deviation with coloured noise, times the quantile.
///
/// # Errors
/// [`ModelError`] where the model cannot be computed.
pub fn profile<M: Model + ?Sized>(
    model: &M,
    fit: &Fit,
    linearised: &Linearised,
    beforehand: &Beforehand,
    i: usize,
    reach: Option<f64>,
) -> Result<Profile, ModelError> {
    let parameter = &model.parameters()[i];
    let Some(reach) = reach.filter(|reach| *reach > 0.0 && linearised.units[i] > 0.0) else {
        return Ok(Profile { ends: [None; 2], shape: Shape::Flat, points: Vec::new() });
    };
    let search = Search::new(model, fit, linearised, beforehand, i);
    let allowed = search.curvature * reach * reach;
    let mut points = vec![[fit.values[i], 0.0]];
    let mut end = |side: f64| -> Result<Option<f64>, ModelError> {
        let bound = if side < 0.0 { parameter.bounds[0] } else { parameter.bounds[1] };
        let most = (bound - fit.values[i]).abs();
        let mut distance = reach.min(most);
        let (mut inside, mut outside) = ([0.0, 0.0], None);
        for _ in 0..POINTS {
            let rise = search.rise(side * distance)?;
            points.push([fit.values[i] + side * distance, rise / allowed]);
            if (rise / allowed - 1.0).abs() < CLOSE {
                break;
            }
            if rise < allowed {
                if distance >= most {
                    return Ok(None);
                }
                inside = [distance, rise];
            } else {
                outside = Some([distance, rise]);
            }
            // As on a parabola, but between what is known to be inside and outside.
            let parabola = distance * libm::sqrt(allowed / rise.max(0.01 * allowed));
            distance = match outside {
                Some([far, _]) if parabola <= inside[0] || parabola >= far => 0.5 * (inside[0] + far),
                Some(_) => parabola,
                None => parabola.max(1.2 * distance).min(most),
            };
        }
        Ok(Some(fit.values[i] + side * distance))
    };
    let ends = [end(-1.0)?, end(1.0)?];
    let shape = match ends {
        [Some(_), Some(_)] => Shape::Bounded,
        [None, None] => Shape::Flat,
        _ => Shape::OneSided,
    };
    points.sort_by(|one, other| one[0].total_cmp(&other[0]));
    Ok(Profile { ends, shape, points })
}

/// What is the same at all points of a profile.
struct Search<'a, M: Model + ?Sized> {
    model: &'a M,
    fit: &'a Fit,
    linearised: &'a Linearised,
    cost: Cost<'a>,
    i: usize,
    others: Vec<usize>,
    /// Inverse of the products of the others' columns.
    inverse: DMatrix<f64>,
    /// How the others follow, for a change of the parameter by its unit.
    follow: DVector<f64>,
    /// Loss at the estimate.
    least: f64,
    /// Rise of the loss for a change by 1 (SI), over its square.
    curvature: f64,
}

impl<'a, M: Model + ?Sized> Search<'a, M> {
    fn new(model: &'a M, fit: &'a Fit, linearised: &'a Linearised, beforehand: &'a Beforehand, i: usize) -> Self {
        let others: Vec<usize> = (0..fit.values.len()).filter(|k| *k != i && linearised.units[*k] > 0.0).collect();
        let product = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|k| &linearised.columns[k]);
            a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>()
        };
        let known = beforehand.normal_equations(&fit.values, &linearised.units, fit.scale);
        let added = |a: usize, b: usize| if a == b { known[others[a]][0] } else { 0.0 };
        let products = DMatrix::from_fn(others.len(), others.len(), |a, b| product(others[a], others[b]) + added(a, b));
        let shared = DVector::from_fn(others.len(), |a, _| product(others[a], i));
        let inverse = pseudo_inverse(products).0;
        let follow = -(&inverse * &shared);
        let slopes = fit.residuals.iter().map(|residual| fit.loss.psi_slope(residual / fit.scale));
        let slope = slopes.sum::<f64>() / fit.residuals.len() as f64;
        let unit = linearised.units[i];
        // Where residuals are cut the loss of the record rises less.
        let own = slope.max(0.1) * (1.0 + follow.dot(&shared)) + known[i][0];
        let curvature = own / (fit.scale * fit.scale * unit * unit);
        let cost = Cost { loss: fit.loss, scale: fit.scale, beforehand };
        let least = cost.of(&fit.residuals, &fit.values);
        Self { model, fit, linearised, cost, i, others, inverse, follow, least, curvature }
    }

    fn residuals(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        let output = self.model.simulate(values)?;
        Ok(self.model.measured().iter().zip(&output).map(|(measured, output)| measured - output).collect())
    }

    /// How much the loss rises when the parameter moves `by` (SI) and the others follow to where it is least: by steps of Gauss and Newton
    /// with the derivatives of the estimate, until they gain no more.
    fn rise(&self, by: f64) -> Result<f64, ModelError> {
        let mut values = self.fit.values.clone();
        values[self.i] += by;
        self.shift(&mut values, &(&self.follow * (by / self.linearised.units[self.i])));
        let mut residuals = self.residuals(&values)?;
        let mut least = self.cost.of(&residuals, &values) - self.least;
        for _ in 0..if self.others.is_empty() { 0 } else { STEPS } {
            let scores = self.scores(&residuals, &values);
            self.shift(&mut values, &(&self.inverse * scores));
            let Ok(next) = self.residuals(&values) else { break };
            let rise = self.cost.of(&next, &values) - self.least;
            let gain = least - rise;
            (least, residuals) = (least.min(rise), next);
            if gain < GAIN * least {
                break;
            }
        }
        Ok(least)
    }

    /// The derivatives of the loss by the others, in their units, negative and halved.
    fn scores(&self, residuals: &[f64], values: &[f64]) -> DVector<f64> {
        let Cost { loss, scale, beforehand } = self.cost;
        let cut: Vec<f64> = residuals.iter().map(|residual| scale * loss.psi(residual / scale)).collect();
        let known = beforehand.normal_equations(values, &self.linearised.units, scale);
        let score =
            |k: &usize| self.linearised.columns[*k].iter().zip(&cut).map(|(a, b)| a * b).sum::<f64>() + known[*k][1];
        DVector::from_iterator(self.others.len(), self.others.iter().map(score))
    }

    /// Moves the others by `shifts` in their units, within their bounds.
    fn shift(&self, values: &mut [f64], shifts: &DVector<f64>) {
        for (k, shift) in self.others.iter().zip(shifts.iter()) {
            let [low, high] = self.model.parameters()[*k].bounds;
            values[*k] = (values[*k] + shift * self.linearised.units[*k]).clamp(low, high);
        }
    }
}
