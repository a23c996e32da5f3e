//! The normal distribution.

use slipfit_tolerance::numeric::normal::tail;

use super::family::Family;

/// ln √(2π).
pub const LN_ROOT_TAU: f64 = 0.918_938_533_204_672_7;

/// A normal distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal {
    /// Mean.
    pub mean: f64,
    /// Standard deviation, above 0.
    pub deviation: f64,
}

impl Normal {
    fn score(&self, x: f64) -> f64 {
        (x - self.mean) / self.deviation
    }
}

impl Family for Normal {
    fn clone_box(&self) -> Box<dyn Family> {
        Box::new(*self)
    }

    fn parameters(&self) -> Vec<(&'static str, f64)> {
        vec![("mean", self.mean), ("sd", self.deviation)]
    }

    fn ln_density(&self, x: f64) -> f64 {
        let score = self.score(x);
        -0.5 * score * score - libm::log(self.deviation) - LN_ROOT_TAU
    }

    fn tails(&self, x: f64) -> [f64; 2] {
        let score = self.score(x);
        [tail(-score), tail(score)]
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn deviation(&self) -> f64 {
        self.deviation
    }

    fn value(&self, score: f64) -> f64 {
        self.mean + score * self.deviation
    }
}
