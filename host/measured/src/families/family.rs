//! What every distribution of a family can tell.

use std::fmt;

use slipfit_tolerance::numeric::normal::quantile;

use crate::numeric::scale::scores;

/// A distribution of a family.
pub trait Family: fmt::Debug + Send + Sync {
    /// A copy of it.
    fn clone_box(&self) -> Box<dyn Family>;

    /// Its parameters with their usual names, in the unit of the values where they have one.
    fn parameters(&self) -> Vec<(&'static str, f64)>;

    /// The logarithm of its density; −∞ where it is 0.
    fn ln_density(&self, x: f64) -> f64;

    /// The probabilities of values up to `x` and above it, each accurate where it is small.
    fn tails(&self, x: f64) -> [f64; 2];

    /// The value below which it lies with the same probability as a standard normal below `score`: its quantile, accurate
    /// in both tails.
    fn value(&self, score: f64) -> f64;

    /// Its mean.
    fn mean(&self) -> f64 {
        scores().iter().map(|[score, weight]| weight * self.value(*score)).sum()
    }

    /// Its standard deviation.
    fn deviation(&self) -> f64 {
        let mean = self.mean();
        let square = |[score, weight]: &[f64; 2]| {
            let off = self.value(*score) - mean;
            weight * off * off
        };
        libm::sqrt(scores().iter().map(square).sum())
    }

    /// The probability of values up to `x`.
    fn cdf(&self, x: f64) -> f64 {
        self.tails(x)[0]
    }

    /// The value below which it lies with a `probability` between 0 and 1.
    fn quantile(&self, probability: f64) -> f64 {
        self.value(quantile(probability))
    }

    /// The logarithm of the likelihood of `values`.
    fn ln_likelihood(&self, values: &[f64]) -> f64 {
        values.iter().map(|x| self.ln_density(*x)).sum()
    }
}
