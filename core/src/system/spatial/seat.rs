//! A point of one body as seen from another.

use nalgebra::Matrix3;

use super::{
    FreeBodies, Placed, PlacedBody,
    blocks::{add, add_wrench, put, sub, sub_rows},
};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    linear::cross_matrix,
    system::{GradientLink, Seen},
};

/// A point of a body, or of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Port<S> {
    /// Which body; `None` for the frame, which also stands for a body that is not there.
    pub body: Option<usize>,
    /// The point (m) from the body's centre of mass, in its axes; in the frame from its origin.
    pub lever: Vector3<S>,
}

/// A point of one body as seen from another, in the axes of the latter: displacement (m) since the nominal poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat<S> {
    /// The point.
    pub point: Port<S>,
    /// The body that it is seen from; `None` for the frame.
    pub from: Option<usize>,
}

/// A point seen from a body, with what its derivatives are made of.
#[derive(Clone, Copy, Debug)]
pub struct View<S> {
    /// Displacement since the nominal poses, in the axes of the body that it is seen from (m).
    pub(super) displacement: Vector3<S>,
    /// From that body's centre of mass, in its axes (m).
    pub(super) lever: Vector3<S>,
    /// From the point's body into these axes.
    pub(super) across: Matrix3<S>,
    /// From the frame into these axes.
    pub(super) to_seat: Matrix3<S>,
    /// Velocity of the centres of mass against each other, in these axes (m/s).
    pub(super) velocity: Vector3<S>,
    /// Angular velocities, each in its body's axes (rad/s).
    pub(super) rotations: [Vector3<S>; 2],
}

impl<S: Scalar> Seat<S> {
    /// Whether the coordinate `k` moves the point or what it is seen from.
    #[inline(always)]
    pub(super) fn is_moved_by(&self, k: usize) -> bool {
        let body = Some(k / 6);
        self.point.body == body || self.from == body
    }

    #[inline(always)]
    pub(super) fn look<const N: usize, const D: usize>(
        &self,
        bodies: &FreeBodies<S, N, D>,
        placed: &Placed<S, N, D>,
    ) -> View<S> {
        let centre = |body: Option<usize>| {
            body.and_then(|body| bodies.bodies().get(body)).map_or(Vector3::zeros(), |body| body.centre_w)
        };
        let nominal = centre(self.point.body) + self.point.lever - centre(self.from);
        let of = self.point.body.map_or(PlacedBody::still(), |body| placed.body(body));
        let moved_w = of.displacement_w + (of.to_frame * self.point.lever - self.point.lever);
        match self.from {
            Some(body) => {
                let from = placed.body(body);
                let to_seat = from.to_frame.transpose();
                let displacement = (to_seat * nominal - nominal) + to_seat * (moved_w - from.displacement_w);
                View {
                    displacement,
                    lever: nominal + displacement,
                    across: to_seat * of.to_frame,
                    to_seat,
                    velocity: to_seat * (of.velocity_w - from.velocity_w),
                    rotations: [of.rotation_b, from.rotation_b],
                }
            }
            None => View {
                displacement: moved_w,
                lever: nominal + moved_w,
                across: of.to_frame,
                to_seat: Matrix3::identity(),
                velocity: of.velocity_w,
                rotations: [of.rotation_b, Vector3::zeros()],
            },
        }
    }

    /// How fast the point moves, seen from the body.
    #[inline(always)]
    pub(super) fn rate(&self, view: &View<S>) -> Vector3<S> {
        let [of, from] = &view.rotations;
        let rate = view.velocity + view.across * of.cross(&self.point.lever);
        if self.from.is_some() { rate - from.cross(&view.lever) } else { rate }
    }

    /// Adds the generalised force (N, N·m) of a `force` (N) on the point, given in the axes of the body that it is seen from.
    #[inline(always)]
    pub(super) fn add_force<const D: usize>(&self, view: &View<S>, force: &Vector3<S>, sum: &mut SVector<S, D>) {
        let force_w = if self.from.is_some() { view.to_seat.tr_mul(force) } else { *force };
        if let Some(i) = self.point.body {
            let torque_b = self.point.lever.cross(&view.across.tr_mul(force));
            add_wrench(sum, i, [&force_w, &torque_b]);
        }
        if let Some(j) = self.from {
            add_wrench(sum, j, [&-force_w, &force.cross(&view.lever)]);
        }
    }

    /// How these lengths go by the velocities.
    #[inline(always)]
    pub(super) fn lengths<const D: usize>(&self, view: &View<S>) -> SMatrix<S, 3, D> {
        let mut gradient = SMatrix::<S, 3, D>::zeros();
        if let Some(i) = self.point.body {
            put(&mut gradient, (0, 6 * i), &view.to_seat);
            put(&mut gradient, (0, 6 * i + 3), &-(view.across * cross_matrix(&self.point.lever)));
        }
        if let Some(i) = self.from {
            put(&mut gradient, (0, 6 * i), &-view.to_seat);
            put(&mut gradient, (0, 6 * i + 3), &cross_matrix(&view.lever));
        }
        gradient
    }

    /// Subtracts ∂(Λᵀφ)/∂Q for the `force` φ (N) from `stiffness`.
    #[inline(always)]
    pub(super) fn carry<const D: usize>(
        &self,
        view: &View<S>,
        gradient: &SMatrix<S, 3, D>,
        force: &Vector3<S>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let turned = cross_matrix(force);
        let to_frame = view.to_seat.transpose();
        if let Some(i) = self.point.body {
            let arm = cross_matrix(&self.point.lever);
            let force_b = view.across.tr_mul(force);
            sub(stiffness, (6 * i + 3, 6 * i + 3), &(arm * cross_matrix(&force_b)));
            if let Some(j) = self.from {
                sub(stiffness, (6 * i, 6 * j + 3), &-(to_frame * turned));
                sub(stiffness, (6 * i + 3, 6 * j + 3), &-(arm * view.across.tr_mul(&turned)));
            }
        }
        if let Some(j) = self.from {
            sub(stiffness, (6 * j, 6 * j + 3), &(to_frame * turned));
            sub_rows(stiffness, 6 * j + 3, &(turned * gradient));
        }
    }

    /// ∂(Λ·V)/∂Q.
    #[inline(always)]
    pub(super) fn sweep<const D: usize>(
        &self,
        view: &View<S>,
        gradient: &SMatrix<S, 3, D>,
        swept: &mut SMatrix<S, 3, D>,
    ) {
        let [of, from] = &view.rotations;
        let carried = of.cross(&self.point.lever);
        if let Some(j) = self.from {
            sub_rows(swept, 0, &(cross_matrix(from) * gradient));
            add(swept, (0, 6 * j + 3), &cross_matrix(&(view.velocity + view.across * carried)));
        }
        if let Some(i) = self.point.body {
            sub(swept, (0, 6 * i + 3), &(view.across * cross_matrix(&carried)));
        }
    }
}

impl<S: Scalar, const N: usize, const D: usize> GradientLink<S, FreeBodies<S, N, D>, D, 3> for Seat<S> {
    type View = View<S>;

    #[inline(always)]
    fn view(&self, bodies: &FreeBodies<S, N, D>, placed: &Placed<S, N, D>) -> View<S> {
        self.look(bodies, placed)
    }

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.is_moved_by(k)
    }

    #[inline(always)]
    fn seen(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N, D>), view: &View<S>) -> Seen<S, 3> {
        Seen { place: view.displacement, rate: self.rate(view) }
    }

    #[inline(always)]
    fn gradient(&self, _: (&FreeBodies<S, N, D>, &Placed<S, N, D>), view: &View<S>) -> SMatrix<S, 3, D> {
        self.lengths(view)
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &View<S>,
        force: &SVector<S, 3>,
        sum: &mut SVector<S, D>,
    ) {
        Seat::add_force(self, view, force, sum);
    }

    #[inline(always)]
    fn add_carried(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &View<S>,
        gradient: &SMatrix<S, 3, D>,
        force: &SVector<S, 3>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        self.carry(view, gradient, force, stiffness);
    }

    #[inline(always)]
    fn swept(
        &self,
        _: (&FreeBodies<S, N, D>, &Placed<S, N, D>),
        view: &View<S>,
        gradient: &SMatrix<S, 3, D>,
    ) -> SMatrix<S, 3, D> {
        let mut swept = SMatrix::zeros();
        self.sweep(view, gradient, &mut swept);
        swept
    }
}
