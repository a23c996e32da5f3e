//! Tails of distributions that tests and intervals need.

use slipfit_tolerance::numeric::{
    normal::{quantile, tail},
    root::zero,
};
use statrs::function::{beta::checked_beta_reg, gamma::checked_gamma_ur};

/// P(χ² > `value`) with some degrees of `freedom`.
pub fn chi_squared_above(value: f64, freedom: f64) -> f64 {
    if value <= 0.0 {
        return 1.0;
    }
    if !value.is_finite() {
        return 0.0;
    }
    // Beyond, Wilson and Hilferty's cube root (1931) is accurate to 1e-7.
    if freedom > 1e5 {
        let variance = 2.0 / (9.0 * freedom);
        return tail((libm::cbrt(value / freedom) - 1.0 + variance) / libm::sqrt(variance));
    }
    checked_gamma_ur(0.5 * freedom, 0.5 * value).unwrap_or(f64::NAN)
}

/// P(T > `value` ≥ 0) of Student's t.
pub fn student_above(value: f64, freedom: f64) -> f64 {
    0.5 * checked_beta_reg(0.5 * freedom, 0.5, freedom / (freedom + value * value)).unwrap_or(f64::NAN)
}

/// The value that Student's t exceeds with a `chance` below ½.
pub fn student_quantile_above(chance: f64, freedom: f64) -> f64 {
    let mut high = (-quantile(chance)).max(1.0);
    while student_above(high, freedom) > chance && high.is_finite() {
        high *= 2.0;
    }
    zero(0.0, high, |value| libm::log(chance / student_above(value, freedom)))
}

/// P(F > `value`) of Fisher's ratio of variances.
pub fn fisher_above(value: f64, [upper, lower]: [f64; 2]) -> f64 {
    if value <= 0.0 {
        return 1.0;
    }
    checked_beta_reg(0.5 * lower, 0.5 * upper, lower / (lower + upper * value)).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::{chi_squared_above, fisher_above, student_quantile_above};

    #[test]
    fn tabulated_points() {
        // Student's t, χ² and F as tabled in any textbook.
        for (chance, freedom, value) in
            [(0.025, 1.0, 12.706_205), (0.025, 9.0, 2.262_157), (0.005, 30.0, 2.749_996), (0.05, 2.0, 2.919_986)]
        {
            assert!((student_quantile_above(chance, freedom) / value - 1.0).abs() < 1e-6, "{chance} {freedom}");
        }
        assert!((chi_squared_above(16.918_978, 9.0) - 0.05).abs() < 1e-8);
        assert!((chi_squared_above(101_000.0, 100_001.0) - chi_squared_above(101_000.0, 99_999.9)).abs() < 1e-4);
        assert!((fisher_above(3.325_835, [5.0, 10.0]) - 0.05).abs() < 1e-7);
    }
}
