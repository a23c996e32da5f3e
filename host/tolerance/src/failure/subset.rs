//! Subset simulation: a rare failure as a chain of frequent ones, wherever and in however many places it happens.
//!
//! Au and Beck, "Estimation of small failure probabilities in high dimensions by subset simulation", Probab. Eng. Mech.
//! 16 (2001); chains by the adaptive conditional sampling of Papaioannou et al., Probab. Eng. Mech. 41 (2015), whose
//! steps do not depend on how many scores there are.

use slipfit_core::sampling::stream::{Rng, derived, unit_stream};

use super::Margins;
use crate::numeric::normal::Scores;

/// Share of the units that go on to the next level.
const SHARE: f64 = 0.125;
/// States of a chain.
const LENGTH: usize = 8;
/// The least number of units beyond a level part of the margin from which chains start.
const LEAST_BEYOND: usize = 4;
/// The least number of chains between two adaptations of the step.
const ADAPTED_AFTER: usize = 16;
/// The acceptance that is aimed at.
const ACCEPTANCE: f64 = 0.44;

/// One run.
pub struct Run {
    /// Probability of failure without the factor of truncated zones.
    pub probability: f64,
    /// Scores of units that fail, about as probable relative to each other as all that do.
    pub failing: Vec<Vec<f64>>,
}

/// Why a run did not get down to failure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stopped {
    /// Failure is rarer than this, about the probability of the last level.
    Rarer(f64),
    /// The margin does not tell units from each other.
    Flat,
}

/// Draws `units`, a multiple of 64, a level, over up to `levels` of them, each an eighth as probable as the one before.
///
/// # Errors
/// [`Stopped`], if the levels do not get down to failure.
pub fn run<M: Margins>(state: &mut M, units: usize, levels: u64, seed: u64) -> Result<Run, Stopped> {
    let dimensions = state.dimensions();
    let (mut points, mut margins) = (Vec::with_capacity(units), Vec::with_capacity(units));
    state.enter(1.0, units);
    for first in (0..units).step_by(M::TOGETHER) {
        let group = first..(first + M::TOGETHER).min(units);
        let mut streams: Vec<_> = group.map(|unit| unit_stream(seed, unit as u64)).collect();
        let group: Vec<Vec<f64>> = streams.iter_mut().map(|stream| normals(stream, dimensions)).collect();
        margins.extend(state.at(&group));
        points.extend(group);
    }
    let mut probability = 1.0;
    let mut spread = 0.6;
    for level in 1.. {
        let failing = margins.iter().filter(|margin| **margin < 0.0).count();
        if failing as f64 >= SHARE * units as f64 {
            let failing = points.into_iter().zip(&margins).filter(|(_, margin)| **margin < 0.0).map(|(point, _)| point);
            let failing: Vec<_> = failing.collect();
            probability *= failing.len() as f64 / units as f64;
            return Ok(Run { probability, failing });
        }
        let mut order: Vec<usize> = (0..units).collect();
        order.sort_by(|one, other| margins[*one].total_cmp(&margins[*other]));
        let chains = units / LENGTH;
        let mut threshold = margins[order[chains - 1]];
        if threshold == margins[order[units - 1]] {
            // Most units are on one level part of the margin: the next level are those that are beyond it, however few.
            let beyond = order.partition_point(|unit| margins[*unit] < threshold);
            if beyond < LEAST_BEYOND {
                return Err(Stopped::Flat);
            }
            threshold = margins[order[beyond - 1]];
        }
        if !threshold.is_finite() {
            return Err(Stopped::Flat);
        }
        // On a level part of the margin many units are as good as the last: all of them make up the next level.
        let below: Vec<usize> = (0..units).filter(|unit| margins[*unit] <= threshold).collect();
        probability *= below.len() as f64 / units as f64;
        if level >= levels {
            break;
        }
        let start = |chain: usize| below[chain * below.len() / chains];
        let starts: Vec<(Vec<f64>, f64)> =
            (0..chains).map(start).map(|unit| (points[unit].clone(), margins[unit])).collect();
        state.enter(probability, (LENGTH - 1) * chains);
        (points, margins) = grown(state, &starts, threshold, &mut spread, derived(seed, level));
    }
    Err(Stopped::Rarer(probability))
}

/// Chains from `starts` among the units with margins up to `threshold`; `spread` is the step, which adapts itself.
fn grown<M: Margins>(
    state: &mut M,
    starts: &[(Vec<f64>, f64)],
    threshold: f64,
    spread: &mut f64,
    seed: u64,
) -> (Vec<Vec<f64>>, Vec<f64>) {
    let dimensions = state.dimensions();
    let (mut points, mut margins) = (Vec::new(), Vec::new());
    let (mut accepted, mut tried, mut adaptations) = (0, 0, 0);
    for (group, starts) in starts.chunks(M::TOGETHER).enumerate() {
        let first = group * M::TOGETHER;
        let mut streams: Vec<_> = (first..first + starts.len()).map(|chain| unit_stream(seed, chain as u64)).collect();
        let mut chain = starts.to_vec();
        for _ in 1..LENGTH {
            let step = spread.min(1.0);
            let kept = libm::sqrt(1.0 - step * step);
            let moved = |((point, _), stream): (&(Vec<f64>, f64), &mut _)| -> Vec<f64> {
                point.iter().zip(normals(stream, dimensions)).map(|(z, normal)| kept * z + step * normal).collect()
            };
            points.extend(chain.iter().map(|(point, _)| point.clone()));
            margins.extend(chain.iter().map(|(_, margin)| *margin));
            let proposed: Vec<Vec<f64>> = chain.iter().zip(&mut streams).map(moved).collect();
            let found = state.at(&proposed);
            for ((current, proposed), margin) in chain.iter_mut().zip(proposed).zip(found) {
                if margin <= threshold {
                    *current = (proposed, margin);
                    accepted += 1;
                }
            }
        }
        points.extend(chain.iter().map(|(point, _)| point.clone()));
        margins.extend(chain.iter().map(|(_, margin)| *margin));
        tried += starts.len();
        if tried >= ADAPTED_AFTER {
            adaptations += 1;
            let share = accepted as f64 / (tried * (LENGTH - 1)) as f64;
            *spread = (*spread * libm::exp((share - ACCEPTANCE) / libm::sqrt(f64::from(adaptations)))).min(1.0);
            (accepted, tried) = (0, 0);
        }
    }
    (points, margins)
}

/// Independent standard normal scores.
pub fn normals(stream: &mut impl Rng, count: usize) -> Vec<f64> {
    let table = Scores::table();
    (0..count).map(|_| table.score(stream.next_u64())).collect()
}
