//! Importance sampling around design points.
//!
//! Scores are drawn from a mixture of standard normals, one around each design point instead of the origin, and every unit
//! counts with the ratio of its density over the production to that of the whole mixture, the balance heuristic (Veach
//! 1997; Owen and Zhou 2000). Scrambled Sobol' points whose first coordinate points along the design point see the border
//! between good and bad in one dimension. (Melchers, Struct. Saf. 6, 1989.)

use super::{DesignPoint, LimitState, Margins, dot};
use crate::{
    numeric::{
        lanes::{LANES, Lanes},
        normal::Scores,
    },
    sampling::{
        sampler::{Method, Sampler},
        sobol::MOST_DIMENSIONS,
    },
};
use slipfit_core::sampling::stream::derived;

/// Independent designs, whose spread is the error.
pub const REPLICATES: u64 = 16;
/// Units of each.
const UNITS: u64 = 1024;
/// Units of each for every design point, where these are many.
const UNITS_EACH: u64 = 128;

/// Standard normals around design points.
pub struct Mixture {
    points: Vec<DesignPoint>,
    /// Share of each; they add up to 1.
    weights: Vec<f64>,
}

/// What was found by sampling.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// Probability.
    pub probability: f64,
    /// Its standard error, from the spread of the replicates.
    pub error: f64,
    /// Greatest ratio of densities of a unit that failed.
    pub worst_ratio: f64,
}

impl Mixture {
    /// Around `points` with the given `weights`, of any sum.
    pub fn new(points: Vec<DesignPoint>, weights: Vec<f64>) -> Self {
        let sum: f64 = weights.iter().sum();
        let weights = weights.into_iter().map(|weight| weight / sum).collect();
        Self { points, weights }
    }

    /// Around one point.
    pub fn around(point: DesignPoint) -> Self {
        Self { points: vec![point], weights: vec![1.0] }
    }

    /// Its points.
    pub fn points(&self) -> &[DesignPoint] {
        &self.points
    }

    /// The density of standard normals over the mixture's, of every unit.
    fn ratios(&self, scores: &[Lanes]) -> Lanes {
        let mut sum = Lanes::ZERO;
        for (DesignPoint { point, distance }, weight) in self.points.iter().zip(&self.weights) {
            let along = scores.iter().zip(point).fold(Lanes::ZERO, |sum, (score, z)| sum + *score * *z);
            sum += along.map(|along| weight * libm::exp(along - 0.5 * distance * distance));
        }
        sum.map(f64::recip)
    }

    /// The probability of failure by units of the mixture.
    pub fn sample(mut self, state: &mut LimitState, seed: u64) -> Sampled {
        let dimensions = state.dimensions();
        let method = if dimensions > MOST_DIMENSIONS { Method::PseudoRandom } else { Method::ScrambledSobol };
        // Without Sobol' points more units gain little, and each of so many scores takes its time.
        let least = if method == Method::PseudoRandom { UNITS / 4 } else { UNITS };
        let all = least.max(UNITS_EACH * self.points.len() as u64) as f64;
        // Whole groups, and the weights that these have.
        let groups: Vec<u64> =
            self.weights.iter().map(|w| libm::ceil(w * all / LANES as f64).max(1.0) as u64).collect();
        let units = (LANES as u64 * groups.iter().sum::<u64>()) as f64;
        self.weights = groups.iter().map(|groups| (groups * LANES as u64) as f64 / units).collect();
        let factor = state.factor();
        let mut shares = vec![0.0; REPLICATES as usize];
        let (mut bits, table) = (vec![[0; LANES]; dimensions], Scores::table());
        let mut worst_ratio: f64 = 0.0;
        for (number, (DesignPoint { point, distance }, groups)) in self.points.iter().zip(groups).enumerate() {
            let units_here = groups * LANES as u64;
            let sampler = Sampler::new(method, derived(seed, number as u64), dimensions, REPLICATES, units_here);
            let turned = Turned::new(point, *distance);
            for (replicate, share) in shares.iter_mut().enumerate() {
                let start = replicate as u64 * units_here;
                for first in (start..start + units_here).step_by(LANES) {
                    sampler.fill(first, &mut bits);
                    let mut scores: Vec<Lanes> = bits.iter().map(|bits| table.lanes(*bits)).collect();
                    turned.apply(&mut scores);
                    scores.iter_mut().zip(point).for_each(|(score, z)| *score += Lanes::splat(*z));
                    let ratios = self.ratios(&scores);
                    let margins = state.margins(&mut scores);
                    for (ratio, _) in ratios.0.into_iter().zip(margins).filter(|(_, margin)| *margin < 0.0) {
                        *share += factor * ratio / units;
                        worst_ratio = worst_ratio.max(ratio);
                    }
                }
            }
        }
        let (probability, error) = mean_and_error(&shares);
        Sampled { probability, error, worst_ratio }
    }
}

/// Mean of independent estimates and its standard error.
pub fn mean_and_error(estimates: &[f64]) -> (f64, f64) {
    let count = estimates.len() as f64;
    let mean = estimates.iter().sum::<f64>() / count;
    let square: f64 = estimates.iter().map(|estimate| (estimate - mean) * (estimate - mean)).sum();
    (mean, libm::sqrt(square / (count * (count - 1.0))))
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
        let square = dot(&normal, &normal);
        Self { normal, factor: if square > 1e-24 { 2.0 / square } else { 0.0 } }
    }

    fn apply(&self, scores: &mut [Lanes]) {
        let along = scores.iter().zip(&self.normal).fold(Lanes::ZERO, |sum, (score, x)| sum + *score * *x);
        scores.iter_mut().zip(&self.normal).for_each(|(score, x)| *score -= along * (self.factor * x));
    }
}
