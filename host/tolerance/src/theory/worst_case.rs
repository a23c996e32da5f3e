//! Worst case: every contributor anywhere within its limits or its zone.

use super::{derivative::Expansion, extremes::extremes};
use crate::model::{Model, Variation, widening::Widening};

/// Lowest and highest value of a measure (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstCase {
    /// The worst case: of a linear measure exact, of any other by corners and a search (`extremes`).
    pub range: [f64; 2],
    /// By its slopes at the middle of all limits, and by how zones grow with sizes: no bound for a measure that is not linear.
    pub linear: [f64; 2],
    /// Whether the measure cannot be computed somewhere within the limits.
    pub undefined: bool,
}

/// How far every contributor moves a measure down and up from the middle, at most. A size that zones grow with has what they
/// gain by it.
pub fn reaches(model: &Model, slopes: &[f64]) -> Vec<[f64; 2]> {
    let offsets = model.offsets();
    let own = |i: usize| {
        let variation = &model.contributors[i].variation;
        (variation, &slopes[offsets[i]..offsets[i] + variation.variables()])
    };
    let mut reaches: Vec<[f64; 2]> = (0..offsets.len())
        .map(|i| {
            let (variation, slopes) = own(i);
            [variation.reach(slopes, [1.0; 2]); 2]
        })
        .collect();
    let widenings = model.function.widenings();
    for (size, at) in offsets.iter().enumerate() {
        let grows = || widenings.iter().filter(|widening| widening.size == *at);
        let Variation::Scalar { limits: [low, high], .. } = model.contributors[size].variation else { continue };
        if grows().next().is_none() {
            continue;
        }
        let half = 0.5 * (high - low);
        let gain = |away: f64| -> f64 {
            let of_zone = |widening: &Widening| {
                let (variation, slopes) = own(offsets.partition_point(|at| *at < widening.zone));
                variation.reach(slopes, widening.grown(away)) - variation.reach(slopes, [1.0; 2])
            };
            grows().map(of_zone).sum()
        };
        let gains = [-half, half].map(|away| (slopes[*at] * away, gain(away)));
        reaches[size] = [-1.0, 1.0]
            .map(|sign| gains.iter().map(|(direct, gained)| sign * direct + gained).fold(f64::NEG_INFINITY, f64::max));
    }
    reaches
}

/// By slopes; `around` is expanded around the middles of all contributors.
pub fn linear(model: &Model, around: &Expansion) -> Vec<[f64; 2]> {
    let measure = |(value, slopes): (&f64, &Vec<f64>)| {
        let reaches = reaches(model, slopes);
        let [down, up] = [0, 1].map(|side| reaches.iter().map(|reach| reach[side]).sum::<f64>());
        [value - down, value + up]
    };
    around.values.iter().zip(&around.slopes).map(measure).collect()
}

/// Of each of some `measures`; `around` is expanded around the middles of all contributors.
pub fn worst_cases(model: &Model, around: &Expansion, measures: &[usize]) -> Vec<WorstCase> {
    let linear = linear(model, around);
    let searched: Vec<usize> = measures.iter().copied().filter(|i| !model.function.is_linear(*i)).collect();
    let mut found = searched.iter().zip(extremes(model, &searched)).peekable();
    // Where place and tilts of a zone grow differently, the zone itself is wider than that of the scaled variables.
    let uneven = model.function.widenings().iter().any(|widening| widening.growth[0] != widening.growth[1]);
    let of = |i: &usize| {
        let linear = linear[*i];
        let Some((_, extremes)) = found.next_if(|(searched, _)| *searched == i) else {
            return WorstCase { range: linear, linear, undefined: false };
        };
        let [low, high] = extremes.range;
        let range = if uneven { [low.min(linear[0]), high.max(linear[1])] } else { [low, high] };
        WorstCase { range, linear, undefined: extremes.undefined }
    };
    measures.iter().map(of).collect()
}
