//! The Weibull distribution.

use slipfit_tolerance::numeric::{
    normal::{quantile, tail},
    root::zero,
};

use super::{family::Family, sample::mean_and_square};

/// A Weibull distribution: ((x − shift)/scale)^shape is exponential with mean 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weibull {
    /// Lower end.
    pub shift: f64,
    /// Scale, above 0.
    pub scale: f64,
    /// Shape, above 0.
    pub shape: f64,
}

impl Weibull {
    /// The likeliest one for the `logarithms` of the distances from a lower end `shift`, at least two of which differ.
    pub(super) fn fit(logarithms: &[f64], shift: f64) -> Self {
        let greatest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (mean, square) = mean_and_square(logarithms);
        // Powers of the distances relative to the greatest, which do not overflow.
        let sums = |shape: f64| {
            logarithms.iter().fold([0.0; 2], |[sum, weighted], logarithm| {
                let below = logarithm - greatest;
                let power = libm::exp(shape * below);
                [sum + power, weighted + power * below]
            })
        };
        // The derivative of the likelihood by the shape, which rises from −∞ to the gap of the greatest to the mean.
        let slope = |ln_shape: f64| {
            let shape = libm::exp(ln_shape);
            let [sum, weighted] = sums(shape);
            weighted / sum - 1.0 / shape + (greatest - mean)
        };
        // Menon's estimate by moments of the logarithms is within a few times of it.
        let start = libm::log(std::f64::consts::PI / libm::sqrt(6.0 * square));
        let [mut low, mut high] = [start - 0.5, start + 0.5];
        while slope(low) > 0.0 && low > start - 40.0 {
            low -= 1.0;
        }
        while slope(high) < 0.0 && high < start + 40.0 {
            high += 1.0;
        }
        let shape = libm::exp(zero(low, high, slope));
        let mean_power = sums(shape)[0] / logarithms.len() as f64;
        Self { shift, shape, scale: libm::exp(greatest + libm::log(mean_power) / shape) }
    }

    /// ((x − shift)/scale)^shape.
    fn power(&self, x: f64) -> f64 {
        libm::pow((x - self.shift) / self.scale, self.shape)
    }
}

impl Family for Weibull {
    fn clone_box(&self) -> Box<dyn Family> {
        Box::new(*self)
    }

    fn parameters(&self) -> Vec<(&'static str, f64)> {
        vec![("shift", self.shift), ("scale", self.scale), ("shape", self.shape)]
    }

    fn ln_density(&self, x: f64) -> f64 {
        if x <= self.shift {
            return f64::NEG_INFINITY;
        }
        let logarithm = libm::log((x - self.shift) / self.scale);
        libm::log(self.shape / self.scale) + (self.shape - 1.0) * logarithm - libm::exp(self.shape * logarithm)
    }

    fn tails(&self, x: f64) -> [f64; 2] {
        if x <= self.shift {
            return [0.0, 1.0];
        }
        let power = self.power(x);
        [-libm::expm1(-power), libm::exp(-power)]
    }

    fn mean(&self) -> f64 {
        self.shift + self.scale * libm::tgamma(1.0 + 1.0 / self.shape)
    }

    fn deviation(&self) -> f64 {
        let [first, second] = [1.0, 2.0].map(|order| libm::tgamma(1.0 + order / self.shape));
        self.scale * libm::sqrt((second - first * first).max(0.0))
    }

    fn value(&self, score: f64) -> f64 {
        // −ln of the upper tail, from whichever tail is small.
        let power = if score < 0.0 { -libm::log1p(-tail(-score)) } else { -libm::log(tail(score)) };
        self.shift + self.scale * libm::pow(power, 1.0 / self.shape)
    }

    fn quantile(&self, probability: f64) -> f64 {
        let power = -libm::log1p(-probability);
        if power.is_finite() {
            self.shift + self.scale * libm::pow(power, 1.0 / self.shape)
        } else {
            self.value(quantile(probability))
        }
    }
}
