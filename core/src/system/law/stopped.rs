//! A stop along one axis, without friction.

use super::{Law, Response, steady};
use crate::{
    SMatrix, SVector, Scalar,
    law::{Elastic, Impact, Stop, stop::Resistance},
    mechanism::Way,
};

/// A `stop` along, or about, what its link measures: a pad or a slot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopped<C, N> {
    /// What stands in the way.
    pub stop: C,
    /// Its law.
    pub contact: N,
}

impl<S: Scalar, C: Stop<S>, E: Elastic<S>> Law<S, 1> for Stopped<C, Impact<S, E>> {
    type Internal = ();

    const STICKS: bool = false;

    const PLACES: usize = 1;

    #[inline(always)]
    fn fresh(&self) {}

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 1>,
        rate: &SVector<S, 1>,
        (): &(),
        way: Way<S>,
    ) -> (Response<S, 1>, ()) {
        let resistance = self.stop.resistance(&self.contact, -place.x, rate.x);
        let one = |x: S| SMatrix::<S, 1, 1>::new(x);
        let (impedance, stiffness) = (resistance.impedance(way.over), resistance.stiffness());
        (steady(SVector::<S, 1>::new(resistance.force()), one(impedance), one(stiffness)), ())
    }

    #[inline(always)]
    fn shifted((): &(), (): &(), (): &(), _: S) {}

    #[inline(always)]
    fn or_old((): &(), _: S, (): &()) {}
}
