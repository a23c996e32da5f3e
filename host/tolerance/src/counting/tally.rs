//! What is counted and summed up over units, so that parts can be joined again.
//!
//! Sums are floating-point and so join in a fixed tree only ([`super::forest`]); counts and extremes join in any order.

use std::collections::BTreeMap;

use crate::{
    model::Model,
    numeric::lanes::{LANES, Lanes, widest},
};

/// Units worked on at a time: their measures fit the innermost cache.
pub const TILE: usize = 256;
/// Bins of a histogram in one standard deviation.
pub const BINS_PER_DEVIATION: f64 = 128.0;
/// Bins of a histogram: [`NEAR`] standard deviations to both sides.
pub const BINS: usize = 2561;
/// How far (standard deviations) the bins reach. What lies beyond, such as a small lot far away, is in [`MeasureCounts::far`].
pub const NEAR: f64 = 10.0;
/// Bins beyond in each doubling of the distance, and doublings.
const FAR_BINS: f64 = 1024.0;
const DOUBLINGS: f64 = 64.0;
/// 2⁵²: a number added to it has its integer part in the low bits.
const MAGIC: f64 = 4_503_599_627_370_496.0;

/// Where the numbers of a measure are seen from, so that sums of powers lose no digits and bins fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// About its mean.
    pub origin: f64,
    /// About its standard deviation, positive.
    pub scale: f64,
}

/// Sums over units of d, d², d³, d⁴ and of the products of two measures' d = (value − origin)/scale.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sums {
    /// Of each measure.
    pub powers: Vec<[f64; 4]>,
    /// Of measures j < i, row after row.
    pub products: Vec<f64>,
}

/// What is counted.
#[derive(Clone, Debug, PartialEq)]
pub struct Counts {
    /// Units.
    pub units: u64,
    /// Units with a measure that is out of its limits or cannot be computed.
    pub rejected: u64,
    /// Of each measure.
    pub measures: Vec<MeasureCounts>,
    /// Units in which each of the model's sums is negative.
    pub closed: Vec<u64>,
}

/// What is counted of one measure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureCounts {
    /// Units in which it cannot be computed.
    pub undefined: u64,
    /// Units below the lower and above the upper limit.
    pub outside: [u64; 2],
    /// Least and greatest value.
    pub extremes: [f64; 2],
    /// Units that have exactly these values: many where something stops, such as a gap at nothing.
    pub at_extremes: [u64; 2],
    /// Units a bin; bin k is centred (k − 1280)/128 standard deviations from the frame's origin.
    pub bins: Vec<u64>,
    /// Units beyond the bins, by the bins of [`far_ends`].
    pub far: BTreeMap<i32, u64>,
}

/// The bin beyond all others of a value `d` (standard deviations) with |d| > [`NEAR`]: positive above, negative below.
fn far_bin(d: f64) -> i32 {
    let doublings = libm::log2(d.abs() / NEAR).clamp(0.0, DOUBLINGS);
    let bin = 1 + (doublings * FAR_BINS) as i32;
    if d > 0.0 { bin } else { -bin }
}

/// Both ends (standard deviations) of such a bin, in order.
pub fn far_ends(bin: i32) -> [f64; 2] {
    let end = |k: i32| NEAR * libm::exp2(f64::from(k) / FAR_BINS);
    let [low, high] = [end(bin.abs() - 1), end(bin.abs())];
    if bin > 0 { [low, high] } else { [-high, -low] }
}

impl Sums {
    /// Of no units with `measures` measures.
    pub fn new(measures: usize) -> Self {
        Self { powers: vec![[0.0; 4]; measures], products: vec![0.0; measures * (measures - 1) / 2] }
    }

    /// Both together.
    pub fn joined(mut self, right: &Self) -> Self {
        let powers = self.powers.iter_mut().flatten().zip(right.powers.iter().flatten());
        powers.chain(self.products.iter_mut().zip(&right.products)).for_each(|(a, b)| *a += b);
        self
    }
}

impl Counts {
    /// Of no units of `model`.
    pub fn new(model: &Model) -> Self {
        let measure = MeasureCounts {
            undefined: 0,
            outside: [0; 2],
            extremes: [f64::INFINITY, f64::NEG_INFINITY],
            at_extremes: [0; 2],
            bins: vec![0; BINS],
            far: BTreeMap::new(),
        };
        Self { units: 0, rejected: 0, measures: vec![measure; model.measures.len()], closed: vec![0; model.sums.len()] }
    }

    /// Both together.
    pub fn join(&mut self, other: &Self) {
        self.units += other.units;
        self.rejected += other.rejected;
        add(&mut self.closed, &other.closed);
        for (one, other) in self.measures.iter_mut().zip(&other.measures) {
            one.undefined += other.undefined;
            add(&mut one.outside, &other.outside);
            add(&mut one.bins, &other.bins);
            other.far.iter().for_each(|(bin, units)| *one.far.entry(*bin).or_default() += units);
            one.stretch(other.extremes, other.at_extremes);
        }
    }
}

impl MeasureCounts {
    /// Takes in the extremes of other units, and how many have them.
    fn stretch(&mut self, [least, greatest]: [f64; 2], at: [u64; 2]) {
        let further = [least < self.extremes[0], greatest > self.extremes[1]];
        for ((side, other), further) in [least, greatest].into_iter().enumerate().zip(further) {
            if further {
                (self.extremes[side], self.at_extremes[side]) = (other, at[side]);
            } else if other == self.extremes[side] {
                self.at_extremes[side] += at[side];
            }
        }
    }
}

fn add(to: &mut [u64], from: &[u64]) {
    to.iter_mut().zip(from).for_each(|(a, b)| *a += b);
}

/// The measures of up to [`TILE`] units, one row a measure.
pub struct Tile<'a> {
    model: &'a Model,
    frames: &'a [Frame],
    rows: Vec<[f64; TILE]>,
    rejected: [bool; TILE],
}

impl<'a> Tile<'a> {
    /// For units of `model`, seen from `frames`.
    pub fn new(model: &'a Model, frames: &'a [Frame]) -> Self {
        Self { model, frames, rows: vec![[0.0; TILE]; model.measures.len()], rejected: [false; TILE] }
    }

    /// Room for the measures of all units, one row a measure.
    pub fn rows(&mut self) -> &mut [[f64; TILE]] {
        &mut self.rows
    }

    /// Adds the first `units` of the rows to `sums` and `counts`. The rows are used up.
    pub fn add_to(&mut self, units: usize, sums: &mut Sums, counts: &mut Counts) {
        widest(
            #[inline(always)]
            || self.add_to_here(units, sums, counts),
        );
    }

    #[inline(always)]
    fn add_to_here(&mut self, units: usize, sums: &mut Sums, counts: &mut Counts) {
        counts.units += units as u64;
        for (sum, closed) in self.model.sums.iter().zip(&mut counts.closed) {
            let mut total = [0.0; TILE];
            for measure in &sum.measures {
                total.iter_mut().zip(&self.rows[*measure]).for_each(|(total, value)| *total += value);
            }
            *closed += total[..units].iter().filter(|total| **total < 0.0).count() as u64;
        }
        self.rejected.fill(false);
        for (measure, row) in self.rows.iter_mut().enumerate() {
            let counts = &mut counts.measures[measure];
            count(&row[..units], self.model.measures[measure].limits, counts, &mut self.rejected);
            let Frame { origin, scale } = self.frames[measure];
            let inverse = 1.0 / scale;
            for value in row.iter_mut() {
                *value = (*value - origin) * inverse;
            }
            // Nothing is summed of what is not there.
            row[units..].fill(0.0);
            // All places first, which vectors do.
            let mut places = [0; TILE];
            for (place, value) in places.iter_mut().zip(row.iter()) {
                let at = value.clamp(-NEAR, NEAR) * BINS_PER_DEVIATION + (MAGIC + (BINS / 2) as f64);
                *place = (at.to_bits() & 0xfff).min(BINS as u64 - 1);
            }
            for place in &places[..units] {
                counts.bins[*place as usize] += 1;
            }
            if row[..units].iter().any(|value| value.abs() > NEAR) {
                for (place, value) in places.iter().zip(&row[..units]).filter(|(_, value)| value.abs() > NEAR) {
                    counts.bins[*place as usize] -= 1;
                    *counts.far.entry(far_bin(*value)).or_default() += 1;
                }
            }
            if counts.undefined > 0 {
                for value in row[..units].iter_mut().filter(|value| value.is_nan()) {
                    *value = 0.0;
                    counts.bins[NAN_BIN] -= 1;
                }
            }
            let powers = powers(row);
            sums.powers[measure].iter_mut().zip(powers).for_each(|(sum, power)| *sum += power);
        }
        counts.rejected += self.rejected[..units].iter().filter(|rejected| **rejected).count() as u64;
        let mut products = sums.products.iter_mut();
        for (i, row) in self.rows.iter().enumerate() {
            for (other, product) in self.rows[..i].iter().zip(&mut products) {
                *product += dot(row, other);
            }
        }
    }
}

/// Where the place of a value that is not a number ends up.
const NAN_BIN: usize = 0;

#[inline(always)]
fn count(values: &[f64], limits: [Option<f64>; 2], counts: &mut MeasureCounts, rejected: &mut [bool]) {
    let ([least, greatest], sum) = range(values);
    // Hardly any tile has new ones.
    if least <= counts.extremes[0] || greatest >= counts.extremes[1] {
        let equal = |extreme: f64| values.iter().filter(|value| **value == extreme).count() as u64;
        counts.stretch([least, greatest], [equal(least), equal(greatest)]);
    }
    if !sum.is_finite() {
        for (value, rejected) in values.iter().zip(rejected.iter_mut()) {
            counts.undefined += u64::from(value.is_nan());
            *rejected |= value.is_nan();
        }
    }
    let [lower, upper] = [limits[0].unwrap_or(f64::NEG_INFINITY), limits[1].unwrap_or(f64::INFINITY)];
    // Most tiles are good as a whole.
    if least < lower || greatest > upper {
        for (value, rejected) in values.iter().zip(rejected) {
            counts.outside[0] += u64::from(*value < lower);
            counts.outside[1] += u64::from(*value > upper);
            *rejected |= *value < lower || *value > upper;
        }
    }
}

/// Least and greatest of the values that are numbers, and the sum of all, eight apart, so that they are vectors.
#[inline(always)]
fn range(values: &[f64]) -> ([f64; 2], f64) {
    let (mut least, mut greatest, mut sums) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES], [0.0; LANES]);
    let (groups, rest) = values.as_chunks::<LANES>();
    let mut add = |lane: usize, value: f64| {
        least[lane] = if value < least[lane] { value } else { least[lane] };
        greatest[lane] = if value > greatest[lane] { value } else { greatest[lane] };
        sums[lane] += value;
    };
    for group in groups {
        for (lane, value) in group.iter().enumerate() {
            add(lane, *value);
        }
    }
    rest.iter().enumerate().for_each(|(lane, value)| add(lane, *value));
    let least = least.into_iter().fold(f64::INFINITY, f64::min);
    ([least, greatest.into_iter().fold(f64::NEG_INFINITY, f64::max)], sums.iter().sum())
}

/// Sums of the first four powers, eight apart, so that they are vectors.
#[inline(always)]
fn powers(row: &[f64; TILE]) -> [f64; 4] {
    // One operation on all lanes after another: otherwise the four sums of a lane become a vector, which is slower.
    let [mut one, mut two, mut three, mut four] = [Lanes::ZERO; 4];
    for values in row.as_chunks::<LANES>().0 {
        let d = Lanes(*values);
        let square = d * d;
        one += d;
        two += square;
        three += square * d;
        four += square * square;
    }
    [total(&one.0), total(&two.0), total(&three.0), total(&four.0)]
}

#[inline(always)]
fn dot(one: &[f64; TILE], other: &[f64; TILE]) -> f64 {
    let mut sums = [0.0; LANES];
    for (a, b) in one.chunks_exact(LANES).zip(other.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    total(&sums)
}

/// Lane after lane.
#[inline(always)]
fn total(lanes: &[f64; LANES]) -> f64 {
    let mut total = 0.0;
    for lane in lanes {
        total += lane;
    }
    total
}
