//! What the full model says of measures: by slopes and corners, by tails, by drawn units. A unit in which a measure cannot be
//! computed is outside of its limits.

use slipfit_core::sampling::stream::{derived, unit_stream};

use super::{AllocateError, nearest::with_nearest};
use crate::{
    counting::study::{Settings, Study, StudyError},
    failure::{Failure, subset::normals, tail::probability},
    model::Model,
    numeric::lanes::{LANES, Lanes},
    sampling::{draw::Draw, sampler::Method, sobol::MOST_DIMENSIONS},
    theory::{derivative::expansion, moments::spreads, rss::root_sum_square, worst_case::worst_cases},
};

/// Units that mean and standard deviation are found from.
const UNITS: u64 = 8192;
/// Units that are counted where no other figure of defects is to be trusted.
const COUNTED: u64 = 1 << 17;
/// Units that show whether a measure can be undefined, and how much wider they spread than those of the production.
const SEEN: u64 = 4096;
const WIDER: f64 = 2.0;
/// What the seeds of tails, and of these units, are derived with.
const TAILS: u64 = 4 << 32;
const UNDEFINED: u64 = 6 << 32;

/// What follows from slopes, corners and a search, for every measure.
pub(super) struct Formula {
    /// Root of the sum of squares (SI).
    pub rss: Vec<f64>,
    /// Lowest and highest (SI) of those measures of which they are asked for; without bound where the measure cannot be computed.
    pub worst: Vec<[f64; 2]>,
}

impl Formula {
    /// Of `model`; the worst cases of some measures.
    pub fn new(model: &Model, worst_of: &[usize]) -> Self {
        let (_, deviations) = spreads(model);
        let around = expansion(model, &model.middles(), &deviations);
        let mut worst = vec![[f64::NAN; 2]; model.measures.len()];
        for (i, found) in worst_of.iter().zip(worst_cases(model, &around, worst_of)) {
            worst[*i] = if found.undefined { [f64::NEG_INFINITY, f64::INFINITY] } else { found.range };
        }
        Self {
            worst,
            rss: root_sum_square(model, &around, &around, &deviations).iter().map(|rss| rss.tolerance).collect(),
        }
    }
}

/// The share of units in which a measure is outside of its limits or cannot be computed.
pub(super) fn defects(model: &Model, measure: usize, seed: u64) -> Result<f64, AllocateError> {
    let draw = Draw::new(model, seed).map_err(StudyError::from)?;
    let mut sum = undefined(model, &draw, measure, seed)?;
    for (side, limit) in model.measures[measure].limits.iter().enumerate() {
        let Some(limit) = *limit else { continue };
        let failure = Failure { measures: vec![measure], limit, above: side == 1 };
        let seed = derived(seed, TAILS + 2 * measure as u64 + side as u64);
        match probability(model, &draw, &failure, seed, None) {
            Some(tail) => sum += tail.probability,
            None => {
                let beyond = |value: f64| if side == 1 { value > limit } else { value < limit };
                sum += counted(model, measure, seed, beyond)?;
            }
        }
    }
    Ok(sum.min(1.0))
}

/// The share of units in which a measure cannot be computed: counted, unless none of some units that spread `WIDER` than those
/// of the production is such a one.
fn undefined(model: &Model, draw: &Draw, measure: usize, seed: u64) -> Result<f64, AllocateError> {
    if model.function.is_linear(measure) {
        return Ok(0.0);
    }
    let mut measures = vec![Lanes::ZERO; model.measures.len()];
    let found = (0..SEEN / LANES as u64).any(|group| {
        let points: [Vec<f64>; LANES] = std::array::from_fn(|lane| {
            normals(&mut unit_stream(derived(seed, UNDEFINED), group * LANES as u64 + lane as u64), draw.dimensions())
        });
        let mut scores: Vec<Lanes> =
            (0..draw.dimensions()).map(|k| Lanes(std::array::from_fn(|lane| WIDER * points[lane][k]))).collect();
        draw.transform(&mut scores);
        model.function.evaluate(&scores, &mut measures);
        measures[measure].0.iter().any(|value| value.is_nan())
    });
    if found { counted(model, measure, seed, f64::is_nan) } else { Ok(0.0) }
}

/// The share of units in which any measure is outside, or cannot be computed, whether it has limits or not.
pub(super) fn any_defects(model: Model, seed: u64) -> Result<f64, AllocateError> {
    match &model.measures[..] {
        [_] => defects(&model, 0, seed),
        _ => {
            let model = with_nearest(model);
            defects(&model, model.measures.len() - 1, seed)
        }
    }
}

fn study(model: &Model, samples: u64, seed: u64) -> Result<Study<'_>, StudyError> {
    let method = if model.variables() > MOST_DIMENSIONS { Method::PseudoRandom } else { Method::ScrambledSobol };
    Study::new(model, Settings { method, samples, replicates: 1, seed })
}

/// The share of drawn units whose value of a measure is a `hit`.
fn counted(model: &Model, measure: usize, seed: u64, hit: impl Fn(f64) -> bool) -> Result<f64, AllocateError> {
    let study = study(model, COUNTED, seed)?;
    let hits = |first| study.unit_measures(first)[measure].0.iter().filter(|value| hit(**value)).count();
    let hits: usize = (0..COUNTED).step_by(LANES).map(hits).sum();
    Ok(hits as f64 / COUNTED as f64)
}

/// Mean and standard deviation of a measure of drawn units; none if it cannot be computed in one of them.
pub(super) fn drawn(model: &Model, measure: usize, seed: u64) -> Result<Option<[f64; 2]>, AllocateError> {
    let study = study(model, UNITS, seed)?;
    let values: Vec<f64> = (0..UNITS).step_by(LANES).flat_map(|first| study.unit_measures(first)[measure].0).collect();
    if !values.iter().all(|value| value.is_finite()) {
        return Ok(None);
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    Ok(Some([mean, libm::sqrt(square / (count - 1.0))]))
}
