//! The least and the greatest value of measures that are not linear, over all limits and zones.
//!
//! All corners are computed where these are few. From the best of them, from the middle, from random points and corners and from
//! where each kink is farthest away, a search then climbs: along one contributor after the other, onwards where the last rounds led, and
//! towards the point at which the slopes promise most. On every such line the best place is narrowed down, so that extremes inside of the
//! limits and on the rim of round zones are found as well. The search is deterministic, and its effort is bounded.

mod climb;
mod field;
mod line;

use rayon::prelude::*;

use self::{
    climb::Climb,
    field::Field,
    line::{moved_to, on_line, places, targets},
};
use super::derivative::evaluate;
use crate::model::{Model, Variation};

/// How many times the values at corners and random points a search exceeds that ends beside a pole.
const POLE: f64 = 1e6;

/// Values below this share of the variables' size may be rounding.
const ROUNDING: f64 = 1e-13;

/// What was found of a measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Least and greatest value (SI), infinite beside a pole; not in order if it cannot be computed anywhere.
    pub range: [f64; 2],
    /// Whether it cannot be computed, or is infinite, at some point that was looked at.
    pub undefined: bool,
}

/// Of each of some `measures`.
pub fn extremes(model: &Model, measures: &[usize]) -> Vec<Extremes> {
    if measures.is_empty() {
        return Vec::new();
    }
    let field = Field::new(model);
    let of = |measure: &usize| {
        let mut found = Extremes { range: [f64::INFINITY, f64::NEG_INFINITY], undefined: field.undefined[*measure] };
        for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let (best, undefined) = Climb::new(&field, *measure, side).best();
            let ordinary = field.best[*measure].iter().flatten().fold(0.0f64, |most, (value, _)| most.max(value.abs()));
            // Where all of these are rounding the measure is level nearly everywhere, which says nothing of poles.
            let is_beside_pole = ordinary > ROUNDING * field.size && best > POLE * ordinary;
            found.range[side] = sign * if is_beside_pole { f64::INFINITY } else { best };
            found.undefined |= undefined;
        }
        found
    };
    measures.par_iter().map(of).collect()
}

/// How far every contributor alone moves `measure`, all others in the middle: half of the range.
pub fn reaches(model: &Model, measure: usize) -> Vec<f64> {
    let centre = model.middles();
    let of = |(variation, at): (&Variation, usize)| {
        let lines = targets(variation).into_iter().map(|target| moved_to(at, &target));
        let changes = lines.flat_map(|line| places(variation).iter().map(move |part| (line.clone(), *part)));
        let points = changes.map(|(line, part)| {
            let mut point = centre.clone();
            on_line(&centre, &line, part).into_iter().for_each(|(k, value)| point[k] = value);
            point
        });
        let values = evaluate(model, &points.chain([centre.clone()]).collect::<Vec<_>>());
        let (low, high) = values
            .iter()
            .map(|value| value[measure])
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low <= high { 0.5 * (high - low) } else { 0.0 }
    };
    model.contributors.iter().map(|contributor| &contributor.variation).zip(model.offsets()).map(of).collect()
}
