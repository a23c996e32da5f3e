//! The noncentral t distribution: that of (Z + δ)/(s/σ), the distance of a sample's mean from a limit in its own standard
//! deviations.

use slipfit_tolerance::numeric::{
    normal::{quantile, tail},
    root::zero,
};

use super::{
    scale::{ratios, scores},
    tails::chi_squared_above,
};

/// Its points for some degrees of freedom.
pub struct NoncentralT {
    freedom: f64,
    /// Points of the standard deviation's ratio.
    ratios: Vec<[f64; 2]>,
    /// Points of the normal score.
    scores: &'static [[f64; 2]],
}

impl NoncentralT {
    /// With degrees of `freedom` > 0.
    pub fn new(freedom: f64) -> Self {
        Self { freedom, ratios: ratios(freedom), scores: scores() }
    }

    /// P(T ≤ `t`) and P(T > `t`) with noncentrality `shift`, to 1e-9.
    pub fn sides(&self, t: f64, shift: f64) -> [f64; 2] {
        // Of the two variables, the integral is over the one along which the other's probability is smoother.
        if t.abs() < libm::sqrt(2.0 * self.freedom) {
            let below = self.ratios.iter().map(|[ratio, weight]| weight * tail(shift - t * ratio)).sum();
            let above = self.ratios.iter().map(|[ratio, weight]| weight * tail(t * ratio - shift)).sum();
            return [below, above];
        }
        if t < 0.0 {
            let [below, above] = self.sides(-t, -shift);
            return [above, below];
        }
        // (Z + δ)/r ≤ t where r ≥ (Z + δ)/t.
        let mut sides = [0.0; 2];
        for [score, weight] in self.scores {
            let ratio = ((score + shift) / t).max(0.0);
            let below = chi_squared_above(self.freedom * ratio * ratio, self.freedom);
            sides[0] += weight * below;
            sides[1] += weight * (1.0 - below);
        }
        sides
    }

    /// The noncentrality with which T exceeds `t` with a `chance`.
    pub fn shift(&self, t: f64, chance: f64) -> f64 {
        // A bracket by the normal approximation, whose standard deviation in δ is √(1 + t²/2ν).
        let width = libm::sqrt(1.0 + 0.5 * t * t / self.freedom);
        let start = t + quantile(chance) * width;
        let excess = |shift: f64| {
            let [below, above] = self.sides(t, shift);
            // Logarithms are nearly straight lines, and keep their digits for small chances.
            libm::log(above.max(f64::MIN_POSITIVE) / chance) - libm::log(below.max(f64::MIN_POSITIVE) / (1.0 - chance))
        };
        let (mut low, mut high, mut step) = (start - 0.5 * width, start + 0.5 * width, width);
        while excess(low) > 0.0 && step < 1e3 * width {
            (high, low) = (low, low - step);
            step *= 2.0;
        }
        while excess(high) < 0.0 && step < 1e3 * width {
            (low, high) = (high, high + step);
            step *= 2.0;
        }
        zero(low, high, excess)
    }

    /// The value that T exceeds with a `chance` at noncentrality `shift`.
    pub fn quantile_above(&self, shift: f64, chance: f64) -> f64 {
        let excess = |t: f64| {
            let [below, above] = self.sides(t, shift);
            libm::log(below.max(f64::MIN_POSITIVE) / (1.0 - chance)) - libm::log(above.max(f64::MIN_POSITIVE) / chance)
        };
        let (mut low, mut high, mut step) = (shift - 1.0, shift + 1.0, 1.0);
        while excess(low) > 0.0 && step < 1e12 {
            step *= 2.0;
            low -= step;
        }
        while excess(high) < 0.0 && step < 1e12 {
            step *= 2.0;
            high += step;
        }
        zero(low, high, excess)
    }
}

#[cfg(test)]
mod tests {
    use slipfit_tolerance::numeric::normal::quantile;

    use super::NoncentralT;

    #[test]
    fn one_sided_tolerance_factors_as_published() {
        // t(ν, δ)/√n with δ = z·√n, 95 % confidence: R. Odeh and D. Owen, "Tables for Normal Tolerance Limits, Sampling
        // Plans, and Screening", 1980, table 1.
        for (parts, factors) in [
            (5.0, [3.407, 4.203, 5.741]),
            (10.0, [2.355, 2.911, 3.981]),
            (30.0, [1.777, 2.220, 3.064]),
            (100.0, [1.527, 1.927, 2.684]),
        ] {
            for (share, published) in [0.9, 0.95, 0.99].into_iter().zip(factors) {
                assert!((factor(parts, share, 0.95) - published).abs() < 5e-4, "{parts} {share} {published}");
            }
        }
        // NIST/SEMATECH e-Handbook of Statistical Methods, 7.2.6.3: 43 wafers, 90 %, 99 % confidence.
        assert!((factor(43.0, 0.9, 0.99) - 1.8740).abs() < 5e-5);
    }

    fn factor(parts: f64, share: f64, confidence: f64) -> f64 {
        let root = libm::sqrt(parts);
        NoncentralT::new(parts - 1.0).quantile_above(quantile(share) * root, 1.0 - confidence) / root
    }

    #[test]
    fn shifts_are_inverse_to_probabilities() {
        for freedom in [1.0, 5.0, 99.0, 5000.0] {
            let t = NoncentralT::new(freedom);
            for value in [-80.0, -3.0, 0.0, 0.5, 7.0, 60.0, 1e4] {
                for chance in [0.025, 0.975] {
                    let shift = t.shift(value, chance);
                    let above = t.sides(value, shift)[1];
                    assert!((above - chance).abs() < 1e-9, "{freedom} {value} {chance}: {shift} {above}");
                }
            }
        }
    }
}
