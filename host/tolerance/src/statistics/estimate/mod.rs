//! Statistics of the measures from a study's tallies, each with its error.
//!
//! The errors of independent units follow from the shape of the measure, which the model knows better than a sample does.
//! The units of a design depend on each other, which is what makes it better: its error is the spread between independent
//! replicates, and without replicates it has none to show.

mod capability;
mod errors;
mod plain;

pub use self::{
    capability::POINTS,
    errors::Estimate,
    plain::{histogram, quantile},
};
use self::{
    errors::Errors,
    plain::{Plain, PlainMeasure},
};
use super::interval;
use crate::{
    counting::{pairs::Pairs, study::Tally, tally::Frame},
    model::{Measure, Model, loss::Loss},
    numeric::shape::{Shape, about, between},
    sampling::sampler::Method,
};

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
    /// Pp and Ppk by the [`POINTS`] instead of σ (ISO 22514-2), which hold for any shape; where the measure is not normal.
    pub by_points: Option<[Option<Estimate>; 2]>,
    /// Mean loss, where the measure has one.
    pub loss: Option<Estimate>,
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
    /// The 95 % intervals of its entries; none where a measure does not vary.
    pub correlation_intervals: Vec<Vec<[Option<f64>; 2]>>,
    /// P(sum < 0) of each of the model's sums.
    pub closed: Vec<Estimate>,
    /// Units in which each of these sums is negative, and all units.
    pub closed_counts: (Vec<u64>, u64),
    /// Share of units with all measures defined and within their limits, if any has limits.
    pub good: Option<Estimate>,
}

/// What the errors of independent units follow from.
#[derive(Clone, Debug)]
pub struct Spread {
    /// Shape of each measure.
    pub shapes: Vec<Shape>,
    /// Of their pairs.
    pub pairs: Pairs,
}

/// Finds all statistics.
pub fn joint(model: &Model, method: Method, frames: &[Frame], tallies: &[Tally], spread: &Spread) -> Joint {
    let parts: Vec<Plain> = tallies.iter().map(|tally| Plain::of(std::slice::from_ref(tally), frames)).collect();
    let all = Plain::of(tallies, frames);
    let errors = if method == Method::PseudoRandom { Errors::Independent } else { Errors::Replicates(&parts) };
    let share = |hits: &dyn Fn(&Plain) -> (u64, u64)| errors.share(&all, hits);
    let limited = model.measures.iter().any(|measure| measure.limits.iter().any(Option::is_some));
    let count = model.measures.len();
    let correlation = all.correlation();
    let correlations: Vec<_> = parts.iter().map(Plain::correlation).collect();
    let between = |i: usize, j: usize| {
        let value = correlation[i][j];
        if i == j || value == 0.0 {
            return [Some(value).filter(|_| i == j); 2];
        }
        let independent = |value| {
            let [known, error] = spread.pairs.error(i.max(j), i.min(j), all.units as f64);
            Estimate::between(value, None, interval::correlation(value, known, error))
        };
        let values = correlations.iter().map(|matrix| matrix[i][j]);
        errors.of_values(value, values, &independent).interval.map(|end| end.map(|end| end.clamp(-1.0, 1.0)))
    };
    Joint {
        measures: (0..count)
            .map(|i| statistics(&model.measures[i], model.function.loss(i), i, &spread.shapes[i], &all, &errors))
            .collect(),
        correlation_intervals: (0..count).map(|i| (0..count).map(|j| between(i, j)).collect()).collect(),
        correlation,
        closed: (0..model.sums.len()).map(|i| share(&|plain| (plain.closed[i], plain.units))).collect(),
        closed_counts: (all.closed.clone(), all.units),
        good: limited.then(|| share(&|plain| (plain.units - plain.rejected, plain.units))),
    }
}

fn statistics(
    measure: &Measure,
    loss: Option<Loss>,
    i: usize,
    shape: &Shape,
    all: &Plain,
    errors: &Errors,
) -> Statistics {
    let at = &all.measures[i];
    let units = at.units as f64;
    // What does not vary has no shape and no error either.
    let varies = at.kurtosis.is_finite();
    let shape = if varies && shape.kurtosis().is_finite() { *shape } else { Shape::NORMAL };
    let [lower, upper] = measure.limits;
    let estimate = |of: &dyn Fn(&PlainMeasure) -> f64, independent: &dyn Fn(f64) -> Estimate| {
        errors.estimate(of(at), &|plain| of(&plain.measures[i]), independent)
    };
    let with_error = |value: f64, error: f64| Estimate::between(value, Some(error), about(value, error));
    let own = at.shape();
    let share =
        |hits: &dyn Fn(&PlainMeasure) -> u64| errors.share(all, &|plain| (hits(&plain.measures[i]), plain.units));
    let limited = lower.is_some() || upper.is_some();
    let freedom = shape.freedom(units);
    let of_deviation = libm::sqrt(0.5 / freedom);
    let known = |value: Estimate| varies.then_some(value);
    Statistics {
        units: at.units,
        undefined: at.undefined,
        mean: estimate(&|plain| plain.mean, &|mean| with_error(mean, at.deviation / libm::sqrt(units))),
        deviation: estimate(&|plain| plain.deviation, &|deviation| {
            Estimate::between(deviation, Some(deviation * of_deviation), interval::deviation(deviation, freedom))
        }),
        skewness: known(estimate(&|plain| plain.skewness, &|value| {
            with_error(value, between(shape.of_skewness(units), own.of_skewness(units)))
        })),
        kurtosis: known(estimate(&|plain| plain.kurtosis, &|value| {
            with_error(value, between(shape.of_kurtosis(units), own.of_kurtosis(units)))
        })),
        extremes: at.extremes,
        points: POINTS.map(|p| {
            estimate(&|plain| plain.quantile(p), &|value| Estimate { value, error: None, interval: at.enclosed(p) })
        }),
        pp: lower.zip(upper).map(|(lower, upper)| {
            let width = upper - lower;
            estimate(&|plain| width / (6.0 * plain.deviation), &|value| {
                let [low, high] = interval::deviation(at.deviation, freedom);
                Estimate::between(value, Some(value * of_deviation), [high, low].map(|end| width / (6.0 * end)))
            })
        }),
        ppk: limited.then(|| {
            estimate(&|plain| capability::by_deviation(plain, measure.limits), &|value| {
                let upper = capability::is_upper(at, measure.limits);
                with_error(value, shape.of_capability(value, upper, units))
            })
        }),
        by_points: (limited && varies && !shape.is_normal()).then(|| {
            [capability::WIDTH, capability::NEARER].map(|of| {
                of(POINTS.map(|p| at.quantile(p)), measure.limits)?;
                let value =
                    |plain: &PlainMeasure| of(POINTS.map(|p| plain.quantile(p)), measure.limits).unwrap_or(f64::NAN);
                Some(estimate(&value, &|_| capability::with_interval(of, at, measure.limits)))
            })
        }),
        loss: loss.map(|loss| {
            if loss.repair.is_some() {
                return estimate(&|plain| plain.loss(&loss)[0], &|value| with_error(value, at.loss(&loss)[1]));
            }
            estimate(&|plain| loss.mean(plain.mean, plain.deviation), &|value| {
                let square = shape.of_square(at.deviation, at.mean - loss.target, units);
                with_error(value, loss.coefficient() * square)
            })
        }),
        outside: [0, 1].map(|side| measure.limits[side].map(|_| share(&|plain| plain.outside[side]))),
        good: limited.then(|| share(&|plain| plain.units - plain.outside[0] - plain.outside[1])),
        hits: at.outside,
        all: all.units,
    }
}
