//! Statistics of the measures from a study's tallies, each with its error.
//!
//! Independent units have known error formulas. The units of a design depend on each other, which is what makes it
//! better: its error is the spread between independent replicates, and without replicates it has none to show.

mod plain;

use serde::Serialize;

use self::plain::{Plain, PlainMeasure};
pub use self::plain::{histogram, quantile};
use super::{
    interval,
    model::{Measure, Model},
    sampler::Method,
    study::Tally,
    tally::Frame,
};

/// The probabilities of the natural limits ±3σ and of the median.
pub const POINTS: [f64; 3] = [0.001_35, 0.5, 0.998_65];

/// A number found from a sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard error, where one is known.
    pub error: Option<f64>,
    /// Lower and upper end of its 95 % confidence interval; `None` where the sample does not bound it.
    pub interval: [Option<f64>; 2],
}

impl Estimate {
    fn with_error(value: f64, error: f64) -> Self {
        let half = interval::normal_factor() * error;
        Self { value, error: Some(error), interval: [Some(value - half), Some(value + half)] }
    }

    /// The same in another unit.
    pub fn scaled(self, factor: f64) -> Self {
        let scale = |value: f64| value * factor;
        Self {
            value: scale(self.value),
            error: self.error.map(scale),
            interval: self.interval.map(|end| end.map(scale)),
        }
    }
}

/// Statistics of one measure (SI).
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    /// Units in which it could be computed.
    pub units: u64,
    /// Units in which it could not.
    pub undefined: u64,
    /// Mean.
    pub mean: Estimate,
    /// Standard deviation.
    pub deviation: Estimate,
    /// Skewness, if the measure varies.
    pub skewness: Option<Estimate>,
    /// Kurtosis, if the measure varies; 3 for a normal.
    pub kurtosis: Option<Estimate>,
    /// Least and greatest value.
    pub extremes: [f64; 2],
    /// The points of [`POINTS`], good to a 128th of a standard deviation beside their error.
    pub points: [Estimate; 3],
    /// Pp, the width between both limits over 6σ.
    pub pp: Option<Estimate>,
    /// Ppk, the nearer limit over 3σ.
    pub ppk: Option<Estimate>,
    /// Shares of units below the lower and above the upper limit.
    pub outside: [Option<Estimate>; 2],
    /// Share of units within the limits.
    pub good: Option<Estimate>,
    /// Units below the lower and above the upper limit, of all units.
    hits: [u64; 2],
    all: u64,
}

impl Statistics {
    /// Units beyond a limit, lower or upper, and all units.
    pub fn outside_counts(&self, side: usize) -> (u64, u64) {
        (self.hits[side], self.all)
    }
}

/// Statistics of all measures together.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Of each measure.
    pub measures: Vec<Statistics>,
    /// Correlation matrix of the measures, row by row.
    pub correlation: Vec<Vec<f64>>,
    /// P(sum < 0) of each of the model's sums.
    pub closed: Vec<Estimate>,
    /// Units in which each of these sums is negative, and all units.
    pub closed_counts: (Vec<u64>, u64),
    /// Share of units with all measures defined and within their limits, if any has limits.
    pub good: Option<Estimate>,
}

/// Finds all statistics.
pub fn joint(model: &Model, method: Method, frames: &[Frame], tallies: &[Tally]) -> Joint {
    let parts: Vec<Plain> = tallies.iter().map(|tally| Plain::of(std::slice::from_ref(tally), frames)).collect();
    let all = Plain::of(tallies, frames);
    let errors = if method == Method::PseudoRandom { Errors::Independent } else { Errors::Replicates(&parts) };
    let share = |hits: &dyn Fn(&Plain) -> (u64, u64)| errors.share(&all, hits);
    let limited = model.measures.iter().any(|measure| measure.limits.iter().any(Option::is_some));
    Joint {
        measures: (0..model.measures.len()).map(|i| statistics(&model.measures[i], i, &all, &errors)).collect(),
        correlation: all.correlation(),
        closed: (0..model.sums.len()).map(|i| share(&|plain| (plain.closed[i], plain.units))).collect(),
        closed_counts: (all.closed.clone(), all.units),
        good: limited.then(|| share(&|plain| (plain.units - plain.rejected, plain.units))),
    }
}

fn statistics(measure: &Measure, i: usize, all: &Plain, errors: &Errors) -> Statistics {
    let at = &all.measures[i];
    let units = at.units as f64;
    let [lower, upper] = measure.limits;
    let estimate = |of: &dyn Fn(&PlainMeasure) -> f64, independent: &dyn Fn(f64) -> Estimate| {
        errors.estimate(of(at), &|plain| of(&plain.measures[i]), independent)
    };
    let width = lower.zip(upper).map(|(lower, upper)| upper - lower);
    let capability = |plain: &PlainMeasure| {
        let below = lower.map_or(f64::INFINITY, |lower| plain.mean - lower);
        let above = upper.map_or(f64::INFINITY, |upper| upper - plain.mean);
        below.min(above) / (3.0 * plain.deviation)
    };
    let share =
        |hits: &dyn Fn(&PlainMeasure) -> u64| errors.share(all, &|plain| (hits(&plain.measures[i]), plain.units));
    let between = |value, ends: [f64; 2]| Estimate { value, error: None, interval: ends.map(Some) };
    let limited = lower.is_some() || upper.is_some();
    Statistics {
        units: at.units,
        undefined: at.undefined,
        mean: estimate(&|plain| plain.mean, &|mean| Estimate::with_error(mean, at.deviation / libm::sqrt(units))),
        deviation: estimate(&|plain| plain.deviation, &|deviation| Estimate {
            error: Some(deviation * libm::sqrt(((at.kurtosis - 1.0) / (4.0 * units)).max(0.0))),
            ..between(deviation, interval::deviation(deviation, units))
        }),
        skewness: at
            .skewness
            .is_finite()
            .then(|| estimate(&|plain| plain.skewness, &|value| Estimate::with_error(value, libm::sqrt(6.0 / units)))),
        kurtosis: at
            .kurtosis
            .is_finite()
            .then(|| estimate(&|plain| plain.kurtosis, &|value| Estimate::with_error(value, libm::sqrt(24.0 / units)))),
        extremes: at.extremes,
        points: POINTS.map(|p| {
            let ends = interval::ranks(p, at.units).map(|rank| at.enclosed(rank));
            estimate(&|plain| plain.quantile(p), &|value| Estimate {
                value,
                error: None,
                interval: [ends[0].0, ends[1].1],
            })
        }),
        pp: width.map(|width| {
            estimate(&|plain| width / (6.0 * plain.deviation), &|value| {
                let [low, high] = interval::deviation(at.deviation, units);
                between(value, [width / (6.0 * high), width / (6.0 * low)])
            })
        }),
        ppk: limited.then(|| {
            estimate(&capability, &|value| Estimate::with_error(value, interval::capability_error(value, units)))
        }),
        outside: [0, 1].map(|side| measure.limits[side].map(|_| share(&|plain| plain.outside[side]))),
        good: limited.then(|| share(&|plain| plain.units - plain.outside[0] - plain.outside[1])),
        hits: at.outside,
        all: all.units,
    }
}

/// Where errors come from.
enum Errors<'a> {
    Independent,
    Replicates(&'a [Plain<'a>]),
}

impl Errors<'_> {
    fn estimate(&self, value: f64, of: &dyn Fn(&Plain) -> f64, independent: &dyn Fn(f64) -> Estimate) -> Estimate {
        match self {
            Self::Independent => independent(value),
            Self::Replicates(parts) if parts.len() < 2 => Estimate { value, error: None, interval: [None; 2] },
            Self::Replicates(parts) => {
                let count = parts.len() as f64;
                let values: Vec<f64> = parts.iter().map(of).collect();
                let mean = values.iter().sum::<f64>() / count;
                let square: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
                let error = libm::sqrt(square / (count * (count - 1.0)));
                let half = interval::student_factor(parts.len()) * error;
                Estimate { value, error: Some(error), interval: [Some(value - half), Some(value + half)] }
            }
        }
    }

    fn share(&self, all: &Plain, hits: &dyn Fn(&Plain) -> (u64, u64)) -> Estimate {
        let share = |plain: &Plain| {
            let (hits, units) = hits(plain);
            hits as f64 / units as f64
        };
        let independent = |value| {
            let (hits, units) = hits(all);
            Estimate {
                value,
                error: Some(libm::sqrt(value * (1.0 - value) / units as f64)),
                interval: interval::proportion(hits, units).map(Some),
            }
        };
        let found = self.estimate(share(all), &share, &independent);
        // Replicates that all count the same, such as nothing, have no spread to learn from. A design's counts spread less
        // than those of independent units, so that these are on the safe side.
        let found = if found.error == Some(0.0) { independent(found.value) } else { found };
        Estimate { interval: found.interval.map(|end| end.map(|end| end.clamp(0.0, 1.0))), ..found }
    }
}
