//! The least and the greatest value of measures that are not linear, over all limits and zones.
//!
//! All corners are computed where these are few. From the best of them, from the middle, from random points and from where
//! each kink is farthest away, a search then climbs: along each contributor alone, along all of them together, and towards the
//! point at which the slopes promise most. On every such line the best place is narrowed down, so that extremes inside of the
//! limits and on the rim of round zones are found as well. The search is deterministic, and its effort is bounded.

use rayon::prelude::*;
use slipfit_core::sampling::stream::mix;

use super::derivative::evaluate;
use crate::tolerance::model::{
    Model, Variation,
    lanes::{LANES, Lanes},
};

/// The most combinations of corners that are computed.
const MOST_CORNERS: usize = 1 << 16;
/// Points that are computed at a time.
const CHUNK: usize = 1 << 12;
/// Corners and random points inside that each search starts from: the best of all that were computed.
const BEST: usize = 2;
/// Random points inside that are computed, and random corners to start from.
const INSIDE: u64 = 256;
const RANDOM: u64 = 4;
/// The most kinks whose farthest points are starts.
const KINKS: usize = 16;
/// Contributors up to which a search has many starts; and up to which it has some.
const FEW: usize = 32;
const WIDE: usize = 512;
/// Starts of a search with few, more and very many contributors.
const STARTS: [usize; 3] = [24, 6, 2];
/// The most rounds of a climb.
const ROUNDS: usize = 60;
/// A gain (share of the spread of the starts) that no longer counts.
const STILL: f64 = 1e-12;
/// Places on a line that are looked at: of a scalar, of a zone, of all contributors together.
const OF_SCALAR: [f64; 6] = [1.0 / 64.0, 0.25, 0.5, 0.75, 63.0 / 64.0, 1.0];
const OF_ZONE: [f64; 2] = [0.5, 1.0];
const OF_ALL: [f64; 6] = [1.0 / 1024.0, 1.0 / 64.0, 0.25, 0.5, 0.75, 1.0];
/// Width (share of a line) up to which the best place is narrowed down.
const NARROW: f64 = 1e-10;
/// Distances for slopes (shares of half a tolerance or zone): a narrow one, and one that sees beyond a kink.
const STEPS: [f64; 2] = [1e-3, 0.25];

/// What was found of a measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Least and greatest value (SI); not in order if it cannot be computed anywhere.
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
            found.range[side] = sign * best;
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
        let values = evaluate(model, &points.collect::<Vec<_>>());
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

/// A model with what all searches of its measures start from.
struct Field<'a> {
    model: &'a Model,
    offsets: Vec<usize>,
    /// Where every search can start: the middle first.
    starts: Vec<Vec<f64>>,
    /// Of each measure and side, the best points of all that were computed.
    best: Vec<[Vec<(f64, Vec<f64>)>; 2]>,
    /// Whether a measure cannot be computed at one of these.
    undefined: Vec<bool>,
    /// Of each measure, the contributors that move it at any start.
    moving: Vec<Vec<usize>>,
}

impl<'a> Field<'a> {
    fn new(model: &'a Model) -> Self {
        let count = model.measures.len();
        let mut field = Self {
            model,
            offsets: model.offsets(),
            starts: vec![model.middles()],
            best: vec![[Vec::new(), Vec::new()]; count],
            undefined: vec![false; count],
            moving: Vec::new(),
        };
        let corners: Vec<_> = model.contributors.iter().map(|contributor| contributor.variation.corners()).collect();
        let all = corners.iter().try_fold(1usize, |all, corners| all.checked_mul(corners.len()));
        match all.filter(|all| *all <= MOST_CORNERS) {
            Some(all) => field.compute((0..all).map(|mut number| {
                let corner = |corners: &Vec<Vec<f64>>| {
                    let choice = number % corners.len();
                    number /= corners.len();
                    corners[choice].clone()
                };
                corners.iter().flat_map(corner).collect()
            })),
            None => field.starts.extend((0..RANDOM).map(|number| {
                let corner = |(i, corners): (usize, &Vec<Vec<f64>>)| {
                    corners[(mix(number << 32 | i as u64) % corners.len() as u64) as usize].clone()
                };
                corners.iter().enumerate().flat_map(corner).collect()
            })),
        }
        field.compute((0..INSIDE).map(|number| inside(model, number)));
        field.starts.extend(at_kinks(model, &field.offsets));
        field.moving = field.moving();
        field
    }

    /// Computes the measures at points and keeps the best.
    fn compute(&mut self, points: impl Iterator<Item = Vec<f64>>) {
        let mut points = points.peekable();
        let mut kept = vec![[Vec::new(), Vec::new()]; self.best.len()];
        while points.peek().is_some() {
            let chunk: Vec<Vec<f64>> = points.by_ref().take(CHUNK).collect();
            for (point, values) in chunk.iter().zip(evaluate(self.model, &chunk)) {
                for ((value, kept), undefined) in values.into_iter().zip(&mut kept).zip(&mut self.undefined) {
                    *undefined |= !value.is_finite();
                    for (kept, sign) in kept.iter_mut().zip([-1.0, 1.0]) {
                        keep(kept, sign * value, point);
                    }
                }
            }
        }
        for (best, kept) in self.best.iter_mut().zip(kept) {
            best.iter_mut().zip(kept).for_each(|(best, kept)| best.extend(kept));
        }
    }

    /// Contributors that move a measure at any start, measure by measure.
    fn moving(&self) -> Vec<Vec<usize>> {
        let contributors = &self.model.contributors;
        let mut moves = vec![vec![false; contributors.len()]; self.best.len()];
        let room = &mut Room::new(self.model);
        for (number, start) in self.starts.iter().enumerate() {
            let here = evaluate(self.model, std::slice::from_ref(start)).concat();
            let change = |i: usize| {
                let own = &start[self.offsets[i]..];
                let mut corners = contributors[i].variation.corners();
                corners.retain(|corner| !own.starts_with(corner));
                let choice = mix((number as u64) << 32 | i as u64) % (corners.len() as u64).max(1);
                corners.get(choice as usize).map_or_else(Vec::new, |corner| moved_to(self.offsets[i], corner))
            };
            let changes: Vec<Change> = (0..contributors.len()).map(change).collect();
            for (first, group) in changes.chunks(LANES).enumerate() {
                room.evaluate(self.model, start, group, |lane, measures| {
                    let i = LANES * first + lane;
                    for ((moves, here), there) in moves.iter_mut().zip(&here).zip(measures) {
                        moves[i] |= there.0[lane] != *here;
                    }
                });
            }
        }
        let chosen = |moves: &Vec<bool>| {
            (0..moves.len()).filter(|i| moves[*i] && !contributors[*i].variation.is_fixed()).collect()
        };
        moves.iter().map(chosen).collect()
    }
}

/// Keeps a value and its point, if it is among the best.
fn keep(kept: &mut Vec<(f64, Vec<f64>)>, value: f64, point: &[f64]) {
    if value.is_finite() && (kept.len() < BEST || kept.iter().any(|(other, _)| value > *other)) {
        kept.push((value, point.to_vec()));
        kept.sort_by(|(one, _), (other, _)| other.total_cmp(one));
        kept.truncate(BEST);
    }
}

/// A random point within all limits and zones.
fn inside(model: &Model, number: u64) -> Vec<f64> {
    let uniform = |i: usize| (mix(mix(number + 1) ^ i as u64) >> 11) as f64 / (1u64 << 53) as f64;
    let of = |(i, contributor): (usize, &crate::tolerance::model::Contributor)| {
        let variation = &contributor.variation;
        if let Variation::Scalar { limits: [low, high], .. } = variation {
            return vec![if variation.is_fixed() {
                variation.corners()[0][0]
            } else {
                low + (high - low) * uniform(i)
            }];
        }
        let corners = variation.corners();
        let corner = &corners[(mix(!number ^ (i as u64) << 20) % corners.len() as u64) as usize];
        corner.iter().map(|x| x * uniform(i)).collect()
    };
    model.contributors.iter().enumerate().flat_map(of).collect()
}

/// The points at which what decides on each kink is least and greatest, by its slopes in the middle: a measure may be level
/// everywhere but there.
fn at_kinks(model: &Model, offsets: &[usize]) -> Vec<Vec<f64>> {
    let centre: Vec<Lanes> = model.middles().into_iter().map(Lanes::splat).collect();
    let count = model.function.kinks(&centre).len().min(KINKS);
    let mut slopes = vec![vec![0.0; centre.len()]; count];
    if count == 0 {
        return Vec::new();
    }
    for (contributor, at) in model.contributors.iter().zip(offsets) {
        let step = match contributor.variation {
            Variation::Scalar { limits: [low, high], .. } => 0.5 * STEPS[1] * (high - low),
            _ => STEPS[1],
        };
        for k in *at..at + contributor.variation.variables() {
            let mut moved = centre.clone();
            moved[k].0[0] -= step;
            moved[k].0[1] += step;
            for (slopes, kink) in slopes.iter_mut().zip(model.function.kinks(&moved)) {
                slopes[k] = kink.0[1] - kink.0[0];
            }
        }
    }
    let farthest = |slopes: &Vec<f64>, sign: f64| -> Vec<f64> {
        let of = |(contributor, at): (&crate::tolerance::model::Contributor, &usize)| {
            let own = &slopes[*at..at + contributor.variation.variables()];
            contributor.variation.farthest(&own.iter().map(|slope| sign * slope).collect::<Vec<_>>())
        };
        model.contributors.iter().zip(offsets).flat_map(of).collect()
    };
    slopes.iter().flat_map(|slopes| [-1.0, 1.0].map(|sign| farthest(slopes, sign))).collect()
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

    /// Calls `each` with lane and measures of every change of `base`, up to [`LANES`] of them.
    fn evaluate(&mut self, model: &Model, base: &[f64], changes: &[Change], mut each: impl FnMut(usize, &[Lanes])) {
        self.variables.iter_mut().zip(base).for_each(|(variable, value)| *variable = Lanes::splat(*value));
        for (lane, change) in changes.iter().enumerate() {
            change.iter().for_each(|(k, value)| self.variables[*k].0[lane] = *value);
        }
        model.function.evaluate(&self.variables, &mut self.measures);
        (0..changes.len()).for_each(|lane| each(lane, &self.measures));
    }
}

/// The search for the greatest value of a measure, or of its negative.
struct Climb<'a> {
    field: &'a Field<'a>,
    measure: usize,
    side: usize,
    room: Room,
    undefined: bool,
}

impl<'a> Climb<'a> {
    fn new(field: &'a Field, measure: usize, side: usize) -> Self {
        Self { field, measure, side, room: Room::new(field.model), undefined: false }
    }

    /// The greatest value that any climb reaches, and whether a point without a value was met.
    fn best(mut self) -> (f64, bool) {
        let own = &self.field.best[self.measure][self.side];
        let points: Vec<Vec<f64>> =
            self.field.starts.iter().chain(own.iter().map(|(_, point)| point)).cloned().collect();
        let mut starts: Vec<(f64, Vec<f64>)> = Vec::new();
        for point in points {
            let value = self.values(&point, &[Vec::new()])[0];
            if !starts.iter().any(|(_, other)| *other == point) {
                starts.push((value, point));
            }
        }
        let finite = || starts.iter().map(|(value, _)| *value).filter(|value| value.is_finite());
        let spread = finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min);
        let still = STILL * if spread.is_finite() { spread } else { 0.0 };
        // The middle stays the first.
        starts[1..].sort_by(|(one, _), (other, _)| other.total_cmp(one));
        let moving = self.field.moving[self.measure].len();
        let count = STARTS[usize::from(moving > FEW) + usize::from(moving > WIDE)];
        let best = starts.into_iter().take(count).map(|(value, point)| self.climbed(value, point, still));
        let best = best.fold(f64::NEG_INFINITY, f64::max);
        (best, self.undefined)
    }

    /// The value at every change of `base`, −∞ where there is none.
    fn values(&mut self, base: &[f64], changes: &[Change]) -> Vec<f64> {
        let values = self.signed(base, changes);
        self.undefined |= values.iter().any(|value| !value.is_finite());
        values.into_iter().map(|value| if value.is_finite() { value } else { f64::NEG_INFINITY }).collect()
    }

    fn signed(&mut self, base: &[f64], changes: &[Change]) -> Vec<f64> {
        let (measure, sign) = (self.measure, [-1.0, 1.0][self.side]);
        let mut values = Vec::with_capacity(changes.len());
        for group in changes.chunks(LANES) {
            let each = |lane: usize, measures: &[Lanes]| values.push(sign * measures[measure].0[lane]);
            self.room.evaluate(self.field.model, base, group, each);
        }
        values
    }

    /// The highest value on the way up from a point.
    fn climbed(&mut self, mut best: f64, mut point: Vec<f64>, still: f64) -> f64 {
        for _ in 0..ROUNDS {
            let Some((value, change)) = self.step(&point, best) else { break };
            let gain = value - best;
            change.into_iter().for_each(|(k, value)| point[k] = value);
            best = value;
            if gain <= still.max(1e-15 * best.abs()) {
                break;
            }
        }
        best
    }

    /// The best change that was found of a point whose value is `best`; `None` if none is better.
    fn step(&mut self, point: &[f64], best: f64) -> Option<(f64, Change)> {
        let field = self.field;
        let mut lines = Vec::new();
        let (mut joint, mut chosen) = (Change::new(), (best, Change::new(), 0.0, OF_SCALAR.as_slice()));
        for i in &field.moving[self.measure] {
            let variation = &field.model.contributors[*i].variation;
            let parts = places(variation);
            for target in targets(variation) {
                let line = moved_to(field.offsets[*i], &target);
                lines.push((*i, line, parts));
            }
        }
        let changes: Vec<Change> = lines
            .iter()
            .flat_map(|(_, line, parts)| parts.iter().map(move |part| on_line(point, line, *part)))
            .collect();
        let mut values = self.values(point, &changes).into_iter().zip(changes);
        let mut own: Option<(usize, f64, Change)> = None;
        for (i, line, parts) in lines {
            for (part, (value, change)) in parts.iter().zip(values.by_ref()) {
                if value > chosen.0 {
                    chosen = (value, line.clone(), *part, parts);
                }
                let before = own.as_ref().filter(|(of, ..)| *of == i).map_or(best, |(_, value, _)| *value);
                if value > before {
                    if let Some((of, _, change)) = own.take()
                        && of != i
                    {
                        joint.extend(change);
                    }
                    own = Some((i, value, change));
                }
            }
        }
        joint.extend(own.into_iter().flat_map(|(_, _, change)| change));
        let mut all = vec![joint];
        all.extend(STEPS.map(|step| self.promised(point, step)));
        for line in all.into_iter().filter(|line| !line.is_empty()) {
            let changes: Vec<Change> = OF_ALL.iter().map(|part| on_line(point, &line, *part)).collect();
            for (part, value) in OF_ALL.iter().zip(self.values(point, &changes)) {
                if value > chosen.0 {
                    chosen = (value, line.clone(), *part, &OF_ALL);
                }
            }
        }
        let (value, line, part, parts) = chosen;
        (value > best).then(|| self.narrowed(point, &line, value, part, parts))
    }

    /// The best place on a line, near to the best of some `parts`.
    fn narrowed(
        &mut self,
        point: &[f64],
        line: &Change,
        mut value: f64,
        mut part: f64,
        parts: &[f64],
    ) -> (f64, Change) {
        let at = parts.iter().position(|other| *other == part).unwrap_or(0);
        let mut low = if at > 0 { parts[at - 1] } else { 0.0 };
        let mut high = parts.get(at + 1).copied().unwrap_or(1.0);
        while part < 1.0 && high - low > NARROW {
            let step = (high - low) / (LANES + 1) as f64;
            let parts: [f64; LANES] = std::array::from_fn(|k| low + step * (k + 1) as f64);
            let values = self.values(point, &parts.map(|part| on_line(point, line, part)));
            for (other, found) in parts.into_iter().zip(values) {
                if found > value {
                    (value, part) = (found, other);
                }
            }
            (low, high) = (low.max(part - step), high.min(part + step));
        }
        (value, on_line(point, line, part))
    }

    /// The point at which slopes over a `step` promise most.
    fn promised(&mut self, point: &[f64], step: f64) -> Change {
        let field = self.field;
        let mut ends = Vec::new();
        let mut changes = Vec::new();
        for i in &field.moving[self.measure] {
            let (variation, at) = (&field.model.contributors[*i].variation, field.offsets[*i]);
            for k in at..at + variation.variables() {
                let [low, high] = match variation {
                    Variation::Scalar { limits: [low, high], .. } => {
                        let step = 0.5 * step * (high - low);
                        [f64::max(point[k] - step, *low), f64::min(point[k] + step, *high)]
                    }
                    _ => [point[k] - step, point[k] + step],
                };
                changes.extend([vec![(k, low)], vec![(k, high)]]);
                ends.push(high - low);
            }
        }
        // Beyond the zone: what is found there shows slopes only.
        let values = self.signed(point, &changes);
        let slopes = values.chunks(2).zip(ends).map(|(pair, width)| (pair[1] - pair[0]) / width);
        let slopes: Vec<f64> = slopes.map(|slope| if slope.is_finite() { slope } else { 0.0 }).collect();
        let mut next = slopes.as_slice();
        let mut line = Change::new();
        for i in &field.moving[self.measure] {
            let variation = &field.model.contributors[*i].variation;
            let (own, rest) = next.split_at(variation.variables());
            next = rest;
            if own.iter().any(|slope| *slope != 0.0) {
                line.extend(moved_to(field.offsets[*i], &variation.farthest(own)));
            }
        }
        line
    }
}
