//! What a sample leaves open of a distribution within its family.

use slipfit_tolerance::numeric::normal::SIDE;

use super::{
    family::Family,
    free::Free,
    kind::{FitError, Kind},
    sample::Sample,
};
use crate::numeric::importance;

/// Distributions with the probability that a sample leaves them.
#[derive(Debug)]
pub struct Posterior {
    draws: Vec<(f64, Box<dyn Family>)>,
    mode: Box<dyn Family>,
}

/// Values at each end that stay as they are, and groups of equal number between them.
const ENDS: usize = 100;
const GROUPS: usize = 800;

/// Sorted values, each with its number: of many values, neighbours in the middle are one value at their mean. What that takes from the
/// variance is less than a part in 10,000, where the standard error of a variance of so many values is about a hundredth.
fn grouped(sorted: &[f64]) -> Vec<(f64, f64)> {
    let single = |x: &f64| (1.0, *x);
    if sorted.len() <= 2 * ENDS + GROUPS {
        return sorted.iter().map(single).collect();
    }
    let (low, rest) = sorted.split_at(ENDS);
    let (middle, high) = rest.split_at(rest.len() - ENDS);
    let group = |values: &[f64]| {
        let count = values.len() as f64;
        (count, values.iter().sum::<f64>() / count)
    };
    let groups = middle.chunks(middle.len().div_ceil(GROUPS)).map(group);
    low.iter().map(single).chain(groups).chain(high.iter().map(single)).collect()
}

impl Posterior {
    /// Of a family, for `values`; a distribution `near` the likeliest one helps to find it.
    pub fn new(kind: Kind, near: Option<&dyn Family>, values: &[f64]) -> Result<Self, FitError> {
        let sample = Sample::new(values)?;
        let none = FitError::NoInterval(kind);
        let free = Free::new(kind, &sample).ok_or(none.clone())?;
        let (start, widths) = free.start(near);
        let grouped = grouped(&sample.sorted);
        let ln_density = |point: &[f64]| {
            let family = free.family(point);
            let ln_likelihood: f64 = grouped.iter().map(|(count, x)| count * family.ln_density(*x)).sum();
            ln_likelihood + free.ln_prior(point)
        };
        let drawn = importance::draw(&start, &widths, ln_density).ok_or(none.clone())?;
        let mode = drawn.iter().max_by(|a, b| ln_density(&a.1).total_cmp(&ln_density(&b.1))).ok_or(none)?;
        let mode = free.family(&mode.1);
        let draws = drawn.into_iter().map(|(weight, point)| (weight, free.family(&point))).collect();
        Ok(Self { draws, mode })
    }

    /// The most probable of the drawn distributions.
    pub fn mode(&self) -> &dyn Family {
        self.mode.as_ref()
    }

    /// The drawn distributions, each with its weight.
    pub fn draws(&self) -> impl Iterator<Item = (f64, &dyn Family)> {
        self.draws.iter().map(|(weight, family)| (*weight, family.as_ref()))
    }

    /// The intervals of 95 % of some `figures` of the distribution.
    pub fn intervals<const N: usize>(&self, figures: impl Fn(&dyn Family) -> [f64; N]) -> [[f64; 2]; N] {
        let rows: Vec<([f64; N], f64)> =
            self.draws.iter().map(|(weight, family)| (figures(family.as_ref()), *weight)).collect();
        let sum: f64 = rows.iter().map(|(_, weight)| weight).sum();
        let mut order: Vec<usize> = (0..rows.len()).collect();
        std::array::from_fn(|k| {
            order.sort_by(|a, b| rows[*a].0[k].total_cmp(&rows[*b].0[k]));
            [SIDE, 1.0 - SIDE].map(|wanted| {
                let mut below = 0.0;
                let at = order.iter().find(|i| {
                    below += rows[**i].1;
                    below >= wanted * sum
                });
                at.or(order.last()).map_or(f64::NAN, |i| rows[*i].0[k])
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::grouped;
    use crate::families::tests::{draw, examples};

    #[test]
    fn groups_have_the_moments_and_the_likelihood_of_their_values() {
        for (kind, family) in examples() {
            for count in [900, 1001, 5000, 20_000] {
                let mut values = draw(family.as_ref(), count, 7);
                values.sort_by(f64::total_cmp);
                let found = grouped(&values);
                let single: Vec<(f64, f64)> = values.iter().map(|x| (1.0, *x)).collect();
                let of =
                    |values: &[(f64, f64)], f: &dyn Fn(f64) -> f64| values.iter().map(|(n, x)| n * f(*x)).sum::<f64>();
                let mean = of(&single, &|x| x) / count as f64;
                let square = |x: f64| (x - mean) * (x - mean);
                let [one, two] = [&single, &found].map(|values| of(values, &square));
                assert_eq!(of(&found, &|_| 1.0), count as f64);
                assert!((of(&found, &|x| x) / count as f64 - mean).abs() < 1e-12 * mean.abs().max(1.0));
                assert!((0.0..1e-4).contains(&((one - two + 1e-12 * one) / one)), "{kind} of {count}: {one}, {two}");
                // A weight is a ratio of likelihoods, here of this distribution and of one about a standard error wider: it is
                // right to 2 %.
                let ratio = |x: f64| {
                    family.ln_density(x) - family.ln_density(mean + (x - mean) * (1.0 - 0.7 / libm::sqrt(count as f64)))
                };
                let [one, two] = [&single, &found].map(|values| of(values, &ratio));
                assert!((one - two).abs() < 0.02, "{kind} of {count}: {one}, {two}");
                assert!(count < 1001 || found.len() <= 1001);
            }
        }
    }
}
