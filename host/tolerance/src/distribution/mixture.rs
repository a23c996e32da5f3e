//! Mixtures: units from several machines or lots, each with a distribution of its own.

use super::Marginal;
use crate::numeric::normal::tail;
use crate::numeric::root::{excess, zero};

/// The distribution of a unit that is of one of several distributions.
#[derive(Clone, Debug)]
pub struct Mixture {
    /// Shares, which add up to 1, and distributions.
    parts: Vec<(f64, Marginal)>,
}

impl Mixture {
    /// Of distributions with their shares, which add up to 1.
    pub fn new(parts: Vec<(f64, Marginal)>) -> Self {
        Self { parts }
    }

    /// The value at a standard normal score. It lies between the values that the parts have at the same score, and is solved for
    /// there, by the smaller of both tails.
    pub fn value(&self, score: f64) -> f64 {
        let values = self.parts.iter().map(|(_, part)| part.value(score));
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let [below, above] = [tail(-score), tail(score)].map(|tail| tail.max(f64::MIN_POSITIVE));
        zero(low, high, |x| {
            let found = self.tails(x);
            if below < above { excess(found[0], below) } else { -excess(found[1], above) }
        })
    }

    /// P(X ≤ x) and P(X > x).
    pub fn tails(&self, x: f64) -> [f64; 2] {
        self.parts.iter().fold([0.0; 2], |[below, above], (share, part)| {
            let found = part.tails(x);
            [below + share * found[0], above + share * found[1]]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Mixture;
    use crate::{
        distribution::Marginal,
        model::Distribution,
        numeric::normal::{quantile, tail},
    };

    #[test]
    fn points_of_mixtures() {
        let normal = |mean, deviation| Marginal::new(&Distribution::Normal { mean, deviation });
        let uniform = |low, high| Marginal::new(&Distribution::Uniform { limits: [low, high] });
        // Two lots far apart: a tenth of the units is the whole lower lot's.
        let lots = Mixture::new(vec![(0.1, uniform(0.0, 1.0)), (0.9, uniform(5.0, 6.0))]);
        for (p, expected) in [(0.01, 0.1), (0.05, 0.5), (0.1 + 0.09, 5.1), (0.55, 5.5)] {
            assert!((lots.value(quantile(p)) - expected).abs() < 1e-12, "{p}");
        }
        // The wide part has the tails: a hundredth of it beyond 6 of its deviations.
        let wide = Mixture::new(vec![(0.99, normal(0.0, 1.0)), (0.01, normal(0.0, 5.0))]);
        for score in [-quantile(0.01 * tail(6.0)), quantile(0.01 * tail(6.0))] {
            assert!((wide.value(score) - 30.0f64.copysign(score)).abs() < 1e-9, "{}", wide.value(score));
        }
        let equal = Mixture::new(vec![(0.5, normal(1.0, 2.0)), (0.5, normal(1.0, 2.0))]);
        assert_eq!(equal.value(1.5), 4.0);
    }
}
