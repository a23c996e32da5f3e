//! How probable a failure is, by a way that fits where it lies.
//!
//! A margin that goes one way has one design point, and importance sampling around it. For any other, runs of subset
//! simulation show where failures lie; design points are searched from there until a mixture around them explains all
//! failures that were seen. Where it does not, as on the surface of a sphere in many dimensions, subset simulation gives the
//! figure. No figure is given that contradicts the units which were counted.

use slipfit_core::sampling::stream::derived;

use super::{
    DesignPoint, Failure, LimitState, Margins,
    importance::{Mixture, REPLICATES, Sampled, mean_and_error},
    regions::{Cover, is_straight, seeds},
    subset,
};
use crate::{model::Model, numeric::normal::tail, sampling::draw::Draw, statistics::binomial};

/// Runs of subset simulation that look for failures, and their units a level.
const SEARCHES: (u64, usize) = (8, 512);
/// Levels after which a failure is too rare: 2⁻⁴⁸, 4e-15.
const LEVELS: u64 = 16;
/// Runs whose mean is the figure.
const RUNS: (u64, usize) = (REPLICATES, 4096);
/// How many standard errors a figure may lie off the units that were counted, and off the search, whose few runs know
/// their own error badly.
const AGREEMENT: [f64; 2] = [4.0, 6.0];
/// The chance of a count beyond what still agrees with a figure.
const UNLIKELY: f64 = 3e-5;
/// The greatest relative standard error of a figure that is given.
pub const MOST_ERROR: f64 = 0.3;

/// Where a probability comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// Counted units.
    Counted,
    /// Importance sampling.
    ImportanceSampling,
    /// Subset simulation.
    SubsetSimulation,
}

/// How probable a failure is.
#[derive(Clone, Debug, PartialEq)]
pub struct Tail {
    /// Probability.
    pub probability: f64,
    /// Its standard error, from [`REPLICATES`] independent designs.
    pub error: f64,
    /// How it was found.
    pub source: Source,
    /// Distance of the most probable failure from the origin, if it was reached; negative if the origin itself fails.
    pub reliability: Option<f64>,
    /// P(Z > β): the probability if the border of failure were flat.
    pub first_order: Option<f64>,
    /// The most probable points of failure (scores) that were found, the nearest first; of the opposite, if the origin fails.
    pub points: Vec<DesignPoint>,
    /// Evaluations of the model.
    pub evaluations: u64,
}

/// The probability of `failure`, which was `counted` as some hits among units; `None` if there is no figure to be trusted,
/// as where nothing moves the measure.
pub fn probability(
    model: &Model,
    draw: &Draw,
    failure: &Failure,
    seed: u64,
    counted: Option<(u64, u64)>,
) -> Option<Tail> {
    let (at_origin, _) = LimitState::new(model, draw, failure, false).expansion(&vec![0.0; draw.dimensions()]);
    // Where nearly all units fail, those that do not are the rare ones.
    let opposite = at_origin < 0.0;
    let mut state = LimitState::new(model, draw, failure, opposite);
    let likely = |tail: &Tail| {
        let probability = if opposite { 1.0 - tail.probability } else { tail.probability };
        agrees(counted, probability, tail.error)
    };
    let straight = is_straight(&mut state, seed).then(|| of_one_region(&mut state, seed)).flatten();
    let tail = straight.filter(likely).or_else(|| of_regions(&mut state, seed, likely))?;
    let sign = if opposite { -1.0 } else { 1.0 };
    Some(Tail {
        probability: if opposite { 1.0 - tail.probability } else { tail.probability },
        reliability: tail.reliability.map(|distance| sign * distance),
        first_order: tail.reliability.map(|distance| self::tail(sign * distance)),
        evaluations: state.evaluations,
        ..tail
    })
}

/// Whether the count does not speak against a figure.
pub fn agrees(counted: Option<(u64, u64)>, probability: f64, error: f64) -> bool {
    let Some((hits, units)) = counted.filter(|(_, units)| *units > 0) else { return true };
    let [lower, upper] = binomial::limits(hits, units, UNLIKELY);
    lower <= probability + AGREEMENT[0] * error && probability - AGREEMENT[0] * error <= upper
}

/// With one design point, reached from the origin.
fn of_one_region(state: &mut LimitState, seed: u64) -> Option<Tail> {
    let point = state.design_point(&vec![0.0; state.dimensions()])?;
    let bound = libm::exp(-0.5 * point.distance * point.distance);
    let sampled = Mixture::around(point.clone()).sample(state, seed);
    // A unit that is much more probable than the most probable point lies somewhere else.
    let elsewhere = sampled.worst_ratio > libm::exp(2.0) * bound;
    by_importance(sampled, vec![point]).filter(|_| !elsewhere)
}

fn by_importance(sampled: Sampled, mut points: Vec<DesignPoint>) -> Option<Tail> {
    points.sort_by(|one, other| one.distance.total_cmp(&other.distance));
    let distance = points.first()?.distance;
    let Sampled { mut probability, mut error, .. } = sampled;
    if distance > 30.0 && probability < f64::MIN_POSITIVE {
        // Below any number, but not nothing.
        probability = tail(distance).max(f64::MIN_POSITIVE);
        error = probability;
    } else if error.is_nan() || error > MOST_ERROR * probability {
        return None;
    }
    Some(Tail {
        probability,
        error,
        source: Source::ImportanceSampling,
        reliability: Some(distance),
        first_order: None,
        points,
        evaluations: 0,
    })
}

/// With any number of design points, or none.
fn of_regions(state: &mut LimitState, seed: u64, likely: impl Fn(&Tail) -> bool) -> Option<Tail> {
    let origin = vec![0.0; state.dimensions()];
    let (runs, units) = SEARCHES;
    let searches: Vec<_> =
        seeds(derived(seed, 1), runs).map(|seed| subset::run(state, units, LEVELS, seed).ok()).collect();
    let from_origin = state.design_point(&origin);
    let Some(searches) = searches.into_iter().collect::<Option<Vec<_>>>() else {
        // Too rare for levels to get there; or the margin is level for most units, so that it takes many to find what is beyond.
        let Some(point) = from_origin else { return of_levels(state, derived(seed, 3)).filter(&likely) };
        let sampled = Mixture::around(point.clone()).sample(state, seed);
        return by_importance(sampled, vec![point]).filter(likely);
    };
    let factor = state.factor();
    let (found, spread) = mean_and_error(&searches.iter().map(|run| factor * run.probability).collect::<Vec<_>>());
    let mut cover = Cover::new(searches.into_iter().flat_map(|run| run.failing).collect());
    if let Some(point) = from_origin {
        cover.add(point);
    }
    let complete = cover.complete(state, found / factor);
    let mixture = cover.mixture().filter(|_| complete);
    let by_mixture = mixture.and_then(|mixture| {
        let points = mixture.points().to_vec();
        let sampled = mixture.sample(state, derived(seed, 2));
        let apart = (sampled.probability - found).abs();
        let close = apart <= AGREEMENT[1] * libm::hypot(sampled.error, spread);
        by_importance(sampled, points).filter(|_| close).filter(&likely)
    });
    by_mixture.or_else(|| of_levels(state, derived(seed, 3)).filter(&likely))
}

/// By subset simulation alone.
fn of_levels(state: &mut LimitState, seed: u64) -> Option<Tail> {
    let (runs, units) = RUNS;
    let factor = state.factor();
    let mut probabilities = Vec::with_capacity(runs as usize);
    for seed in seeds(seed, runs) {
        probabilities.push(factor * subset::run(state, units, LEVELS, seed).ok()?.probability);
    }
    let (probability, error) = mean_and_error(&probabilities);
    (error <= MOST_ERROR * probability).then_some(Tail {
        probability,
        error,
        source: Source::SubsetSimulation,
        reliability: None,
        first_order: None,
        points: Vec::new(),
        evaluations: 0,
    })
}
