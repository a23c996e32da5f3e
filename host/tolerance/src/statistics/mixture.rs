//! The probability of an event in a production of which something has one unknown value.
//!
//! Units are counted at several values, each as probable as any other. Their shares differ because the values do, and because few
//! units are counted at each. Empirical Bayes keeps the two apart: every share is drawn towards the mean by the part B of the variance
//! that the counting explains, and is then as certain as 1 / ((1 − B)/n + B/N) units would make it, n at a value and N in all. The
//! spread of the mixture is that between the values, and without any it is as certain as all units together.

use statrs::function::beta::beta_reg;

use super::binomial;
use crate::numeric::{
    normal::{SIDE, tail},
    root::zero,
};

/// Units, and hits and misses, from which on a beta distribution is computed by its normal approximation, which then errs by less
/// than 1e-4. Continued fractions would take the square root of their number in terms.
const MANY: f64 = 2000.0;
const SEVERAL: f64 = 20.0;

/// What is known of a probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixture {
    /// Its mean over all values.
    pub expected: f64,
    /// The interval that holds it with 95 %. Where nothing differs between the values, that of Clopper and Pearson.
    pub interval: [f64; 2],
    /// Its variance between the values; 0 where the counting explains all differences.
    pub between: f64,
    /// Variance of the share at one value by the counting alone.
    pub noise: f64,
}

/// Beta distributions of the same number of units, each as probable as any other.
struct Betas {
    means: Vec<f64>,
    units: f64,
}

impl Betas {
    /// The probability below `p`, where the shapes have so many hits and misses more.
    fn below(&self, p: f64, [hits, misses]: [f64; 2]) -> f64 {
        let each = |mean: &f64| below(mean * self.units + hits, (1.0 - mean) * self.units + misses, p);
        self.means.iter().map(each).sum::<f64>() / self.means.len() as f64
    }

    /// The ends that are not exceeded with [`SIDE`], and with 1 − [`SIDE`]: each with one hit or miss more, as of Clopper and Pearson.
    fn interval(&self) -> [f64; 2] {
        let end = |more: [f64; 2], chance: f64| zero(0.0, 1.0, |p| self.below(p, more) - chance);
        [end([0.0, 1.0], SIDE), end([1.0, 0.0], 1.0 - SIDE)]
    }
}

/// The probability that a beta distribution of these shapes has below `p`; a shape of 0 puts it at an end.
fn below(a: f64, b: f64, p: f64) -> f64 {
    if p <= 0.0 || p >= 1.0 {
        return if p >= 1.0 || (p == 0.0 && a == 0.0) { 1.0 } else { 0.0 };
    }
    match (a > 0.0, b > 0.0) {
        (false, _) => 1.0,
        (true, false) => 0.0,
        (true, true) if a + b > MANY && a.min(b) > SEVERAL => tail(-score(a, b, p)),
        (true, true) => beta_reg(a, b, p),
    }
}

/// The normal score of the probability that a beta distribution has below `p` (Peizer and Pratt, "A normal approximation for
/// binomial, F, beta, and other common, related tail probabilities", 1968).
fn score(a: f64, b: f64, p: f64) -> f64 {
    let (q, s, t, n) = (1.0 - p, b - 0.5, a - 0.5, a + b - 1.0);
    let off = s + 1.0 / 6.0 - (n + 1.0 / 3.0) * q + 0.02 * (q / b - p / a + (q - 0.5) / (a + b));
    let deviance = s * libm::log(s / (n * q)) + t * libm::log(t / (n * p));
    let from_middle = s - n * q;
    if from_middle.abs() < 1e-7 * n {
        return off / libm::sqrt((n + 1.0 / 6.0) * p * q);
    }
    off / from_middle.abs() * libm::sqrt((2.0 / (1.0 + 1.0 / (6.0 * n)) * deviance).max(0.0))
}

impl Mixture {
    /// Of the `hits` among `units` ≥ 2 at each of two values or more.
    pub fn of(hits: &[u64], units: u64) -> Self {
        let (n, count) = (units as f64, hits.len() as f64);
        let all = hits.iter().sum::<u64>();
        let total = n * count;
        let shares = || hits.iter().map(|hits| *hits as f64 / n);
        let expected = all as f64 / total;
        // Values of equal strata have the spread of the whole, so that their number divides it; one of their shares is free no more.
        let spread = shares().map(|share| (share - expected) * (share - expected)).sum::<f64>() / count;
        let noise = shares().map(|share| share * (1.0 - share)).sum::<f64>() / (count * (n - 1.0));
        let between = (spread - noise * (1.0 - 1.0 / count)).max(0.0);
        if between == 0.0 {
            let interval = binomial::limits(all, units * hits.len() as u64, SIDE);
            return Self { expected, interval, between, noise };
        }
        let by_counting = noise / (noise + between);
        let means = shares().map(|share| expected + (1.0 - by_counting) * (share - expected)).collect();
        let betas = Betas { means, units: 1.0 / ((1.0 - by_counting) / n + by_counting / total) };
        Self { expected, interval: betas.interval(), between, noise }
    }
}

#[cfg(test)]
mod tests {
    use super::{Mixture, below, score};
    use crate::{
        numeric::normal::{SIDE, tail},
        statistics::binomial,
    };
    use slipfit_core::sampling::stream::{Rng, uniform, unit_stream};
    use statrs::function::beta::beta_reg;

    /// Hits among `units` at each of `values`, in strata of what is unknown, u, where the probability is `p` of it.
    fn counted(values: u64, units: u64, seed: u64, p: impl Fn(f64) -> f64) -> Vec<u64> {
        let mut stream = unit_stream(seed, 0);
        let mut share = move || uniform(stream.next_u64());
        let count = |k: u64| {
            let chance = p((k as f64 + share()) / values as f64);
            (0..units).filter(|_| share() < chance).count() as u64
        };
        (0..values).map(count).collect()
    }

    #[test]
    fn betas_of_many_units_are_nearly_normal() {
        for (a, b) in [(25.0, 3000.0), (300.0, 2500.0), (1500.0, 1500.0), (5000.0, 25.0)] {
            let mean = a / (a + b);
            let deviation = libm::sqrt(mean * (1.0 - mean) / (a + b + 1.0));
            for z in [-2.5, -1.0, 0.0, 0.5, 1.96] {
                let p = mean + z * deviation;
                if p > 0.0 && p < 1.0 {
                    let (found, exact) = (tail(-score(a, b, p)), beta_reg(a, b, p));
                    assert!((found - exact).abs() < 1e-4, "{a} {b} {z}: {found} {exact}");
                }
            }
        }
        assert_eq!([below(0.0, 3.0, 0.0), below(0.0, 3.0, 0.5), below(3.0, 0.0, 0.5)], [1.0, 1.0, 0.0]);
    }

    /// Equal counts, which chance alone explains, have the interval of all units together.
    #[test]
    fn without_differences_it_is_the_interval_of_all_units() {
        for (hits, units) in [(0, 300), (7, 300), (150, 300), (300, 300)] {
            let found = Mixture::of(&[hits; 32], units);
            assert_eq!(found.interval, binomial::limits(32 * hits, 32 * units, SIDE));
            assert!((found.expected - hits as f64 / units as f64).abs() < 1e-15 && found.between == 0.0);
        }
        // Counts that chance does make unequal: hardly wider.
        let mut wider = 0.0;
        for seed in 0..200 {
            let hits = counted(64, 312, seed, |_| 0.3);
            let all = binomial::limits(hits.iter().sum(), 64 * 312, SIDE);
            let found = Mixture::of(&hits, 312);
            wider += (found.interval[1] - found.interval[0]) / (all[1] - all[0]) / 200.0;
        }
        println!("{wider} times as wide");
        assert!((1.0..2.5).contains(&wider), "{wider}");
    }

    /// p = u, p = u² and a jump: with u unknown, the mean and the 2.5 % and 97.5 % points of p are known.
    #[test]
    fn intervals_are_those_of_known_probabilities() {
        // Of many values with the same probability each is as uncertain as its own units leave it: 2.5 standard deviations of 0.028.
        type Case = (&'static str, fn(f64) -> f64, f64, [f64; 2]);
        let cases: [Case; 3] = [
            ("u", |u| u, 0.5, [0.01, 0.02]),
            ("u²", |u| u * u, 1.0 / 3.0, [0.01, 0.02]),
            ("a jump", |u| if u < 0.4 { 0.02 } else { 0.5 }, 0.308, [0.07, 1.0]),
        ];
        for (name, p, mean, [off, more]) in cases {
            let (low, high) = (p(0.025), p(0.975));
            let (mut ends, mut expected, mut held) = ([0.0; 2], 0.0, 0);
            let seeds = 400;
            for seed in 0..seeds {
                let found = Mixture::of(&counted(64, 312, seed, p), 312);
                ends = [0, 1].map(|i| ends[i] + found.interval[i] / seeds as f64);
                expected += found.expected / seeds as f64;
                // The truth is a value of u like any other.
                let truth = p((seed as f64 * 0.618_033_988_749_895 + 0.5).fract());
                held += u32::from(found.interval[0] <= truth && truth <= found.interval[1]);
            }
            println!("{name}: {ends:?} for {low} to {high}, {expected} for {mean}, {held} of {seeds} hold");
            assert!((ends[0] - low).abs() < off && (ends[1] - high).abs() < off, "{name}: {ends:?}");
            assert!((expected - mean).abs() < 0.004, "{name}: {expected}");
            let held = f64::from(held) / seeds as f64;
            assert!(held >= 0.93 && held <= 0.96 + more, "{name}: {held}");
        }
    }

    /// The variance of the mixture is that between the values.
    #[test]
    fn the_spread_is_that_between_the_values() {
        let p = |u: f64| 0.1 + 0.4 * u;
        let known = 0.16 / 12.0;
        let seeds = 200;
        let mean = (0..seeds).map(|seed| Mixture::of(&counted(32, 64, seed, p), 64).between).sum::<f64>();
        assert!((mean / f64::from(seeds as u32) / known - 1.0).abs() < 0.03, "{mean}");
    }
}
