//! Several single-precision numbers as one: a step of the kernel moves as many units at a time.
//!
//! Every operation is done number by number, so that a unit's bits depend neither on its neighbours nor on how many there
//! are, nor on the instructions that compute them.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};
use slipfit_core::Scalar;

/// `W` numbers. A comparison holds if it holds for all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Pack<const W: usize>(pub [f32; W]);

impl<const W: usize> Pack<W> {
    /// `x` in every lane.
    #[inline(always)]
    pub fn splat(x: f32) -> Self {
        Self([x; W])
    }

    /// `f` of every number.
    #[inline(always)]
    fn map(self, f: impl Fn(f32) -> f32) -> Self {
        let mut result = self;
        for x in &mut result.0 {
            *x = f(*x);
        }
        result
    }

    /// `f` of every number and the one of `other` beside it.
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let mut result = self;
        for (x, y) in result.0.iter_mut().zip(other.0) {
            *x = f(*x, y);
        }
        result
    }

    fn all(&self, other: &Self, holds: impl Fn(f32, f32) -> bool) -> bool {
        self.0.iter().zip(other.0).all(|(x, y)| holds(*x, y))
    }
}

impl<const W: usize> Default for Pack<W> {
    fn default() -> Self {
        Self::splat(0.0)
    }
}

impl<const W: usize> Add for Pack<W> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |x, y| x + y)
    }
}

impl<const W: usize> Sub for Pack<W> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |x, y| x - y)
    }
}

impl<const W: usize> Mul for Pack<W> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |x, y| x * y)
    }
}

impl<const W: usize> Div for Pack<W> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |x, y| x / y)
    }
}

impl<const W: usize> Neg for Pack<W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl<const W: usize> AddAssign for Pack<W> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const W: usize> SubAssign for Pack<W> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const W: usize> MulAssign for Pack<W> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<const W: usize> DivAssign for Pack<W> {
    #[inline(always)]
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl<const W: usize> Zero for Pack<W> {
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::splat(0.0)
    }
}

impl<const W: usize> One for Pack<W> {
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }
}

impl<const W: usize> PartialOrd for Pack<W> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        use std::cmp::Ordering::{Equal, Greater, Less};
        let holds = |ordering: &std::cmp::Ordering| self.all(other, |x, y| x.partial_cmp(&y) == Some(*ordering));
        [Less, Equal, Greater].into_iter().find(holds)
    }

    fn lt(&self, other: &Self) -> bool {
        self.all(other, |x, y| x < y)
    }

    fn le(&self, other: &Self) -> bool {
        self.all(other, |x, y| x <= y)
    }

    fn gt(&self, other: &Self) -> bool {
        self.all(other, |x, y| x > y)
    }

    fn ge(&self, other: &Self) -> bool {
        self.all(other, |x, y| x >= y)
    }
}

impl<const W: usize> Scalar for Pack<W> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::splat(value as f32)
    }

    /// The least of the numbers.
    fn to_f64(self) -> f64 {
        self.0.iter().fold(f64::INFINITY, |least, x| least.min(f64::from(*x)))
    }

    #[inline(always)]
    fn from_count(count: u32) -> Self {
        Self::splat(f32::from_count(count))
    }

    #[inline(always)]
    fn from_word(word: u64) -> Self {
        Self::splat(f32::from_word(word))
    }

    #[inline(always)]
    fn select_gt(self, other: Self, yes: Self, no: Self) -> Self {
        let mut result = self;
        for lane in 0..W {
            result.0[lane] = self.0[lane].select_gt(other.0[lane], yes.0[lane], no.0[lane]);
        }
        result
    }

    #[inline(always)]
    fn rsqrt(self) -> Self {
        self.map(Scalar::rsqrt)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(Scalar::sqrt)
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        self.zip(exponent, Scalar::pow)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.map(Scalar::ln)
    }

    fn is_finite(self) -> bool {
        self.0.iter().all(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::Pack;
    use slipfit_core::Scalar;

    #[test]
    fn every_lane_has_the_bits_of_a_number_alone() {
        let numbers = [0.3f32, 7.25, 1e-7, 4e5, 1.0, 0.999, 12.0, 3e-3];
        let (x, y) = (Pack(numbers), Pack::<8>::splat(1.7));
        type Alone = fn(f32) -> f32;
        let pairs: [(Pack<8>, Alone); 7] = [
            (x + y, |x| x + 1.7),
            (x - y, |x| x - 1.7),
            (x / y, |x| x / 1.7),
            (x.rsqrt(), |x| Scalar::rsqrt(x)),
            (x.sqrt(), |x| Scalar::sqrt(x)),
            (x.pow(y), |x| Scalar::pow(x, 1.7)),
            (x.select_gt(y, -x, x * y), |x| if x > 1.7 { -x } else { x * 1.7 }),
        ];
        for (pack, alone) in pairs {
            assert_eq!(pack.0.map(f32::to_bits), numbers.map(|x| alone(x).to_bits()));
        }
    }

    #[test]
    fn a_comparison_holds_if_it_holds_everywhere() {
        let mixed = Pack([1.0f32, 3.0]);
        let two = Pack::splat(2.0);
        assert_eq!([mixed > two, mixed < two, mixed >= two, mixed <= two], [false; 4]);
        assert!(mixed >= Pack::splat(1.0) && mixed <= Pack::splat(3.0));
        assert_eq!(mixed.to_f64(), 1.0);
    }
}
