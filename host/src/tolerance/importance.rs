//! Rare failures by importance sampling around the most probable point of failure.
//!
//! In the space of independent standard normal scores z, the failure nearest to the origin, z*, is the most probable; β =
//! |z*| is the reliability index. Scores are drawn around z* instead of the origin, z = z* + y, and every unit counts with the
//! ratio of the two densities, exp(−z*·y − β²/2). Scrambled Sobol' points whose first coordinate points along z* see the
//! border between good and bad in one dimension. (Hasofer, Lind 1974; Rackwitz, Fiessler 1978; Melchers 1989.)

use super::{
    draw::Draw,
    lanes::{LANES, Lanes},
    model::Model,
    normal::{Scores, tail},
    sampler::{Method, Sampler},
    sobol::MOST_DIMENSIONS,
};

/// Independent designs, whose spread is the error.
const REPLICATES: u64 = 16;
/// Units of each.
const UNITS: u64 = 1024;
/// Steps to the most probable point.
const MOST_STEPS: usize = 30;
/// Distance of points for slopes (scores).
const STEP: f64 = 0.01;

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

/// How probable a failure is.
#[derive(Clone, Debug, PartialEq)]
pub struct Tail {
    /// Probability.
    pub probability: f64,
    /// Its standard error, from independent designs.
    pub error: f64,
    /// Distance of the most probable point from the origin; negative if the origin itself fails.
    pub reliability: f64,
    /// P(Z > β): the probability if the border of failure were flat.
    pub first_order: f64,
    /// The most probable point (scores).
    pub point: Vec<f64>,
    /// Evaluations of the model.
    pub evaluations: u64,
}

impl Failure {
    /// Positive for good units, negative for bad ones.
    fn margin(&self, measures: &[Lanes]) -> Lanes {
        let sum = self.measures.iter().fold(Lanes::ZERO, |sum, measure| sum + measures[*measure]);
        let margin = sum - Lanes::splat(self.limit);
        if self.above { -margin } else { margin }
    }
}

/// Evaluates margins at scores.
struct Margin<'a> {
    model: &'a Model,
    draw: &'a Draw,
    failure: &'a Failure,
    measures: Vec<Lanes>,
    evaluations: u64,
}

impl Margin<'_> {
    /// At several scores, which are turned into variables.
    fn at(&mut self, scores: &mut [Lanes]) -> Lanes {
        self.draw.transform(scores);
        self.model.function.evaluate(scores, &mut self.measures);
        self.evaluations += LANES as u64;
        self.failure.margin(&self.measures)
    }

    /// Margin and slopes at a point.
    fn expansion(&mut self, point: &[f64]) -> (f64, Vec<f64>) {
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
            let margins = self.at(&mut scores).0;
            value = margins[0];
            slopes.extend(
                group.enumerate().map(|(pair, _)| (margins[1 + 2 * pair] - margins[2 + 2 * pair]) / (2.0 * STEP)),
            );
        }
        (value, slopes)
    }
}

/// The probability of `failure`; `None` if there is no most probable point to be found, as where nothing moves the
/// measure.
pub fn probability(model: &Model, draw: &Draw, failure: &Failure, seed: u64) -> Option<Tail> {
    let measures = vec![Lanes::ZERO; model.measures.len()];
    let mut margin = Margin { model, draw, failure, measures, evaluations: 0 };
    let (point, sign) = most_probable_point(&mut margin)?;
    let beta = norm(&point);
    let dimensions = point.len();
    let method = if dimensions > MOST_DIMENSIONS { Method::PseudoRandom } else { Method::ScrambledSobol };
    let sampler = Sampler::new(method, seed, dimensions, REPLICATES, UNITS);
    let turned = Turned::new(&point, beta);
    let mut bits = vec![[0; LANES]; dimensions];
    let mut scores = vec![Lanes::ZERO; dimensions];
    let table = Scores::table();
    let mut shares = Vec::with_capacity(REPLICATES as usize);
    for replicate in 0..REPLICATES {
        let mut sum = Lanes::ZERO;
        for first in (replicate * UNITS..(replicate + 1) * UNITS).step_by(LANES) {
            sampler.fill(first, &mut bits);
            scores.iter_mut().zip(&bits).for_each(|(score, bits)| *score = table.lanes(*bits));
            let along = scores[0];
            turned.apply(&mut scores);
            scores.iter_mut().zip(&point).for_each(|(score, z)| *score += Lanes::splat(*z));
            let margins = margin.at(&mut scores);
            let (inside, factor) = draw.is_inside(&scores);
            for (lane, _) in inside.iter().enumerate().filter(|(lane, inside)| **inside && margins.0[*lane] < 0.0) {
                sum.0[lane] += factor * libm::exp(-beta * (along.0[lane] + 0.5 * beta));
            }
        }
        shares.push(sum.0.iter().sum::<f64>() / UNITS as f64);
    }
    let count = REPLICATES as f64;
    let mean = shares.iter().sum::<f64>() / count;
    let square: f64 = shares.iter().map(|share| (share - mean) * (share - mean)).sum();
    Some(Tail {
        probability: mean,
        error: libm::sqrt(square / (count * (count - 1.0))),
        reliability: sign * beta,
        first_order: tail(sign * beta),
        point,
        evaluations: margin.evaluations,
    })
}

/// Rackwitz and Fiessler's steps, halved while they do not get nearer; and 1, or −1 if the origin fails.
fn most_probable_point(margin: &mut Margin) -> Option<(Vec<f64>, f64)> {
    let mut point = vec![0.0; margin.draw.dimensions()];
    let (mut value, mut slopes) = margin.expansion(&point);
    let at_origin = value;
    let scale = value.abs();
    for _ in 0..MOST_STEPS {
        let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
        if !(value.is_finite() && square.is_finite() && square > 0.0) {
            return None;
        }
        let along: f64 = slopes.iter().zip(&point).map(|(slope, z)| slope * z).sum();
        let target: Vec<f64> = slopes.iter().map(|slope| slope * (along - value) / square).collect();
        let step: Vec<f64> = target.iter().zip(&point).map(|(target, z)| target - z).collect();
        // A merit that falls along the step: the squared distance, and the margin at a price above the multiplier's.
        let price = 2.0 * (norm(&point).max(norm(&target)) / libm::sqrt(square)) + 1e-300;
        let merit = |point: &[f64], value: f64| 0.5 * norm(point) * norm(point) + price * value.abs();
        let before = merit(&point, value);
        let mut length = 1.0;
        loop {
            let next: Vec<f64> = point.iter().zip(&step).map(|(z, step)| z + length * step).collect();
            let (next_value, next_slopes) = margin.expansion(&next);
            if merit(&next, next_value) < before || length < 0.05 {
                (point, value, slopes) = (next, next_value, next_slopes);
                break;
            }
            length *= 0.5;
        }
        if norm(&step) * length < 1e-6 * (1.0 + norm(&point)) && value.abs() <= 1e-6 * scale.max(libm::sqrt(square)) {
            break;
        }
    }
    point.iter().all(|z| z.is_finite()).then(|| (point, if at_origin < 0.0 { -1.0 } else { 1.0 }))
}

fn norm(point: &[f64]) -> f64 {
    libm::sqrt(point.iter().map(|z| z * z).sum())
}

/// Householder's reflection that takes the first axis into a direction.
struct Turned {
    normal: Vec<f64>,
    /// 2/|normal|²; 0 for no reflection.
    factor: f64,
}

impl Turned {
    fn new(point: &[f64], length: f64) -> Self {
        let mut normal: Vec<f64> = point.iter().map(|z| if length > 0.0 { -z / length } else { 0.0 }).collect();
        normal[0] += f64::from(length > 0.0);
        let square: f64 = normal.iter().map(|x| x * x).sum();
        Self { normal, factor: if square > 1e-24 { 2.0 / square } else { 0.0 } }
    }

    fn apply(&self, scores: &mut [Lanes]) {
        let along = scores.iter().zip(&self.normal).fold(Lanes::ZERO, |sum, (score, x)| sum + *score * *x);
        scores.iter_mut().zip(&self.normal).for_each(|(score, x)| *score -= along * (self.factor * x));
    }
}
