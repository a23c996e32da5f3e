//! A pin of the frame as a floating body sees it.

use nalgebra::Matrix2;

use super::{Floating, Placed, add_at};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    system::{Law, Link, Response, Seen, jacobian::Own, planar::left},
};

/// A pin of the frame as the body sees it, in the body's axes: displacement (m) since the nominal pose. Forces act on both at the
/// pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin<S> {
    /// From the centre of mass at the nominal pose (m).
    pub place: Vector2<S>,
}

/// The pin at a pose and motion of the body, in the body's axes.
#[derive(Clone, Copy, Debug)]
pub struct View<S> {
    /// Displacement of the pin (m).
    offset: Vector2<S>,
    /// From the centre of mass (m).
    lever: Vector2<S>,
    /// Velocity of the body's material there (m/s).
    velocity: Vector2<S>,
}

/// Adds how the force of a damper with the `matrix` at `lever` from the centre of mass goes by the body's velocity.
#[inline(always)]
fn spread<S: Scalar>(lever: &Vector2<S>, matrix: &Matrix2<S>, sum: &mut Own<S, 3>) {
    let arm = left(lever);
    let turning = matrix * arm;
    let torque = matrix.tr_mul(&arm);
    #[rustfmt::skip]
    let whole = SMatrix::<S, 3, 3>::new(
        matrix.m11, matrix.m12, turning.x,
        matrix.m21, matrix.m22, turning.y,
        torque.x, torque.y, arm.dot(&turning),
    );
    sum.0 += whole;
}

impl<S: Scalar> Link<S, Floating<S>, 3, 2> for Pin<S> {
    type View = View<S>;

    #[inline(always)]
    fn view(&self, _: &Floating<S>, placed: &Placed<S>) -> View<S> {
        let offset = placed.turn.change(&self.place) - placed.displacement;
        let lever = self.place + offset;
        View { offset, lever, velocity: placed.velocity_at(&lever) }
    }

    #[inline(always)]
    fn seen(&self, _: (&Floating<S>, &Placed<S>), view: &View<S>) -> Seen<S, 2> {
        Seen { place: view.offset, rate: -view.velocity }
    }

    #[inline(always)]
    fn add_force(&self, _: (&Floating<S>, &Placed<S>), view: &View<S>, force: &Vector2<S>, sum: &mut SVector<S, 3>) {
        add_at(&view.lever, &-force, sum);
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 2>>(
        &self,
        _: (&Floating<S>, &Placed<S>),
        view: &View<S>,
        response: &Response<S, 2>,
        _: S,
        matrix: &mut Own<S, 3>,
    ) {
        spread(&view.lever, &response.impedance, matrix);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, 2>>(
        &self,
        (_, placed): (&Floating<S>, &Placed<S>),
        view: &View<S>,
        response: &Response<S, 2>,
        damping: &mut Own<S, 3>,
        stiffness: &mut Own<S, 3>,
    ) {
        let Response { force, impedance, stiffness: by_place, .. } = response;
        let (arm, zero) = (left(&view.lever), S::zero());
        spread(&view.lever, impedance, damping);
        // Where the body turns, a displacement changes the velocity of its material at the pin.
        let carried = Matrix2::new(zero, -placed.rotation, placed.rotation, zero);
        spread(&view.lever, &(by_place - impedance * carried), stiffness);
        // A turn changes the velocity that the body sees; the force stays at the pin, and turns with the body.
        let turned = impedance * left(&placed.velocity);
        let stays = left(force);
        let column = stays - turned;
        #[rustfmt::skip]
        let carried = SMatrix::<S, 3, 3>::new(
            zero, zero, column.x,
            zero, zero, column.y,
            stays.x, stays.y, view.lever.dot(force) - arm.dot(&turned),
        );
        stiffness.0 += carried;
    }
}
