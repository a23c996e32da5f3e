//! Where searches of all measures start, and which contributors move a measure.

use slipfit_core::sampling::stream::mix;

use super::line::{Change, Room, STEPS, moved_to};
use crate::{
    model::{Contributor, Model, Variation},
    numeric::lanes::{LANES, Lanes},
    theory::derivative::evaluate,
};

/// The most combinations of corners that are computed.
const MOST_CORNERS: usize = 1 << 16;
/// Points that are computed at a time.
const CHUNK: usize = 1 << 12;
/// Corners and random points inside that each search starts from: the best of all that were computed.
const BEST: usize = 4;
/// Random points inside that are computed, and random corners to start from.
const INSIDE: u64 = 256;
const RANDOM: u64 = 16;
/// The most changes of one contributor that are computed to see what moves a measure.
const MOST_MOVES: usize = 1 << 18;
/// The most kinks whose farthest points are starts.
const KINKS: usize = 16;

/// Values and the points that have them.
type Best = Vec<(f64, Vec<f64>)>;

/// A model with what all searches of its measures start from.
pub(super) struct Field<'a> {
    pub model: &'a Model,
    /// The first variable of every contributor.
    pub offsets: Vec<usize>,
    /// Where every search can start: the middle first.
    pub starts: Vec<Vec<f64>>,
    /// Of each measure and side, the best points of all that were computed.
    pub best: Vec<[Best; 2]>,
    /// The greatest magnitude of a scalar's limit (SI).
    pub size: f64,
    /// Whether a measure cannot be computed at one of these.
    pub undefined: Vec<bool>,
    /// Of each measure, the contributors that move it at any start, or from where any measure is best.
    pub moving: Vec<Vec<usize>>,
}

/// The greatest magnitude of a scalar's limits (SI).
fn size(variation: &Variation) -> f64 {
    match variation {
        Variation::Scalar { limits: [low, high], .. } => low.abs().max(high.abs()),
        Variation::Zone(_) | Variation::Disc(_) | Variation::Nested(_) => 0.0,
    }
}

impl<'a> Field<'a> {
    /// Of a model.
    pub fn new(model: &'a Model) -> Self {
        let count = model.measures.len();
        let mut field = Self {
            model,
            offsets: model.offsets(),
            starts: vec![model.middles()],
            best: vec![[Vec::new(), Vec::new()]; count],
            size: model.contributors.iter().map(|contributor| size(&contributor.variation)).fold(0.0, f64::max),
            undefined: vec![false; count],
            moving: Vec::new(),
        };
        let corners: Vec<_> = model.contributors.iter().map(|contributor| contributor.variation.corners()).collect();
        let all = corners.iter().try_fold(1usize, |all, corners| all.checked_mul(corners.len()));
        if let Some(all) = all.filter(|all| *all <= MOST_CORNERS) {
            field.compute((0..all).map(|mut number| {
                let corner = |corners: &Vec<Vec<f64>>| {
                    let choice = number % corners.len();
                    number /= corners.len();
                    corners[choice].clone()
                };
                corners.iter().flat_map(corner).collect()
            }));
        }
        field.starts.extend((0..RANDOM).map(|number| {
            let corner = |(i, corners): (usize, &Vec<Vec<f64>>)| {
                corners[(mix(number << 32 | i as u64) % corners.len() as u64) as usize].clone()
            };
            corners.iter().enumerate().flat_map(corner).collect()
        }));
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

    /// Contributors that move a measure at any start, or from where any measure is best, measure by measure. A measure that is level at all
    /// corners, as one with a limit of its own is, shows only inside what moves it.
    fn moving(&self) -> Vec<Vec<usize>> {
        let contributors = &self.model.contributors;
        let mut moves = vec![vec![false; contributors.len()]; self.best.len()];
        let room = &mut Room::new(self.model);
        let best = self.best.iter().flatten().flat_map(|best| best.iter().map(|(_, point)| point));
        let most = (MOST_MOVES / contributors.len().max(1)).max(self.starts.len());
        for (number, start) in self.starts.iter().chain(best).take(most).enumerate() {
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
    let of = |(i, contributor): (usize, &Contributor)| {
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

/// The points at which what decides on each kink is least and greatest, by its slopes in the middle, and where it is zero between there and
/// the middle: a measure may be level everywhere but at one of these.
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
    let middles = model.middles();
    let farthest = |slopes: &Vec<f64>, sign: f64| -> Vec<f64> {
        let of = |(contributor, at): (&Contributor, &usize)| {
            let own = &slopes[*at..at + contributor.variation.variables()];
            contributor.variation.farthest(&own.iter().map(|slope| sign * slope).collect::<Vec<_>>())
        };
        model.contributors.iter().zip(offsets).flat_map(of).collect()
    };
    let of_kink = |(kink, slopes): (usize, &Vec<f64>)| {
        let ends = [-1.0, 1.0].map(|sign| farthest(slopes, sign));
        let zeros = ends.clone().map(|end| zero(model, kink, &middles, &end));
        ends.into_iter().chain(zeros.into_iter().flatten())
    };
    slopes.iter().enumerate().flat_map(of_kink).collect()
}

/// Where what decides on a `kink` is zero on the way from one point to another; `None` where it has the same sign at both.
fn zero(model: &Model, kink: usize, from: &[f64], to: &[f64]) -> Option<Vec<f64>> {
    let at = |parts: [f64; LANES]| -> [f64; LANES] {
        let place = |(from, to): (&f64, &f64)| Lanes(parts.map(|part| from + part * (to - from)));
        let points: Vec<Lanes> = from.iter().zip(to).map(place).collect();
        model.function.kinks(&points)[kink].0
    };
    let mut parts = [0.0; LANES];
    parts[1] = 1.0;
    let [start, end, ..] = at(parts);
    let is_between = start * end < 0.0;
    if !is_between {
        return None;
    }
    let (mut low, mut width) = (0.0, 1.0);
    for _ in 0..16 {
        width /= (LANES + 1) as f64;
        let values = at(std::array::from_fn(|lane| low + width * (lane + 1) as f64));
        low += width * values.iter().take_while(|value| **value * start > 0.0).count() as f64;
    }
    Some(from.iter().zip(to).map(|(from, to)| from + low * (to - from)).collect())
}
