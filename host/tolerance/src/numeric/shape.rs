//! The shape of a distribution by its moments, and what errors the statistics of a sample have for it.
//!
//! A statistic follows a small change of the distribution as the mean of its influence function does, a polynomial of the
//! standardised value. So its variance is that polynomial's mean square over the number of units: moments up to the eighth
//! order for a kurtosis. A few thousand units of a skewed measure do not know these; the model does, but it counts values that
//! are too rare for a sample of this size to have.

use super::normal::normal_factor;

/// The highest moment.
pub const ORDER: usize = 8;

/// Central moments of the orders 0 to 8 over powers of the standard deviation; not a number for what does not vary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape([f64; ORDER + 1]);

/// How far (standard deviations) the points at ±3σ may be off for a shape that counts as normal.
const NORMAL: f64 = 0.15;

impl Shape {
    /// The normal one.
    pub const NORMAL: Self = Self([1.0, 0.0, 1.0, 0.0, 3.0, 0.0, 15.0, 0.0, 105.0]);

    /// From central moments, the variance among them.
    pub fn of_moments(moments: [f64; ORDER + 1]) -> Self {
        let deviation = libm::sqrt(moments[2]);
        let mut scale = 1.0;
        Self(moments.map(|moment| {
            let scaled = moment / scale;
            scale *= deviation;
            scaled
        }))
    }

    /// From cumulants, the mean first.
    pub fn of_cumulants(cumulants: &[f64; ORDER]) -> Self {
        let mut moments = [1.0; ORDER + 1];
        moments[1] = 0.0;
        for n in 2..=ORDER {
            moments[n] = (2..=n).map(|k| binomial(n - 1, k - 1) * cumulants[k - 1] * moments[n - k]).sum();
        }
        Self::of_moments(moments)
    }

    /// Skewness.
    pub fn skewness(&self) -> f64 {
        self.0[3]
    }

    /// Kurtosis; 3 for a normal.
    pub fn kurtosis(&self) -> f64 {
        self.0[4]
    }

    /// Whether capability may be read as that of a normal: the points at ±3σ are those of one within 5 %, by the first
    /// terms of Cornish and Fisher's series.
    pub fn is_normal(&self) -> bool {
        self.skewness().abs() * 8.0 / 6.0 + (self.kurtosis() - 3.0).abs() * 18.0 / 24.0 <= NORMAL
    }

    /// Degrees of freedom of the variance of `units`: as many as that of a normal sample with the same spread has.
    pub fn freedom(&self, units: f64) -> f64 {
        2.0 / ((self.kurtosis() - 3.0) / units + 2.0 / (units - 1.0))
    }

    /// Standard error of the skewness of `units`.
    pub fn of_skewness(&self, units: f64) -> f64 {
        let g = self.skewness();
        self.error(&[0.5 * g, -3.0, -1.5 * g, 1.0], units)
    }

    /// Standard error of the kurtosis of `units`.
    pub fn of_kurtosis(&self, units: f64) -> f64 {
        let (g, k) = (self.skewness(), self.kurtosis());
        self.error(&[k, -4.0 * g, -2.0 * k, 0.0, 1.0], units)
    }

    /// Standard error of a Ppk of `units` whose nearer limit is the lower or the upper one. For a normal shape it is that of
    /// Bissell (1990), √(1/(9n) + Ppk²/(2n)).
    pub fn of_capability(&self, capability: f64, upper: bool, units: f64) -> f64 {
        let third = if upper { -1.0 / 3.0 } else { 1.0 / 3.0 };
        self.error(&[0.5 * capability, third, -0.5 * capability], units)
    }

    /// Standard error of the mean square about a point that the mean of `units` is `off` by.
    pub fn of_square(&self, deviation: f64, off: f64, units: f64) -> f64 {
        let variance = deviation * deviation;
        self.error(&[-variance, 2.0 * deviation * off, variance], units)
    }

    /// Standard error of a statistic of `units` whose influence function has these coefficients, the constant first.
    fn error(&self, influence: &[f64], units: f64) -> f64 {
        let row = |(i, a): (usize, &f64)| influence.iter().enumerate().map(|(j, b)| a * b * self.0[i + j]).sum::<f64>();
        let square: f64 = influence.iter().enumerate().map(row).sum();
        libm::sqrt(square.max(0.0) / units)
    }
}

/// The part that a sample's own standard error of a skewness or a kurtosis has in the exponent. With the model's alone 98 % of
/// intervals hold for a log-normal of skewness 2, with the sample's alone 72 %.
const OWN: f64 = 0.45;

/// A standard error between that of the `model` and the `own` one of the sample.
pub fn between(model: f64, own: f64) -> f64 {
    if own > 0.0 && own.is_finite() { libm::pow(model, 1.0 - OWN) * libm::pow(own, OWN) } else { model }
}

/// The 95 % interval of a statistic with a standard `error` about its `value`.
pub fn about(value: f64, error: f64) -> [f64; 2] {
    let half = normal_factor() * error;
    [value - half, value + half]
}

/// Cumulants from central moments of the orders 0 to 8, with a `mean`.
pub fn cumulants(mean: f64, moments: &[f64; ORDER + 1]) -> [f64; ORDER] {
    let mut cumulants = [0.0; ORDER];
    cumulants[0] = mean;
    for n in 2..=ORDER {
        let known: f64 = (2..n).map(|k| binomial(n - 1, k - 1) * cumulants[k - 1] * moments[n - k]).sum();
        cumulants[n - 1] = moments[n] - known;
    }
    cumulants
}

/// Mean and central moments of the orders 0 to 8 of weighted values; the weights add up to 1.
pub fn weighted(values: impl Iterator<Item = (f64, f64)> + Clone) -> (f64, [f64; ORDER + 1]) {
    let mean: f64 = values.clone().map(|(weight, value)| weight * value).sum();
    let mut moments = [0.0; ORDER + 1];
    for (weight, value) in values {
        let mut power = weight;
        for moment in &mut moments {
            *moment += power;
            power *= value - mean;
        }
    }
    moments[0] = 1.0;
    moments[1] = 0.0;
    (mean, moments)
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

#[cfg(test)]
mod tests {
    use crate::numeric::shape::{ORDER, Shape, cumulants, weighted};

    #[track_caller]
    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{found}, not {expected}");
    }

    /// Central moments of an exponential distribution of rate 1.
    const SUBFACTORIALS: [f64; ORDER + 1] = [1.0, 0.0, 1.0, 2.0, 9.0, 44.0, 265.0, 1854.0, 14_833.0];

    #[test]
    fn moments_and_cumulants_are_each_other_s_inverse() {
        // The cumulants of an exponential distribution of rate 1 are (r − 1)!.
        let mut factorials = [1.0; ORDER];
        for r in 1..ORDER {
            factorials[r] = factorials[r - 1] * r as f64;
        }
        let Shape(moments) = Shape::of_cumulants(&factorials);
        for (found, expected) in moments.into_iter().zip(SUBFACTORIALS) {
            close(found, expected);
        }
        for (found, expected) in cumulants(1.0, &moments).into_iter().zip(factorials) {
            close(found, expected);
        }
        let (mean, moments) = weighted([(0.5, 1.0), (0.5, 3.0)].into_iter());
        close(mean, 2.0);
        assert!((0..=ORDER).all(|order| moments[order] == f64::from(u8::from(order % 2 == 0))));
    }

    #[test]
    fn errors_of_normal_samples_are_the_known_ones() {
        let n = 1000.0;
        close(Shape::NORMAL.freedom(n), n - 1.0);
        close(Shape::NORMAL.of_skewness(n), libm::sqrt(6.0 / n));
        close(Shape::NORMAL.of_kurtosis(n), libm::sqrt(24.0 / n));
        for upper in [false, true] {
            let known = libm::sqrt(1.0 / (9.0 * n) + 1.5 * 1.5 / (2.0 * n));
            close(Shape::NORMAL.of_capability(1.5, upper, n), known);
        }
        assert!(Shape::NORMAL.is_normal());
    }

    #[test]
    fn a_uniform_sample_knows_its_deviation_better() {
        // Central moments of a uniform: 1/(r + 1) of its half width to the power of r.
        let even = |order: usize| f64::from(u8::from(order.is_multiple_of(2)));
        let uniform = Shape::of_moments(std::array::from_fn(|order| even(order) / (order + 1) as f64));
        close(uniform.kurtosis(), 1.8);
        // Twice and a half the degrees of freedom: 2/(κ − 1) = 2.5.
        assert!((uniform.freedom(1e6) / 1e6 - 2.5).abs() < 1e-5 && !uniform.is_normal());
    }
}
