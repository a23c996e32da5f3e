//! The numbers of which a pack holds several, and what the instructions of a machine do with registers of them.

use std::any::TypeId;

use pulp::{Scalar256b, Simd, bytemuck::Pod};
use slipfit_core::Scalar;

/// Aligned as the registers of AVX2.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Of32Bytes;

/// Aligned as the registers of AVX-512.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Of64Bytes;

/// A number that registers hold.
pub trait Number: Scalar + PartialOrd + Pod {
    /// A register of the instructions `V`.
    type Register<V: Simd>: Pod + std::fmt::Debug + Send + Sync;
    /// Something aligned as the widest register that is used for such numbers.
    type Aligned: Copy + std::fmt::Debug + Send + Sync;

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
    /// x where x > y, else y.
    fn larger<V: Simd>(instructions: V, x: Self::Register<V>, y: Self::Register<V>) -> Self::Register<V>;
    /// x where x < y, else y.
    fn smaller<V: Simd>(instructions: V, x: Self::Register<V>, y: Self::Register<V>) -> Self::Register<V>;
    /// √x, to half a unit in the last place.
    fn root<V: Simd>(instructions: V, x: Self::Register<V>) -> Self::Register<V>;
}

/// Whether the library stands for instructions: its maximum is another than that of registers, which is the one that is meant, where a
/// number is none.
#[inline(always)]
fn is_library<V: Simd>() -> bool {
    V::IS_SCALAR || TypeId::of::<V>() == TypeId::of::<Scalar256b>()
}

impl Number for f32 {
    type Register<V: Simd> = V::f32s;
    type Aligned = Of64Bytes;

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
    fn larger<V: Simd>(v: V, x: V::f32s, y: V::f32s) -> V::f32s {
        if is_library::<V>() { Self::chosen(v, x, y, [x, y]) } else { v.max_f32s(x, y) }
    }

    #[inline(always)]
    fn smaller<V: Simd>(v: V, x: V::f32s, y: V::f32s) -> V::f32s {
        if is_library::<V>() { Self::chosen(v, y, x, [x, y]) } else { v.min_f32s(x, y) }
    }

    #[inline(always)]
    fn root<V: Simd>(v: V, x: V::f32s) -> V::f32s {
        v.sqrt_f32s(x)
    }
}

impl Number for f64 {
    type Register<V: Simd> = V::f64s;
    /// The desk's pins are as many as an AVX2 register holds.
    type Aligned = Of32Bytes;

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
    fn larger<V: Simd>(v: V, x: V::f64s, y: V::f64s) -> V::f64s {
        if is_library::<V>() { Self::chosen(v, x, y, [x, y]) } else { v.max_f64s(x, y) }
    }

    #[inline(always)]
    fn smaller<V: Simd>(v: V, x: V::f64s, y: V::f64s) -> V::f64s {
        if is_library::<V>() { Self::chosen(v, y, x, [x, y]) } else { v.min_f64s(x, y) }
    }

    #[inline(always)]
    fn root<V: Simd>(v: V, x: V::f64s) -> V::f64s {
        v.sqrt_f64s(x)
    }
}
