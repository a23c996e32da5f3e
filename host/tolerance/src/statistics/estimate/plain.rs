//! Statistics of tallies without their errors.

use std::collections::BTreeMap;

use crate::{
    counting::{
        study::Tally,
        tally::{BINS, BINS_PER_DEVIATION, Frame, MeasureCounts, NEAR, Sums, far_ends},
    },
    model::loss::Loss,
    numeric::shape::{Shape, weighted},
    statistics::interval,
};

/// Statistics without errors.
pub(super) struct Plain<'a> {
    pub units: u64,
    pub rejected: u64,
    pub closed: Vec<u64>,
    pub measures: Vec<PlainMeasure<'a>>,
    pub sums: Sums,
}

pub(super) struct PlainMeasure<'a> {
    pub units: u64,
    pub undefined: u64,
    pub outside: [u64; 2],
    pub mean: f64,
    pub deviation: f64,
    /// Not a number for a measure that does not vary.
    pub skewness: f64,
    /// The same.
    pub kurtosis: f64,
    pub extremes: [f64; 2],
    pub frame: Frame,
    pub parts: Vec<&'a MeasureCounts>,
    /// Bins with units in them, ascending.
    cells: Vec<Cell>,
}

/// A bin with units in it.
#[derive(Clone, Copy)]
struct Cell {
    /// Both ends (standard deviations of the frame).
    ends: [f64; 2],
    units: u64,
}

/// The bins of all `parts` that have units in them.
fn cells(parts: &[&MeasureCounts]) -> Vec<Cell> {
    let mut far = BTreeMap::new();
    for (bin, units) in parts.iter().flat_map(|part| &part.far) {
        *far.entry(*bin).or_insert(0) += units;
    }
    let beyond = |(bin, units): (&i32, &u64)| Cell { ends: far_ends(*bin), units: *units };
    let border = |k: usize| ((k as f64 - 0.5 - (BINS / 2) as f64) / BINS_PER_DEVIATION).clamp(-NEAR, NEAR);
    let near = (0..BINS)
        .map(|k| Cell { ends: [border(k), border(k + 1)], units: parts.iter().map(|part| part.bins[k]).sum() });
    let all = far.range(..0).map(beyond).chain(near).chain(far.range(0..).map(beyond));
    all.filter(|cell| cell.units > 0).collect()
}

impl<'a> Plain<'a> {
    pub fn of(tallies: &'a [Tally], frames: &[Frame]) -> Self {
        let sums = tallies.iter().filter_map(|tally| tally.sums.total());
        let sums = sums.reduce(|left, right| left.joined(&right)).unwrap_or_default();
        let total = |of: &dyn Fn(&Tally) -> u64| tallies.iter().map(of).sum::<u64>();
        let measure = |(i, frame): (usize, &Frame)| {
            let parts: Vec<_> = tallies.iter().map(|tally| &tally.counts.measures[i]).collect();
            let undefined = parts.iter().map(|part| part.undefined).sum();
            let units = total(&|tally| tally.counts.units) - undefined;
            let n = units as f64;
            let [m1, m2, m3, m4] = sums.powers[i].map(|sum| sum / n);
            let variance = (m2 - m1 * m1).max(0.0);
            let third = m3 - 3.0 * m1 * m2 + 2.0 * m1 * m1 * m1;
            let fourth = m4 - 4.0 * m1 * m3 + 6.0 * m1 * m1 * m2 - 3.0 * m1 * m1 * m1 * m1;
            let extremes = [
                parts.iter().map(|part| part.extremes[0]).fold(f64::INFINITY, f64::min),
                parts.iter().map(|part| part.extremes[1]).fold(f64::NEG_INFINITY, f64::max),
            ];
            // What varies by rounding alone has no shape.
            let constant = extremes[1] - extremes[0] <= 1e-12 * extremes[0].abs().max(extremes[1].abs());
            let shape = |moment: f64| if constant { f64::NAN } else { moment };
            // Seen from a frame elsewhere what is the same in all units would scatter by rounding.
            let is_level = extremes[0] == extremes[1];
            let deviation = frame.scale * libm::sqrt(variance * n / (n - 1.0));
            PlainMeasure {
                units,
                undefined,
                outside: [0, 1].map(|side| parts.iter().map(|part| part.outside[side]).sum()),
                mean: if is_level { extremes[0] } else { frame.origin + frame.scale * m1 },
                deviation: if is_level { 0.0 } else { deviation },
                skewness: shape(third / (variance * libm::sqrt(variance))),
                kurtosis: shape(fourth / (variance * variance)),
                extremes,
                frame: *frame,
                cells: cells(&parts),
                parts,
            }
        };
        let closed = tallies.first().map_or(0, |tally| tally.counts.closed.len());
        Self {
            units: total(&|tally| tally.counts.units),
            rejected: total(&|tally| tally.counts.rejected),
            closed: (0..closed).map(|i| total(&|tally| tally.counts.closed[i])).collect(),
            measures: frames.iter().enumerate().map(measure).collect(),
            sums,
        }
    }

    /// Correlation of all measures; units in which one cannot be computed count as its frame's origin.
    pub fn correlation(&self) -> Vec<Vec<f64>> {
        let n = self.units as f64;
        let covariance = |i: usize, j: usize| {
            let product = match i.cmp(&j) {
                std::cmp::Ordering::Equal => self.sums.powers[i][1],
                std::cmp::Ordering::Greater => self.sums.products[i * (i - 1) / 2 + j],
                std::cmp::Ordering::Less => self.sums.products[j * (j - 1) / 2 + i],
            };
            product / n - self.sums.powers[i][0] / n * (self.sums.powers[j][0] / n)
        };
        let count = self.measures.len();
        let coefficient = |i: usize, j: usize| {
            let scale = libm::sqrt(covariance(i, i) * covariance(j, j));
            let is_level = [i, j].iter().any(|k| self.measures[*k].deviation == 0.0);
            if i == j || scale == 0.0 || is_level { f64::from(i == j) } else { covariance(i, j) / scale }
        };
        (0..count).map(|i| (0..count).map(|j| coefficient(i, j)).collect()).collect()
    }
}

impl PlainMeasure<'_> {
    /// Units in bin `k`.
    fn bin(&self, k: usize) -> u64 {
        self.parts.iter().map(|part| part.bins[k]).sum()
    }

    /// Mean of a loss that a repair limits, and its standard error, from the bins.
    pub fn loss(&self, loss: &Loss) -> [f64; 2] {
        let n = self.units as f64;
        let Frame { origin, scale } = self.frame;
        let of = |Cell { ends: [low, high], units }: &Cell| {
            (*units as f64 / n, loss.of(origin + scale * 0.5 * (low + high)))
        };
        let mean: f64 = self.cells.iter().map(of).map(|(share, loss)| share * loss).sum();
        let square: f64 = self.cells.iter().map(of).map(|(share, loss)| share * (loss - mean) * (loss - mean)).sum();
        [mean, libm::sqrt(square / n)]
    }

    /// The shape of the sample, from its bins.
    pub fn shape(&self) -> Shape {
        let n = self.units as f64;
        let values = self.cells.iter().map(|Cell { ends: [low, high], units }| (*units as f64 / n, 0.5 * (low + high)));
        let (_, moments) = weighted(values);
        Shape::of_moments(moments)
    }

    /// The 95 % interval of the point below which a value lies with `probability`.
    pub fn enclosed(&self, probability: f64) -> [Option<f64>; 2] {
        let n = self.units as f64;
        let rank = probability * n;
        // A point linear within its bin scatters as the counts below both borders of the bin do, by their weights.
        let ([before, within], _) = self.ends(rank);
        // The outermost borders are the extremes: they scatter by a unit, and the first distance from them by another.
        let counts = [before.max(2), (before + within).min(self.units.saturating_sub(2))];
        let [low, high] = counts.map(|count| count as f64 / n);
        let share = ((rank - before as f64) / within.max(1) as f64).clamp(0.0, 1.0);
        let square = (1.0 - share) * (1.0 - share) * low * (1.0 - low)
            + share * share * high * (1.0 - high)
            + 2.0 * share * (1.0 - share) * low * (1.0 - high);
        let scatter = libm::sqrt((square / (probability * (1.0 - probability))).min(1.0));
        interval::ranks(probability, self.units).map(|end| {
            // The rank of a value is half a unit more than that of the point below which it lies.
            let end = if (1.0..=n).contains(&end) { end } else { return None };
            Some(self.at_rank(rank + (end - 0.5 - rank) * scatter))
        })
    }

    /// The bin of the `rank`-th value (from 1 on): how many lie before it and in it, and its ends.
    fn ends(&self, rank: f64) -> ([u64; 2], [f64; 2]) {
        let mut before = 0;
        let [least, greatest] = self.extremes;
        let Frame { origin, scale } = self.frame;
        for (number, Cell { ends, units }) in self.cells.iter().enumerate() {
            if number + 1 == self.cells.len() || (before + units) as f64 >= rank {
                let mut ends = ends.map(|end| (origin + scale * end).max(least).min(greatest));
                if number == 0 {
                    ends[0] = least;
                }
                if number + 1 == self.cells.len() {
                    ends[1] = greatest;
                }
                return ([before, *units], ends);
            }
            before += units;
        }
        ([0, 0], [f64::NAN; 2])
    }

    /// The point below which a value lies with `probability`, linear within its bin.
    pub fn quantile(&self, probability: f64) -> f64 {
        self.at_rank(probability * self.units as f64)
    }

    /// The point that `rank` values lie below.
    fn at_rank(&self, rank: f64) -> f64 {
        // Units that share an extreme are not spread over its bin.
        for (side, beyond) in [rank, self.units as f64 - rank].into_iter().enumerate() {
            let parts = self.parts.iter().filter(|part| part.extremes[side] == self.extremes[side]);
            let at: u64 = parts.map(|part| part.at_extremes[side]).sum();
            if at > 1 && beyond <= at as f64 {
                return self.extremes[side];
            }
        }
        let ([before, within], [low, high]) = self.ends(rank);
        // The least and the greatest value are ends of bins, half a unit from those of all ranks.
        let from = if low == self.extremes[0] { 0.5 } else { before as f64 };
        let to = (before + within) as f64 - if high == self.extremes[1] { 0.5 } else { 0.0 };
        let share = if to > from { ((rank - from) / (to - from)).clamp(0.0, 1.0) } else { 0.5 };
        low + (high - low) * share
    }
}

/// The `probability` point of measure `i` over all of `tallies`.
pub fn quantile(frames: &[Frame], tallies: &[Tally], i: usize, probability: f64) -> f64 {
    Plain::of(tallies, frames).measures[i].quantile(probability)
}

/// Shares of units of measure `i` in classes `width` bins wide, as (middle, share): a histogram.
pub fn histogram(frames: &[Frame], tallies: &[Tally], i: usize, width: usize) -> Vec<(f64, f64)> {
    let plain = Plain::of(tallies, frames);
    let measure = &plain.measures[i];
    let mut bins: Vec<u64> = (0..BINS).map(|k| measure.bin(k)).collect();
    // What lies beyond all bins is in the outermost.
    for (bin, units) in measure.parts.iter().flat_map(|part| &part.far) {
        bins[if *bin < 0 { 0 } else { BINS - 1 }] += units;
    }
    let Frame { origin, scale } = measure.frame;
    let class = |(c, bins): (usize, &[u64])| {
        let middle = (c * width) as f64 + (bins.len() - 1) as f64 / 2.0 - (BINS / 2) as f64;
        let share = bins.iter().sum::<u64>() as f64 / measure.units.max(1) as f64;
        (origin + scale * middle / BINS_PER_DEVIATION, share)
    };
    let classes: Vec<_> = bins.chunks(width).enumerate().map(class).collect();
    let first = classes.iter().position(|(_, share)| *share > 0.0).unwrap_or(0);
    let last = classes.iter().rposition(|(_, share)| *share > 0.0).unwrap_or(0);
    classes[first..=last].to_vec()
}
