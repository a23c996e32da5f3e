//! A spring with a damper along the line between two points.

use super::{Law, Response, steady};
use crate::{SMatrix, SVector, Scalar, mechanism::Way};

/// It pulls the points together with stiffness·(L − free length) + damping·dL/dt, where L is their distance, and pushes them apart where
/// that is negative. Where the points meet the line has no direction, and there is no force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineSpring<S, const K: usize> {
    /// N/m.
    pub stiffness: S,
    /// N·s/m.
    pub damping: S,
    /// Distance of the points without force (m); negative for a spring that pulls at any distance.
    pub free_length: S,
    /// From the fixed end to the moving one (m) where the link measures zero.
    pub drawn: SVector<S, K>,
}

crate::cast::cast!([] [K] LineSpring: LineSpring<f64, K> => T LineSpring<T, K> { stiffness, damping, free_length, drawn });

/// The force on the moving end, −∂force/∂rate and −∂force/∂place.
type Pull<S, const K: usize> = (SVector<S, K>, SMatrix<S, K, K>, SMatrix<S, K, K>);

impl<S: Scalar, const K: usize> LineSpring<S, K> {
    /// What it does where the moving end has come to `place` and moves at `rate`.
    #[inline(always)]
    fn pull(&self, place: &SVector<S, K>, rate: &SVector<S, K>) -> Pull<S, K> {
        let apart = self.drawn + place;
        let squared = apart.dot(&apart);
        let per_length = squared.max_of(S::from_f64(1e-30)).rsqrt();
        let length = squared * per_length;
        let direction = apart * per_length;
        let growing = direction.dot(rate);
        let tension = self.stiffness * (length - self.free_length) + self.damping * growing;
        let across = (rate - direction * growing) * (self.damping * per_length);
        let turned = tension * per_length;
        let along = direction * direction.transpose();
        let mut stiffness = along * (self.stiffness - turned) + direction * across.transpose();
        for k in 0..K {
            stiffness[(k, k)] += turned;
        }
        (direction * -tension, along * self.damping, stiffness)
    }
}

macro_rules! law {
    ($numbers:literal, $directions:literal, $note:literal) => {
        #[doc = $note]
        impl<S: Scalar> Law<S, $numbers> for LineSpring<S, $directions> {
            type Internal = ();

            const STICKS: bool = false;

            const PLACES: usize = $directions;

            #[inline(always)]
            fn fresh(&self) {}

            #[inline(always)]
            fn response(
                &self,
                _: S,
                place: &SVector<S, $numbers>,
                rate: &SVector<S, $numbers>,
                (): &(),
                way: Way<S>,
            ) -> (Response<S, $numbers>, ()) {
                let [place, rate] = [place, rate].map(|of| of.fixed_rows::<$directions>(0).into_owned());
                let (force, impedance, stiffness) = self.pull(&place, &rate);
                let zero = S::zero();
                let response = steady(
                    force.fixed_resize::<$numbers, 1>(zero),
                    impedance.fixed_resize::<$numbers, $numbers>(zero),
                    stiffness.fixed_resize::<$numbers, $numbers>(zero),
                );
                (response.moving(way.over, $directions), ())
            }

            #[inline(always)]
            fn shifted((): &(), (): &(), (): &(), _: S) {}

            #[inline(always)]
            fn or_old((): &(), _: S, (): &()) {}
        }
    };
}

law!(
    4,
    2,
    "In the plane, between the two points of a [`Between`](crate::system::planar::Between), whose turns do not count."
);
law!(3, 3, "In space, at a [`Seat`](crate::system::spatial::Seat).");
