//! The numbers a kernel computes with.

use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign};
use num_traits::{One, Zero};

use crate::power;

/// A real number, or a lane of several, that never branches on its value.
///
/// Every method gives the same bits on every machine: only `+ − × ÷`, comparisons and `libm` are used.
pub trait Scalar:
    nalgebra::Scalar
    + Copy
    + Default
    + Zero
    + One
    + core::ops::Neg<Output = Self>
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + ClosedDivAssign
{
    /// The nearest value of this type.
    fn from_f64(value: f64) -> Self;

    /// The value as f64, exact for f32 and f64. For reports and errors, never inside a step.
    fn to_f64(self) -> f64;

    /// A count of steps as a number, exact below 2²⁴ for f32.
    fn from_count(count: u32) -> Self;

    /// The nearest value to `word`/2⁶⁴.
    fn from_word(word: u64) -> Self;

    /// `yes` where `self > other`, else `no` (also where either is NaN). Both sides are computed.
    fn select_gt(self, other: Self, yes: Self, no: Self) -> Self;

    /// 1/√`self` for a positive normal number. Relative error ≤ 2.5e-7 in f32, 3e-16 in f64. At zero it is finite
    /// in f32 and infinite in f64 and in lanes.
    fn rsqrt(self) -> Self;

    /// √`self` for `self` ≥ 0, exactly 0 at 0. Relative error ≤ 3e-7 in f32, half a unit in the last place in f64.
    fn sqrt(self) -> Self;

    /// `self` to the power of `exponent`, for `self` ≥ 0 and `exponent` > 0; 0 at 0.
    /// Relative error ≤ 2e-6 in f32, 1e-14 in f64 for results inside 2^±126 and 2^±1022.
    fn pow(self, exponent: Self) -> Self;

    /// ln `self` for a positive normal number. Relative error ≤ 3e-7 in f32, 1e-15 in f64.
    fn ln(self) -> Self;

    /// False for NaN and the infinities. A lane is finite if all of its numbers are.
    fn is_finite(self) -> bool;

    /// `self` where it is finite and `condition` > 0, else `old`.
    ///
    /// Each number asks for itself, because compilers make of one question for many a branch, or a choice of addresses for
    /// which both sides must be in memory.
    #[inline(always)]
    fn or_old(self, condition: Self, old: Self) -> Self {
        (condition + self * Self::zero()).select_gt(Self::zero(), self, old)
    }

    /// The larger of `self` and `other`, `other` where `self` is NaN.
    #[inline(always)]
    fn max_of(self, other: Self) -> Self {
        self.select_gt(other, self, other)
    }

    /// `self`, or `low` where `self` is below it.
    #[inline(always)]
    fn at_least(self, low: Self) -> Self {
        low.select_gt(self, low, self)
    }

    /// `self`, or `high` where `self` is above it.
    #[inline(always)]
    fn at_most(self, high: Self) -> Self {
        self.select_gt(high, high, self)
    }

    /// |`self`|.
    #[inline(always)]
    fn magnitude(self) -> Self {
        self.select_gt(Self::zero(), self, -self)
    }

    /// `self` held inside [`low`, `high`].
    #[inline(always)]
    fn within(self, low: Self, high: Self) -> Self {
        self.max_of(low).at_most(high)
    }
}

impl Scalar for f32 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn from_count(count: u32) -> Self {
        count as f32
    }

    #[inline(always)]
    fn from_word(word: u64) -> Self {
        word as f32 * (1.0 / 18_446_744_073_709_551_616.0)
    }

    #[inline(always)]
    fn select_gt(self, other: Self, yes: Self, no: Self) -> Self {
        if self > other { yes } else { no }
    }

    /// Some 20 instructions on a Cortex-M4F, against a software root of some 200 in `libm`, and free of branches.
    #[inline(always)]
    fn rsqrt(self) -> Self {
        power::rsqrt_f32(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        power::sqrt_f32(self)
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        power::pow_f32(self, exponent)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        power::ln_f32(self)
    }

    fn is_finite(self) -> bool {
        f32::is_finite(self)
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }

    fn to_f64(self) -> f64 {
        self
    }

    #[inline(always)]
    fn from_count(count: u32) -> Self {
        f64::from(count)
    }

    #[inline(always)]
    fn from_word(word: u64) -> Self {
        word as f64 * (1.0 / 18_446_744_073_709_551_616.0)
    }

    #[inline(always)]
    fn select_gt(self, other: Self, yes: Self, no: Self) -> Self {
        if self > other { yes } else { no }
    }

    #[inline(always)]
    fn rsqrt(self) -> Self {
        1.0 / power::sqrt_f64(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        power::sqrt_f64(self)
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        power::pow_f64(self, exponent)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        power::ln_f64(self)
    }

    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

#[cfg(test)]
mod tests {
    use super::Scalar;

    #[test]
    fn f32_reciprocal_root_meets_its_bound() {
        let mut worst = 0.0f64;
        for exponent in -126..127 {
            for step in (0..997u16).step_by(if cfg!(miri) { 100 } else { 1 }) {
                let mantissa = 1.0 + f64::from(step) / 997.0;
                let x = (mantissa * libm::exp2(f64::from(exponent))) as f32;
                let exact = 1.0 / libm::sqrt(f64::from(x));
                worst = worst.max(libm::fabs(f64::from(Scalar::rsqrt(x)) / exact - 1.0));
                let root = f64::from(Scalar::sqrt(x));
                assert!(libm::fabs(root * exact - 1.0) <= 3e-7, "sqrt({x})");
            }
        }
        assert!(worst <= 2.5e-7, "{worst:e}");
    }

    #[test]
    fn root_of_zero_is_zero() {
        assert_eq!(Scalar::sqrt(0.0f32).to_bits(), 0);
        assert_eq!(Scalar::sqrt(0.0f64).to_bits(), 0);
    }

    #[test]
    fn selection_keeps_a_fixed_order() {
        assert_eq!(f32::NAN.max_of(2.0), 2.0);
        assert_eq!(3.0f64.within(0.0, 1.0), 1.0);
        assert_eq!((-3.0f64).within(0.0, 1.0), 0.0);
        assert_eq!((-3.0f32).magnitude(), 3.0);
    }
}
