//! A journal in the plane: a hole around a pin, the paper's cylindrical joint (Fig. 3).
//!
//! With ρ from the hole's centre to the pin's the gap is q − |ρ| and its normal n along ρ. The pin pushes the hole's body
//! along n at the rim of the pin, and there they rub, so that friction also has moments about both centres. Where the pin is
//! inside there is no force, and so none where ρ = 0 has no direction.

use super::{Contact, Law, Response, along, steady};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    law::{Friction, Normal},
    mechanism::Way,
    system::planar::left,
};

/// The law of a journal, seen as displacement of the pin from the hole's centre along two axes and the rotations of the hole's and the
/// pin's body.
///
/// Friction's memory is the force along the tangent, and so goes round with the pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Journal<S, N, F> {
    /// Radial clearance q (m), by which the hole's radius exceeds the pin's.
    pub clearance: S,
    /// Radius of the pin (m).
    pub radius: S,
    /// Its laws.
    pub contact: Contact<N, F>,
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 4> for Journal<S, N, F> {
    type Memory = F::Memory;

    const STICKS: bool = F::STICKS;

    #[inline(always)]
    fn fresh() -> F::Memory {
        F::fresh()
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 4>,
        rate: &SVector<S, 4>,
        memory: &F::Memory,
        way: Way<S>,
    ) -> (Response<S, 4>, F::Memory) {
        let (zero, one) = (S::zero(), S::one());
        let apart = Vector2::new(place[0], place[1]);
        let moving = Vector2::new(rate[0], rate[1]);
        let squared = apart.dot(&apart);
        let per_distance = squared.max_of(S::from_f64(1e-30)).rsqrt();
        let distance = squared * per_distance;
        let normal = apart * per_distance;
        let tangent = left(&normal);
        let (outward, aside) = (moving.dot(&normal), moving.dot(&tangent));
        let [hole, pin] = [rate[2], rate[3]];
        let rim = distance + self.radius;

        // By ρ along normal and tangent, its rate along them, and both rotations. Along the tangent the axes turn by 1/|ρ|.
        let depth = (distance - self.clearance, along::<S, 6>(0, one));
        let approach = (outward, along::<S, 6>(2, one) + along(1, aside * per_distance));
        let mut slope = along::<S, 6>(0, hole);
        slope[1] = outward * per_distance;
        slope[3] = -one;
        slope[4] = rim;
        slope[5] = -self.radius;
        let sliding = (rim * hole - aside - self.radius * pin, slope);
        let none = (zero, SVector::zeros());
        let touch = self.contact.touch(memory, way, [depth, approach], [sliding, none]);
        let ([rub, _], [rub_slope, _]) = (touch.traction, touch.traction_slopes);
        let by_turn = along::<S, 6>(1, per_distance);
        let rows = [
            by_turn * rub - touch.force_slope,
            -(by_turn * touch.force) - rub_slope,
            rub_slope * rim + along(0, rub),
            rub_slope * -self.radius,
        ];
        let force = -(normal * touch.force + tangent * rub);
        let force = SVector::<S, 4>::new(force.x, force.y, rim * rub, -self.radius * rub);
        let (by_place, by_rate) = (
            SMatrix::<S, 4, 4>::from_fn(|i, j| if j < 2 { rows[i][j] } else { zero }),
            SMatrix::<S, 4, 4>::from_fn(|i, j| rows[i][j + 2]),
        );
        #[rustfmt::skip]
        let axes = SMatrix::<S, 4, 4>::new(
            normal.x, tangent.x, zero, zero,
            normal.y, tangent.y, zero, zero,
            zero, zero, one, zero,
            zero, zero, zero, one,
        );
        let in_frame = |local: SMatrix<S, 4, 4>| -(axes * local * axes.transpose());
        (steady(force, in_frame(by_rate), in_frame(by_place)), touch.memory)
    }

    #[inline(always)]
    fn shifted(base: &F::Memory, from: &F::Memory, to: &F::Memory, weight: S) -> F::Memory {
        F::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn or_old(new: &F::Memory, condition: S, old: &F::Memory) -> F::Memory {
        F::or_old(new, condition, old)
    }
}
