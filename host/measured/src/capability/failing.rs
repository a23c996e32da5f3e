//! The share of a normal production outside its limits.

use serde::Serialize;
use slipfit_tolerance::{
    numeric::{
        normal::{SIDE, quantile, tail},
        root::zero,
    },
    statistics::interval,
};

use super::{estimate::Estimate, indices::Known};
use crate::numeric::{scale::scores, tails::chi_squared_above};

/// Parts outside the limits that were measured, without a family.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Counted {
    /// Measured parts below the lower limit and above the upper one.
    pub parts: [usize; 2],
    /// Share of both in the production, with the interval of C. Clopper and E. Pearson (1934).
    pub share: Estimate,
}

impl Counted {
    /// Of rising values.
    pub fn new(sorted: &[f64], [lower, upper]: [Option<f64>; 2]) -> Self {
        let below = lower.map_or(0, |limit| sorted.partition_point(|x| *x < limit));
        let above = upper.map_or(0, |limit| sorted.len() - sorted.partition_point(|x| *x <= limit));
        let (hits, units) = (below + above, sorted.len());
        let share = Estimate {
            value: hits as f64 / units as f64,
            interval: interval::proportion(hits.min(units) as u64, units as u64),
        };
        Self { parts: [below, above], share }
    }
}

/// Expected shares of the production outside its limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Failing {
    /// Below the lower limit.
    pub below: Option<Estimate>,
    /// Above the upper limit.
    pub above: Option<Estimate>,
    /// Outside of either.
    pub both: Option<Estimate>,
}

impl Known {
    /// The shares outside the limits, with intervals of 95 %. That of one limit is exact, by the noncentral t
    /// distribution. That of both holds the shares with which an estimate as great, and one as small, has 2.5 % or more; as
    /// the mean's place between the limits, the estimated one counts, which leaves 94 to 98 %. If the mean is outside, or
    /// the estimate above ½, its bounds are the greater lower one and the sum of the upper ones, which is never too short.
    pub fn failing(&self, limits: [Option<f64>; 2]) -> Failing {
        let share = |score: Estimate| Estimate {
            value: tail(score.value),
            interval: [tail(score.interval[1]), tail(score.interval[0])],
        };
        let [below, above] = self.scores(limits).map(|score| score.map(share));
        let both = match (below, above, limits) {
            (Some(below), Some(above), [Some(lower), Some(upper)]) => {
                let distances = [self.mean - lower, upper - self.mean];
                let estimate = below.value + above.value;
                let interval = if distances.iter().all(|distance| *distance > 0.0) && estimate < 0.5 {
                    self.share_of_both(distances, estimate)
                } else {
                    let [a, b] = [below.interval, above.interval];
                    [a[0].max(b[0]), (a[1] + b[1]).min(1.0)]
                };
                Some(Estimate { value: (below.value + above.value).min(1.0), interval })
            }
            _ => below.or(above),
        };
        Failing { below, above, both }
    }

    /// The interval of the share outside two limits at `distances` > 0 from the mean, near an `estimate` below ½.
    fn share_of_both(&self, distances: [f64; 2], estimate: f64) -> [f64; 2] {
        let points = scores();
        let root = libm::sqrt(self.parts);
        let [below, above] = distances.map(|distance| distance / self.deviation);
        let seen = quantile_above(estimate);
        let seen_halved = quantile_above(0.5 * estimate);
        // The chance of an estimate as great, if the share is the tail above `score` and the mean off the middle by as many
        // standard deviations as it seems. For each error of the mean, the estimate rises with the standard deviation.
        let off = 0.5 * (below - above);
        let chance = |score: f64| -> f64 {
            let half = half_width(score, off.abs());
            let chance = |[error, weight]: &[f64; 2]| {
                let error = off + error / root;
                let distances = [half + error, half - error];
                if distances.iter().any(|distance| *distance <= 0.0) {
                    return *weight;
                }
                let ratio = 1.0 / scale_of_share(distances, [seen, seen_halved]);
                weight * chi_squared_above(self.freedom * ratio * ratio, self.freedom)
            };
            points.iter().map(chance).sum()
        };
        [SIDE, 1.0 - SIDE].map(|wanted| {
            // The chance falls with the score.
            let excess = |score: f64| wanted - chance(score);
            let (mut low, mut high, mut step) = (seen - 0.5, seen + 0.5, 0.5);
            while excess(low) > 0.0 && low > LOWEST_SCORE {
                (high, low) = (low, (low - step).max(LOWEST_SCORE));
                step *= 2.0;
            }
            while excess(high) < 0.0 && high < HIGHEST_SCORE {
                (low, high) = (high, (high + step).min(HIGHEST_SCORE));
                step *= 2.0;
            }
            tail(zero(low, high, excess))
        })
    }
}

/// Scores of shares of 1 and of 0 as far as numbers go.
const LOWEST_SCORE: f64 = -8.0;
const HIGHEST_SCORE: f64 = 37.0;

/// The score above which a share lies.
fn quantile_above(share: f64) -> f64 {
    if share < f64::MIN_POSITIVE { HIGHEST_SCORE } else { -quantile(share.min(1.0 - 1e-16)) }
}

/// Half the distance of two limits, in standard deviations, of which the tails above `score` lies outside with the mean off
/// their middle by `off` ≥ 0.
fn half_width(score: f64, off: f64) -> f64 {
    let wanted = tail(score);
    // The nearer limit's share is between half of it and all of it.
    zero((off + score).max(0.0), off + quantile_above(0.5 * wanted), |half| {
        let share = tail(half - off) + tail(half + off);
        (wanted - share) / (wanted + share)
    })
}

/// The factor of `distances` > 0 of two limits, in standard deviations, with which the tail above the first score lies
/// outside of them; the second score is that of half that tail.
fn scale_of_share([below, above]: [f64; 2], [score, halved]: [f64; 2]) -> f64 {
    let wanted = tail(score);
    let nearer = below.min(above);
    zero((score / nearer).max(0.0), halved / nearer, |scale| {
        let share = tail(below * scale) + tail(above * scale);
        (wanted - share) / (wanted + share)
    })
}

#[cfg(test)]
mod tests {
    use super::{Counted, Known};

    #[test]
    fn a_far_limit_changes_nothing() {
        let known = Known { parts: 10.0, mean: 0.2, deviation: 1.1, freedom: 9.0 };
        let one = known.failing([None, Some(3.0)]).both.expect("a share");
        let both = known.failing([Some(-1e4), Some(3.0)]).both.expect("a share");
        for side in 0..2 {
            assert!((one.interval[side] / both.interval[side] - 1.0).abs() < 1e-6, "{one:?} {both:?}");
        }
    }

    #[test]
    fn parts_outside_are_counted() {
        let counted = Counted::new(&[1.0, 2.0, 2.0, 3.0, 4.0], [Some(2.0), Some(3.0)]);
        assert_eq!((counted.parts, counted.share.value), ([1, 1], 0.4));
    }

    #[test]
    fn extremes_end() {
        for mean in [-1e6, -5.0, 0.0, 1.0, 1e6] {
            for deviation in [1e-9, 1.0, 1e9] {
                let known = Known { parts: 2.0, mean, deviation, freedom: 1.0 };
                let share = known.failing([Some(-1.0), Some(1.0)]).both.expect("a share");
                let [low, high] = share.interval;
                assert!(0.0 <= low && low <= high && high <= 1.0, "{mean} {deviation}: {share:?}");
            }
        }
    }
}
