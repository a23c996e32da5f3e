//! The lognormal distribution.

use slipfit_tolerance::numeric::normal::tail;

use super::{family::Family, normal::LN_ROOT_TAU, sample::mean_and_square};

/// A distribution of which the logarithm of the distance from a lower end is normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lognormal {
    /// Lower end.
    pub shift: f64,
    /// Mean of the logarithms.
    pub mean: f64,
    /// Standard deviation of the logarithms, above 0.
    pub deviation: f64,
}

impl Lognormal {
    /// The likeliest one for the `logarithms` of the distances from a lower end `shift`.
    pub(super) fn fit(logarithms: &[f64], shift: f64) -> Self {
        let (mean, square) = mean_and_square(logarithms);
        Self { shift, mean, deviation: libm::sqrt(square) }
    }
}

impl Family for Lognormal {
    fn clone_box(&self) -> Box<dyn Family> {
        Box::new(*self)
    }

    fn parameters(&self) -> Vec<(&'static str, f64)> {
        vec![("shift", self.shift), ("mean of ln", self.mean), ("sd of ln", self.deviation)]
    }

    fn ln_density(&self, x: f64) -> f64 {
        if x <= self.shift {
            return f64::NEG_INFINITY;
        }
        let logarithm = libm::log(x - self.shift);
        let score = (logarithm - self.mean) / self.deviation;
        -0.5 * score * score - libm::log(self.deviation) - LN_ROOT_TAU - logarithm
    }

    fn tails(&self, x: f64) -> [f64; 2] {
        if x <= self.shift {
            return [0.0, 1.0];
        }
        let score = (libm::log(x - self.shift) - self.mean) / self.deviation;
        [tail(-score), tail(score)]
    }

    fn mean(&self) -> f64 {
        self.shift + libm::exp(self.mean + 0.5 * self.deviation * self.deviation)
    }

    fn deviation(&self) -> f64 {
        let square = self.deviation * self.deviation;
        libm::exp(self.mean + 0.5 * square) * libm::sqrt(libm::expm1(square))
    }

    fn value(&self, score: f64) -> f64 {
        self.shift + libm::exp(self.mean + score * self.deviation)
    }
}
