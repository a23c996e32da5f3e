//! Johnson's system with two ends.

use slipfit_tolerance::numeric::normal::tail;

use super::{
    family::Family,
    normal::LN_ROOT_TAU,
    sample::{Sample, mean_and_square},
};
use crate::numeric::minimum::minimise;

/// A distribution of which γ + δ·ln((x − ξ)/(ξ + λ − x)) is standard normal: from ξ to ξ + λ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JohnsonSb {
    /// γ.
    pub gamma: f64,
    /// δ, above 0.
    pub delta: f64,
    /// ξ, the lower end.
    pub xi: f64,
    /// λ, above 0, the distance of the ends.
    pub lambda: f64,
}

/// Least and greatest distance of an end from the value next to it, in the range of the values; the least one is divided by
/// the number of parts. With an end at a value, the likelihood is infinite and estimates nothing; far ends change nothing.
const DISTANCE: [f64; 2] = [0.5, 100.0];

impl JohnsonSb {
    /// The likeliest one, unless the likelihood grows towards an end at a value. For each pair of ends, γ and δ are those
    /// of a normal; a search finds the ends.
    pub(super) fn fit(sample: &Sample) -> Option<Self> {
        let range = sample.greatest() - sample.least();
        let bounds = [DISTANCE[0] / sample.sorted.len() as f64, DISTANCE[1]].map(libm::log);
        let with = |point: &[f64; 2]| {
            let [below, above] = point.map(|ln| range * libm::exp(ln.clamp(bounds[0], bounds[1])));
            let (xi, end) = (sample.least() - below, sample.greatest() + above);
            let lengths: Vec<f64> = sample.sorted.iter().map(|x| libm::log((x - xi) / (end - x))).collect();
            let (mean, square) = mean_and_square(&lengths);
            let delta = 1.0 / libm::sqrt(square);
            Self { gamma: -mean * delta, delta, xi, lambda: end - xi }
        };
        let cost = |point: &[f64; 2]| -with(point).ln_likelihood(&sample.sorted);
        let mut best = ([0.0; 2], f64::INFINITY);
        for start in [[-2.0, -2.0], [-1.0, 1.0], [1.0, -1.0], [0.0, 0.0]] {
            let found = minimise(start, [0.3, 0.3], cost);
            let is_inside = found.0.iter().all(|ln| *ln > bounds[0]);
            if is_inside && found.1 < best.1 {
                best = found;
            }
        }
        best.1.is_finite().then(|| with(&best.0))
    }

    fn score(&self, x: f64) -> f64 {
        self.gamma + self.delta * libm::log((x - self.xi) / (self.xi + self.lambda - x))
    }
}

impl Family for JohnsonSb {
    fn clone_box(&self) -> Box<dyn Family> {
        Box::new(*self)
    }

    fn parameters(&self) -> Vec<(&'static str, f64)> {
        vec![("gamma", self.gamma), ("delta", self.delta), ("xi", self.xi), ("lambda", self.lambda)]
    }

    fn ln_density(&self, x: f64) -> f64 {
        let (below, above) = (x - self.xi, self.xi + self.lambda - x);
        if below <= 0.0 || above <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let score = self.score(x);
        -0.5 * score * score + libm::log(self.delta * self.lambda / (below * above)) - LN_ROOT_TAU
    }

    fn tails(&self, x: f64) -> [f64; 2] {
        if x <= self.xi {
            return [0.0, 1.0];
        }
        if x >= self.xi + self.lambda {
            return [1.0, 0.0];
        }
        let score = self.score(x);
        [tail(-score), tail(score)]
    }

    fn value(&self, score: f64) -> f64 {
        let odds = libm::exp(-(score - self.gamma) / self.delta);
        self.xi + self.lambda / (1.0 + odds)
    }
}
