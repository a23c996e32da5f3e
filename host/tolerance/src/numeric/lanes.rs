//! Several assembled units at once: a number of each of [`LANES`] units, on which arithmetic works unit by unit.
//!
//! Element loops over a fixed array compile to vector instructions, and every lane has the bits that a scalar would.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Units in one [`Lanes`].
pub const LANES: usize = 8;

/// One number of each of [`LANES`] units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// Zero in every lane.
    pub const ZERO: Self = Self::splat(0.0);

    /// The same value in every lane.
    #[inline(always)]
    pub const fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    /// `function` of every lane.
    #[inline(always)]
    pub fn map(mut self, function: impl Fn(f64) -> f64) -> Self {
        // A plain loop: the closures of array functions are not always inlined into wider instructions.
        for lane in 0..LANES {
            self.0[lane] = function(self.0[lane]);
        }
        self
    }

    /// `function` of every lane and that of another.
    #[inline(always)]
    pub fn zip(mut self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        for lane in 0..LANES {
            self.0[lane] = function(self.0[lane], other.0[lane]);
        }
        self
    }

    /// Square roots. IEEE 754 rounds them correctly, so these are the bits of every machine.
    #[inline(always)]
    #[expect(clippy::disallowed_methods, reason = "an instruction, with the bits of libm::sqrt")]
    pub fn sqrt(self) -> Self {
        self.map(|x| x.sqrt())
    }
}

/// Does `work` in the widest instructions that the machine has, which what it calls uses as far as it is inlined. The bits do
/// not depend on them.
#[inline(always)]
pub fn widest<T>(work: impl FnOnce() -> T) -> T {
    #[cfg(target_arch = "x86_64")]
    {
        if let Some(avx512) = pulp::x86::V4::try_new() {
            return pulp::Simd::vectorize(avx512, work);
        }
        if let Some(avx2) = pulp::x86::V3::try_new() {
            return pulp::Simd::vectorize(avx2, work);
        }
    }
    work()
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Mul<f64> for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.map(|a| a * factor)
    }
}

impl Div for Lanes {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
