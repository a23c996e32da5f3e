//! Scalars of the desk solver: one number, or one for each of several units.

use pulp::Simd;
use slipfit_core::Scalar;

use crate::pack::Pack;

/// A number, or one for each of several units. A comparison holds if it holds for all of them.
pub trait Real: Scalar + PartialOrd {
    /// How many units it has a value for.
    const UNITS: usize;

    /// The value of the unit on a `lane`.
    fn get(self, lane: usize) -> f64;

    /// Gives the unit on a `lane` the value `x`.
    fn set(&mut self, lane: usize, x: f64);

    /// What `of` makes of each of these numbers and the other's.
    fn zip_map(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self;
}

impl Real for f64 {
    const UNITS: usize = 1;

    fn get(self, _: usize) -> f64 {
        self
    }

    fn set(&mut self, _: usize, x: f64) {
        *self = x;
    }

    fn zip_map(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        of(self, other)
    }
}

impl<V: Simd> Real for Pack<V, f64> {
    const UNITS: usize = Self::LANES;

    #[inline(always)]
    fn get(self, lane: usize) -> f64 {
        Pack::get(&self, lane)
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, x: f64) {
        Pack::set(self, lane, x);
    }

    #[inline(always)]
    fn zip_map(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = self;
        for (x, y) in result.numbers_mut().iter_mut().zip(other.numbers()) {
            *x = of(*x, *y);
        }
        result
    }
}
