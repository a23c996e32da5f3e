//! A linear spring with a damper, along or about what its link measures.

use super::{Law, Response, steady};
use crate::{SMatrix, SVector, Scalar, mechanism::Way};

/// φ = −stiffness·(x − rest) − damping·ẋ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring<S> {
    /// N/m or N·m/rad.
    pub stiffness: S,
    /// N·s/m or N·m·s/rad.
    pub damping: S,
    /// Where it is relaxed (m or rad).
    pub rest: S,
}

impl<S: Scalar> Law<S, 1> for Spring<S> {
    type Internal = ();

    const STICKS: bool = false;

    const PLACES: usize = 1;

    #[inline(always)]
    fn fresh() {}

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 1>,
        rate: &SVector<S, 1>,
        (): &(),
        way: Way<S>,
    ) -> (Response<S, 1>, ()) {
        let force = -(self.stiffness * (place.x - self.rest) + self.damping * rate.x);
        let one = |x: S| SMatrix::<S, 1, 1>::new(x);
        (steady(SVector::<S, 1>::new(force), one(self.damping), one(self.stiffness)).moving(way.over, 1), ())
    }

    #[inline(always)]
    fn shifted((): &(), (): &(), (): &(), _: S) {}

    #[inline(always)]
    fn or_old((): &(), _: S, (): &()) {}
}
