//! Deviations by the block bootstrap: estimates from blocks of the record, drawn again and again.

use nalgebra::DVector;
use slipfit_core::sampling::stream::{Rng, unit_stream};

use super::covariance::Linearised;

/// Estimates that are drawn.
const DRAWS: usize = 1000;
/// Seed of the draws.
const SEED: u64 = 1;

/// Deviations (SI) of the parameters and their 95 % ranges about the estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct Bootstrap {
    /// Standard deviations.
    pub deviations: Vec<f64>,
    /// Distances of the 2.5 % and the 97.5 % quantile from the estimate.
    pub ranges: Vec<[f64; 2]>,
}

/// The numbers of blocks into which what was measured is divided. Long blocks keep slow noise together; of short ones there are enough.
const BLOCKS: [usize; 2] = [24, 48];

/// The wider of the deviations that long and short blocks of a `linearised` fit give, parameter by parameter.
pub fn widest(linearised: &Linearised) -> Bootstrap {
    let [mut wide, other] = BLOCKS.map(|blocks| draw(linearised, (linearised.residuals.len() / blocks).max(1)));
    for i in 0..wide.deviations.len() {
        if other.deviations[i] > wide.deviations[i] {
            (wide.deviations[i], wide.ranges[i]) = (other.deviations[i], other.ranges[i]);
        }
    }
    wide
}

/// Draws blocks of `block` samples of a `linearised` fit. What is drawn are the residuals times their derivatives, of which the estimate is a
/// sum; the derivatives by themselves stay those of the record: it is its noise that is drawn anew, not the motion.
fn draw(linearised: &Linearised, block: usize) -> Bootstrap {
    let p = linearised.columns.len();
    let mut blocks: Vec<DVector<f64>> = Vec::new();
    let mut at = 0;
    for length in &linearised.runs {
        let mut start = at;
        let end = at + length;
        while start < end {
            // The rest of a run belongs to its last block.
            let stop = if start + 2 * block > end { end } else { start + block };
            let of = |i: usize| &linearised.columns[i][start..stop];
            let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let residuals = &linearised.residuals[start..stop];
            blocks.push(DVector::from_fn(p, |i, _| product(of(i), residuals)));
            start = stop;
        }
        at = end;
    }
    // The fit takes a part of the noise out of the residuals.
    let count = blocks.len() as f64;
    let taken = libm::sqrt(count / (count - p as f64).max(1.0));
    let mut stream = unit_stream(SEED, 0);
    let mut draws: Vec<Vec<f64>> = vec![Vec::with_capacity(DRAWS); p];
    for _ in 0..DRAWS {
        let mut scores = DVector::zeros(p);
        for _ in 0..blocks.len() {
            let k = ((u128::from(stream.next_u64()) * blocks.len() as u128) >> 64) as usize;
            scores += &blocks[k];
        }
        let moved = &linearised.inverse * scores * taken;
        draws.iter_mut().zip(moved.iter().zip(&linearised.units)).for_each(|(all, (by, unit))| all.push(by * unit));
    }
    let deviation = |draws: &Vec<f64>| {
        let mean = draws.iter().sum::<f64>() / DRAWS as f64;
        libm::sqrt(draws.iter().map(|by| (by - mean) * (by - mean)).sum::<f64>() / (DRAWS - 1) as f64)
    };
    let deviations = draws.iter().map(deviation).collect();
    let range = |draws: &mut Vec<f64>| {
        draws.sort_by(f64::total_cmp);
        [draws[DRAWS / 40], draws[DRAWS - 1 - DRAWS / 40]]
    };
    let ranges = draws.iter_mut().map(range).collect();
    Bootstrap { deviations, ranges }
}

#[cfg(test)]
mod tests {
    use slipfit_core::sampling::stream::unit_stream;
    use slipfit_tolerance::failure::subset::normals;

    use super::{Linearised, draw};

    #[test]
    fn independent_residuals_give_the_textbook_error() {
        let residuals = normals(&mut unit_stream(3, 0), 10_000);
        let found = draw(&Linearised::new(&[vec![1.0; 10_000]], residuals, vec![10_000]), 50);
        assert!((found.deviations[0] * 100.0 - 1.0).abs() < 0.15, "{found:?}");
        assert!((found.ranges[0][1] * 100.0 - 1.96).abs() < 0.35, "{found:?}");
    }
}
