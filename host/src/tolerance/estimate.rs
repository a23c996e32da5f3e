//! Statistics of the measures from a study's tallies, each with its error.
//!
//! Independent units have known error formulas. The units of a design depend on each other, which is what makes it
//! better: its error is the spread between independent replicates, and without replicates it has none to show.

use serde::Serialize;

use super::{
    interval,
    model::{Measure, Model},
    sampler::Method,
    study::Tally,
    tally::{BINS, BINS_PER_DEVIATION, Frame, MeasureCounts, Sums},
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
    /// Skewness.
    pub skewness: Estimate,
    /// Kurtosis; 3 for a normal.
    pub kurtosis: Estimate,
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
        skewness: estimate(&|plain| plain.skewness, &|value| Estimate::with_error(value, libm::sqrt(6.0 / units))),
        kurtosis: estimate(&|plain| plain.kurtosis, &|value| Estimate::with_error(value, libm::sqrt(24.0 / units))),
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
        let found = self.estimate(share(all), &share, &|value| {
            let (hits, units) = hits(all);
            Estimate {
                value,
                error: Some(libm::sqrt(value * (1.0 - value) / units as f64)),
                interval: interval::proportion(hits, units).map(Some),
            }
        });
        Estimate { interval: found.interval.map(|end| end.map(|end| end.clamp(0.0, 1.0))), ..found }
    }
}

/// Statistics without errors.
struct Plain<'a> {
    units: u64,
    rejected: u64,
    closed: Vec<u64>,
    measures: Vec<PlainMeasure<'a>>,
    sums: Sums,
}

struct PlainMeasure<'a> {
    units: u64,
    undefined: u64,
    outside: [u64; 2],
    mean: f64,
    deviation: f64,
    skewness: f64,
    kurtosis: f64,
    extremes: [f64; 2],
    frame: Frame,
    parts: Vec<&'a MeasureCounts>,
}

impl<'a> Plain<'a> {
    fn of(tallies: &'a [Tally], frames: &[Frame]) -> Self {
        let sums = tallies.iter().filter_map(|tally| tally.sums.total());
        let sums = sums.reduce(|left, right| left.joined(&right)).unwrap_or_default();
        let total = |of: &dyn Fn(&Tally) -> u64| tallies.iter().map(of).sum::<u64>();
        let measure = |(i, frame): (usize, &Frame)| {
            let parts: Vec<_> = tallies.iter().map(|tally| &tally.counts.measures[i]).collect();
            let undefined = parts.iter().map(|part| part.undefined).sum();
            let units = total(&|tally| tally.counts.units) - undefined;
            let n = units as f64;
            let [m1, m2, m3, m4] = sums.powers[i].map(|sum| sum / n);
            let variance = (m2 - m1 * m1).max(0.0);
            let third = m3 - 3.0 * m1 * m2 + 2.0 * m1 * m1 * m1;
            let fourth = m4 - 4.0 * m1 * m3 + 6.0 * m1 * m1 * m2 - 3.0 * m1 * m1 * m1 * m1;
            PlainMeasure {
                units,
                undefined,
                outside: [0, 1].map(|side| parts.iter().map(|part| part.outside[side]).sum()),
                mean: frame.origin + frame.scale * m1,
                deviation: frame.scale * libm::sqrt(variance * n / (n - 1.0)),
                skewness: third / (variance * libm::sqrt(variance)),
                kurtosis: fourth / (variance * variance),
                extremes: [
                    parts.iter().map(|part| part.extremes[0]).fold(f64::INFINITY, f64::min),
                    parts.iter().map(|part| part.extremes[1]).fold(f64::NEG_INFINITY, f64::max),
                ],
                frame: *frame,
                parts,
            }
        };
        let closed = tallies.first().map_or(0, |tally| tally.counts.closed.len());
        Self {
            units: total(&|tally| tally.counts.units),
            rejected: total(&|tally| tally.counts.rejected),
            closed: (0..closed).map(|i| total(&|tally| tally.counts.closed[i])).collect(),
            measures: frames.iter().enumerate().map(measure).collect(),
            sums,
        }
    }

    /// Correlation of all measures; units in which one cannot be computed count as its frame's origin.
    fn correlation(&self) -> Vec<Vec<f64>> {
        let n = self.units as f64;
        let covariance = |i: usize, j: usize| {
            let product = match i.cmp(&j) {
                std::cmp::Ordering::Equal => self.sums.powers[i][1],
                std::cmp::Ordering::Greater => self.sums.products[i * (i - 1) / 2 + j],
                std::cmp::Ordering::Less => self.sums.products[j * (j - 1) / 2 + i],
            };
            product / n - self.sums.powers[i][0] / n * (self.sums.powers[j][0] / n)
        };
        let count = self.measures.len();
        let coefficient = |i, j| {
            let scale = libm::sqrt(covariance(i, i) * covariance(j, j));
            if i == j || scale == 0.0 { f64::from(i == j) } else { covariance(i, j) / scale }
        };
        (0..count).map(|i| (0..count).map(|j| coefficient(i, j)).collect()).collect()
    }
}

impl PlainMeasure<'_> {
    /// Units in bin `k`.
    fn bin(&self, k: usize) -> u64 {
        self.parts.iter().map(|part| part.bins[k]).sum()
    }

    /// The value that `rank` values lie below, if it is one: the lower and upper end of its bin.
    fn enclosed(&self, rank: f64) -> (Option<f64>, Option<f64>) {
        if rank < 1.0 || rank > self.units as f64 {
            return (None, None);
        }
        let [low, high] = self.ends(rank).1;
        (Some(low), Some(high))
    }

    /// The bin of the `rank`-th value (from 1 on): how many lie before it and in it, and its ends.
    fn ends(&self, rank: f64) -> ([u64; 2], [f64; 2]) {
        let mut before = 0;
        let mut k = 0;
        while k + 1 < BINS && ((before + self.bin(k)) as f64) < rank {
            before += self.bin(k);
            k += 1;
        }
        let [least, greatest] = self.extremes;
        let Frame { origin, scale } = self.frame;
        let border = |k: f64| origin + scale * (k - 0.5 - (BINS / 2) as f64) / BINS_PER_DEVIATION;
        let low = if k == 0 { least } else { border(k as f64).clamp(least, greatest) };
        let high = if k + 1 == BINS { greatest } else { border(k as f64 + 1.0).clamp(least, greatest) };
        ([before, self.bin(k)], [low, high])
    }

    /// The point below which a value lies with `probability`, linear within its bin.
    fn quantile(&self, probability: f64) -> f64 {
        let rank = probability * self.units as f64;
        let ([before, within], [low, high]) = self.ends(rank);
        let share = if within > 0 { ((rank - before as f64) / within as f64).clamp(0.0, 1.0) } else { 0.5 };
        low + (high - low) * share
    }
}

/// The `probability` point of measure `i` over all of `tallies`.
pub fn quantile(frames: &[Frame], tallies: &[Tally], i: usize, probability: f64) -> f64 {
    Plain::of(tallies, frames).measures[i].quantile(probability)
}

/// Shares of units of measure `i` in classes `width` bins wide, as (middle, share): a histogram.
pub fn histogram(frames: &[Frame], tallies: &[Tally], i: usize, width: usize) -> Vec<(f64, f64)> {
    let plain = Plain::of(tallies, frames);
    let measure = &plain.measures[i];
    let bins: Vec<u64> = (0..BINS).map(|k| measure.bin(k)).collect();
    let Frame { origin, scale } = measure.frame;
    let class = |(c, bins): (usize, &[u64])| {
        let middle = (c * width) as f64 + (bins.len() - 1) as f64 / 2.0 - (BINS / 2) as f64;
        let share = bins.iter().sum::<u64>() as f64 / measure.units.max(1) as f64;
        (origin + scale * middle / BINS_PER_DEVIATION, share)
    };
    let classes: Vec<_> = bins.chunks(width).enumerate().map(class).collect();
    let first = classes.iter().position(|(_, share)| *share > 0.0).unwrap_or(0);
    let last = classes.iter().rposition(|(_, share)| *share > 0.0).unwrap_or(0);
    classes[first..=last].to_vec()
}
