//! Distributions of extreme values: Weibull's of a smallest, Gumbel's of a largest or a smallest one.
//!
//! Both follow from an exponential variable E = −ln P(Z > z) of a standard normal score z, which is accurate in both tails.

use crate::numeric::normal::tail;

/// The unit exponential variable of a standard normal score; it grows with the score.
fn exponential(score: f64) -> f64 {
    if score > 0.0 {
        -libm::log(tail(score).max(f64::MIN_POSITIVE))
    } else {
        -libm::log1p(-tail(-score).max(f64::MIN_POSITIVE))
    }
}

/// Weibull's distribution: F(x) = 1 − exp(−((x − location)/scale)^shape). (Weibull 1951.)
#[derive(Clone, Copy, Debug)]
pub struct Weibull {
    /// Shape, positive: 1 is exponential, 2 Rayleigh's.
    pub shape: f64,
    /// Scale, positive.
    pub scale: f64,
    /// Least value.
    pub location: f64,
}

impl Weibull {
    /// The value at a standard normal score: location + scale·E^(1/shape).
    pub fn value(&self, score: f64) -> f64 {
        self.location + self.scale * libm::pow(exponential(score), 1.0 / self.shape)
    }

    /// P(X ≤ x) and P(X > x).
    pub fn tails(&self, x: f64) -> [f64; 2] {
        let hazard = libm::pow(((x - self.location) / self.scale).max(0.0), self.shape);
        [-libm::expm1(-hazard), libm::exp(-hazard)]
    }
}

/// Gumbel's distribution of a largest value: F(x) = exp(−exp(−(x − mode)/scale)); with a negative scale its mirror image, that of
/// a smallest one. (Gumbel, *Statistics of extremes*, 1958.)
#[derive(Clone, Copy, Debug)]
pub struct Gumbel {
    /// Most frequent value.
    pub mode: f64,
    /// Scale, not 0: positive has its long tail upwards.
    pub scale: f64,
}

impl Gumbel {
    /// The value at a standard normal score.
    pub fn value(&self, score: f64) -> f64 {
        self.mode - self.scale * libm::log(exponential(-score * 1.0f64.copysign(self.scale)))
    }

    /// P(X ≤ x) and P(X > x).
    pub fn tails(&self, x: f64) -> [f64; 2] {
        let hazard = libm::exp((self.mode - x) / self.scale);
        let [below, above] = [libm::exp(-hazard), -libm::expm1(-hazard)];
        if self.scale > 0.0 { [below, above] } else { [above, below] }
    }
}

#[cfg(test)]
mod tests {
    use super::{Gumbel, Weibull, exponential};

    fn close(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{found:e}, not {expected:e}");
    }

    /// One in a billion lies beyond this score.
    #[test]
    fn both_tails_are_exact() {
        let six = 5.997_807_015_007_687;
        let [far, near] = [six, -six].map(exponential);
        close(far, -libm::log(1e-9));
        close(near, -libm::log1p(-1e-9));
        let rayleigh = Weibull { shape: 2.0, scale: 3.0, location: 0.0 };
        close(rayleigh.value(six), 3.0 * libm::sqrt(-libm::log(1e-9)));
        close(rayleigh.value(-six), 3.0 * libm::sqrt(-libm::log1p(-1e-9)));
        // −ln(−ln(1 − 1e-9)) and −ln(9·ln 10).
        let largest = Gumbel { mode: 0.0, scale: 2.0 };
        close(largest.value(six), -2.0 * libm::log(-libm::log1p(-1e-9)));
        close(largest.value(-six), -2.0 * libm::log(9.0 * std::f64::consts::LN_10));
        let smallest = Gumbel { mode: 0.0, scale: -2.0 };
        for score in [-7.0, -1.0, 0.0, 0.3, 8.0] {
            assert_eq!(smallest.value(score), -largest.value(-score));
        }
    }
}
