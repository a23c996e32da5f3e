//! Sobol' indices: shares of contributors in the variance of measures that need not be linear.
//!
//! Saltelli et al., "Variance based sensitivity analysis of model output", Comput. Phys. Commun. 181 (2010): first-order
//! indices by their equation (b), total ones by Jansen's. A contributor's variables go together.

use rayon::prelude::*;

use crate::tolerance::{
    model::{
        Model,
        lanes::{LANES, Lanes},
    },
    sampling::{
        draw::Draw,
        sampler::{Method, Sampler},
        sobol::MOST_DIMENSIONS,
    },
};

/// Units of each of the two samples.
const UNITS: u64 = 4096;
/// Units that are worked on together.
const PIECE: u64 = 256;

/// Indices of one measure, one a contributor.
#[derive(Clone, Debug, PartialEq)]
pub struct Indices {
    /// Share of the variance that falls away once the contributor is known.
    pub first: Vec<f64>,
    /// Share that stays if all but the contributor are known.
    pub total: Vec<f64>,
}

/// What the units of a piece add up to.
struct Sums {
    /// Σ values and Σ squares of both samples, of every measure.
    whole: Vec<[f64; 2]>,
    /// Numerators of the first-order and the total index, of every contributor to every measure.
    parts: Vec<Vec<[f64; 2]>>,
}

impl Sums {
    fn zero(measures: usize, contributors: usize) -> Self {
        Self { whole: vec![[0.0; 2]; measures], parts: vec![vec![[0.0; 2]; contributors]; measures] }
    }

    fn add(&mut self, piece: &Self) {
        let whole = self.whole.iter_mut().zip(&piece.whole);
        let parts = self.parts.iter_mut().flatten().zip(piece.parts.iter().flatten());
        for (sum, more) in whole.chain(parts) {
            sum[0] += more[0];
            sum[1] += more[1];
        }
    }
}

/// Of every measure, from 4096 · (contributors + 2) evaluations. The contributors have to be independent.
pub fn indices(model: &Model, draw: &Draw, seed: u64) -> Vec<Indices> {
    let (dimensions, contributors, measures) = (draw.dimensions(), model.contributors.len(), model.measures.len());
    let method = if 2 * dimensions > MOST_DIMENSIONS { Method::PseudoRandom } else { Method::ScrambledSobol };
    let sampler = Sampler::new(method, seed, 2 * dimensions, 1, UNITS);
    let offsets = model.offsets();
    let origin = {
        let mut scores = vec![Lanes::ZERO; dimensions];
        draw.transform(&mut scores);
        let mut values = vec![Lanes::ZERO; measures];
        model.function.evaluate(&scores, &mut values);
        values
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
                for (a, b) in a.0.iter().zip(b.0) {
                    sums[0] += a + b;
                    sums[1] += a * a + b * b;
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
                        part[0] += b * (mixed - a);
                        part[1] += (mixed - a) * (mixed - a);
                    }
                }
            }
        }
        sums
    });
    let mut sums = Sums::zero(measures, contributors);
    pieces.collect::<Vec<_>>().iter().for_each(|piece| sums.add(piece));
    let n = UNITS as f64;
    let of = |(sums, parts): (&[f64; 2], &Vec<[f64; 2]>)| {
        let mean = sums[0] / (2.0 * n);
        let variance = sums[1] / (2.0 * n) - mean * mean;
        let share = |part: f64| if variance > 0.0 { part / n / variance } else { 0.0 };
        Indices {
            first: parts.iter().map(|part| share(part[0])).collect(),
            total: parts.iter().map(|part| share(0.5 * part[1])).collect(),
        }
    };
    sums.whole.iter().zip(&sums.parts).map(of).collect()
}
