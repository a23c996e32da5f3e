//! The figures of a production by points of its distribution.

use serde::Serialize;

use super::{
    estimate::Estimate,
    failing::Failing,
    indices::{Indices, Known},
    sample::Sample,
};
use crate::families::{Family, Fit, FitError, Kind, Normal, Posterior, choose, preferred, supported};

/// The distribution that figures are of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Distribution {
    /// Its family.
    pub family: Kind,
    /// Whether the family was stated, not chosen from the data.
    pub stated: bool,
    /// Its parameters.
    pub parameters: Vec<(&'static str, f64)>,
    /// Akaike's information criterion for small samples; infinite where there are too few parts for it.
    pub aicc: f64,
    /// Correlation of the sorted values and the distribution's quantiles.
    pub qq_correlation: f64,
    /// The values below which 0.135 %, 50 % and 99.865 % lie.
    pub points: [f64; 3],
    /// Families that the intervals allow for.
    pub allowed: Vec<Kind>,
}

/// Figures of a production.
#[derive(Clone, Copy, Debug)]
pub struct Figures {
    /// Mean.
    pub mean: Estimate,
    /// Standard deviation.
    pub deviation: Estimate,
    /// Indices by points; those of a normal production are the usual ones.
    pub performance: Indices,
    /// Expected shares outside the limits.
    pub failing: Failing,
}

/// Scores of the points: Φ(±3) is 0.135 % and 99.865 %.
pub const SCORES: [f64; 3] = [-3.0, 0.0, 3.0];

/// Distribution and figures with a stated family, or with the one that the data choose. Intervals of a stated normal are
/// exact; those of other families are of their posterior. Those of a chosen one hold whichever family that is not refuted is
/// the true one: from the least to the greatest end of the intervals of these.
pub fn figures(
    sample: &Sample,
    stated: Option<Kind>,
    limits: [Option<f64>; 2],
) -> Result<(Distribution, Figures), FitError> {
    let known = Known::of(sample);
    let (fits, errors) = match stated {
        Some(kind) => (vec![kind.fit_or_mode(&sample.sorted)?], Vec::new()),
        None => choose(&sample.sorted)?,
    };
    let Some(fit) = preferred(&fits) else {
        return Err(errors.into_iter().next().unwrap_or(FitError::TooFarApart));
    };
    let (allowed, figures) = if stated == Some(Kind::Normal) {
        (vec![Kind::Normal], Figures::normal(&known, limits))
    } else {
        let row = |family: &dyn Family| row(family, limits);
        let mut intervals = Posterior::new(fit.kind, Some(fit.family.as_ref()), &sample.sorted)?.intervals(row);
        let mut allowed = vec![fit.kind];
        for other in supported(&fits).filter(|other| other.kind != fit.kind) {
            let near = Some(other.family.as_ref());
            let Ok(posterior) = Posterior::new(other.kind, near, &sample.sorted) else { continue };
            for (interval, [low, high]) in intervals.iter_mut().zip(posterior.intervals(row)) {
                *interval = [interval[0].min(low), interval[1].max(high)];
            }
            allowed.push(other.kind);
        }
        (allowed, Figures::new(&known, fit, &intervals, limits))
    };
    let family = estimated(&known, fit);
    let distribution = Distribution {
        family: fit.kind,
        stated: stated.is_some(),
        parameters: family.parameters(),
        aicc: fit.aicc,
        qq_correlation: fit.qq_correlation,
        points: SCORES.map(|score| family.value(score)),
        allowed,
    };
    Ok((distribution, figures))
}

/// The distribution that estimates are of: the likeliest one, but with the usual standard deviation of a normal one.
fn estimated(known: &Known, fit: &Fit) -> Box<dyn Family> {
    match fit.kind {
        Kind::Normal => Box::new(Normal { mean: known.mean, deviation: known.deviation }),
        _ => fit.family.clone_box(),
    }
}

impl Figures {
    /// Of a normal production.
    fn normal(known: &Known, limits: [Option<f64>; 2]) -> Self {
        Self {
            mean: known.mean_estimate(),
            deviation: known.deviation_estimate(),
            performance: known.indices(limits),
            failing: known.failing(limits),
        }
    }

    fn new(known: &Known, fit: &Fit, intervals: &[[f64; 2]; FIGURES], limits: [Option<f64>; 2]) -> Self {
        let mut values = row(estimated(known, fit).as_ref(), limits);
        [values[0], values[1]] = [known.mean, known.deviation];
        // A figure of the sample is in its interval, whatever the family.
        let estimate = |k: usize| {
            let (value, [low, high]) = (values[k], intervals[k]);
            Estimate { value, interval: [low.min(value), high.max(value)] }
        };
        let [has_lower, has_upper] = limits.map(|limit| limit.is_some());
        let (lower, upper) = (has_lower.then(|| estimate(3)), has_upper.then(|| estimate(4)));
        let (below, above) = (has_lower.then(|| estimate(5)), has_upper.then(|| estimate(6)));
        Self {
            mean: estimate(0),
            deviation: estimate(1),
            performance: Indices {
                spread: (has_lower && has_upper).then(|| estimate(2)),
                lower,
                upper,
                least: (has_lower || has_upper).then(|| estimate(8)),
            },
            failing: Failing { below, above, both: (has_lower || has_upper).then(|| estimate(7)) },
        }
    }
}

/// Number of figures of a distribution.
const FIGURES: usize = 9;

/// Mean, standard deviation, indices, shares outside the limits, their sum, and the least index; 0 of absent limits.
fn row(family: &dyn Family, limits: [Option<f64>; 2]) -> [f64; FIGURES] {
    let [spread, lower, upper] = indices(family, limits);
    let [below, above] = shares(family, limits);
    let least = match limits {
        [Some(_), Some(_)] => lower.min(upper),
        _ => lower + upper,
    };
    [family.mean(), family.deviation(), spread, lower, upper, below, above, below + above, least]
}

/// Tolerance by the distance of the outer points, and the distances of both limits from the middle point by those of the
/// outer points; 0 without a limit.
fn indices(family: &dyn Family, [lower, upper]: [Option<f64>; 2]) -> [f64; 3] {
    let [low, middle, high] = SCORES.map(|score| family.value(score));
    [
        lower.zip(upper).map_or(0.0, |(lower, upper)| (upper - lower) / (high - low)),
        lower.map_or(0.0, |limit| (middle - limit) / (middle - low)),
        upper.map_or(0.0, |limit| (limit - middle) / (high - middle)),
    ]
}

/// Expected shares outside the limits; 0 without a limit.
fn shares(family: &dyn Family, [lower, upper]: [Option<f64>; 2]) -> [f64; 2] {
    [lower.map_or(0.0, |limit| family.tails(limit)[0]), upper.map_or(0.0, |limit| family.tails(limit)[1])]
}
