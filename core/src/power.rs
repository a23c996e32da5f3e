//! Powers with a real exponent, without branches: x^y = 2^(y·log₂ x). And 1/√x.
//!
//! `libm::pow` leaves early for many arguments, so that its run time depends on them, and cannot be vectorised.

/// √`x`, which IEEE 754 rounds alike on every machine.
#[cfg_attr(feature = "std", expect(clippy::disallowed_methods, reason = "a root has no other bits"))]
#[inline(always)]
pub(crate) fn sqrt_f64(x: f64) -> f64 {
    // libm has the instruction as assembly in its old encoding, for which a processor waits amid wide instructions: mechanisms in a plane
    // took three times as long.
    #[cfg(feature = "std")]
    return x.sqrt();
    #[cfg(not(feature = "std"))]
    libm::sqrt(x)
}

/// 1/√`x` for x > 0.
#[inline(always)]
pub fn rsqrt_f32(x: f32) -> f32 {
    let near = near_rsqrt_f32(x);
    near + near * what_is_missing(x * near * near)
}

/// √`x` for x ≥ 0, exactly 0 at 0.
#[inline(always)]
pub fn sqrt_f32(x: f32) -> f32 {
    let near = near_rsqrt_f32(x);
    let root = x * near;
    root + root * what_is_missing(root * near)
}

/// 1/√`x` to 0.09 %: one Newton step from a guess whose bits halve and negate the exponent. Guess and step are scaled so that the
/// step's cubic term has no factor.
#[inline(always)]
fn near_rsqrt_f32(x: f32) -> f32 {
    let guess = f32::from_bits(0x5f0b_3880u32.wrapping_sub(x.to_bits() >> 1));
    guess * (1.890_99 - x * guess * guess)
}

/// 1/√`s` − 1 for an s near 1, by its series up to the second order: the error is below the rounding.
#[inline(always)]
fn what_is_missing(s: f32) -> f32 {
    let miss = 1.0 - s;
    miss * (0.5 + 0.375 * miss)
}

/// `x` to the power of `y` for x ≥ 0, y > 0. Relative error ≤ 2e-6 for results inside 2^±126; 0 at 0.
///
/// Zero and denormals count as 2⁻¹²⁶ for the logarithm and are scaled back, so that the result stays monotone.
#[inline(always)]
pub fn pow_f32(x: f32, y: f32) -> f32 {
    let (exponent, series) = split_log_f32(x);
    let (log_high, log_low) = (exponent, series * core::f32::consts::LOG2_E);

    let scaled = y * log_high + y * log_low;
    let limited = if scaled > 127.0 { 127.0 } else { scaled };
    let limited = if limited > -126.0 { limited } else { -126.0 };
    let whole = (limited + if limited > 0.0 { 0.5 } else { -0.5 }) as i32;
    // The two products apart keep the fraction's digits, which the sum above has rounded away.
    let fraction = (y * log_high - whole as f32) + y * log_low;
    // Far outside the range of results only.
    let fraction = if fraction > 1.0 { 1.0 } else { fraction };
    let fraction = if fraction > -1.0 { fraction } else { -1.0 };
    let z = fraction * core::f32::consts::LN_2;
    let exponential = 1.0
        + z * (1.0
            + z * (1.0 / 2.0
                + z * (1.0 / 6.0 + z * (1.0 / 24.0 + z * (1.0 / 120.0 + z * (1.0 / 720.0 + z / 5040.0))))));
    let power = exponential * f32::from_bits((whole.wrapping_add(127) as u32) << 23);
    if x > f32::MIN_POSITIVE { power } else { power * (x / f32::MIN_POSITIVE) }
}

/// `x` to the power of `y` for x ≥ 0, y > 0. Relative error ≤ 1e-14 for results inside 2^±1022; 0 at 0.
///
/// Zero and denormals count as 2⁻¹⁰²² for the logarithm and are scaled back, so that the result stays monotone.
#[inline(always)]
pub fn pow_f64(x: f64, y: f64) -> f64 {
    let (exponent, series) = split_log_f64(x);
    let (log_high, log_low) = (exponent, series * core::f64::consts::LOG2_E);

    let scaled = y * log_high + y * log_low;
    let limited = if scaled > 1023.0 { 1023.0 } else { scaled };
    let limited = if limited > -1022.0 { limited } else { -1022.0 };
    let whole = (limited + if limited > 0.0 { 0.5 } else { -0.5 }) as i32;
    let fraction = (y * log_high - f64::from(whole)) + y * log_low;
    // Far outside the range of results only.
    let fraction = if fraction > 1.0 { 1.0 } else { fraction };
    let fraction = if fraction > -1.0 { fraction } else { -1.0 };
    let z = fraction * core::f64::consts::LN_2;
    let mut exponential = 1.0;
    for divisor in [15.0, 14.0, 13.0, 12.0, 11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0] {
        exponential = 1.0 + exponential * z / divisor;
    }
    let power = exponential * f64::from_bits((i64::from(whole).wrapping_add(1023) as u64) << 52);
    if x > f64::MIN_POSITIVE { power } else { power * (x / f64::MIN_POSITIVE) }
}

/// ln `x` for x > 0. Relative error ≤ 3e-7; zero and denormals count as 2⁻¹²⁶.
#[inline(always)]
pub fn ln_f32(x: f32) -> f32 {
    let (exponent, series) = split_log_f32(x);
    exponent * core::f32::consts::LN_2 + series
}

/// ln `x` for x > 0. Relative error ≤ 1e-15; zero and denormals count as 2⁻¹⁰²².
#[inline(always)]
pub fn ln_f64(x: f64) -> f64 {
    let (exponent, series) = split_log_f64(x);
    exponent * core::f64::consts::LN_2 + series
}

/// The exponent k and ln m of x = 2ᵏ·m, m in [√½, √2), so that the logarithm is accurate around x = 1. Zero and denormals
/// count as 2⁻¹²⁶.
#[inline(always)]
fn split_log_f32(x: f32) -> (f32, f32) {
    let normal = if x > f32::MIN_POSITIVE { x } else { f32::MIN_POSITIVE };
    let shifted = normal.to_bits().wrapping_sub(0x3f35_04f3);
    let exponent = (shifted as i32) >> 23;
    let mantissa = f32::from_bits((shifted & 0x007f_ffff).wrapping_add(0x3f35_04f3));
    let r = (mantissa - 1.0) / (mantissa + 1.0);
    let q = r * r;
    // ln m = 2 artanh r
    let series = r * (2.0 + q * (2.0 / 3.0 + q * (2.0 / 5.0 + q * (2.0 / 7.0 + q * (2.0 / 9.0)))));
    (exponent as f32, series)
}

/// The exponent k and ln m of x = 2ᵏ·m, m in [√½, √2). Zero and denormals count as 2⁻¹⁰²².
#[inline(always)]
fn split_log_f64(x: f64) -> (f64, f64) {
    let normal = if x > f64::MIN_POSITIVE { x } else { f64::MIN_POSITIVE };
    let shifted = normal.to_bits().wrapping_sub(0x3fe6_a09e_667f_3bcd);
    let exponent = ((shifted as i64) >> 52) as i32;
    let mantissa = f64::from_bits((shifted & 0x000f_ffff_ffff_ffff).wrapping_add(0x3fe6_a09e_667f_3bcd));
    let r = (mantissa - 1.0) / (mantissa + 1.0);
    let q = r * r;
    let mut tail = 0.0;
    for denominator in [23.0, 21.0, 19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0] {
        tail = tail * q + 2.0 / denominator;
    }
    let series = r * (2.0 + q * tail);
    (f64::from(exponent), series)
}

#[cfg(test)]
mod tests {
    use super::{ln_f32, ln_f64, pow_f32, pow_f64, sqrt_f64};

    /// With the feature `std` the root is the processor's, without it `libm`'s.
    #[test]
    fn roots_have_the_same_bits_whoever_computes_them() {
        let mut word = 1u64;
        for _ in 0..if cfg!(miri) { 1000 } else { 100_000 } {
            word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let x = f64::from_bits(word & !(1 << 63));
            assert!(x.is_nan() || sqrt_f64(x).to_bits() == libm::sqrt(x).to_bits(), "{x:e}");
        }
        for x in [0.0, -0.0, f64::from_bits(1), f64::MIN_POSITIVE, f64::MAX, f64::INFINITY] {
            assert_eq!(sqrt_f64(x).to_bits(), libm::sqrt(x).to_bits(), "{x:e}");
        }
        assert!(sqrt_f64(-1.0).is_nan());
    }

    #[test]
    fn logarithms_meet_their_bounds_against_libm() {
        for step in (-5000..5000).step_by(if cfg!(miri) { 100 } else { 1 }) {
            let x = libm::exp2(f64::from(step) / 47.0);
            let error = |found: f64, x: f64| libm::fabs(found - libm::log(x)) / libm::fabs(libm::log(x));
            assert!(x == 1.0 || error(ln_f64(x), x) <= 1e-15, "{x:e}");
            let single = x as f32;
            if single != 1.0 {
                assert!(error(f64::from(ln_f32(single)), f64::from(single)) <= 3e-7, "{x:e} in f32");
            }
        }
    }

    #[test]
    fn powers_meet_their_bounds_against_libm() {
        for exponent in [1.0, 1.1, 1.5, 2.0, 2.2, 3.0, 0.1, 0.5] {
            for k in (0..20_000u32).step_by(if cfg!(miri) { 1000 } else { 1 }) {
                let x = libm::exp2(-25.0 + 30.0 * f64::from(k) / 20_000.0);
                let exact = libm::pow(x, exponent);
                let error = libm::fabs(pow_f64(x, exponent) / exact - 1.0);
                assert!(error <= 1e-14, "{x}^{exponent}: {error:e}");
                let (x, y) = (x as f32, exponent as f32);
                let exact = libm::pow(f64::from(x), f64::from(y));
                let error = libm::fabs(f64::from(pow_f32(x, y)) / exact - 1.0);
                assert!(error <= 2e-6, "{x}^{y} in f32: {error:e}");
            }
        }
    }

    #[test]
    fn zero_and_denormals_stay_small_and_ordered() {
        assert_eq!(pow_f32(0.0, 1.5), 0.0);
        assert_eq!(pow_f64(0.0, 1.5), 0.0);
        assert!(pow_f32(1e-40, 0.5) > pow_f32(1e-42, 0.5));
        assert!(pow_f64(1e-310, 1.5) >= 0.0);
    }
}
