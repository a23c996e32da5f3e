//! Several single-precision numbers as one, in a vector register of the machine: a step of the kernel moves as many units at a
//! time.
//!
//! Every operation is done number by number, so that a unit's bits depend neither on its neighbours nor on how many there
//! are, nor on the instructions that compute them.

use std::{
    ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign},
    ptr::NonNull,
};

use num_traits::{One, Zero};
use pulp::{Simd, bytemuck};
use slipfit_core::{Scalar, power};

/// As many numbers as a register of the instructions `V` holds. A comparison holds if it holds for all of them.
///
/// Only what was given a `V` may name `Pack<V>`: with a `V` comes the knowledge that the machine has its instructions.
#[derive(Clone, Copy, Debug)]
pub struct Pack<V: Simd>(V::f32s);

/// The instructions themselves, for operators and constants, which have no argument that could bring them.
#[expect(unsafe_code, reason = "operators are not handed the proof that the machine has their instructions")]
#[inline(always)]
fn instructions<V: Simd>() -> V {
    const { assert!(size_of::<V>() == 0, "a proof has no bytes") };
    // SAFETY: a value without bytes can be read from any aligned address. That there may be one follows from the rule above:
    // packs are made by what was given a `V`.
    unsafe { NonNull::<V>::dangling().read() }
}

impl<V: Simd> Pack<V> {
    /// How many numbers there are.
    pub const LANES: usize = V::F32_LANES;

    /// `x` in every lane.
    #[inline(always)]
    pub fn splat(x: f32) -> Self {
        Self(instructions::<V>().splat_f32s(x))
    }

    /// The number in each lane.
    #[inline(always)]
    pub fn numbers(&self) -> &[f32] {
        bytemuck::cast_slice(std::slice::from_ref(&self.0))
    }

    /// The number in each lane.
    #[inline(always)]
    pub fn numbers_mut(&mut self) -> &mut [f32] {
        bytemuck::cast_slice_mut(std::slice::from_mut(&mut self.0))
    }

    /// The number in a `lane`.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> f32 {
        self.numbers()[lane]
    }

    /// Puts `x` into a `lane`.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, x: f32) {
        self.numbers_mut()[lane] = x;
    }

    fn all(&self, other: &Self, holds: impl Fn(&f32, &f32) -> bool) -> bool {
        self.numbers().iter().zip(other.numbers()).all(|(x, y)| holds(x, y))
    }
}

impl<V: Simd> Default for Pack<V> {
    fn default() -> Self {
        Self::splat(0.0)
    }
}

impl<V: Simd> Add for Pack<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(instructions::<V>().add_f32s(self.0, other.0))
    }
}

impl<V: Simd> Sub for Pack<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(instructions::<V>().sub_f32s(self.0, other.0))
    }
}

impl<V: Simd> Mul for Pack<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(instructions::<V>().mul_f32s(self.0, other.0))
    }
}

impl<V: Simd> Div for Pack<V> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(instructions::<V>().div_f32s(self.0, other.0))
    }
}

impl<V: Simd> Neg for Pack<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(instructions::<V>().neg_f32s(self.0))
    }
}

impl<V: Simd> AddAssign for Pack<V> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<V: Simd> SubAssign for Pack<V> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<V: Simd> MulAssign for Pack<V> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<V: Simd> DivAssign for Pack<V> {
    #[inline(always)]
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl<V: Simd> Zero for Pack<V> {
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::splat(0.0)
    }
}

impl<V: Simd> One for Pack<V> {
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }
}

impl<V: Simd> PartialEq for Pack<V> {
    fn eq(&self, other: &Self) -> bool {
        self.all(other, f32::eq)
    }
}

impl<V: Simd> PartialOrd for Pack<V> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        use std::cmp::Ordering::{Equal, Greater, Less};
        let holds = |ordering: &std::cmp::Ordering| self.all(other, |x, y| x.partial_cmp(y) == Some(*ordering));
        [Less, Equal, Greater].into_iter().find(holds)
    }

    fn lt(&self, other: &Self) -> bool {
        self.all(other, f32::lt)
    }

    fn le(&self, other: &Self) -> bool {
        self.all(other, f32::le)
    }

    fn gt(&self, other: &Self) -> bool {
        self.all(other, f32::gt)
    }

    fn ge(&self, other: &Self) -> bool {
        self.all(other, f32::ge)
    }
}

impl<V: Simd> Scalar for Pack<V> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::splat(value as f32)
    }

    /// The least of the numbers.
    fn to_f64(self) -> f64 {
        self.numbers().iter().fold(f64::INFINITY, |least, x| least.min(f64::from(*x)))
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
        let v = instructions::<V>();
        Self(v.select_f32s(v.less_than_f32s(other.0, self.0), yes.0, no.0))
    }

    #[inline(always)]
    fn rsqrt(self) -> Self {
        let v = instructions::<V>();
        let bits = v.wrapping_dyn_shr_u32s(v.transmute_u32s_f32s(self.0), v.splat_u32s(1));
        let guess = Self(v.transmute_f32s_u32s(v.sub_u32s(v.splat_u32s(power::RSQRT_BITS), bits)));
        power::refined_rsqrt(self, guess)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self * self.rsqrt()
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        let mut result = self;
        for (x, y) in result.numbers_mut().iter_mut().zip(exponent.numbers()) {
            *x = Scalar::pow(*x, *y);
        }
        result
    }

    #[inline(always)]
    fn ln(self) -> Self {
        let mut result = self;
        for x in result.numbers_mut() {
            *x = Scalar::ln(*x);
        }
        result
    }

    fn is_finite(self) -> bool {
        self.numbers().iter().all(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::Pack;
    use pulp::{Simd, WithSimd};
    use slipfit_core::Scalar;

    /// The bits of what operations give that are done on several numbers at once.
    struct Operations;

    /// Numbers to work on.
    const NUMBERS: [f32; 8] = [0.3, 7.25, 1e-7, 4e5, 1.0, 0.999, 12.0, 3e-3];

    impl WithSimd for Operations {
        type Output = Vec<[f32; 7]>;

        fn with_simd<V: Simd>(self, _: V) -> Vec<[f32; 7]> {
            let lanes = Pack::<V>::LANES;
            let mut x = Pack::<V>::splat(0.0);
            (0..lanes).for_each(|lane| x.set(lane, NUMBERS[lane % 8]));
            let y = Pack::splat(1.7);
            let found = [x + y, x - y, x / y, x.rsqrt(), x.sqrt(), x.pow(y), x.select_gt(y, -x, x * y)]
                .map(|pack| pack.numbers().to_vec());
            (0..lanes).map(|lane| std::array::from_fn(|i| found[i][lane])).collect()
        }
    }

    /// What `work` gives by every kind of instructions that the machine has, and by single numbers.
    fn by_all<T>(work: impl Fn() -> T) -> Vec<T::Output>
    where
        T: WithSimd,
    {
        let mut all = vec![Simd::vectorize(pulp::Scalar, work())];
        #[cfg(target_arch = "x86_64")]
        {
            all.extend(pulp::x86::V3::try_new().map(|avx2| Simd::vectorize(avx2, work())));
            all.extend(pulp::x86::V4::try_new().map(|avx512| Simd::vectorize(avx512, work())));
        }
        all
    }

    #[test]
    fn every_lane_has_the_bits_of_a_number_alone() {
        for found in by_all(|| Operations) {
            for (lane, found) in found.into_iter().enumerate() {
                let x = NUMBERS[lane % 8];
                let chosen = if x > 1.7 { -x } else { x * 1.7 };
                let alone = [x + 1.7, x - 1.7, x / 1.7, Scalar::rsqrt(x), Scalar::sqrt(x), Scalar::pow(x, 1.7), chosen];
                assert_eq!(found.map(f32::to_bits), alone.map(f32::to_bits));
            }
        }
    }

    /// Comparisons of a pack whose first number is 1 and whose others are 3, and the least of its numbers.
    struct Comparisons;

    impl WithSimd for Comparisons {
        type Output = Option<([bool; 4], [bool; 2], f64)>;

        fn with_simd<V: Simd>(self, _: V) -> Self::Output {
            let mut mixed = Pack::<V>::splat(3.0);
            mixed.set(0, 1.0);
            let [one, two, three] = [1.0, 2.0, 3.0].map(Pack::splat);
            let within = [mixed >= one, mixed <= three];
            (Pack::<V>::LANES > 1)
                .then(|| ([mixed > two, mixed < two, mixed >= two, mixed <= two], within, mixed.to_f64()))
        }
    }

    #[test]
    fn a_comparison_holds_if_it_holds_everywhere() {
        let found: Vec<_> = by_all(|| Comparisons).into_iter().flatten().collect();
        assert!(found.iter().all(|found| *found == ([false; 4], [true; 2], 1.0)), "{found:?}");
    }
}
