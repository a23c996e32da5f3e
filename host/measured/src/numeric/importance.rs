//! Adaptive importance sampling: weighted points of a density that is known up to a factor.

use nalgebra::{DMatrix, DVector};
use slipfit_core::sampling::{
    normal::score,
    stream::{Rng, Xoshiro256PlusPlus, unit_stream},
};

/// Points of each round that adapts the proposal, and of the last one.
const POINTS: usize = 500;
const LAST: usize = 2500;
const ROUNDS: usize = 12;
/// Degrees of freedom of the proposed Student's t, whose tails enclose those of the density.
const FREEDOM: usize = 5;
/// Part of a round's points that are effective when the proposal fits, and that a flattened round has to have.
const GOOD: f64 = 0.5;
const FLATTENED: f64 = 0.1;
/// Effective points below which the last round does not stand for the density.
const LEAST_EFFECTIVE: f64 = 250.0;
const SEED: u64 = 0x5eed;

/// A point with its weight.
pub type Weighted = (f64, Vec<f64>);

/// Points with weights that add up to 1. The proposal starts around `start` with some `widths` and takes mean and
/// covariance of each round's weighted points (J.-M. Cornuet and others, "Adaptive multiple importance sampling", 2012);
/// a round with few effective points is flattened first. `None` if too few points of the last round are effective.
pub fn draw(start: &[f64], widths: &[f64], ln_density: impl Fn(&[f64]) -> f64) -> Option<Vec<Weighted>> {
    let mut stream = unit_stream(SEED, 0);
    let diagonal = DVector::from_iterator(widths.len(), widths.iter().map(|width| width * width));
    let mut proposal =
        Proposal { mean: DVector::from_column_slice(start), root: root(&DMatrix::from_diagonal(&diagonal))? };
    for _ in 0..ROUNDS {
        let points = proposal.draw(POINTS, &mut stream, &ln_density);
        let enough = effective(&points, 1.0);
        let power = flattening(&points)?;
        proposal = Proposal::of(&points, power)?;
        if enough > GOOD * POINTS as f64 {
            break;
        }
    }
    let points = proposal.draw(LAST, &mut stream, &ln_density);
    if effective(&points, 1.0) < LEAST_EFFECTIVE {
        return None;
    }
    let weights = weights(&points, 1.0);
    Some(weights.into_iter().zip(points).map(|(weight, (_, point))| (weight, point.as_slice().to_vec())).collect())
}

/// A point with the logarithm of its weight.
type Point = (f64, DVector<f64>);

/// Weights that add up to 1, of the `power` of those of points.
fn weights(points: &[Point], power: f64) -> Vec<f64> {
    let greatest = points.iter().map(|(ln, _)| *ln).fold(f64::NEG_INFINITY, f64::max);
    let mut weights: Vec<f64> = points.iter().map(|(ln, _)| libm::exp(power * (ln - greatest))).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    weights
}

/// Number of points with equal weights that are worth as much.
fn effective(points: &[Point], power: f64) -> f64 {
    1.0 / weights(points, power).iter().map(|weight| weight * weight).sum::<f64>()
}

/// The greatest power up to 1 of the weights with which enough points are effective.
fn flattening(points: &[Point]) -> Option<f64> {
    if !points.iter().any(|(ln, _)| ln.is_finite()) {
        return None;
    }
    let is_enough = |power: f64| effective(points, power) >= FLATTENED * points.len() as f64;
    if is_enough(1.0) {
        return Some(1.0);
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        if is_enough(middle) { low = middle } else { high = middle }
    }
    Some(low)
}

/// A Student's t around a mean.
struct Proposal {
    mean: DVector<f64>,
    /// Cholesky's factor of the scale.
    root: DMatrix<f64>,
}

impl Proposal {
    /// With mean and covariance of weighted points.
    fn of(points: &[Point], power: f64) -> Option<Self> {
        let size = points.first()?.1.len();
        let weights = weights(points, power);
        let mut mean = DVector::zeros(size);
        weights.iter().zip(points).for_each(|(weight, (_, point))| mean += *weight * point);
        let mut covariance = DMatrix::zeros(size, size);
        for (weight, (_, point)) in weights.iter().zip(points) {
            let off = point - &mean;
            covariance += *weight * &off * off.transpose();
        }
        Some(Self { mean, root: root(&covariance)? })
    }

    /// Points, weighted for a density.
    fn draw(&self, count: usize, stream: &mut Xoshiro256PlusPlus, ln_density: &impl Fn(&[f64]) -> f64) -> Vec<Point> {
        let size = self.mean.len();
        let freedom = FREEDOM as f64;
        let mut next = || -> f64 { score(stream.next_u64()) };
        let point = |_| {
            let scores = DVector::from_iterator(size, (0..size).map(|_| next()));
            let chi: f64 = (0..FREEDOM).map(|_| next()).map(|z| z * z).sum();
            let square = scores.norm_squared() * freedom / chi;
            let point = &self.mean + &self.root * scores * libm::sqrt(freedom / chi);
            let ln_proposal = -0.5 * (freedom + size as f64) * libm::log1p(square / freedom);
            let ln = ln_density(point.as_slice()) - ln_proposal;
            (if ln.is_nan() { f64::NEG_INFINITY } else { ln }, point)
        };
        (0..count).map(point).collect()
    }
}

/// Cholesky's factor.
fn root(covariance: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    covariance.clone().cholesky().map(|factor| factor.l())
}

#[cfg(test)]
mod tests {
    use super::draw;

    #[test]
    fn moments_of_a_gamma_and_a_normal_far_from_the_start() {
        // ln of a gamma variable with mean 3 and variance 3; a normal around 20 that goes with it.
        let ln_density = |point: &[f64]| match point {
            [ln, x] => 3.0 * ln - libm::exp(*ln) - 0.5 * (x - 20.0 - ln) * (x - 20.0 - ln),
            _ => f64::NAN,
        };
        let points = draw(&[0.0, 0.0], &[1.0, 1.0], ln_density).expect("points");
        let moment = |of: &dyn Fn(&[f64]) -> f64| points.iter().map(|(weight, x)| weight * of(x)).sum::<f64>();
        assert!((moment(&|x| libm::exp(x[0])) - 3.0).abs() < 0.15);
        assert!((moment(&|x| x[1] - x[0]) - 20.0).abs() < 0.1);
        assert!((moment(&|x| (x[1] - x[0] - 20.0) * (x[1] - x[0] - 20.0)) - 1.0).abs() < 0.1);
    }

    #[test]
    fn nothing_is_drawn_of_no_density() {
        assert!(draw(&[0.0], &[1.0], |_| f64::NEG_INFINITY).is_none());
        assert!(draw(&[0.0], &[0.0], |_| 0.0).is_none());
    }
}
