//! Everything that is found of a model: by formula, and by the units of a study.

use slipfit_core::sampling::stream::derived;
use slipfit_system::parallel;

use super::{
    counting::{
        pairs::Pairs,
        study::{Settings, Study, StudyError, Tally},
    },
    failure::{
        Failure,
        tail::{Source, Tail, probability},
    },
    model::{Model, Sum, Variation},
    sampling::{draw::Draw, sampler::Method},
    statistics::estimate::{Estimate, Joint, Spread, joint},
    theory::{
        derivative::{Expansion, evaluate, expansion},
        extremes::reaches,
        indices::{Indices, indices},
        moments::{Moments, moments, spreads},
        rss::{RootSumSquare, root_sum_square},
        tensor::{self, Exact},
        worst_case::{WorstCase, reaches as linear_reaches, worst_cases},
    },
};
use crate::numeric::normal;

/// Share of the curvature in a measure's variance above which the measure counts as not linear.
pub const LINEAR: f64 = 1e-6;
/// The most contributors that have Sobol' indices: each takes thousands of evaluations of all.
const MOST_INDICES: usize = 512;
/// What the seeds of everything but the study itself are derived with.
const TAILS: u64 = 1 << 32;
const INDICES: u64 = 2 << 32;

/// What is found by formula and importance sampling, without the study's units.
#[derive(Clone, Debug, PartialEq)]
pub struct Theory {
    /// Every measure at the drawing's nominal values (SI), where there is a drawing.
    pub nominal: Option<Vec<f64>>,
    /// Worst case of every measure.
    pub worst_cases: Vec<WorstCase>,
    /// Root sum of squares of every measure.
    pub sums_of_squares: Vec<RootSumSquare>,
    /// Moments of second order of every measure.
    pub moments: Vec<Moments>,
    /// What every contributor does to every measure, a row a measure.
    pub sensitivities: Vec<Vec<Sensitivity>>,
    /// Moments by quadrature of the measures that are not linear, where their variables are few.
    pub exact: Vec<Option<Exact>>,
    /// Sobol' indices of the measures that are not linear; none with correlated contributors, or more than 512, or of a measure that too few
    /// units have.
    pub indices: Vec<Option<Indices>>,
    /// P(below the lower limit), P(above the upper limit) of every measure.
    pub tails: Vec<[Option<Tail>; 2]>,
    /// Of every sum of the model.
    pub closings: Vec<Closing>,
}

/// What a contributor does to a measure (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivity {
    /// ∂measure/∂variable of a scalar at the middle of its limits, ∂measure/∂tolerance where a tolerance shifts the value;
    /// none where slopes do not describe the measure.
    pub slope: Option<f64>,
    /// How far its whole tolerance moves the measure to either side: half of what the worst case gains by it, or of the range
    /// that it has alone where slopes do not describe the measure.
    pub reach: f64,
}

/// How probable it is that a sum of measures is negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Closing {
    /// Mean and standard deviation of the sum, of second order (SI).
    pub mean: f64,
    /// Standard deviation with the model's own correlation.
    pub deviation: f64,
    /// By importance sampling, with the model's own correlation.
    pub tail: Option<Tail>,
    /// As if the sum were normal, with the model's own correlation.
    pub normal: f64,
    /// As if normal, and all measures moved together (ρ = +1): how eq. 9 tightens both sides of a gap.
    pub together: f64,
    /// As if normal, and all measures were independent (ρ = 0).
    pub independent: f64,
}

/// Theory and study.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// What was drawn.
    pub settings: Settings,
    /// By formula.
    pub theory: Theory,
    /// By the study's units.
    pub joint: Joint,
}

/// Draws all units and finds everything; `done` is called with the units of every block. Runs on the current pool.
///
/// # Errors
/// [`StudyError`], if the model cannot be drawn or the settings do not fit.
pub fn analyse(model: &Model, settings: Settings, done: impl Fn(u64) + Sync) -> Result<Analysis, StudyError> {
    let study = Study::new(model, settings)?;
    let mut tallies = study.empty();
    study.add(0..settings.blocks(), &mut tallies, done);
    conclude(&study, &tallies)
}

/// Finds everything from units that have been drawn.
///
/// # Errors
/// [`StudyError`], if the model cannot be drawn, a measure cannot be computed in two units of a replicate at least, or somebody
/// asked to stop.
pub fn conclude(study: &Study, tallies: &[Tally]) -> Result<Analysis, StudyError> {
    let Settings { seed, method, .. } = study.settings;
    for tally in tallies {
        for (measure, counts) in study.model.measures.iter().zip(&tally.counts.measures) {
            let (computed, units) = (tally.counts.units - counts.undefined, tally.counts.units);
            if computed < 2 {
                return Err(StudyError::Undefined { measure: measure.name.clone(), computed, units });
            }
        }
    }
    let basis = Basis::new(study.model);
    let spread = Spread {
        shapes: basis.moments.iter().map(|moments| moments.shape).collect(),
        pairs: if method == Method::PseudoRandom { Pairs::new(study.model) } else { Pairs::default() },
    };
    let joint = joint(study.model, method, study.frames(), tallies, &spread);
    Ok(Analysis { settings: study.settings, theory: of_basis(study.model, basis, seed, Some(&joint))?, joint })
}

/// What both theory and the errors of a sample start from.
struct Basis {
    deviations: Vec<f64>,
    around_mean: Expansion,
    moments: Vec<Moments>,
}

impl Basis {
    fn new(model: &Model) -> Self {
        let (means, deviations) = spreads(model);
        let around_mean = expansion(model, &means, &deviations);
        let moments = moments(model, &around_mean, &means, &deviations);
        Self { deviations, around_mean, moments }
    }
}

/// What needs no study. `seed` is for importance sampling and Sobol' indices; no probability contradicts what was
/// `counted`.
///
/// # Errors
/// [`StudyError`], if the model cannot be drawn or somebody asked to stop.
pub fn theory(model: &Model, seed: u64, counted: Option<&Joint>) -> Result<Theory, StudyError> {
    of_basis(model, Basis::new(model), seed, counted)
}

fn of_basis(model: &Model, basis: Basis, seed: u64, counted: Option<&Joint>) -> Result<Theory, StudyError> {
    let draw = Draw::new(model, seed)?;
    let Basis { deviations, around_mean, moments } = basis;
    let around_middle = expansion(model, &model.middles(), &deviations);
    let bends = |moments: &Moments| moments.curved > LINEAR || !moments.described;
    let curved = moments.iter().any(bends);
    stop_if_asked()?;
    let all_indices = if curved && model.correlations.is_empty() && model.contributors.len() <= MOST_INDICES {
        indices(model, &draw, derived(seed, INDICES))
    } else {
        vec![None; model.measures.len()]
    };
    let exact = if curved { tensor::of_measures(model) } else { vec![None; model.measures.len()] };
    let all: Vec<usize> = (0..model.measures.len()).collect();
    let worst_cases = worst_cases(model, &around_middle, &all);
    let mut sensitivities: Vec<Vec<Sensitivity>> =
        around_middle.slopes.iter().map(|slopes| sensitivities(model, slopes)).collect();
    stop_if_asked()?;
    for i in (0..moments.len()).filter(|i| !moments[*i].by_slopes()) {
        let reaches = reaches(model, i).into_iter();
        sensitivities[i] = reaches.map(|reach| Sensitivity { slope: None, reach }).collect();
    }
    let rare = rare(model, &draw, seed, counted)?;
    let (tails, sums) = rare.split_at(2 * model.measures.len());
    let tails = tails.chunks(2).map(|sides| [sides[0].clone(), sides[1].clone()]).collect();
    let closings = model.sums.iter().zip(sums);
    let closings = closings
        .map(|(sum, tail)| closing(model, sum, &moments, &around_mean.slopes, &deviations, tail.clone(), counted));
    Ok(Theory {
        nominal: model.function.nominal().map(|nominal| evaluate(model, &[nominal.to_vec()]).concat()),
        closings: closings.collect(),
        worst_cases,
        sums_of_squares: root_sum_square(model, &around_middle, &around_mean, &deviations),
        sensitivities,
        exact: exact.into_iter().zip(&moments).map(|(e, m)| e.filter(|_| bends(m))).collect(),
        indices: all_indices.into_iter().zip(&moments).map(|(i, m)| i.filter(|_| bends(m))).collect(),
        moments,
        tails,
    })
}

/// The probabilities of all failures: below and above of every measure, then those of the sums. Each has a seed of its own,
/// so that they can be found side by side.
fn rare(model: &Model, draw: &Draw, seed: u64, counted: Option<&Joint>) -> Result<Vec<Option<Tail>>, StudyError> {
    let sides = model.measures.iter().enumerate().flat_map(|(i, measure)| {
        [0, 1].map(|side| {
            let limit = measure.limits[side]?;
            let hits = counted.map(|joint| joint.measures[i].outside_counts(side));
            Some((Failure { measures: vec![i], limit, above: side == 1 }, hits))
        })
    });
    let sums = model.sums.iter().enumerate().map(|(i, sum)| {
        let hits = counted.map(|joint| (joint.closed_counts.0[i], joint.closed_counts.1));
        Some((Failure { measures: sum.measures.clone(), limit: 0.0, above: false }, hits))
    });
    let failures: Vec<_> = sides.chain(sums).enumerate().collect();
    parallel::try_map(&failures, |(number, failure)| {
        stop_if_asked()?;
        let Some((failure, hits)) = failure else { return Ok(None) };
        Ok(probability(model, draw, failure, derived(seed, TAILS + *number as u64), *hits))
    })
}

fn stop_if_asked() -> Result<(), StudyError> {
    if slipfit_system::interrupt::requested() { Err(StudyError::Interrupted) } else { Ok(()) }
}

fn sensitivities(model: &Model, slopes: &[f64]) -> Vec<Sensitivity> {
    let of = |((contributor, at), [down, up]): ((&super::model::Contributor, usize), [f64; 2])| {
        let slope = matches!(contributor.variation, Variation::Scalar { .. }).then(|| slopes[at]);
        Sensitivity { slope, reach: 0.5 * (down + up) }
    };
    model.contributors.iter().zip(model.offsets()).zip(linear_reaches(model, slopes)).map(of).collect()
}

fn closing(
    model: &Model,
    sum: &Sum,
    moments: &[Moments],
    slopes: &[Vec<f64>],
    deviations: &[f64],
    rare: Option<Tail>,
    counted: Option<&Joint>,
) -> Closing {
    let members = || sum.measures.iter().map(|i| &moments[*i]);
    let mean: f64 = members().map(|moments| moments.mean).sum();
    let together: f64 = members().map(|moments| moments.deviation).sum();
    let described = members().all(Moments::by_slopes);
    let independent = libm::sqrt(members().map(|moments| moments.deviation * moments.deviation).sum());
    // Of first order: the sum's own slopes.
    let moves: Vec<f64> = (0..deviations.len())
        .map(|k| deviations[k] * sum.measures.iter().map(|i| slopes[*i][k]).sum::<f64>())
        .collect();
    let variance: f64 = model.correlation().times(&moves).iter().zip(&moves).map(|(with, own)| with * own).sum();
    let of_first_order = libm::sqrt(variance.max(0.0));
    // Where slopes do not describe a member, as the units have it.
    let deviation = counted.filter(|_| !described).map_or(of_first_order, |joint| {
        let product = |i: &usize, j: &usize| moments[*i].deviation * moments[*j].deviation * joint.correlation[*i][*j];
        let row = |i: &usize| sum.measures.iter().map(|j| product(i, j)).sum::<f64>();
        libm::sqrt(sum.measures.iter().map(row).sum::<f64>().max(0.0))
    });
    let below = |deviation: f64| normal::tail(mean / deviation);
    Closing {
        mean,
        deviation,
        tail: rare,
        normal: below(deviation),
        together: below(together),
        independent: below(independent),
    }
}

/// The better known of two estimates of a probability: a count is taken if its error is the smaller one.
pub fn better(counted: &Estimate, tail: Option<&Tail>) -> (f64, Option<f64>, Source) {
    match (tail, counted.error) {
        (Some(tail), error) if !error.is_some_and(|error| counted.value > 0.0 && error < tail.error) => {
            (tail.probability, Some(tail.error), tail.source)
        }
        _ => (counted.value, counted.error, Source::Counted),
    }
}
