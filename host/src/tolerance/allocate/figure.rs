//! What the full model says of measures: by slopes and corners, by tails, by drawn units.

use slipfit_core::sampling::stream::derived;

use super::{AllocateError, nearest::with_nearest};
use crate::tolerance::{
    counting::study::{Settings, Study, StudyError},
    failure::{Failure, tail::probability},
    model::{Measure, Model, lanes::LANES},
    sampling::{draw::Draw, sampler::Method, sobol::MOST_DIMENSIONS},
    theory::{
        derivative::expansion,
        extremes::extremes,
        moments::spreads,
        rss::root_sum_square,
        worst_case::{middle, worst_case},
    },
};

/// Units that mean and standard deviation are found from.
const UNITS: u64 = 8192;
/// Units that are counted where no other figure of defects is to be trusted.
const COUNTED: u64 = 1 << 17;
/// What the seeds of tails are derived with.
const TAILS: u64 = 4 << 32;

/// What follows from slopes and corners, for every measure.
pub(super) struct Formula {
    /// Root of the sum of squares (SI).
    pub rss: Vec<f64>,
    /// Lowest and highest (SI).
    pub worst: Vec<[f64; 2]>,
}

impl Formula {
    /// Of `model`, of whose measures slopes have `described` some.
    pub fn new(model: &Model, described: &[bool]) -> Self {
        let (_, deviations) = spreads(model);
        let middles: Vec<f64> = model.contributors.iter().flat_map(|c| middle(&c.variation)).collect();
        let around = expansion(model, &middles, &deviations);
        let worst = worst_case(model, &around).into_iter().enumerate().map(|(i, found)| {
            let [low, high] = found.vertices.unwrap_or(found.linear);
            if described[i] {
                return [low, high];
            }
            let [least, greatest] = extremes(model, i);
            [low.min(least), high.max(greatest)]
        });
        let worst = worst.collect();
        Self {
            worst,
            rss: root_sum_square(model, &around, &around, &deviations).iter().map(|rss| rss.tolerance).collect(),
        }
    }
}

/// The share of units in which a measure is outside of its limits.
pub(super) fn defects(model: &Model, measure: usize, seed: u64) -> Result<f64, AllocateError> {
    let draw = Draw::new(model, seed).map_err(StudyError::from)?;
    let mut sum = 0.0;
    for (side, limit) in model.measures[measure].limits.iter().enumerate() {
        let Some(limit) = *limit else { continue };
        let failure = Failure { measures: vec![measure], limit, above: side == 1 };
        let seed = derived(seed, TAILS + 2 * measure as u64 + side as u64);
        match probability(model, &draw, &failure, seed, None) {
            Some(tail) => sum += tail.probability,
            None => sum += counted(model, measure, side, limit, seed)?,
        }
    }
    Ok(sum.min(1.0))
}

/// The share of units in which any measure is outside.
pub(super) fn any_defects(model: Model, seed: u64) -> Result<f64, AllocateError> {
    let limited = |measure: &Measure| measure.limits.iter().any(Option::is_some);
    let several = model.measures.iter().filter(|measure| limited(measure)).count() > 1;
    match model.measures.iter().position(limited) {
        None => Ok(0.0),
        Some(only) if !several => defects(&model, only, seed),
        Some(_) => {
            let model = with_nearest(model);
            defects(&model, model.measures.len() - 1, seed)
        }
    }
}

fn study(model: &Model, samples: u64, seed: u64) -> Result<Study<'_>, StudyError> {
    let method = if model.variables() > MOST_DIMENSIONS { Method::PseudoRandom } else { Method::ScrambledSobol };
    Study::new(model, Settings { method, samples, replicates: 1, seed })
}

/// The share of drawn units beyond a limit.
fn counted(model: &Model, measure: usize, side: usize, limit: f64, seed: u64) -> Result<f64, AllocateError> {
    let study = study(model, COUNTED, seed)?;
    let beyond = |value: &&f64| if side == 1 { **value > limit } else { **value < limit };
    let hits = |first| study.unit_measures(first)[measure].0.iter().filter(beyond).count();
    let hits: usize = (0..COUNTED).step_by(LANES).map(hits).sum();
    Ok(hits as f64 / COUNTED as f64)
}

/// Mean and standard deviation of a measure of drawn units.
pub(super) fn drawn(model: &Model, measure: usize, seed: u64) -> Result<[f64; 2], AllocateError> {
    let study = study(model, UNITS, seed)?;
    let values = (0..UNITS).step_by(LANES).flat_map(|first| study.unit_measures(first)[measure].0);
    let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    Ok([mean, libm::sqrt(square / (count - 1.0))])
}
