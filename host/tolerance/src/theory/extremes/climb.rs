//! The search for the greatest value of one measure.

use super::{
    field::Field,
    line::{Change, OF_ALL, Room, STEPS, moved_to, on_line, places, targets},
};
use crate::{
    model::Variation,
    numeric::lanes::{LANES, Lanes},
};

/// Contributors up to which a search has many starts; and up to which it has some.
const FEW: usize = 32;
const WIDE: usize = 512;
/// Starts of a search with few, more and very many contributors.
const STARTS: [usize; 3] = [24, 6, 2];
/// The most rounds of a climb.
const ROUNDS: usize = 60;
/// How far a climb goes on in the direction of its last two rounds, over what these moved it.
const ONWARDS: f64 = 16.0;
/// A gain (share of the spread of the starts) that no longer counts.
const STILL: f64 = 1e-12;
/// Width (share of a line) up to which the best place is narrowed down.
const NARROW: f64 = 1e-10;

/// The search for the greatest value of a measure, or of its negative.
pub(super) struct Climb<'a> {
    field: &'a Field<'a>,
    measure: usize,
    side: usize,
    room: Room,
    undefined: bool,
}

impl<'a> Climb<'a> {
    /// Of a measure from below (side 0), or from above.
    pub fn new(field: &'a Field<'a>, measure: usize, side: usize) -> Self {
        Self { field, measure, side, room: Room::new(field.model), undefined: false }
    }

    /// The greatest value that any climb reaches, and whether a point without a value was met.
    pub fn best(mut self) -> (f64, bool) {
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
        // Where the climb was a round and two rounds ago.
        let mut before = [point.clone(), point.clone()];
        for _ in 0..ROUNDS {
            let start = best;
            let here = point.clone();
            let onwards = self.onwards(&point, &before[1]);
            self.round(&mut point, &mut best, onwards);
            let [last, _] = before;
            before = [here, last];
            if best - start <= still.max(1e-15 * best.abs()) {
                break;
            }
        }
        best
    }

    /// Onwards from where a climb was `before`, within the limits: along a ridge, on which single rounds go to and fro.
    fn onwards(&self, point: &[f64], before: &[f64]) -> Change {
        let field = self.field;
        let along = |i: &usize| {
            let Variation::Scalar { limits: [low, high], .. } = field.model.contributors[*i].variation else {
                return None;
            };
            let k = field.offsets[*i];
            let end = (point[k] + ONWARDS * (point[k] - before[k])).max(low).min(high);
            (end != point[k]).then_some((k, end))
        };
        field.moving[self.measure].iter().filter_map(along).collect()
    }

    /// Moves a `point` whose value is `best` to better ones: along one contributor after the other, then along all of them together, the
    /// line `onwards` among these.
    fn round(&mut self, point: &mut [f64], best: &mut f64, onwards: Change) {
        let field = self.field;
        for i in &field.moving[self.measure] {
            let variation = &field.model.contributors[*i].variation;
            let lines: Vec<Change> =
                targets(variation).iter().map(|target| moved_to(field.offsets[*i], target)).collect();
            self.take_best(point, best, &lines, places(variation));
        }
        let mut lines = vec![onwards];
        lines.extend(STEPS.map(|step| self.promised(point, step)));
        lines.retain(|line| !line.is_empty());
        self.take_best(point, best, &lines, &OF_ALL);
    }

    /// Moves a `point` along the best of some `lines` if it is better there than its value `best`.
    fn take_best(&mut self, point: &mut [f64], best: &mut f64, lines: &[Change], parts: &[f64]) {
        if let Some((value, change)) = self.best_along(point, lines, parts, *best) {
            change.into_iter().for_each(|(k, value)| point[k] = value);
            *best = value;
        }
    }

    /// The best change on any of some `lines`, first at `parts` of them; `None` if none is better than `best`.
    fn best_along(&mut self, point: &[f64], lines: &[Change], parts: &[f64], best: f64) -> Option<(f64, Change)> {
        let places = || lines.iter().flat_map(|line| parts.iter().map(move |part| (line, *part)));
        let changes: Vec<Change> = places().map(|(line, part)| on_line(point, line, part)).collect();
        let values = self.values(point, &changes);
        let better = places().zip(values).filter(|(_, value)| *value > best);
        let ((line, part), value) = better.max_by(|(_, one), (_, other)| one.total_cmp(other))?;
        Some(self.narrowed(point, line, value, part, parts))
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
            for (k, here) in point.iter().enumerate().skip(at).take(variation.variables()) {
                let [low, high] = match variation {
                    Variation::Scalar { limits: [low, high], .. } => {
                        let step = 0.5 * step * (high - low);
                        [f64::max(here - step, *low), f64::min(here + step, *high)]
                    }
                    _ => [here - step, here + step],
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
