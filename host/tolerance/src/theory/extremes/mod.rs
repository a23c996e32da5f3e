//! The least and the greatest value of measures that are not linear, over all limits and zones.
//!
//! All corners are computed where these are few. From the best of them, from the middle, from random points and corners and from
//! where each kink is farthest away, a search then climbs: along one contributor after the other, onwards where the last rounds led, and
//! towards the point at which the slopes promise most. On every such line the best place is narrowed down, so that extremes inside of the
//! limits and on the rim of round zones are found as well. The search is deterministic, and its effort is bounded.

mod climb;
mod field;

use rayon::prelude::*;

use self::{climb::Climb, field::Field};
use super::derivative::evaluate;
use crate::{
    model::{Model, Variation},
    numeric::lanes::Lanes,
};

/// Places on a line that are looked at: of a scalar, of a zone, of all contributors together.
const OF_SCALAR: [f64; 6] = [1.0 / 64.0, 0.25, 0.5, 0.75, 63.0 / 64.0, 1.0];
const OF_ZONE: [f64; 2] = [0.5, 1.0];
const OF_ALL: [f64; 6] = [1.0 / 1024.0, 1.0 / 64.0, 0.25, 0.5, 0.75, 1.0];
/// Distances for slopes (shares of half a tolerance or zone): a narrow one, and one that sees beyond a kink.
const STEPS: [f64; 2] = [1e-3, 0.25];

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

/// Variables and the values to which they are moved.
type Change = Vec<(usize, f64)>;

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

/// Places on a line of one contributor.
fn places(variation: &Variation) -> &'static [f64] {
    match variation {
        Variation::Scalar { .. } => &OF_SCALAR,
        Variation::Zone(_) | Variation::Disc(_) | Variation::Nested(_) => &OF_ZONE,
    }
}

/// Points towards which a contributor is moved: its corners, and the middle of a zone.
fn targets(variation: &Variation) -> Vec<Vec<f64>> {
    let mut targets = variation.corners();
    if !matches!(variation, Variation::Scalar { .. }) {
        targets.push(variation.middle());
    }
    targets
}

/// The change of the variables from `at` on to a point.
fn moved_to(at: usize, point: &[f64]) -> Change {
    point.iter().enumerate().map(|(k, value)| (at + k, *value)).collect()
}

/// The change to a place on the line from `point` to the end of `line`, which the part 1 hits exactly.
fn on_line(point: &[f64], line: &Change, part: f64) -> Change {
    let place = |end: f64, start: f64| if part == 1.0 { end } else { start + part * (end - start) };
    line.iter().map(|(k, end)| (*k, place(*end, point[*k]))).collect()
}

/// Numbers of some units at work.
struct Room {
    variables: Vec<Lanes>,
    measures: Vec<Lanes>,
}

impl Room {
    fn new(model: &Model) -> Self {
        Self { variables: vec![Lanes::ZERO; model.variables()], measures: vec![Lanes::ZERO; model.measures.len()] }
    }

    /// Calls `each` with lane and measures of every change of `base`, up to one a lane.
    fn evaluate(&mut self, model: &Model, base: &[f64], changes: &[Change], mut each: impl FnMut(usize, &[Lanes])) {
        self.variables.iter_mut().zip(base).for_each(|(variable, value)| *variable = Lanes::splat(*value));
        for (lane, change) in changes.iter().enumerate() {
            change.iter().for_each(|(k, value)| self.variables[*k].0[lane] = *value);
        }
        model.function.evaluate(&self.variables, &mut self.measures);
        (0..changes.len()).for_each(|lane| each(lane, &self.measures));
    }
}
