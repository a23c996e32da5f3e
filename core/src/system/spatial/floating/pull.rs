//! A drive at a point of a floating body.

use super::{Floating, Placed, add};
use crate::{
    SVector, Scalar, Vector3,
    linear::{Blocks, twice_crossed},
    product::{cross, dot, outer},
    system::{Law, Link, Response, Seen},
};

/// A point of the body along the frame's z axis, and the body's centre of mass, whose speed along it counts. It is a drive's: it
/// pushes at the point alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull<S> {
    /// Where the force acts, from the centre of mass in the body's axes (m).
    pub point_b: Vector3<S>,
}

/// What a force of 1 N along the frame's z is at the point: a force and a torque about the centre of mass, in body axes.
#[derive(Clone, Copy, Debug)]
pub struct View<S> {
    force_b: Vector3<S>,
    torque_b: Vector3<S>,
}

impl<S: Scalar> View<S> {
    /// Adds how the force at the point by the rates of point and centre, the first row of the impedance in `response`, goes by the
    /// body's velocity.
    #[inline(always)]
    fn spread<W: Law<S, 2>>(&self, response: &Response<S, 2>, sum: &mut Blocks<S>) {
        let Self { force_b, torque_b } = self;
        for (j, answers) in W::ANSWERS[0].into_iter().enumerate() {
            if answers {
                let along = force_b * response.impedance[(0, j)];
                sum.a += outer(force_b, &along);
                sum.c += outer(torque_b, &along);
                // The speed of the centre does not go by the rotation.
                if j == 0 {
                    sum.b += outer(&along, torque_b);
                    sum.d += outer(torque_b, torque_b) * response.impedance[(0, j)];
                }
            }
        }
    }
}

impl<S: Scalar> Link<S, Floating<S>, 6, 2> for Pull<S> {
    type View = View<S>;

    #[inline(always)]
    fn view(&self, _: &Floating<S>, placed: &Placed<S>) -> View<S> {
        let force_b = placed.to_body.z_axis();
        View { force_b, torque_b: cross(&self.point_b, &force_b) }
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&Floating<S>, &Placed<S>), view: &View<S>) -> Seen<S, 2> {
        let centre = placed.velocity_z;
        let point = centre + dot(&view.torque_b, &placed.rotation_b);
        Seen { place: SVector::zeros(), rate: SVector::<S, 2>::new(point, centre) }
    }

    #[inline(always)]
    fn add_force(&self, _: (&Floating<S>, &Placed<S>), view: &View<S>, force: &SVector<S, 2>, sum: &mut SVector<S, 6>) {
        add(&(view.force_b * force.x), &(view.torque_b * force.x), sum);
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 2>>(
        &self,
        _: (&Floating<S>, &Placed<S>),
        view: &View<S>,
        response: &Response<S, 2>,
        _: S,
        matrix: &mut Blocks<S>,
    ) {
        view.spread::<W>(response, matrix);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, 2>>(
        &self,
        _: (&Floating<S>, &Placed<S>),
        view: &View<S>,
        response: &Response<S, 2>,
        damping: &mut Blocks<S>,
        stiffness: &mut Blocks<S>,
    ) {
        view.spread::<W>(response, damping);
        // The force does not turn with the body.
        stiffness.d -= twice_crossed(&outer(&(view.force_b * response.force.x), &self.point_b));
    }
}
