//! A drive at a point of a floating body.

use super::{Floating, Placed, add_at};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    system::{Law, Link, Response, Seen, jacobian::Own, planar::left},
};

/// A point of the body along an axis of the frame, and the body's centre of mass, whose speed along it counts. It is a drive's: it
/// pushes at the point alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull<S> {
    /// Where the force acts, from the centre of mass in the body's axes (m).
    pub point: Vector2<S>,
    /// Direction in the frame, of unit length.
    pub axis: Vector2<S>,
}

impl<S: Scalar> Pull<S> {
    /// Adds how the force at the point by the rates of point and centre, the first row of the `impedance`, goes by the body's velocity.
    #[inline(always)]
    fn spread<W: Law<S, 2>>(&self, axis: &Vector2<S>, impedance: &SMatrix<S, 2, 2>, sum: &mut Own<S, 3>) {
        let pull = [axis.x, axis.y, left(&self.point).dot(axis)];
        // The speed of the centre does not go by the rotation.
        for (j, coordinates) in [3, 2].into_iter().enumerate() {
            if W::ANSWERS[0][j] {
                for (row, pushed) in pull.iter().enumerate() {
                    let along = *pushed * impedance[(0, j)];
                    for (column, seen) in pull.iter().enumerate().take(coordinates) {
                        sum.0[(row, column)] += along * *seen;
                    }
                }
            }
        }
    }
}

impl<S: Scalar> Link<S, Floating<S>, 3, 2> for Pull<S> {
    /// The axis, in the body's axes.
    type View = Vector2<S>;

    #[inline(always)]
    fn view(&self, _: &Floating<S>, placed: &Placed<S>) -> Vector2<S> {
        placed.turn.to_body(&self.axis)
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&Floating<S>, &Placed<S>), axis: &Vector2<S>) -> Seen<S, 2> {
        let speeds = [placed.velocity_at(&self.point), placed.velocity].map(|velocity| axis.dot(&velocity));
        Seen { place: SVector::zeros(), rate: speeds.into() }
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&Floating<S>, &Placed<S>),
        axis: &Vector2<S>,
        force: &SVector<S, 2>,
        sum: &mut SVector<S, 3>,
    ) {
        add_at(&self.point, &(axis * force.x), sum);
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 2>>(
        &self,
        _: (&Floating<S>, &Placed<S>),
        axis: &Vector2<S>,
        response: &Response<S, 2>,
        _: S,
        matrix: &mut Own<S, 3>,
    ) {
        self.spread::<W>(axis, &response.impedance, matrix);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, 2>>(
        &self,
        _: (&Floating<S>, &Placed<S>),
        axis: &Vector2<S>,
        response: &Response<S, 2>,
        damping: &mut Own<S, 3>,
        stiffness: &mut Own<S, 3>,
    ) {
        self.spread::<W>(axis, &response.impedance, damping);
        // The force does not turn with the body.
        stiffness.0.m33 += self.point.dot(axis) * response.force.x;
    }
}
