//! A hole of a floating body around a pin of the frame.

use nalgebra::Matrix2;

use super::{Floating, Placed, add_at};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    system::{Law, Link, Response, Seen, jacobian::Own, planar::left},
};

/// The centre of a pin of the frame as seen from that of a hole of the body, concentric at the nominal pose, along the body's axes:
/// displacement (m), then how fast the hole's body and the pin turn (rad/s), of which the latter stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hole<S> {
    /// From the centre of mass, in the body's axes (m).
    pub centre: Vector2<S>,
}

/// Force and torque along what the hole sees, of which the pin's own part is left out.
#[inline(always)]
fn halves<S: Scalar>(force: &SVector<S, 4>) -> (Vector2<S>, S) {
    (Vector2::new(force.x, force.y), force.z)
}

/// The blocks of a `matrix` by displacement of the pin and rotation of the hole.
#[inline(always)]
fn blocks<S: Scalar>(matrix: &SMatrix<S, 4, 4>) -> (Matrix2<S>, Vector2<S>, Vector2<S>, S) {
    let m = matrix;
    (Matrix2::new(m.m11, m.m12, m.m21, m.m22), Vector2::new(m.m13, m.m23), Vector2::new(m.m31, m.m32), m.m33)
}

impl<S: Scalar> Hole<S> {
    /// Adds how the force by rates of the `matrix` goes by the body's velocity.
    #[inline(always)]
    fn spread(&self, matrix: &SMatrix<S, 4, 4>, sum: &mut Own<S, 3>) {
        let arm = left(&self.centre);
        let (a, b, c, d) = blocks(matrix);
        let turning = a * arm - b;
        let torque = a.tr_mul(&arm) - c;
        #[rustfmt::skip]
        let whole = SMatrix::<S, 3, 3>::new(
            a.m11, a.m12, turning.x,
            a.m21, a.m22, turning.y,
            torque.x, torque.y, torque.dot(&arm) - arm.dot(&b) + d,
        );
        sum.0 += whole;
    }
}

impl<S: Scalar> Link<S, Floating<S>, 3, 4> for Hole<S> {
    /// Displacement of the pin (m).
    type View = Vector2<S>;

    #[inline(always)]
    fn view(&self, _: &Floating<S>, placed: &Placed<S>) -> Vector2<S> {
        placed.turn.change(&self.centre) - placed.displacement
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&Floating<S>, &Placed<S>), offset: &Vector2<S>) -> Seen<S, 4> {
        let zero = S::zero();
        let velocity = placed.velocity_at(&self.centre);
        Seen {
            place: SVector::<S, 4>::new(offset.x, offset.y, zero, zero),
            rate: SVector::<S, 4>::new(-velocity.x, -velocity.y, placed.rotation, zero),
        }
    }

    #[inline(always)]
    fn add_force(&self, _: (&Floating<S>, &Placed<S>), _: &Vector2<S>, force: &SVector<S, 4>, sum: &mut SVector<S, 3>) {
        let (force, torque) = halves(force);
        add_at(&self.centre, &-force, sum);
        sum.z += torque;
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 4>>(
        &self,
        _: (&Floating<S>, &Placed<S>),
        _: &Vector2<S>,
        response: &Response<S, 4>,
        _: S,
        matrix: &mut Own<S, 3>,
    ) {
        self.spread(&response.impedance, matrix);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, 4>>(
        &self,
        (_, placed): (&Floating<S>, &Placed<S>),
        offset: &Vector2<S>,
        response: &Response<S, 4>,
        damping: &mut Own<S, 3>,
        stiffness: &mut Own<S, 3>,
    ) {
        self.spread(&response.impedance, damping);
        let (force, _) = halves(&response.force);
        let ((by_rate, _, torque_by_rate, _), (by_place, _, torque_by_place, _)) =
            (blocks(&response.impedance), blocks(&response.stiffness));
        let (arm, swirl) = (left(&self.centre), left(&placed.velocity));
        // A turn moves the pin, as the body sees it, about the centre of mass, and changes the velocity that the body sees.
        let moved = left(&(self.centre + offset));
        let column = by_place * moved - by_rate * swirl;
        let row = by_place.tr_mul(&arm) - torque_by_place;
        let corner = arm.dot(&column) - torque_by_place.dot(&moved) + torque_by_rate.dot(&swirl);
        // The force turns with the body.
        let column = column + left(&force);
        #[rustfmt::skip]
        let whole = SMatrix::<S, 3, 3>::new(
            by_place.m11, by_place.m12, column.x,
            by_place.m21, by_place.m22, column.y,
            row.x, row.y, corner,
        );
        stiffness.0 += whole;
    }
}
