//! A journal in the plane: a hole around a pin, the paper's cylindrical joint (Fig. 3).
//!
//! With ρ from the hole's centre to the pin's the gap is q − |ρ| and its normal n along ρ. The pin pushes the hole's body
//! along n at the rim of the pin, and there they rub, so that friction also has moments about both centres. Where the pin is
//! inside there is no force, and so none where ρ = 0 has no direction.

use nalgebra::Matrix2;

use super::{Contact, Law, Response, Rub, steady};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    law::{Friction, Normal},
    linear::{growing, length},
    mechanism::Way,
    product::outer_in_plane,
    system::planar::left,
};

/// The law of a journal, seen as displacement of the pin from the hole's centre along two axes and the rotations of the hole's and the
/// pin's body.
///
/// Friction's internal variable is the force along the tangent, and so goes round with the pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Journal<S, N, F> {
    /// Radial clearance q (m), by which the hole's radius exceeds the pin's.
    pub clearance: S,
    /// Radius of the pin (m).
    pub radius: S,
    /// Its laws.
    pub contact: Contact<N, F>,
}

crate::cast::cast!([N F] [] Journal: Journal<f64, N, F> => T Journal<T, N::Of<T>, F::Of<T>> { clearance, radius, contact });

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 4> for Journal<S, N, F> {
    type Internal = F::Internal;

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 2;

    #[inline(always)]
    fn fresh(&self) -> F::Internal {
        F::fresh()
    }

    #[inline(always)]
    fn gap(&self, place: &SVector<S, 4>) -> S {
        let [distance, _] = length(&Vector2::new(place[0], place[1]));
        self.clearance - distance
    }

    #[inline(always)]
    fn each_gap(&self, place: &SVector<S, 4>, rate: &SVector<S, 4>, mut see: impl FnMut(S, S)) {
        let [distance, speed] = growing(&Vector2::new(place[0], place[1]), &Vector2::new(rate[0], rate[1]));
        see(self.clearance - distance, -speed);
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 4>,
        rate: &SVector<S, 4>,
        internal: &F::Internal,
        way: Way<S>,
    ) -> (Response<S, 4>, F::Internal) {
        let zero = S::zero();
        let apart = Vector2::new(place[0], place[1]);
        let moving = Vector2::new(rate[0], rate[1]);
        let [hole, pin] = [rate[2], rate[3]];
        let [distance, per_distance] = length(&apart);
        let normal = apart * per_distance;
        let tangent = left(&normal);
        let (outward, aside) = (moving.dot(&normal), moving.dot(&tangent));
        let (rim, radius) = (distance + self.radius, self.radius);
        let sliding = rim * hole - aside - radius * pin;
        let touch = self.contact.rub(internal, way, [distance - self.clearance, outward], sliding);
        let Rub { force: push, stiffness, damping, traction, per_force, per_sliding, internal } = touch;
        let force = -(normal * push + tangent * traction);
        let force = SVector::<S, 4>::new(force.x, force.y, rim * traction, -radius * traction);

        // By ρ along normal and tangent and by its rate along them. Along the tangent the axes turn by 1/|ρ|, and the rates with
        // them.
        let turned = [aside * per_distance, outward * per_distance];
        let push_by_place = [stiffness, damping * turned[0]];
        let rub_by_place =
            [per_force * push_by_place[0] + per_sliding * hole, per_force * push_by_place[1] + per_sliding * turned[1]];
        let rub_by_rate = [per_force * damping, -per_sliding];
        let in_frame = |along: S, across: S| normal * along + tangent * across;
        let moving = |by_rate: Vector2<S>, by_place: Vector2<S>| match way.over {
            Some(a) => by_rate + by_place * a,
            None => by_rate,
        };
        let block = |n: Vector2<S>, t: Vector2<S>| outer_in_plane(&n, &normal) + outer_in_plane(&t, &tangent);
        if !F::RUBS {
            let by_place = [normal * push_by_place[0], in_frame(push_by_place[1], per_distance * push)];
            let by_rate = [moving(normal * damping, by_place[0]), moving(Vector2::zeros(), by_place[1])];
            let among = |block: Matrix2<S>| block.fixed_resize::<4, 4>(zero);
            let force = SVector::<S, 4>::new(-normal.x * push, -normal.y * push, zero, zero);
            return (
                steady(force, among(block(by_rate[0], by_rate[1])), among(block(by_place[0], by_place[1]))),
                internal,
            );
        }
        let by_place = [
            in_frame(push_by_place[0], -rub_by_place[0]),
            in_frame(push_by_place[1] - per_distance * traction, per_distance * push - rub_by_place[1]),
        ];
        let by_rate = [in_frame(damping, -rub_by_rate[0]), in_frame(zero, -rub_by_rate[1])];
        let rub_by_place = in_frame(rub_by_place[0], rub_by_place[1]);
        let rub_by_rate = in_frame(rub_by_rate[0], rub_by_rate[1]);
        let rim_by_place = rub_by_place * rim - normal * traction;
        let rim_by_rate = rub_by_rate * rim;
        let by_rate = [moving(by_rate[0], by_place[0]), moving(by_rate[1], by_place[1])];
        let (rim_by_rate, rub_by_rate) = (moving(rim_by_rate, rim_by_place), moving(rub_by_rate, rub_by_place));
        let (place_block, rate_block) = (block(by_place[0], by_place[1]), block(by_rate[0], by_rate[1]));
        let dragged = tangent * -per_sliding;
        #[rustfmt::skip]
        let impedance = SMatrix::<S, 4, 4>::new(
            rate_block.m11, rate_block.m12, dragged.x * rim, -dragged.x * radius,
            rate_block.m21, rate_block.m22, dragged.y * rim, -dragged.y * radius,
            rim_by_rate.x, rim_by_rate.y, rim * rim * per_sliding, -(rim * radius * per_sliding),
            -(radius * rub_by_rate.x), -(radius * rub_by_rate.y), -(rim * radius * per_sliding), radius * radius * per_sliding,
        );
        #[rustfmt::skip]
        let stiffness = SMatrix::<S, 4, 4>::new(
            place_block.m11, place_block.m12, zero, zero,
            place_block.m21, place_block.m22, zero, zero,
            rim_by_place.x, rim_by_place.y, zero, zero,
            -(radius * rub_by_place.x), -(radius * rub_by_place.y), zero, zero,
        );
        (steady(force, impedance, stiffness), internal)
    }

    #[inline(always)]
    fn shifted(base: &F::Internal, from: &F::Internal, to: &F::Internal, weight: S) -> F::Internal {
        F::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn or_old(new: &F::Internal, condition: S, old: &F::Internal) -> F::Internal {
        F::or_old(new, condition, old)
    }
}

#[cfg(test)]
mod tests;
