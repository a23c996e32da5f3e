//! The beta distribution over an interval.

use statrs::function::beta::beta_reg;

use crate::numeric::normal::tail;
use crate::numeric::root::{excess, zero};

/// The logarithm of the least positive number.
const LEAST: f64 = -708.0;

/// A beta distribution: density ∝ u^(a−1)·(1−u)^(b−1) of the place u within its limits.
#[derive(Clone, Copy, Debug)]
pub struct Beta {
    /// Lower and upper limit.
    pub limits: [f64; 2],
    /// a and b, positive.
    pub shapes: [f64; 2],
}

impl Beta {
    /// The value at a standard normal score. The logarithm of the distance from the nearer limit is solved for, so that both tails
    /// are exact.
    pub fn value(&self, score: f64) -> f64 {
        let ([low, high], [a, b]) = (self.limits, self.shapes);
        let wanted = [tail(-score), tail(score)].map(|tail| tail.max(f64::MIN_POSITIVE));
        // Rises with u = `near` or falls with it, if that is the distance from the upper limit.
        let off = |found: [f64; 2]| {
            if wanted[0] < wanted[1] { excess(found[0], wanted[0]) } else { -excess(found[1], wanted[1]) }
        };
        let half = -std::f64::consts::LN_2;
        if off(shares([a, b], 0.5)) >= 0.0 {
            low + (high - low) * libm::exp(zero(LEAST, half, |log| off(shares([a, b], libm::exp(log)))))
        } else {
            let mirrored = |near: f64| {
                let [above, below] = shares([b, a], near);
                [below, above]
            };
            high - (high - low) * libm::exp(zero(LEAST, half, |log| -off(mirrored(libm::exp(log)))))
        }
    }

    /// P(X ≤ x) and P(X > x).
    pub fn tails(&self, x: f64) -> [f64; 2] {
        let ([low, high], [a, b]) = (self.limits, self.shapes);
        let [from_low, from_high] = [x - low, high - x].map(|distance| (distance / (high - low)).clamp(0.0, 1.0));
        if from_low <= from_high {
            shares([a, b], from_low)
        } else {
            let [above, below] = shares([b, a], from_high);
            [below, above]
        }
    }
}

/// The shares below and above the place `near` ≤ ½.
fn shares([a, b]: [f64; 2], near: f64) -> [f64; 2] {
    let below = beta_reg(a, b, near);
    [below, if below < 0.5 { 1.0 - below } else { beta_reg(b, a, 1.0 - near) }]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::Beta;
    use crate::numeric::normal::tail;

    fn close(found: f64, expected: f64, relative: f64) {
        assert!((found / expected - 1.0).abs() < relative, "{found:e}, not {expected:e}");
    }

    /// Powers, the arcsine distribution, and u²·(3 − 2u) have quantiles in closed form.
    #[test]
    fn quantiles_in_closed_form() {
        let beta = |shapes| Beta { limits: [0.0, 1.0], shapes };
        for score in [-8.0, -5.0, -2.0, -0.3, 0.0, 0.4, 1.0, 3.0] {
            let p = tail(-score);
            close(beta([3.0, 1.0]).value(score), libm::cbrt(p), 1e-12);
            close(beta([0.25, 1.0]).value(score), libm::pow(p, 4.0), 1e-12);
            close(beta([1.0, 5.0]).value(score), -libm::expm1(libm::log1p(-p) / 5.0), 1e-12);
            let sine = libm::sin(FRAC_PI_2 * p);
            close(beta([0.5, 0.5]).value(score), sine * sine, 1e-12);
            let x = beta([2.0, 2.0]).value(score);
            close(x * x * (3.0 - 2.0 * x), p, 1e-12);
        }
        // The upper tail as the distance from the upper limit.
        let upper = Beta { limits: [-1.0, 0.0], shapes: [2.0, 3.0] };
        for score in [0.5, 2.0, 5.0, 8.0] {
            close(upper.value(score), -Beta { limits: [0.0, 1.0], shapes: [3.0, 2.0] }.value(-score), 1e-12);
        }
    }
}
