//! How characteristics move together: correlations of their normal scores.

use slipfit_core::sampling::{
    normal::score,
    stream::{Rng, Xoshiro256PlusPlus},
};
use slipfit_tolerance::{
    numeric::normal::{quantile as score_at, tail},
    product::correlation::{factor, is_positive_definite},
};

/// Parts with both characteristics without which their correlation is not estimated.
const LEAST_COMMON: usize = 4;
/// Greatest correlation: of characteristics that measure the same thing.
const GREATEST: f64 = 0.9999;

/// Correlations of pairs of characteristics.
#[derive(Debug)]
pub struct Dependence {
    characteristics: usize,
    /// Row, column, coefficient and standard error of its Fisher's z.
    pairs: Vec<(usize, usize, f64, f64)>,
}

impl Dependence {
    /// Of characteristics in the order of the parts: for each pair by the parts that have both.
    pub fn of(characteristics: &[&[Option<f64>]]) -> Self {
        let mut pairs = Vec::new();
        for (column, other) in characteristics.iter().enumerate() {
            for (row, one) in characteristics[..column].iter().enumerate() {
                let common: Vec<(f64, f64)> = one.iter().zip(*other).filter_map(|(a, b)| (*a).zip(*b)).collect();
                if common.len() < LEAST_COMMON {
                    continue;
                }
                let (a, b): (Vec<f64>, Vec<f64>) = common.into_iter().unzip();
                let coefficient = product_moment(&scores(&a), &scores(&b)).clamp(-GREATEST, GREATEST);
                pairs.push((row, column, coefficient, 1.0 / libm::sqrt(a.len() as f64 - 3.0)));
            }
        }
        Self { characteristics: characteristics.len(), pairs }
    }

    /// The coefficients, each moved within its error if a `stream` says by how much. Pairs of few common parts can contradict
    /// each other: all are brought nearer to 0 until they do not.
    pub fn coefficients(&self, mut stream: Option<&mut Xoshiro256PlusPlus>) -> Vec<(usize, usize, f64)> {
        let of = |(row, column, coefficient, error): &(usize, usize, f64, f64)| {
            let moved = stream.as_mut().map_or(0.0, |stream| *error * score::<f64>(stream.next_u64()));
            (*row, *column, libm::tanh(libm::atanh(*coefficient) + moved))
        };
        let mut found: Vec<(usize, usize, f64)> = self.pairs.iter().map(of).filter(|(.., r)| *r != 0.0).collect();
        while !is_positive_definite(self.characteristics, &found) {
            found.iter_mut().for_each(|(.., coefficient)| *coefficient *= 0.98);
        }
        found
    }
}

impl Dependence {
    /// A share between 0 and 1 for each characteristic, as correlated as these are.
    pub fn shares(&self, stream: &mut Xoshiro256PlusPlus) -> Vec<f64> {
        let scores: Vec<f64> = (0..self.characteristics).map(|_| score(stream.next_u64())).collect();
        let weights = factor(self.characteristics, &self.coefficients(None)).unwrap_or_default();
        let moved = |row: &Vec<f64>| tail(-row.iter().zip(&scores).map(|(weight, z)| weight * z).sum::<f64>());
        weights.iter().map(moved).collect()
    }
}

/// Normal scores of the ranks of `values` (B. van der Waerden 1952); equal values have their mean rank.
fn scores(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|i, j| values[*i].total_cmp(&values[*j]));
    let mut scores = vec![0.0; values.len()];
    let mut first = 0;
    while first < order.len() {
        let same = order[first..].iter().take_while(|i| values[**i] == values[order[first]]).count();
        let rank = first as f64 + 0.5 * (same as f64 - 1.0) + 1.0;
        order[first..first + same].iter().for_each(|i| scores[*i] = score_at(rank / (values.len() as f64 + 1.0)));
        first += same;
    }
    scores
}

/// Pearson's coefficient; 0 where one does not vary.
fn product_moment(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
    let (of_a, of_b) = (mean(a), mean(b));
    let sum = |x: &[f64], y: &[f64], [mx, my]: [f64; 2]| x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum::<f64>();
    let width = libm::sqrt(sum(a, a, [of_a; 2]) * sum(b, b, [of_b; 2]));
    if width > 0.0 { sum(a, b, [of_a, of_b]) / width } else { 0.0 }
}
