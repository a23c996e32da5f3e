//! Worst case: every contributor anywhere within its limits or its zone.

use super::derivative::{Expansion, evaluate};
use crate::tolerance::model::{Distribution, Model, Variation, nested::Nest, widening::Widening};

/// The most combinations of vertices that are tried.
const MOST_VERTICES: usize = 1 << 16;

/// Lowest and highest value of a measure (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstCase {
    /// By its slopes at the middle of all limits, and by how zones grow with sizes; exact for a linear measure.
    pub linear: [f64; 2],
    /// Over all combinations of limits and of corners of zones, if there are not more than 65,536 and no disc, which has
    /// none; exact for a measure that is monotone in every contributor.
    pub vertices: Option<[f64; 2]>,
    /// By a search over corners, rims and the inside, where slopes do not describe the measure.
    pub searched: Option<[f64; 2]>,
}

/// The middle of a contributor's limits or zone.
pub fn middle(variation: &Variation) -> Vec<f64> {
    match variation {
        Variation::Scalar { limits: [low, high], .. } => vec![0.5 * (low + high)],
        zone @ (Variation::Zone(_) | Variation::Disc(_) | Variation::Nested(_)) => vec![0.0; zone.variables()],
    }
}

/// How far a contributor moves a measure from the middle, at most, with `slopes` in its variables. In a zone |u| + |p| +
/// |r| ≤ 1 that is at one of its corners, in a disc on its rim. Place and tilts of a zone have `grown` by factors.
pub(crate) fn reach(variation: &Variation, slopes: &[f64], grown: [f64; 2]) -> f64 {
    let most = slopes.iter().fold(0.0, |most: f64, slope| most.max(slope.abs()));
    match variation {
        Variation::Scalar { limits: [low, high], .. } => 0.5 * (high - low) * most,
        Variation::Zone(_) => grown[0] * most,
        Variation::Disc(_) => grown[0] * libm::sqrt(slopes.iter().map(|slope| slope * slope).sum()),
        Variation::Nested(zone) => zone.most(slopes, grown),
    }
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
            [reach(variation, slopes, [1.0; 2]); 2]
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
                reach(variation, slopes, widening.grown(away)) - reach(variation, slopes, [1.0; 2])
            };
            grows().map(of_zone).sum()
        };
        let gains = [-half, half].map(|away| (slopes[*at] * away, gain(away)));
        reaches[size] = [-1.0, 1.0]
            .map(|sign| gains.iter().map(|(direct, gained)| sign * direct + gained).fold(f64::NEG_INFINITY, f64::max));
    }
    reaches
}

/// Of every measure; `around` is expanded around the [`middle`] of all contributors.
pub fn worst_case(model: &Model, around: &Expansion) -> Vec<WorstCase> {
    let sum = |slopes: &[f64]| -> [f64; 2] {
        let reaches = reaches(model, slopes);
        [0, 1].map(|side| reaches.iter().map(|reach| reach[side]).sum())
    };
    let vertices = by_vertices(model);
    let measure = |(i, (value, slopes)): (usize, (&f64, &Vec<f64>))| {
        let [down, up] = sum(slopes);
        let vertices = vertices.as_ref().map(|vertices| vertices[i]);
        WorstCase { linear: [value - down, value + up], vertices, searched: None }
    };
    around.values.iter().zip(&around.slopes).enumerate().map(measure).collect()
}

fn by_vertices(model: &Model) -> Option<Vec<[f64; 2]>> {
    let is_round = |variation: &Variation| match variation {
        Variation::Disc(_) => true,
        Variation::Nested(zone) => zone.of != Nest::Face,
        _ => false,
    };
    if model.contributors.iter().any(|contributor| is_round(&contributor.variation)) {
        return None;
    }
    let corners: Vec<Vec<Vec<f64>>> = model.contributors.iter().map(|c| corners(&c.variation)).collect();
    let count = corners.iter().try_fold(1usize, |count, corners| count.checked_mul(corners.len()))?;
    if count > MOST_VERTICES {
        return None;
    }
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; model.measures.len()];
    let vertices: Vec<Vec<f64>> = (0..count)
        .map(|mut number| {
            let corner = |corners: &Vec<Vec<f64>>| {
                let choice = number % corners.len();
                number /= corners.len();
                corners[choice].clone()
            };
            corners.iter().flat_map(corner).collect()
        })
        .collect();
    for values in evaluate(model, &vertices) {
        for ([low, high], value) in ranges.iter_mut().zip(values) {
            (*low, *high) = (low.min(value), high.max(value));
        }
    }
    Some(ranges)
}

fn corners(variation: &Variation) -> Vec<Vec<f64>> {
    match variation {
        Variation::Scalar { distribution: Distribution::Constant(value), .. } => vec![vec![*value]],
        Variation::Scalar { limits, .. } => limits.iter().map(|limit| vec![*limit]).collect(),
        Variation::Nested(zone) => zone.corners(),
        zone @ (Variation::Zone(_) | Variation::Disc(_)) => {
            let count = zone.variables();
            let corner = |k: usize, sign: f64| (0..count).map(|j| if j == k { sign } else { 0.0 }).collect();
            (0..count).flat_map(|k| [corner(k, -1.0), corner(k, 1.0)]).collect()
        }
    }
}
