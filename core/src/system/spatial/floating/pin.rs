//! A pin of the frame as a floating body sees it.

use super::{Floating, Placed, add};
use crate::{
    SVector, Scalar, Vector3,
    linear::{Blocks, cross_columns, cross_matrix, cross_rows, twice_crossed},
    product::{cross, outer},
    system::{Law, Link, Response, Seen},
};

/// A pin of the frame as the body sees it, in the body's axes: displacement (m) since the nominal pose. Forces act on both at the
/// pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinOfFrame<S> {
    /// From the centre of mass at the nominal pose (m).
    pub place_w: Vector3<S>,
}

/// The pin at a pose and motion of the body, in the body's axes.
#[derive(Clone, Copy, Debug)]
pub struct View<S> {
    /// Displacement of the pin (m).
    offset: Vector3<S>,
    /// From the centre of mass (m).
    lever: Vector3<S>,
    /// Velocity of the body's material there (m/s).
    velocity: Vector3<S>,
}

impl<S: Scalar> Link<S, Floating<S>, 6, 3> for PinOfFrame<S> {
    type View = View<S>;

    #[inline(always)]
    fn view(&self, _: &Floating<S>, placed: &Placed<S>) -> View<S> {
        let offset = placed.to_body.change(self.place_w) - placed.displacement_b;
        let lever = self.place_w + offset;
        View { offset, lever, velocity: placed.velocity_b + cross(&placed.rotation_b, &lever) }
    }

    #[inline(always)]
    fn seen(&self, _: (&Floating<S>, &Placed<S>), view: &View<S>) -> Seen<S, 3> {
        Seen { place: view.offset, rate: -view.velocity }
    }

    #[inline(always)]
    fn add_force(&self, _: (&Floating<S>, &Placed<S>), view: &View<S>, force: &Vector3<S>, sum: &mut SVector<S, 6>) {
        let on_body = -force;
        add(&on_body, &cross(&view.lever, &on_body), sum);
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 3>>(
        &self,
        _: (&Floating<S>, &Placed<S>),
        view: &View<S>,
        response: &Response<S, 3>,
        _: S,
        matrix: &mut Blocks<S>,
    ) {
        matrix.add_at(&view.lever, &response.impedance);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, 3>>(
        &self,
        (_, placed): (&Floating<S>, &Placed<S>),
        view: &View<S>,
        response: &Response<S, 3>,
        damping: &mut Blocks<S>,
        stiffness: &mut Blocks<S>,
    ) {
        let (lever, on_body) = (&view.lever, -response.force);
        damping.add_at(lever, &response.impedance);
        // Where the body turns, a displacement changes the velocity of its material at the pin by −ω × displacement.
        let by_place = response.stiffness + cross_rows(&placed.rotation_b, &response.impedance);
        // A turn θ moves the pin, as the body sees it, and changes the velocity that the body sees by −θ × v.
        let by_turn = cross_rows(lever, &by_place) - cross_rows(&placed.velocity_b, &response.impedance);
        // The force stays at the pin while the body is displaced, and turns with the body.
        let turned = cross_matrix(&on_body);
        stiffness.a += by_place;
        stiffness.b += by_turn + turned;
        stiffness.c += cross_columns(lever, &by_place) - turned;
        stiffness.d += cross_columns(lever, &by_turn) + twice_crossed(&outer(lever, &on_body));
    }
}
