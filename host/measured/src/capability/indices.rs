//! Performance and capability indices of a normal production.

use serde::Serialize;
use slipfit_tolerance::{numeric::normal::SIDE, statistics::interval};

use super::estimate::Estimate;
use crate::numeric::noncentral_t::NoncentralT;

/// Indices by ISO 22514-2. Each is there if it has its limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Indices {
    /// Tolerance by spread: (upper − lower)/6σ.
    pub spread: Option<Estimate>,
    /// Distance of the lower limit: (mean − lower)/3σ.
    pub lower: Option<Estimate>,
    /// Distance of the upper limit: (upper − mean)/3σ.
    pub upper: Option<Estimate>,
    /// The lesser of the two distances, or the only one: Ppk or Cpk.
    pub least: Option<Estimate>,
}

/// What is known of a normal production: the mean of some parts, and a standard deviation with its degrees of freedom, which
/// are the parts less one, or those within subgroups.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Number of parts in the mean.
    pub parts: f64,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Its degrees of freedom.
    pub freedom: f64,
}

impl Known {
    /// The score at which a limit lies that is at `distance` outwards of the mean, and its interval, exact: the distance
    /// in standard errors is of a noncentral t distribution (D. Owen, "A survey of properties and applications of the
    /// noncentral t-distribution", Technometrics 10, 1968).
    pub(super) fn score(&self, t: &NoncentralT, distance: f64) -> Estimate {
        let root = libm::sqrt(self.parts);
        let value = distance / self.deviation;
        let interval = [SIDE, 1.0 - SIDE].map(|chance| t.shift(value * root, chance) / root);
        Estimate { value, interval }
    }

    /// Both limits' scores.
    pub(super) fn scores(&self, [lower, upper]: [Option<f64>; 2]) -> [Option<Estimate>; 2] {
        let t = NoncentralT::new(self.freedom);
        [lower.map(|limit| self.score(&t, self.mean - limit)), upper.map(|limit| self.score(&t, limit - self.mean))]
    }

    /// The indices for limits, with intervals of 95 %: that of the spread by χ², that of one limit exact by the noncentral t
    /// distribution. Of two limits, the true least index is at most each of the two, so its bounds are the lesser ones of
    /// theirs: too high in at most 2.5 %, and together they hold it in 94 to 97.5 %.
    pub fn indices(&self, limits: [Option<f64>; 2]) -> Indices {
        let [lower, upper] = self.scores(limits).map(|score| score.map(|score| score.map(|score| score / 3.0)));
        let spread = match limits {
            [Some(lower), Some(upper)] => {
                let index = |deviation: f64| (upper - lower) / (6.0 * deviation);
                let [least, greatest] = interval::deviation(self.deviation, self.freedom);
                Some(Estimate { value: index(self.deviation), interval: [index(greatest), index(least)] })
            }
            _ => None,
        };
        let least = match (lower, upper) {
            (Some(a), Some(b)) => Some(Estimate {
                value: a.value.min(b.value),
                interval: [0, 1].map(|side| a.interval[side].min(b.interval[side])),
            }),
            (one, other) => one.or(other),
        };
        Indices { spread, lower, upper, least }
    }
}

#[cfg(test)]
mod tests {
    use super::Known;

    #[test]
    fn capability_example_of_the_nist_handbook() {
        // NIST/SEMATECH e-Handbook of Statistical Methods, 6.1.6: limits 8 and 20, mean 16, standard deviation 2.
        let known = Known { parts: 50.0, mean: 16.0, deviation: 2.0, freedom: 49.0 };
        let indices = known.indices([Some(8.0), Some(20.0)]);
        let value = |index: Option<super::Estimate>| index.map(|index| index.value);
        assert_eq!(value(indices.spread), Some(1.0));
        assert_eq!(value(indices.upper), Some(2.0 / 3.0));
        assert_eq!(value(indices.lower), Some(4.0 / 3.0));
        assert_eq!(value(indices.least), Some(2.0 / 3.0));
    }

    #[test]
    fn intervals_of_a_textbook() {
        // D. Montgomery, "Introduction to Statistical Quality Control", examples 8.4 and 8.5: limits 62 and 38, s = 1.75
        // of 20 parts give Cp 2.29 with 1.57 to 3.01; Cpk 1.33 of 20 parts has 0.88 to 1.78 by Bissell's approximation.
        let known = Known { parts: 20.0, mean: 50.0, deviation: 1.75, freedom: 19.0 };
        let spread = known.indices([Some(38.0), Some(62.0)]).spread.expect("an index");
        assert!((spread.value - 2.29).abs() < 0.005, "{spread:?}");
        assert!((spread.interval[0] - 1.57).abs() < 0.011 && (spread.interval[1] - 3.01).abs() < 0.005, "{spread:?}");
        let known = Known { parts: 20.0, mean: 0.0, deviation: 1.0, freedom: 19.0 };
        let [lower, upper] = known.indices([None, Some(3.99)]).least.expect("an index").interval;
        // The exact interval is not symmetric; its width and place are near.
        assert!((lower - 0.88).abs() < 0.02 && (upper - 1.78).abs() < 0.02, "{lower} {upper}");
    }
}
