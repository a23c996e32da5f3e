//! What a stack's measures do, computed without slipfit: plain sampling, enumeration of corners, search inside.

use super::{
    chance::Chance,
    expression::Range,
    law::{normal_point, normal_share},
    stack::{Dimension, Stack},
};

/// Nodes of scores (from −8 to 8) and their weights.
fn scores() -> impl Iterator<Item = (f64, f64)> {
    const STEP: f64 = 0.1;
    (-80..=80)
        .map(|k| f64::from(k) * STEP)
        .map(|z| (z, STEP * libm::exp(-0.5 * z * z) / libm::sqrt(std::f64::consts::TAU)))
}

/// The value of a dimension at a score.
fn at_score(dimension: &Dimension, score: f64) -> f64 {
    dimension.point(normal_share(score).clamp(1e-15, 1.0 - 1e-15))
}

/// The correlation of the values of two dimensions whose scores have the correlation `r`.
pub fn value_correlation(one: &Dimension, other: &Dimension, r: f64) -> f64 {
    let tabled: Vec<f64> = (-900..=900).map(|k| at_score(other, f64::from(k) / 100.0)).collect();
    let of_other = |z: f64| {
        let place = (z.clamp(-8.99, 8.99) + 9.0) * 100.0;
        let (i, part) = (place as usize, place.fract());
        tabled[i] + part * (tabled[i + 1] - tabled[i])
    };
    let of_one: Vec<(f64, f64, f64)> = scores().map(|(z, weight)| (z, weight, at_score(one, z))).collect();
    let moments = |values: &mut dyn Iterator<Item = (f64, f64)>| {
        let sums = values.fold([0.0; 3], |[n, s, q], (w, x)| [n + w, s + w * x, q + w * x * x]);
        let mean = sums[1] / sums[0];
        (mean, libm::sqrt(sums[2] / sums[0] - mean * mean))
    };
    let (mean, deviation) = moments(&mut of_one.iter().map(|(_, weight, x)| (*weight, *x)));
    let (other_mean, other_deviation) = moments(&mut scores().map(|(z, weight)| (weight, of_other(z))));
    let rest = libm::sqrt(1.0 - r * r);
    let mut sum = 0.0;
    for (z, weight, x) in &of_one {
        sum +=
            scores().map(|(own, w)| w * weight * (x - mean) * (of_other(r * z + rest * own) - other_mean)).sum::<f64>();
    }
    sum / (deviation * other_deviation)
}

/// Pairs of dimensions and the correlation of their scores.
fn score_correlations(stack: &Stack) -> Vec<(usize, usize, f64)> {
    let of = |(a, b, coefficient): &(usize, usize, f64)| {
        if stack.ranks {
            return (*a, *b, 2.0 * libm::sin(std::f64::consts::PI / 6.0 * coefficient));
        }
        let (mut low, mut high) = (-1.0, 1.0);
        for _ in 0..14 {
            let middle = 0.5 * (low + high);
            let found = value_correlation(&stack.dimensions[*a], &stack.dimensions[*b], middle);
            if found < *coefficient { low = middle } else { high = middle }
        }
        (*a, *b, 0.5 * (low + high))
    };
    stack.correlations.iter().map(of).collect()
}

/// Draws dimensions of units.
pub struct Units<'a> {
    stack: &'a Stack,
    correlations: Vec<(usize, usize, f64)>,
}

impl<'a> Units<'a> {
    pub fn new(stack: &'a Stack) -> Self {
        Self { stack, correlations: score_correlations(stack) }
    }

    /// The dimensions (mm, rad, 1) of one unit.
    pub fn draw(&self, chance: &mut Chance) -> Vec<f64> {
        let mut inputs: Vec<f64> = self.stack.dimensions.iter().map(|dimension| dimension.draw(chance)).collect();
        for (a, b, r) in &self.correlations {
            let z = normal_point(chance.unit());
            let other = r * z + libm::sqrt(1.0 - r * r) * normal_point(chance.unit());
            inputs[*a] = at_score(&self.stack.dimensions[*a], z);
            inputs[*b] = at_score(&self.stack.dimensions[*b], other);
        }
        inputs
    }
}

/// The least and the greatest value of `function` over a box, as far as corners, random places and a search from the best of them
/// find it.
pub fn extremes(function: &dyn Fn(&[f64]) -> f64, ranges: &[Range], reads: &[usize], chance: &mut Chance) -> Range {
    let mut middle: Vec<f64> = ranges.iter().map(|[low, high]| 0.5 * (low + high)).collect();
    let mut places: Vec<Vec<f64>> = Vec::new();
    for corner in 0..1usize << reads.len() {
        let mut place = middle.clone();
        reads.iter().enumerate().for_each(|(bit, i)| place[*i] = ranges[*i][corner >> bit & 1]);
        places.push(place);
    }
    places.push(middle.clone());
    for _ in 0..400 {
        reads.iter().for_each(|i| middle[*i] = chance.between(ranges[*i][0], ranges[*i][1]));
        places.push(middle.clone());
    }
    let valued = places.into_iter().map(|place| (function(&place), place)).filter(|(value, _)| value.is_finite());
    let mut valued: Vec<_> = valued.collect();
    valued.sort_by(|a, b| a.0.total_cmp(&b.0));
    let climb = |sign: f64, starts: &mut dyn Iterator<Item = &(f64, Vec<f64>)>, chance: &mut Chance| {
        starts
            .map(|(_, place)| climbed(&|x| sign * function(x), ranges, reads, place.clone(), chance))
            .fold(f64::NEG_INFINITY, f64::max)
    };
    // The best corners lie side by side: some of the starts are at random.
    let few = |at: usize| at < 3 || at % (valued.len() / 3 + 1) == 1;
    let low = -climb(-1.0, &mut valued.iter().enumerate().filter(|(at, _)| few(*at)).map(|(_, v)| v), chance);
    let high = climb(1.0, &mut valued.iter().rev().enumerate().filter(|(at, _)| few(*at)).map(|(_, v)| v), chance);
    [low, high]
}

/// The greatest value on a way up from `place`, along the axes and along random lines, by steps that shrink.
fn climbed(
    function: &dyn Fn(&[f64]) -> f64,
    ranges: &[Range],
    reads: &[usize],
    mut place: Vec<f64>,
    chance: &mut Chance,
) -> f64 {
    let mut best = function(&place);
    let mut size = 0.5;
    while size > 1e-7 {
        let mut better = false;
        let lines = (0..2 * reads.len()).map(|k| {
            let random: Vec<f64> = reads.iter().map(|_| chance.normal()).collect();
            (0..reads.len())
                .map(|j| if k < reads.len() { f64::from(u8::from(j == k)) } else { random[j] })
                .collect::<Vec<f64>>()
        });
        for line in lines.collect::<Vec<_>>() {
            for sign in [-1.0, 1.0] {
                let mut moved = place.clone();
                for (i, along) in reads.iter().zip(&line) {
                    let [low, high] = ranges[*i];
                    moved[*i] = (moved[*i] + sign * size * along * (high - low)).clamp(low, high);
                }
                let value = function(&moved);
                if value > best {
                    (best, place, better) = (value, moved, true);
                }
            }
        }
        if !better {
            size *= 0.4;
        }
    }
    best
}

/// Total Sobol' indices (Jansen's estimator) over the variance, and the standard errors of their numerators.
pub fn total_indices(stack: &Stack, measure: usize, count: usize, chance: &mut Chance) -> Vec<[f64; 2]> {
    let units = Units::new(stack);
    let value = |inputs: &[f64]| stack.values(inputs)[measure];
    let sample: Vec<_> = (0..count).map(|_| (units.draw(chance), units.draw(chance))).collect();
    let values: Vec<f64> = sample.iter().map(|(a, _)| value(a)).collect();
    let of = |k: usize| {
        let squares = sample.iter().zip(&values).map(|((a, b), value_a)| {
            let mut mixed = a.clone();
            mixed[k] = b[k];
            let change = value(&mixed) - value_a;
            0.5 * change * change
        });
        // Pairs of units of which one is undefined do not count.
        let defined = squares.filter(|x| x.is_finite());
        let [n, sum, square] = defined.fold([0.0; 3], |[n, sum, square], x| [n + 1.0, sum + x, square + x * x]);
        let mean = sum / n;
        [mean, libm::sqrt((square / n - mean * mean).max(0.0) / n)]
    };
    (0..stack.dimensions.len()).map(of).collect()
}

/// Mean, standard deviation, skewness and kurtosis of a sample.
pub fn moments(values: &[f64]) -> [f64; 4] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let power = |k: i32| values.iter().map(|x| libm::pow(x - mean, f64::from(k))).sum::<f64>() / n;
    let variance = power(2);
    [mean, libm::sqrt(variance * n / (n - 1.0)), power(3) / libm::pow(variance, 1.5), power(4) / (variance * variance)]
}

/// The greatest distance of the distribution functions of two sorted samples.
pub fn apart(one: &[f64], other: &[f64]) -> f64 {
    let (mut i, mut j, mut most) = (0, 0, 0.0f64);
    while i < one.len() && j < other.len() {
        let x = one[i].min(other[j]);
        // Values that differ by rounding are the same.
        let same = x + 1e-9 * x.abs().max(1e-6);
        while i < one.len() && one[i] <= same {
            i += 1;
        }
        while j < other.len() && other[j] <= same {
            j += 1;
        }
        most = most.max((i as f64 / one.len() as f64 - j as f64 / other.len() as f64).abs());
    }
    most
}
