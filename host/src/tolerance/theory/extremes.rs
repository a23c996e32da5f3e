//! The worst case of measures that slopes do not describe: a search over limits, zones, rims and the inside.

use std::f64::consts::TAU;

use slipfit_core::sampling::stream::mix;

use super::{derivative::evaluate, worst_case::middle};
use crate::tolerance::model::{Contributor, Distribution, Model, Variation};

/// Points on the rim of a disc.
const RIM: usize = 24;
/// Parts of the way to a corner that are tried, and whole ones.
const PARTS: [f64; 9] = [1.0, 0.75, 0.5, 0.25, 0.1, 0.03, 0.01, 1e-3, 1e-4];
/// Rounds through all contributors.
const ROUNDS: usize = 40;
/// Contributors beyond which one start and one round have to do.
const WIDE: usize = 512;
/// Random corners that a search starts from, beside the middle.
const STARTS: u64 = 4;

/// Least and greatest value of `measure` that was found.
pub fn extremes(model: &Model, measure: usize) -> [f64; 2] {
    [-1.0, 1.0].map(|sign| {
        let wide = model.contributors.len() > WIDE;
        let starts = (0..=if wide { 0 } else { STARTS }).map(|number| start(model, number));
        let best = starts.map(|start| climbed(model, measure, sign, start)).filter(|value| value.is_finite());
        sign * best.fold(f64::NEG_INFINITY, f64::max)
    })
}

/// How far every contributor alone moves `measure`, all others in the middle: half of the range.
pub fn reaches(model: &Model, measure: usize) -> Vec<f64> {
    let centre = start(model, 0);
    let of = |(contributor, at): (&Contributor, usize)| {
        let points: Vec<_> = moves(&contributor.variation, at, &centre);
        let values = evaluate(model, &points);
        let (low, high) = values
            .iter()
            .map(|value| value[measure])
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low <= high { 0.5 * (high - low) } else { 0.0 }
    };
    model.contributors.iter().zip(model.offsets()).map(of).collect()
}

/// The middle, or a random corner.
fn start(model: &Model, number: u64) -> Vec<f64> {
    let of = |(i, contributor): (usize, &Contributor)| {
        let corners = corners(&contributor.variation);
        if number == 0 || corners.is_empty() {
            return middle(&contributor.variation);
        }
        corners[(mix(number << 32 | i as u64) % corners.len() as u64) as usize].clone()
    };
    model.contributors.iter().enumerate().flat_map(of).collect()
}

/// The highest value of `sign` · `measure` on the way up from a point, a contributor after the other.
fn climbed(model: &Model, measure: usize, sign: f64, mut point: Vec<f64>) -> f64 {
    let offsets = model.offsets();
    let value = |point: &Vec<f64>| sign * evaluate(model, std::slice::from_ref(point))[0][measure];
    let mut best = value(&point);
    for _ in 0..if model.contributors.len() > WIDE { 1 } else { ROUNDS } {
        let before = best;
        for (contributor, at) in model.contributors.iter().zip(&offsets) {
            let points = moves(&contributor.variation, *at, &point);
            let values = evaluate(model, &points);
            for (moved, values) in points.into_iter().zip(values) {
                let value = sign * values[measure];
                if value > best || (best.is_nan() && !value.is_nan()) {
                    (best, point) = (value, moved);
                }
            }
        }
        if best - before <= 1e-12 * best.abs() {
            break;
        }
    }
    best
}

/// Points on the way from `point` to the corners of a contributor whose first variable is `at`.
fn moves(variation: &Variation, at: usize, point: &[f64]) -> Vec<Vec<f64>> {
    let to = |corner: &Vec<f64>, part: f64| {
        let mut moved = point.to_vec();
        moved[at..].iter_mut().zip(corner).for_each(|(x, corner)| *x += part * (corner - *x));
        moved
    };
    corners(variation).iter().flat_map(|corner| PARTS.map(|part| to(corner, part))).collect()
}

/// Points that a zone is spanned by: its corners, or some of its rim.
fn corners(variation: &Variation) -> Vec<Vec<f64>> {
    match variation {
        Variation::Scalar { distribution: Distribution::Constant(_), .. } => Vec::new(),
        Variation::Scalar { limits, .. } => limits.iter().map(|limit| vec![*limit]).collect(),
        Variation::Disc(_) => {
            let angles = (0..RIM).map(|k| TAU * k as f64 / RIM as f64);
            angles.map(|angle| vec![libm::cos(angle), libm::sin(angle)]).collect()
        }
        Variation::Nested(zone) => zone.corners(),
        zone @ Variation::Zone(_) => {
            let count = zone.variables();
            let corner = |k: usize, sign: f64| (0..count).map(|j| if j == k { sign } else { 0.0 }).collect();
            (0..count).flat_map(|k| [corner(k, -1.0), corner(k, 1.0)]).collect()
        }
    }
}
