//! Sobol' indices: shares of contributors in the variance of measures that need not be linear.
//!
//! Saltelli et al., "Variance based sensitivity analysis of model output", Comput. Phys. Commun. 181 (2010): first-order
//! indices by their equation (b), total ones by Jansen's. A contributor's variables go together.

use rayon::prelude::*;

use crate::{
    model::Model,
    numeric::lanes::{LANES, Lanes},
    sampling::{
        draw::Draw,
        sampler::{Method, Sampler},
        sobol::MOST_DIMENSIONS,
    },
};

/// Units of each of the two samples.
const UNITS: u64 = 4096;
/// Pairs of units with the measure, of one contributor, below which its share would be chance.
const LEAST_PAIRS: f64 = 512.0;
/// Units that are worked on together.
const PIECE: u64 = 256;

/// Indices of one measure, one a contributor.
#[derive(Clone, Debug, PartialEq)]
pub struct Indices {
    /// Share of the variance that falls away once the contributor is known.
    pub first: Vec<f64>,
    /// Share that stays if all but the contributor are known.
    pub total: Vec<f64>,
    /// The greatest standard error of a contributor's part in the sum of total indices: by how much that changes from units to units.
    pub error: f64,
}

/// What the units of a piece add up to.
struct Sums {
    /// Σ values and Σ squares of both samples and the number of both, of every measure.
    whole: Vec<[f64; 3]>,
    /// Numerators of the first-order and the total index and the number of units of each, of every contributor to every measure.
    parts: Vec<Vec<[f64; 4]>>,
}

impl Sums {
    fn zero(measures: usize, contributors: usize) -> Self {
        Self { whole: vec![[0.0; 3]; measures], parts: vec![vec![[0.0; 4]; contributors]; measures] }
    }

    fn add(&mut self, piece: &Self) {
        let whole = self.whole.as_flattened_mut().iter_mut().zip(piece.whole.as_flattened());
        let parts = self.parts.iter_mut().zip(&piece.parts);
        let parts = parts.flat_map(|(sums, more)| sums.as_flattened_mut().iter_mut().zip(more.as_flattened()));
        whole.chain(parts).for_each(|(sum, more)| *sum += more);
    }
}

/// Of every measure, from 4096 · (contributors + 2) evaluations. The contributors have to be independent. Units in which the
/// measure cannot be computed do not count; `None` where too few are left.
pub fn indices(model: &Model, draw: &Draw, seed: u64) -> Vec<Option<Indices>> {
    let (dimensions, contributors, measures) = (draw.dimensions(), model.contributors.len(), model.measures.len());
    let method = if 2 * dimensions > MOST_DIMENSIONS { Method::PseudoRandom } else { Method::ScrambledSobol };
    let sampler = Sampler::new(method, seed, 2 * dimensions, 1, UNITS);
    let offsets = model.offsets();
    let origin = {
        let mut scores = vec![Lanes::ZERO; dimensions];
        draw.transform(&mut scores);
        let mut values = vec![Lanes::ZERO; measures];
        model.function.evaluate(&scores, &mut values);
        values.iter().map(|value| value.map(|value| if value.is_finite() { value } else { 0.0 })).collect::<Vec<_>>()
    };
    // Pieces do not depend on the number of threads, so that neither does the sum.
    let pieces = (0..UNITS).step_by(PIECE as usize).collect::<Vec<_>>().into_par_iter().map(|start| {
        let mut sums = Sums::zero(measures, contributors);
        let mut bits = vec![[0; LANES]; 2 * dimensions];
        let mut samples = [vec![Lanes::ZERO; dimensions], vec![Lanes::ZERO; dimensions]];
        let mut values = [vec![Lanes::ZERO; measures], vec![Lanes::ZERO; measures], vec![Lanes::ZERO; measures]];
        for first in (start..start + PIECE).step_by(LANES) {
            sampler.fill(first, &mut bits);
            let [a, b] = &mut samples;
            draw.variables(first, &bits[..dimensions], a);
            draw.variables(UNITS + first, &bits[dimensions..], b);
            for (sample, values) in samples.iter().zip(&mut values) {
                model.function.evaluate(sample, values);
                values.iter_mut().zip(&origin).for_each(|(value, origin)| *value -= *origin);
            }
            for (sums, (a, b)) in sums.whole.iter_mut().zip(values[0].iter().zip(&values[1])) {
                for value in a.0.into_iter().zip(b.0).flat_map(|(a, b)| [a, b]).filter(|value| value.is_finite()) {
                    sums[0] += value;
                    sums[1] += value * value;
                    sums[2] += 1.0;
                }
            }
            let mut mixed = samples[0].clone();
            for (contributor, at) in offsets.iter().enumerate() {
                let own = *at..at + model.contributors[contributor].variation.variables();
                mixed[own.clone()].copy_from_slice(&samples[1][own.clone()]);
                model.function.evaluate(&mixed, &mut values[2]);
                mixed[own.clone()].copy_from_slice(&samples[0][own]);
                for measure in 0..measures {
                    let part = &mut sums.parts[measure][contributor];
                    for lane in 0..LANES {
                        let [a, b, mixed] = [0, 1, 2].map(|k| values[k][measure].0[lane]);
                        let mixed = mixed - origin[measure].0[lane];
                        if a.is_finite() && mixed.is_finite() {
                            part[1] += (mixed - a) * (mixed - a);
                            part[3] += 1.0;
                            if b.is_finite() {
                                part[0] += b * (mixed - a);
                                part[2] += 1.0;
                            }
                        }
                    }
                }
            }
        }
        sums
    });
    let pieces: Vec<Sums> = pieces.collect();
    let mut sums = Sums::zero(measures, contributors);
    pieces.iter().for_each(|piece| sums.add(piece));
    let of = |measure: usize| {
        let ([sum, squares, count], parts) = (sums.whole[measure], &sums.parts[measure]);
        if parts.iter().any(|[.., pairs]| *pairs < LEAST_PAIRS) {
            return None;
        }
        let mean = sum / count;
        let variance = squares / count - mean * mean;
        let share = |part: f64, units: f64| if variance > 0.0 && units > 0.0 { part / units / variance } else { 0.0 };
        Some(Indices {
            first: parts.iter().map(|[first, _, units, _]| share(*first, *units)).collect(),
            total: parts.iter().map(|[_, total, _, pairs]| share(0.5 * total, *pairs)).collect(),
            error: jackknifed(parts, pieces.iter().map(|piece| &piece.parts[measure])),
        })
    };
    (0..measures).map(of).collect()
}

/// The greatest standard error of a contributor's part in the sum of total indices, by how much each of the `pieces` of the sums `all`
/// changes it (jackknife).
fn jackknifed<'a>(all: &[[f64; 4]], pieces: impl ExactSizeIterator<Item = &'a Vec<[f64; 4]>>) -> f64 {
    let count = pieces.len() as f64;
    let mut sums = vec![[0.0; 2]; all.len()];
    for piece in pieces {
        let without = |(all, own): (&[f64; 4], &[f64; 4])| (all[1] - own[1]) / (all[3] - own[3]).max(1.0);
        let totals: Vec<f64> = all.iter().zip(piece).map(without).collect();
        let sum = totals.iter().sum::<f64>();
        for (sums, total) in sums.iter_mut().zip(totals) {
            let part = if sum > 0.0 { total / sum } else { 0.0 };
            sums[0] += part;
            sums[1] += part * part;
        }
    }
    let variance = |[sum, squares]: [f64; 2]| (count - 1.0) * (squares / count - (sum / count) * (sum / count));
    libm::sqrt(sums.into_iter().map(variance).fold(0.0, f64::max))
}
