//! What is known of the standard deviation of a normal production from a sample.

use std::sync::OnceLock;

use slipfit_tolerance::numeric::gauss::piece;

/// Standard deviations beyond which the ratio of both deviations does not lie.
const WIDEST: f64 = 10.0;
/// Pieces of the integral, of ten points each.
const PIECES: usize = 10;

/// Points of the ratio s/σ of the sample's standard deviation with some degrees of `freedom` > 0 and the true one, with
/// weights that add up to 1: the square root of χ²/ν.
pub fn ratios(freedom: f64) -> Vec<[f64; 2]> {
    let spread = WIDEST / libm::sqrt(2.0 * freedom);
    let (from, to) = ((1.0 - spread).max(0.0), 1.0 + spread);
    // Shifted by a constant, so that its top is at 0 for many parts.
    weighted([from, to], |ratio| (freedom - 1.0) * libm::log(ratio) - 0.5 * freedom * (ratio * ratio - 1.0))
}

/// Points of a standard normal with weights that add up to 1.
pub fn scores() -> &'static [[f64; 2]] {
    const FARTHEST: f64 = 9.0;
    static SCORES: OnceLock<Vec<[f64; 2]>> = OnceLock::new();
    SCORES.get_or_init(|| weighted([-FARTHEST, FARTHEST], |score| -0.5 * score * score))
}

/// Points of a variable between two ends, with weights that add up to 1 and follow the logarithm of its density, up to a constant.
fn weighted([from, to]: [f64; 2], ln_density: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let step = (to - from) / PIECES as f64;
    let mut points: Vec<[f64; 2]> = (0..PIECES)
        .flat_map(|i| piece(from + i as f64 * step, from + (i + 1) as f64 * step))
        .map(|(x, weight)| [x, weight * libm::exp(ln_density(x))])
        .collect();
    let sum: f64 = points.iter().map(|[_, weight]| weight).sum();
    points.iter_mut().for_each(|[_, weight]| *weight /= sum);
    points
}

#[cfg(test)]
mod tests {
    use super::{ratios, scores};

    #[test]
    fn moments_are_exact() {
        for freedom in [1.0, 2.0, 5.0, 29.0, 99.0, 1e4, 1e7] {
            // E χ²/ν = 1 and E s/σ = c4: 0.797885 for two parts, 0.939986 for five (tables of control charts).
            let square: f64 = ratios(freedom).iter().map(|[ratio, weight]| weight * ratio * ratio).sum();
            assert!((square - 1.0).abs() < 1e-10, "{freedom} {square}");
        }
        let mean = |freedom| ratios(freedom).iter().map(|[ratio, weight]| weight * ratio).sum::<f64>();
        assert!((mean(1.0) - 0.797_885).abs() < 1e-6);
        assert!((mean(4.0) - 0.939_986).abs() < 1e-6);
        let fourth: f64 = scores().iter().map(|[score, weight]| weight * score * score * score * score).sum();
        assert!((fourth - 3.0).abs() < 1e-12);
    }
}
