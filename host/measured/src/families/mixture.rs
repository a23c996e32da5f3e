//! A mixture of two normals, as of two cavities or machines.

use slipfit_tolerance::numeric::{
    normal::tail,
    root::{excess, zero},
};

use super::{family::Family, normal::Normal, sample::Sample};

/// Two normals, of which the first has a share of the parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoNormals {
    /// Share of the first one.
    pub share: f64,
    /// The normals, by rising mean.
    pub parts: [Normal; 2],
}

/// Least standard deviation of either in that of all values: with one at a single value, the likelihood is infinite
/// and estimates nothing.
const LEAST_DEVIATION: f64 = 0.1;
const MOST_STEPS: usize = 500;

impl TwoNormals {
    /// The likeliest one by expectation and maximisation (A. Dempster, N. Laird and D. Rubin, "Maximum likelihood from
    /// incomplete data via the EM algorithm", 1977), from several divisions of the sorted values.
    pub(super) fn fit(sample: &Sample) -> Self {
        let mut best: Option<(Self, f64)> = None;
        for share in [0.5, 0.25, 0.75, 0.1, 0.9] {
            let found = Self::climb(sample, Self::start(sample, share));
            if best.as_ref().is_none_or(|(_, likelihood)| found.1 > *likelihood) {
                best = Some(found);
            }
        }
        let mut found = best.map_or(Self::start(sample, 0.5), |(found, _)| found);
        if found.parts[0].mean > found.parts[1].mean {
            found = Self { share: 1.0 - found.share, parts: [found.parts[1], found.parts[0]] };
        }
        found
    }

    /// Normals around the values below and above a division.
    fn start(sample: &Sample, share: f64) -> Self {
        let at = |p: f64| sample.sorted[((sample.sorted.len() - 1) as f64 * p) as usize];
        let deviation = 0.5 * sample.deviation;
        Self { share, parts: [0.5 * share, 0.5 + 0.5 * share].map(|p| Normal { mean: at(p), deviation }) }
    }

    fn climb(sample: &Sample, mut mixture: Self) -> (Self, f64) {
        let least = LEAST_DEVIATION * sample.deviation;
        let n = sample.sorted.len() as f64;
        let mut likelihood = mixture.ln_likelihood(&sample.sorted);
        for _ in 0..MOST_STEPS {
            // Sums of the probability to be of the first normal, with the distance from the mean and its square.
            let [mut first, mut second] = [[0.0; 3]; 2];
            for x in &sample.sorted {
                let [a, b] = mixture.ln_shares(*x);
                let of_first = 1.0 / (1.0 + libm::exp(b - a));
                let y = (x - sample.mean) / sample.deviation;
                for (sums, weight) in [(&mut first, of_first), (&mut second, 1.0 - of_first)] {
                    *sums = [sums[0] + weight, sums[1] + weight * y, sums[2] + weight * y * y];
                }
            }
            let normal = |[weight, sum, square]: [f64; 3]| {
                let mean = sum / weight;
                let deviation = libm::sqrt((square / weight - mean * mean).max(0.0)) * sample.deviation;
                Normal { mean: sample.mean + mean * sample.deviation, deviation: deviation.max(least) }
            };
            let next = Self { share: first[0] / n, parts: [normal(first), normal(second)] };
            let reached = next.ln_likelihood(&sample.sorted);
            // NaN where one is empty.
            if reached.is_nan() || reached < likelihood {
                break;
            }
            mixture = next;
            if reached - likelihood < 1e-10 * n {
                return (mixture, reached);
            }
            likelihood = reached;
        }
        (mixture, likelihood)
    }

    /// Logarithms of both parts of the density.
    fn ln_shares(&self, x: f64) -> [f64; 2] {
        let [a, b] = &self.parts;
        [libm::log(self.share) + a.ln_density(x), libm::log(1.0 - self.share) + b.ln_density(x)]
    }
}

impl Family for TwoNormals {
    fn clone_box(&self) -> Box<dyn Family> {
        Box::new(*self)
    }

    fn parameters(&self) -> Vec<(&'static str, f64)> {
        let [a, b] = self.parts;
        let share = ("share", self.share);
        vec![share, ("mean 1", a.mean), ("sd 1", a.deviation), ("mean 2", b.mean), ("sd 2", b.deviation)]
    }

    fn ln_density(&self, x: f64) -> f64 {
        let [a, b] = self.ln_shares(x);
        let greater = a.max(b);
        greater + libm::log1p(libm::exp(a.min(b) - greater))
    }

    fn tails(&self, x: f64) -> [f64; 2] {
        let [a, b] = self.parts.map(|part| part.tails(x));
        [0, 1].map(|side| self.share * a[side] + (1.0 - self.share) * b[side])
    }

    fn mean(&self) -> f64 {
        let [a, b] = self.parts;
        self.share * a.mean + (1.0 - self.share) * b.mean
    }

    fn deviation(&self) -> f64 {
        let [a, b] = self.parts;
        let (p, q, apart) = (self.share, 1.0 - self.share, b.mean - a.mean);
        libm::sqrt(p * a.deviation * a.deviation + q * b.deviation * b.deviation + p * q * apart * apart)
    }

    fn value(&self, score: f64) -> f64 {
        let [a, b] = self.parts.map(|part| part.value(score));
        // The value lies between those of both; the smaller tail is the accurate one.
        let side = usize::from(score > 0.0);
        let wanted = tail(score.abs());
        let sign = if side == 0 { 1.0 } else { -1.0 };
        zero(a.min(b), a.max(b), |x| sign * excess(self.tails(x)[side], wanted))
    }
}
