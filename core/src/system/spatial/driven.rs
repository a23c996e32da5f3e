//! What a drive sees of a body: a speed along an axis, or about one.

use super::{
    FreeBodies, Placed, PlacedBody,
    blocks::{add_wrench, put_row, sub},
};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    linear::cross_matrix,
    system::{GradientLink, Seen},
};

/// A point of a body along an axis of the frame, and the body's centre of mass, whose speed along it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along<S> {
    /// The body; one that is not there stands still.
    pub body: usize,
    /// Where the force acts (m), from the centre of mass in the body's axes.
    pub lever: Vector3<S>,
    /// Direction in the frame, of unit length.
    pub axis_w: Vector3<S>,
}

/// How fast a body turns about an axis of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct About<S> {
    /// The body; one that is not there stands still.
    pub body: usize,
    /// Direction in the frame, of unit length.
    pub axis_w: Vector3<S>,
}

impl<S: Scalar> Along<S> {
    /// How the speed at the point goes by the angular velocity of the body, which is `at` a pose.
    #[inline(always)]
    fn arm(&self, at: &PlacedBody<S>) -> Vector3<S> {
        self.lever.cross(&at.in_body(&self.axis_w))
    }
}

impl<S: Scalar, const N: usize, const D: usize> GradientLink<S, FreeBodies<S, N, D>, D, 2> for Along<S> {
    type View = ();

    #[inline(always)]
    fn view(&self, _: &FreeBodies<S, N, D>, _: &Placed<S, N, D>) {}

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.body == k / 6
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>), (): &()) -> Seen<S, 2> {
        let at = placed.body(self.body);
        let along = self.axis_w.dot(&at.velocity_w);
        let turning = self.arm(&at).dot(&at.rotation_b);
        Seen { place: SVector::zeros(), rate: SVector::<S, 2>::new(along + turning, along) }
    }

    #[inline(always)]
    fn gradient(&self, (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>), (): &()) -> SMatrix<S, 2, D> {
        let arm = self.arm(&placed.body(self.body));
        let mut gradient = SMatrix::<S, 2, D>::zeros();
        put_row(&mut gradient, (0, 6 * self.body), &self.axis_w);
        put_row(&mut gradient, (1, 6 * self.body), &self.axis_w);
        put_row(&mut gradient, (0, 6 * self.body + 3), &arm);
        gradient
    }

    #[inline(always)]
    fn add_force(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        force: &SVector<S, 2>,
        sum: &mut SVector<S, D>,
    ) {
        let torque_b = self.arm(&placed.body(self.body)) * force[0];
        add_wrench(sum, self.body, [&(self.axis_w * (force[0] + force[1])), &torque_b]);
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        _: &SMatrix<S, 2, D>,
        force: &SVector<S, 2>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let axis_b = placed.body(self.body).in_body(&self.axis_w) * force[0];
        let at = 6 * self.body + 3;
        sub(stiffness, (at, at), &(cross_matrix(&self.lever) * cross_matrix(&axis_b)));
    }

    #[inline(always)]
    fn swept(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        _: &SMatrix<S, 2, D>,
    ) -> SMatrix<S, 2, D> {
        let at = placed.body(self.body);
        let axis_b = at.in_body(&self.axis_w);
        // ω·(lever × axis), the axis turning against the body: ∂axis = axis × θ.
        let by_turn = axis_b.cross(&self.lever.cross(&at.rotation_b));
        let mut swept = SMatrix::<S, 2, D>::zeros();
        put_row(&mut swept, (0, 6 * self.body + 3), &by_turn);
        swept
    }
}

impl<S: Scalar, const N: usize, const D: usize> GradientLink<S, FreeBodies<S, N, D>, D, 1> for About<S> {
    type View = ();

    #[inline(always)]
    fn view(&self, _: &FreeBodies<S, N, D>, _: &Placed<S, N, D>) {}

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.body == k / 6
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>), (): &()) -> Seen<S, 1> {
        let at = placed.body(self.body);
        let rate = at.in_body(&self.axis_w).dot(&at.rotation_b);
        Seen { place: SVector::zeros(), rate: SVector::<S, 1>::new(rate) }
    }

    #[inline(always)]
    fn gradient(&self, (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>), (): &()) -> SMatrix<S, 1, D> {
        let axis_b = placed.body(self.body).in_body(&self.axis_w);
        let mut gradient = SMatrix::<S, 1, D>::zeros();
        put_row(&mut gradient, (0, 6 * self.body + 3), &axis_b);
        gradient
    }

    #[inline(always)]
    fn add_force(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        force: &SVector<S, 1>,
        sum: &mut SVector<S, D>,
    ) {
        let axis_b = placed.body(self.body).in_body(&self.axis_w);
        add_wrench(sum, self.body, [&Vector3::zeros(), &(axis_b * force[0])]);
    }

    #[inline(always)]
    fn add_carried(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        _: &SMatrix<S, 1, D>,
        force: &SVector<S, 1>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let axis_b = placed.body(self.body).in_body(&self.axis_w) * force[0];
        let at = 6 * self.body + 3;
        sub(stiffness, (at, at), &cross_matrix(&axis_b));
    }

    #[inline(always)]
    fn swept(
        &self,
        (_, placed): (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        (): &(),
        _: &SMatrix<S, 1, D>,
    ) -> SMatrix<S, 1, D> {
        let at = placed.body(self.body);
        // ω·axis with ∂axis = axis × θ.
        let by_turn = at.rotation_b.cross(&at.in_body(&self.axis_w));
        let mut swept = SMatrix::<S, 1, D>::zeros();
        put_row(&mut swept, (0, 6 * self.body + 3), &by_turn);
        swept
    }
}
