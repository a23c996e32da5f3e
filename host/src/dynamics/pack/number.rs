//! The numbers of which a pack holds several, and what the instructions of a machine do with registers of them.

use pulp::{Simd, bytemuck::Pod};
use slipfit_core::{Scalar, power};

use super::{Pack, instructions};

/// A number that registers hold.
pub trait Number: Scalar + PartialOrd + Pod {
    /// A register of the instructions `V`.
    type Register<V: Simd>: Pod + std::fmt::Debug + Send + Sync;

    /// `x` in every lane.
    fn splat<V: Simd>(instructions: V, x: Self) -> Self::Register<V>;
    /// x + y.
    fn sum<V: Simd>(instructions: V, x: Self::Register<V>, y: Self::Register<V>) -> Self::Register<V>;
    /// x − y.
    fn difference<V: Simd>(instructions: V, x: Self::Register<V>, y: Self::Register<V>) -> Self::Register<V>;
    /// x·y.
    fn product<V: Simd>(instructions: V, x: Self::Register<V>, y: Self::Register<V>) -> Self::Register<V>;
    /// x/y.
    fn quotient<V: Simd>(instructions: V, x: Self::Register<V>, y: Self::Register<V>) -> Self::Register<V>;
    /// −x.
    fn negated<V: Simd>(instructions: V, x: Self::Register<V>) -> Self::Register<V>;
    /// The first of `chosen` where x > y, else the second.
    fn chosen<V: Simd>(
        instructions: V,
        x: Self::Register<V>,
        y: Self::Register<V>,
        chosen: [Self::Register<V>; 2],
    ) -> Self::Register<V>;
    /// As [`Scalar::rsqrt`].
    fn reciprocal_root<V: Simd>(x: Pack<V, Self>) -> Pack<V, Self>;
    /// As [`Scalar::sqrt`].
    fn root<V: Simd>(x: Pack<V, Self>) -> Pack<V, Self>;
}

impl Number for f32 {
    type Register<V: Simd> = V::f32s;

    #[inline(always)]
    fn splat<V: Simd>(v: V, x: f32) -> V::f32s {
        v.splat_f32s(x)
    }

    #[inline(always)]
    fn sum<V: Simd>(v: V, x: V::f32s, y: V::f32s) -> V::f32s {
        v.add_f32s(x, y)
    }

    #[inline(always)]
    fn difference<V: Simd>(v: V, x: V::f32s, y: V::f32s) -> V::f32s {
        v.sub_f32s(x, y)
    }

    #[inline(always)]
    fn product<V: Simd>(v: V, x: V::f32s, y: V::f32s) -> V::f32s {
        v.mul_f32s(x, y)
    }

    #[inline(always)]
    fn quotient<V: Simd>(v: V, x: V::f32s, y: V::f32s) -> V::f32s {
        v.div_f32s(x, y)
    }

    #[inline(always)]
    fn negated<V: Simd>(v: V, x: V::f32s) -> V::f32s {
        v.neg_f32s(x)
    }

    #[inline(always)]
    fn chosen<V: Simd>(v: V, x: V::f32s, y: V::f32s, [yes, no]: [V::f32s; 2]) -> V::f32s {
        v.select_f32s(v.less_than_f32s(y, x), yes, no)
    }

    #[inline(always)]
    fn reciprocal_root<V: Simd>(x: Pack<V, f32>) -> Pack<V, f32> {
        let v = instructions::<V>();
        let bits = v.wrapping_dyn_shr_u32s(v.transmute_u32s_f32s(x.0), v.splat_u32s(1));
        let guess = Pack(v.transmute_f32s_u32s(v.sub_u32s(v.splat_u32s(power::RSQRT_BITS), bits)));
        power::refined_rsqrt(x, guess)
    }

    #[inline(always)]
    fn root<V: Simd>(x: Pack<V, f32>) -> Pack<V, f32> {
        x * x.rsqrt()
    }
}

impl Number for f64 {
    type Register<V: Simd> = V::f64s;

    #[inline(always)]
    fn splat<V: Simd>(v: V, x: f64) -> V::f64s {
        v.splat_f64s(x)
    }

    #[inline(always)]
    fn sum<V: Simd>(v: V, x: V::f64s, y: V::f64s) -> V::f64s {
        v.add_f64s(x, y)
    }

    #[inline(always)]
    fn difference<V: Simd>(v: V, x: V::f64s, y: V::f64s) -> V::f64s {
        v.sub_f64s(x, y)
    }

    #[inline(always)]
    fn product<V: Simd>(v: V, x: V::f64s, y: V::f64s) -> V::f64s {
        v.mul_f64s(x, y)
    }

    #[inline(always)]
    fn quotient<V: Simd>(v: V, x: V::f64s, y: V::f64s) -> V::f64s {
        v.div_f64s(x, y)
    }

    #[inline(always)]
    fn negated<V: Simd>(v: V, x: V::f64s) -> V::f64s {
        v.neg_f64s(x)
    }

    #[inline(always)]
    fn chosen<V: Simd>(v: V, x: V::f64s, y: V::f64s, [yes, no]: [V::f64s; 2]) -> V::f64s {
        v.select_f64s(v.less_than_f64s(y, x), yes, no)
    }

    #[inline(always)]
    fn reciprocal_root<V: Simd>(x: Pack<V, f64>) -> Pack<V, f64> {
        Pack::splat(1.0) / x.sqrt()
    }

    #[inline(always)]
    fn root<V: Simd>(x: Pack<V, f64>) -> Pack<V, f64> {
        Pack(instructions::<V>().sqrt_f64s(x.0))
    }
}
