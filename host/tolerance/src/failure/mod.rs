//! Failures and their margins over independent standard normal scores, and the way to their most probable points.
//!
//! In that space the failure nearest to the origin is the most probable one, the *design point*; its distance β is the
//! reliability index (Hasofer, Lind 1974). A failure region may have several of them, each nearest in its neighbourhood.

pub mod importance;
mod regions;
pub mod subset;
pub mod tail;
#[cfg(test)]
mod tail_tests;

use super::{model::Model, sampling::draw::Draw};
use crate::numeric::lanes::{LANES, Lanes};

/// Distance of points for slopes (scores).
const STEP: f64 = 0.01;
/// Steps to a design point.
const MOST_STEPS: usize = 30;
/// How far (scores) a design point may be off the border of failure, and off the direction of steepest descent (1 − cos).
const REACHED: [f64; 2] = [0.01, 0.001];

/// The most tangents that a corner is cut out of, and the most that are added.
const TANGENTS: usize = 8;

/// Margins of a failure over independent standard normal scores: negative where it happens, infinite where no unit is.
pub trait Margins {
    /// Points that are best handed over at a time, a multiple of [`LANES`].
    const TOGETHER: usize = LANES;

    /// How many scores a unit has.
    fn dimensions(&self) -> usize;

    /// Margins at `points`.
    fn at(&mut self, points: &[Vec<f64>]) -> Vec<f64>;

    /// From now on so many `points` are drawn in a subset of this `probability`.
    fn enter(&mut self, _probability: f64, _points: usize) {}
}

/// A failure: the sum of some measures is below (or above) a limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Measures that are added up.
    pub measures: Vec<usize>,
    /// The limit (SI).
    pub limit: f64,
    /// Whether too much fails, not too little.
    pub above: bool,
}

/// A most probable point of failure in its neighbourhood.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignPoint {
    /// Scores.
    pub point: Vec<f64>,
    /// Its distance β from the origin.
    pub distance: f64,
}

/// Margins of a failure, or of its opposite: positive where it does not happen.
pub struct LimitState<'a> {
    model: &'a Model,
    draw: &'a Draw,
    failure: &'a Failure,
    opposite: bool,
    measures: Vec<Lanes>,
    /// Evaluations of the model so far.
    pub evaluations: u64,
}

impl<'a> LimitState<'a> {
    /// Of a `failure`; of its opposite, if that is asked for.
    pub fn new(model: &'a Model, draw: &'a Draw, failure: &'a Failure, opposite: bool) -> Self {
        let measures = vec![Lanes::ZERO; model.measures.len()];
        Self { model, draw, failure, opposite, measures, evaluations: 0 }
    }

    /// Margins at several scores, which are turned into variables.
    fn evaluate(&mut self, scores: &mut [Lanes]) -> Lanes {
        self.draw.transform(scores);
        self.model.function.evaluate(scores, &mut self.measures);
        self.evaluations += LANES as u64;
        let Failure { measures, limit, above } = self.failure;
        let sum = measures.iter().fold(Lanes::ZERO, |sum, measure| sum + self.measures[*measure]);
        let margin = sum - Lanes::splat(*limit);
        if *above == self.opposite { margin } else { -margin }
    }

    /// The same where the probability counts: units with a truncated zone outside, which are never made, do not fail, and
    /// what cannot be computed is no failure. The scores become variables.
    pub fn margins(&mut self, scores: &mut [Lanes]) -> [f64; LANES] {
        let margins = self.evaluate(scores).0;
        let undefined = if self.opposite { f64::NEG_INFINITY } else { f64::INFINITY };
        let inside = self.draw.is_inside(scores).0;
        std::array::from_fn(|lane| match margins[lane] {
            _ if !inside[lane] => f64::INFINITY,
            margin if !margin.is_finite() => undefined,
            margin => margin,
        })
    }

    /// By how much a unit is more probable because truncated zones are inside.
    pub fn factor(&self) -> f64 {
        self.draw.is_inside(&vec![Lanes::ZERO; self.dimensions()]).1
    }

    /// Margin and slopes at a point.
    pub fn expansion(&mut self, point: &[f64]) -> (f64, Vec<f64>) {
        let splat: Vec<Lanes> = point.iter().map(|z| Lanes::splat(*z)).collect();
        let mut slopes = Vec::with_capacity(point.len());
        let mut value = 0.0;
        // Lane 0 is the point itself or spare; then pairs.
        for first in (0..point.len()).step_by((LANES - 1) / 2) {
            let group = first..(first + (LANES - 1) / 2).min(point.len());
            let mut scores = splat.clone();
            for (pair, k) in group.clone().enumerate() {
                scores[k].0[1 + 2 * pair] += STEP;
                scores[k].0[2 + 2 * pair] -= STEP;
            }
            let margins = self.evaluate(&mut scores).0;
            value = margins[0];
            slopes.extend(
                group.enumerate().map(|(pair, _)| (margins[1 + 2 * pair] - margins[2 + 2 * pair]) / (2.0 * STEP)),
            );
        }
        (value, slopes)
    }

    /// The design point that Rackwitz and Fiessler's steps (1978) lead to from `start`, halved while they do not get
    /// nearer; `None` if they reach none.
    pub fn design_point(&mut self, start: &[f64]) -> Option<DesignPoint> {
        let mut point = start.to_vec();
        let (mut value, mut slopes) = self.expansion(&point);
        let scale = value.abs();
        let mut tangents = Vec::new();
        for _ in 0..MOST_STEPS {
            let square = dot(&slopes, &slopes);
            if !(value.is_finite() && square.is_finite() && square > 0.0) {
                return None;
            }
            let along = dot(&slopes, &point);
            tangents.push(Tangent { normal: slopes.clone(), most: along - value });
            let target: Vec<f64> = slopes.iter().map(|slope| slope * (along - value) / square).collect();
            let step: Vec<f64> = target.iter().zip(&point).map(|(target, z)| target - z).collect();
            // A merit that falls along the step: the squared distance, and the margin at a price above the multiplier's.
            let price = 2.0 * (norm(&point).max(norm(&target)) / libm::sqrt(square)) + 1e-300;
            let merit = |point: &[f64], value: f64| 0.5 * dot(point, point) + price * value.abs();
            let before = merit(&point, value);
            let mut length = 1.0;
            loop {
                let next: Vec<f64> = point.iter().zip(&step).map(|(z, step)| z + length * step).collect();
                let (next_value, next_slopes) = self.expansion(&next);
                if merit(&next, next_value) < before || length < 0.05 {
                    (point, value, slopes) = (next, next_value, next_slopes);
                    break;
                }
                length *= 0.5;
            }
            let still = norm(&step) * length < 1e-6 * (1.0 + norm(&point));
            if still && value.abs() <= 1e-6 * scale.max(libm::sqrt(square)) {
                break;
            }
        }
        let (distance, steepness) = (norm(&point), norm(&slopes));
        let off = (value / steepness).abs();
        let turned = 1.0 + dot(&slopes, &point) / (steepness * distance);
        if off <= REACHED[0] && (turned <= REACHED[1] || distance <= REACHED[0]) {
            return Some(DesignPoint { point, distance });
        }
        self.corner(tangents)
    }

    /// The design point in a corner of the border, where steps go to and fro between its faces: the point nearest to the
    /// origin behind all tangents so far, until the margin is zero there (Kelley's cutting planes).
    fn corner(&mut self, mut tangents: Vec<Tangent>) -> Option<DesignPoint> {
        tangents.drain(..tangents.len().saturating_sub(TANGENTS));
        for _ in 0..TANGENTS {
            let point = nearest_behind(&tangents)?;
            let (value, slopes) = self.expansion(&point);
            let steepness = norm(&slopes);
            if (value / steepness).abs() <= REACHED[0] {
                let distance = norm(&point);
                return Some(DesignPoint { point, distance });
            }
            if !(value.is_finite() && steepness.is_finite() && steepness > 0.0) {
                return None;
            }
            let most = dot(&slopes, &point) - value;
            tangents.push(Tangent { normal: slopes, most });
        }
        None
    }
}

impl Margins for LimitState<'_> {
    fn dimensions(&self) -> usize {
        self.draw.dimensions()
    }

    fn at(&mut self, points: &[Vec<f64>]) -> Vec<f64> {
        let mut found = Vec::with_capacity(points.len());
        for group in points.chunks(LANES) {
            let mut scores = gathered(group);
            found.extend_from_slice(&self.margins(&mut scores)[..group.len()]);
        }
        found
    }
}

/// The half-space of points with normal · point ≤ most, in which a linear margin is negative.
struct Tangent {
    normal: Vec<f64>,
    most: f64,
}

/// The point of all half-spaces that is nearest to the origin, by Hildreth's cyclic projections; `None` if they have none
/// in common.
fn nearest_behind(tangents: &[Tangent]) -> Option<Vec<f64>> {
    const ROUNDS: usize = 1000;
    let mut point = vec![0.0; tangents.first()?.normal.len()];
    let mut multipliers = vec![0.0; tangents.len()];
    for _ in 0..ROUNDS {
        let mut moved: f64 = 0.0;
        for (Tangent { normal, most }, multiplier) in tangents.iter().zip(&mut multipliers) {
            let square = dot(normal, normal);
            let next = f64::max(0.0, *multiplier + (dot(normal, &point) - most) / square);
            let change = next - *multiplier;
            point.iter_mut().zip(normal).for_each(|(z, n)| *z -= change * n);
            moved = moved.max(change.abs() * libm::sqrt(square));
            *multiplier = next;
        }
        if moved < 1e-9 {
            return Some(point);
        }
    }
    None
}

/// Points side by side; lanes without one repeat the last.
pub fn gathered(points: &[Vec<f64>]) -> Vec<Lanes> {
    let last = points.len() - 1;
    (0..points[0].len()).map(|k| Lanes(std::array::from_fn(|lane| points[lane.min(last)][k]))).collect()
}

/// Scalar product.
pub fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// Length.
pub fn norm(point: &[f64]) -> f64 {
    libm::sqrt(dot(point, point))
}
