//! Several numbers as one, in a vector register of the machine: a step of the kernel moves as many units at a time, or the desk
//! sees the pins of a slide side by side.
//!
//! Every operation is done number by number, so that the bits in a lane depend neither on its neighbours nor on how many there
//! are, nor on the instructions that compute them.

mod number;

use std::{
    ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign},
    ptr::NonNull,
};

use num_traits::{One, Zero};
use pulp::{Simd, bytemuck};
use slipfit_core::{Scalar, system::Lanes};

pub use number::Number;

/// As many numbers `T` as a register of the instructions `V` holds. A comparison holds if it holds for all of them.
///
/// Only what was given a `V` may name `Pack<V>`: with a `V` comes the knowledge that the machine has its instructions.
/// Aligned as the widest register of such numbers: what is read across the border of two lines of the cache takes twice as long.
#[derive(Clone, Copy, Debug)]
pub struct Pack<V: Simd, T: Number = f32>(T::Register<V>, [T::Aligned; 0]);

/// The instructions themselves, for operators and constants, which have no argument that could bring them.
#[expect(unsafe_code, reason = "operators are not handed the proof that the machine has their instructions")]
#[inline(always)]
fn instructions<V: Simd>() -> V {
    const { assert!(size_of::<V>() == 0, "a proof has no bytes") };
    // SAFETY: a value without bytes can be read from any aligned address. That there may be one follows from the rule above:
    // packs are made by what was given a `V`.
    unsafe { NonNull::<V>::dangling().read() }
}

/// Four elements side by side.
impl<V: Simd> Lanes<f64> for Pack<V, f64> {
    #[inline(always)]
    fn of(numbers: [f64; 4]) -> Self {
        const { assert!(Self::LANES == 4, "a register holds four numbers") };
        Self::new(bytemuck::cast(numbers))
    }

    #[inline(always)]
    fn each(self) -> [f64; 4] {
        bytemuck::cast(self.0)
    }
}

impl<V: Simd, T: Number> Pack<V, T> {
    #[inline(always)]
    fn new(register: T::Register<V>) -> Self {
        Self(register, [])
    }

    /// How many numbers there are.
    pub const LANES: usize = size_of::<T::Register<V>>() / size_of::<T>();

    /// `x` in every lane.
    #[inline(always)]
    pub fn splat(x: T) -> Self {
        Self::new(T::splat(instructions::<V>(), x))
    }

    /// The number in each lane.
    #[inline(always)]
    pub fn numbers(&self) -> &[T] {
        bytemuck::cast_slice(std::slice::from_ref(&self.0))
    }

    /// The number in each lane.
    #[inline(always)]
    pub fn numbers_mut(&mut self) -> &mut [T] {
        bytemuck::cast_slice_mut(std::slice::from_mut(&mut self.0))
    }

    /// The number in a `lane`.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> T {
        self.numbers()[lane]
    }

    /// Puts `x` into a `lane`.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, x: T) {
        self.numbers_mut()[lane] = x;
    }

    /// Compares all, whatever the first ones give: without branches, several at a time.
    #[inline(always)]
    fn all(&self, other: &Self, holds: impl Fn(&T, &T) -> bool) -> bool {
        self.numbers().iter().zip(other.numbers()).fold(true, |all, (x, y)| all & holds(x, y))
    }
}

impl<V: Simd, T: Number> Default for Pack<V, T> {
    fn default() -> Self {
        Self::splat(T::zero())
    }
}

impl<V: Simd, T: Number> Add for Pack<V, T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(T::sum(instructions::<V>(), self.0, other.0))
    }
}

impl<V: Simd, T: Number> Sub for Pack<V, T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(T::difference(instructions::<V>(), self.0, other.0))
    }
}

impl<V: Simd, T: Number> Mul for Pack<V, T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(T::product(instructions::<V>(), self.0, other.0))
    }
}

impl<V: Simd, T: Number> Div for Pack<V, T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self::new(T::quotient(instructions::<V>(), self.0, other.0))
    }
}

impl<V: Simd, T: Number> Neg for Pack<V, T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(T::negated(instructions::<V>(), self.0))
    }
}

impl<V: Simd, T: Number> AddAssign for Pack<V, T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<V: Simd, T: Number> SubAssign for Pack<V, T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<V: Simd, T: Number> MulAssign for Pack<V, T> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<V: Simd, T: Number> DivAssign for Pack<V, T> {
    #[inline(always)]
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl<V: Simd, T: Number> Zero for Pack<V, T> {
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(T::zero())
    }

    fn is_zero(&self) -> bool {
        *self == Self::splat(T::zero())
    }
}

impl<V: Simd, T: Number> One for Pack<V, T> {
    #[inline(always)]
    fn one() -> Self {
        Self::splat(T::one())
    }
}

impl<V: Simd, T: Number> PartialEq for Pack<V, T> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.all(other, T::eq)
    }
}

impl<V: Simd, T: Number> PartialOrd for Pack<V, T> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        use std::cmp::Ordering::{Equal, Greater, Less};
        let holds = |ordering: &std::cmp::Ordering| self.all(other, |x, y| x.partial_cmp(y) == Some(*ordering));
        [Less, Equal, Greater].into_iter().find(holds)
    }

    #[inline(always)]
    fn lt(&self, other: &Self) -> bool {
        self.all(other, T::lt)
    }

    #[inline(always)]
    fn le(&self, other: &Self) -> bool {
        self.all(other, T::le)
    }

    #[inline(always)]
    fn gt(&self, other: &Self) -> bool {
        self.all(other, T::gt)
    }

    #[inline(always)]
    fn ge(&self, other: &Self) -> bool {
        self.all(other, T::ge)
    }
}

impl<V: Simd, T: Number> Scalar for Pack<V, T> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::splat(T::from_f64(value))
    }

    /// The least of the numbers.
    fn to_f64(self) -> f64 {
        self.numbers().iter().fold(f64::INFINITY, |least, x| least.min(x.to_f64()))
    }

    #[inline(always)]
    fn from_count(count: u32) -> Self {
        Self::splat(T::from_count(count))
    }

    #[inline(always)]
    fn from_word(word: u64) -> Self {
        Self::splat(T::from_word(word))
    }

    #[inline(always)]
    fn select_gt(self, other: Self, yes: Self, no: Self) -> Self {
        Self::new(T::chosen(instructions::<V>(), self.0, other.0, [yes.0, no.0]))
    }

    #[inline(always)]
    fn max_of(self, other: Self) -> Self {
        Self::new(T::larger(instructions::<V>(), self.0, other.0))
    }

    #[inline(always)]
    fn at_most(self, high: Self) -> Self {
        Self::new(T::smaller(instructions::<V>(), high.0, self.0))
    }

    #[inline(always)]
    fn rsqrt(self) -> Self {
        Self::one() / self.sqrt()
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::new(T::root(instructions::<V>(), self.0))
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        let mut result = self;
        for (x, y) in result.numbers_mut().iter_mut().zip(exponent.numbers()) {
            *x = x.pow(*y);
        }
        result
    }

    #[inline(always)]
    fn ln(self) -> Self {
        let mut result = self;
        for x in result.numbers_mut() {
            *x = x.ln();
        }
        result
    }

    fn is_finite(self) -> bool {
        self.numbers().iter().all(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use std::marker::PhantomData;

    use super::{Number, Pack};
    use pulp::{Simd, WithSimd};
    use slipfit_core::Scalar;

    /// What operations give that are done on several numbers at once.
    struct Operations<T>(PhantomData<T>);

    /// How many operations.
    const OPERATIONS: usize = 9;

    /// Numbers to work on.
    const NUMBERS: [f64; 8] = [0.3, 7.25, 1e-7, 4e5, 1.0, f64::NAN, 12.0, 3e-3];

    impl<T: Number> WithSimd for Operations<T> {
        type Output = Vec<[T; OPERATIONS]>;

        fn with_simd<V: Simd>(self, _: V) -> Vec<[T; OPERATIONS]> {
            let lanes = Pack::<V, T>::LANES;
            let mut x = Pack::<V, T>::splat(T::zero());
            (0..lanes).for_each(|lane| x.set(lane, T::from_f64(NUMBERS[lane % 8])));
            let y = Pack::splat(T::from_f64(1.7));
            let limits = [x.max_of(y), x.at_most(y)];
            let found =
                [x + y, x - y, x / y, x.rsqrt(), x.sqrt(), x.pow(y), x.select_gt(y, -x, x * y), limits[0], limits[1]]
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
        every_lane::<f32>();
        every_lane::<f64>();
    }

    /// Roots are the machine's, of which core's single precision makes do without.
    fn every_lane<T: Number>() {
        for found in by_all(|| Operations(PhantomData::<T>)) {
            for (lane, found) in found.into_iter().enumerate() {
                let (x, y) = (T::from_f64(NUMBERS[lane % 8]), T::from_f64(1.7));
                let chosen = if x > y { -x } else { x * y };
                let root = Pack::<pulp::Scalar, T>::splat(x).sqrt().get(0);
                let power = Scalar::pow(x, y);
                let limits = [Scalar::max_of(x, y), Scalar::at_most(x, y)];
                let alone = [x + y, x - y, x / y, T::one() / root, root, power, chosen, limits[0], limits[1]];
                let same = |(found, alone): (&T, &T)| {
                    let [found, alone]: [f64; 2] = [*found, *alone].map(Scalar::to_f64);
                    found.to_bits() == alone.to_bits() || (found.is_nan() && alone.is_nan())
                };
                assert!(found.iter().zip(&alone).all(same), "{found:?} {alone:?}");
                let [x, root]: [f64; 2] = [x, root].map(|x| x.to_f64());
                assert!(x.is_nan() || (root * root / x - 1.0).abs() <= 3e-7, "the root of {x} is not {root}");
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
