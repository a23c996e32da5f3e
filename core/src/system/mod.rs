//! Any mechanism: bodies that move together, and elements that act between them.
//!
//! *Bodies* ([`Bodies`]) have `D` generalised velocities V, a mass matrix M(Q) and gravity; ideal joints are part of them,
//! because their coordinates leave no other motion. A *link* ([`Link`]) measures what an element sees, a few lengths and
//! angles x(Q), and its gradient Λ with ẋ = Λ·V. A *law* ([`Law`]) answers with the forces φ(x, ẋ) that work along them. The
//! generalised force is the sum of Λᵀφ, so that each force acts on both bodies, equal and opposite, at one point. Laws
//! know nothing of bodies, links nothing of laws, and neither of integrators.
//!
//! Trees in a plane have elements add up by coordinates, and a link tells its gradient ([`GradientLink`]). Free bodies have them add
//! up in the axes of the frame; one body among pins of the frame, like the slide, in its own, where walls stand still ([`Axes`]).
//! There a link says itself how its forces go by motion and place, in fewer operations.
//!
//! Elements compose by type, as tuples and arrays, so that what a mechanism does not have leaves no code.

mod abreast;
mod alike;
mod assembly;
mod axes;
mod axis;
mod bodies;
mod element;
mod half_turn;
mod jacobian;
pub mod law;
mod link;
mod lu;
pub mod planar;
mod reduced;
pub mod spatial;
mod through_joints;

pub use abreast::{AbreastBodies, LANES, Lanes, everywhere};
pub use alike::{Alike, Shape};
pub use assembly::{Assembly, Elements};
pub use axes::Axes;
pub use axis::{AxisBody, Displacement, OnAxis, on_axis};
pub use bodies::{Bodies, ByCoordinate};
pub use element::{Driving, Element};
pub use jacobian::Jacobian;
pub use law::{Law, Response};
pub use link::{Change, GradientLink, Link, Seen};
pub use lu::Lu;
pub use reduced::Reduced;
pub use through_joints::ThroughJoints;

use crate::{
    SVector, Scalar,
    mechanism::{Balance, Differentiated, Mechanism, Way, settled, settling},
};
use assembly::StageSum;
pub(crate) use assembly::{Derivatives, Sum};
use law::DriveLaw;

/// Bodies and the elements that act on them, as integrators see them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct System<B, E> {
    bodies: B,
    elements: E,
}

impl<B, E> System<B, E> {
    /// The mechanism of `bodies` and `elements`.
    pub fn new(bodies: B, elements: E) -> Self {
        Self { bodies, elements }
    }

    /// The bodies.
    pub fn bodies(&self) -> &B {
        &self.bodies
    }

    /// The elements.
    pub fn elements(&self) -> &E {
        &self.elements
    }

    /// The elements, to be given other parameters, which nobody checks.
    pub fn elements_mut(&mut self) -> &mut E {
        &mut self.elements
    }

    /// What the `drive`, one of the elements, sees and gives at time `t` (s), at this `pose` and `velocity`.
    #[inline(always)]
    pub fn driving<S: Scalar, L, W, const R: usize, const D: usize>(
        &self,
        drive: &Element<L, W, R>,
        t: S,
        pose: &B::Pose,
        velocity: &SVector<S, D>,
    ) -> Driving<S>
    where
        B: Bodies<S, D>,
        L: Link<S, B, D, R>,
        W: DriveLaw<S, R>,
    {
        drive.driving(t, (&self.bodies, &self.bodies.placed(pose, velocity)))
    }

    /// The same of a `drive` that is one of the elements [through joints](ThroughJoints).
    #[inline(always)]
    pub fn driving_through_joints<S: Scalar, L, W, const R: usize, const D: usize, const F: usize>(
        &self,
        drive: &Element<L, W, R>,
        t: S,
        pose: &B::Pose,
        velocity: &SVector<S, D>,
    ) -> Driving<S>
    where
        B: Reduced<S, D, F>,
        L: Link<S, B::Free, F, R>,
        W: DriveLaw<S, R>,
    {
        drive.driving(t, self.bodies.free(&self.bodies.placed(pose, velocity)))
    }
}

/// The iteration matrix M/a − ∂force/∂V − a·∂force/∂Q, factorised, and what leads to the axes in which it is.
#[derive(Clone, Copy, Debug, Default)]
pub struct IterationMatrix<F, A> {
    factors: F,
    axes: A,
}

/// How the balance of forces goes by velocity and place, at one motion.
#[derive(Clone, Copy, Debug)]
pub struct Jacobians<M, A, J> {
    mass: M,
    axes: A,
    /// −∂force/∂V, in `axes`.
    damping: J,
    /// −∂(force − M·V̇)/∂Q, in `axes`.
    stiffness: J,
}

/// [`Jacobians`] of bodies `B`.
pub type JacobiansOf<S, B, const D: usize> =
    Jacobians<<B as Bodies<S, D>>::Mass, <B as Bodies<S, D>>::Axes, <B as Bodies<S, D>>::Jacobian>;

impl<S: Scalar, B: Bodies<S, D>, E: Elements<S, B, D>, const D: usize> Mechanism<S, D> for System<B, E> {
    type Pose = B::Pose;
    type Internal = E::Internal;
    type IterationMatrix = IterationMatrix<<B::Jacobian as Jacobian<S, D>>::Factors, B::Axes>;
    type Jacobians = JacobiansOf<S, B, D>;

    const STICKS: bool = E::STICKS;

    #[inline(always)]
    fn implicit_update(&self, pose: &B::Pose, velocity: &SVector<S, D>, dt: S) -> B::Pose {
        self.bodies.implicit_update(pose, velocity, dt)
    }

    #[inline(always)]
    fn explicit_update(&self, pose: &B::Pose, velocity: &SVector<S, D>, dt: S) -> B::Pose {
        self.bodies.explicit_update(pose, velocity, dt)
    }

    #[inline(always)]
    fn shifted(&self, base: &B::Pose, from: &B::Pose, to: &B::Pose, weight: S) -> B::Pose {
        self.bodies.shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn internal_shifted(&self, base: &E::Internal, from: &E::Internal, to: &E::Internal, weight: S) -> E::Internal {
        self.elements.shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn normalised(&self, pose: &B::Pose) -> B::Pose {
        self.bodies.normalised(pose)
    }

    #[inline(always)]
    fn fresh(&self) -> E::Internal {
        self.elements.fresh()
    }

    #[inline(always)]
    fn remembered(&self, pose: &B::Pose, internal: &E::Internal) -> E::Internal {
        if size_of::<E::Internal>() == 0 {
            return *internal;
        }
        self.elements.remembered((&self.bodies, &self.bodies.placed(pose, &SVector::zeros())), internal)
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: (&B::Pose, &E::Internal), kept: (&mut B::Pose, &mut E::Internal)) {
        self.bodies.accept(condition, next.0, kept.0);
        self.elements.accept(condition, next.1, kept.1);
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &B::Pose) -> S {
        self.bodies.finiteness_probe(pose)
    }

    #[inline(always)]
    fn settled(&self, velocity: &SVector<S, D>, a: S) -> SVector<S, D> {
        if !E::STICKS {
            return *velocity;
        }
        let unit = settling(a);
        velocity.zip_map(&self.bodies.per_lever(), |x, per_lever| settled(x, unit * per_lever))
    }

    #[inline(always)]
    fn momentum(&self, pose: &B::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.bodies.momentum(&self.mass_at(pose), velocity)
    }

    #[inline(always)]
    fn velocity(&self, pose: &B::Pose, momentum: &SVector<S, D>) -> SVector<S, D> {
        self.bodies.velocity(&self.mass_at(pose), momentum)
    }

    #[inline(always)]
    fn momentum_by(&self, jacobians: &Self::Jacobians, _: &B::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.bodies.momentum(&jacobians.mass, velocity)
    }

    #[inline(always)]
    fn forces_by(
        &self,
        jacobians: &Self::Jacobians,
        t: S,
        pose: &B::Pose,
        internal: &E::Internal,
        velocity: &SVector<S, D>,
        a: S,
    ) -> SVector<S, D> {
        let placed = self.bodies.placed(pose, velocity);
        if B::MASS_IS_CONSTANT {
            return self.sum(t, &placed, self.bodies.own_force(&placed), internal, a, None);
        }
        let (mass, own) = self.bodies.mass_and_own_force(&placed);
        let force = self.sum(t, &placed, own, internal, a, None);
        self.bodies.momentum(&jacobians.mass, &self.bodies.velocity(&mass, &force))
    }

    #[inline(always)]
    fn forces(
        &self,
        t: S,
        pose: &B::Pose,
        internal: &E::Internal,
        velocity: &SVector<S, D>,
        a: S,
        updated: Option<&mut E::Internal>,
    ) -> SVector<S, D> {
        let placed = self.bodies.placed(pose, velocity);
        self.sum(t, &placed, self.bodies.own_force(&placed), internal, a, updated)
    }

    #[inline(always)]
    fn balance(
        &self,
        t: S,
        pose: &B::Pose,
        internal: &E::Internal,
        velocity: &SVector<S, D>,
        a: S,
        tangent_share: S,
    ) -> Balance<S, Self::IterationMatrix, D> {
        let placed = self.bodies.placed(pose, velocity);
        let rate = S::one() / a;
        let over = if B::MATRIX_IS_LEAN { Some(a) } else { None };
        let way = Way { over, mass_rate: self.bodies.least_mass() * rate, tangent_share };
        let (mass, force) = self.bodies.mass_and_own_force(&placed);
        let mut sum = StageSum { force, matrix: self.bodies.inertia(&mass, rate), a };
        self.elements.act((t, way), (&self.bodies, &placed), internal, None, &mut sum);
        Balance {
            force: self.bodies.total(&placed, &sum.force),
            iteration_matrix: IterationMatrix { factors: sum.matrix.factorised(), axes: self.bodies.axes(&placed) },
        }
    }

    #[inline(always)]
    fn solve(&self, iteration_matrix: &Self::IterationMatrix, residual: &SVector<S, D>) -> SVector<S, D> {
        let IterationMatrix { factors, axes } = iteration_matrix;
        axes.to_velocities(&B::Jacobian::solve(factors, &axes.to_sum(residual)))
    }

    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, D>) -> S {
        self.bodies.impulse(imbalance)
    }

    #[inline(always)]
    fn weighed(&self, _: &B::Pose, change: &SVector<S, D>) -> S {
        self.bodies.weighed(change)
    }

    #[inline(always)]
    fn differentiated(
        &self,
        t: S,
        pose: &B::Pose,
        internal: &E::Internal,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, Self::Jacobians, D> {
        let placed = self.bodies.placed(pose, velocity);
        let way = Way { over: None, mass_rate: S::zero(), tangent_share: S::one() };
        let (mass, force) = self.bodies.mass_and_own_force(&placed);
        let zero = B::Jacobian::zero();
        let mut sum = Derivatives { force, per_time: SVector::zeros(), damping: zero, stiffness: zero };
        self.elements.act((t, way), (&self.bodies, &placed), internal, None, &mut sum);
        self.completed(&placed, mass, sum)
    }

    #[inline(always)]
    fn iteration_matrix(&self, jacobians: &Self::Jacobians, velocity: &SVector<S, D>, a: S) -> Self::IterationMatrix {
        let Jacobians { mass, axes, damping, stiffness } = jacobians;
        let matrix = self.bodies.inertia(mass, S::one() / a).plus(damping, S::one());
        let matrix = self.bodies.stiffened(matrix, stiffness, (axes, velocity), a);
        IterationMatrix { factors: matrix.factorised(), axes: *axes }
    }

    #[inline(always)]
    fn pushed(&self, jacobians: &Self::Jacobians, displacement: &SVector<S, D>) -> SVector<S, D> {
        let Jacobians { axes, stiffness, .. } = jacobians;
        -axes.to_velocities(&stiffness.times(&axes.to_sum(displacement)))
    }

    #[inline(always)]
    fn displacement(&self, velocity: &SVector<S, D>, rate: &SVector<S, D>, a: S) -> SVector<S, D> {
        self.bodies.displacement(velocity, rate, a)
    }

    #[inline(always)]
    fn rate(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.bodies.rate(displacement, velocity)
    }
}

impl<B, E> System<B, E> {
    /// The generalised force (N, N·m) at time `t` (s) of a mechanism that is `placed`, its `own` included; see
    /// [`Mechanism::forces`].
    #[inline(always)]
    fn sum<S: Scalar, const D: usize>(
        &self,
        t: S,
        placed: &B::Placed,
        own: SVector<S, D>,
        internal: &E::Internal,
        a: S,
        updated: Option<&mut E::Internal>,
    ) -> SVector<S, D>
    where
        B: Bodies<S, D>,
        E: Elements<S, B, D>,
    {
        let way = Way { over: None, mass_rate: self.bodies.least_mass() / a, tangent_share: S::one() };
        let mut sum = Sum(own);
        self.elements.act((t, way), (&self.bodies, placed), internal, updated, &mut sum);
        self.bodies.total(placed, &sum.0)
    }

    /// What elements have added up to, of bodies that are `placed`, with what these add.
    #[inline(always)]
    pub(crate) fn completed<S: Scalar, const D: usize>(
        &self,
        placed: &B::Placed,
        mass: B::Mass,
        mut sum: Derivatives<S, B::Jacobian, D>,
    ) -> Differentiated<S, JacobiansOf<S, B, D>, D>
    where
        B: Bodies<S, D>,
    {
        let force = self.bodies.total(placed, &sum.force);
        let acceleration = if B::MASS_IS_CONSTANT { SVector::zeros() } else { self.bodies.velocity(&mass, &force) };
        self.bodies.own_jacobians(placed, &mass, &acceleration, &mut sum.damping, &mut sum.stiffness);
        let axes = self.bodies.axes(placed);
        let Derivatives { per_time, damping, stiffness, .. } = sum;
        let jacobians = Jacobians { mass, axes, damping, stiffness };
        Differentiated { force, per_time: axes.to_velocities(&per_time), jacobians }
    }

    /// The mass matrix at a `pose`.
    #[inline(always)]
    fn mass_at<S: Scalar, const D: usize>(&self, pose: &B::Pose) -> B::Mass
    where
        B: Bodies<S, D>,
    {
        self.bodies.mass(&self.bodies.placed(pose, &SVector::zeros()))
    }
}

#[cfg(test)]
mod tests;
