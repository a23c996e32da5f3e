//! Any mechanism: bodies that move together, and elements that act between them.
//!
//! *Bodies* ([`Bodies`]) have `D` generalised velocities V, a mass matrix M(Q) and gravity; ideal joints are part of them,
//! because their coordinates leave no other motion. A *link* ([`Link`]) measures what an element sees, a few lengths and
//! angles x(Q), and its gradient Λ with ẋ = Λ·V. A *law* ([`Law`]) answers with the forces φ(x, ẋ) that work along them. The
//! generalised force is the sum of Λᵀφ, so that each force acts on both bodies, equal and opposite, at one point. Laws
//! know nothing of bodies, links nothing of laws, and neither of integrators.
//!
//! Elements compose by type, as tuples and arrays, so that what a mechanism does not have leaves no code.

mod assembly;
mod bodies;
mod element;
pub mod law;
mod lu;
pub mod planar;
pub mod spatial;

pub use assembly::Assembly;
pub use bodies::Bodies;
pub use element::{Element, Elements, Law, Link, Response, Seen};
pub use lu::Lu;

use crate::{
    SMatrix, SVector, Scalar,
    mechanism::{Differentiated, Linearised, Mechanism, Way, settled, settling},
};
use assembly::{Balance, Derivatives, Sum};
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
        let placed = self.bodies.placed(pose, velocity);
        let view = drive.link.view(&self.bodies, &placed);
        let speed = drive.law.speed(&drive.link.seen((&self.bodies, &placed), &view).rate);
        Driving { speed, effort: drive.law.effort(t, speed) }
    }
}

/// What a drive sees and gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driving<S> {
    /// The speed that it goes by (m/s, or rad/s of one that turns).
    pub speed: S,
    /// Its force (N), or torque (N·m).
    pub effort: S,
}

/// How the balance of forces goes by time, velocity and place, at one motion.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<S, const D: usize> {
    mass: SMatrix<S, D, D>,
    /// −∂force/∂V.
    damping: SMatrix<S, D, D>,
    /// −∂(force − M·V̇)/∂Q.
    stiffness: SMatrix<S, D, D>,
}

impl<S: Scalar, B: Bodies<S, D>, E: Elements<S, B, D>, const D: usize> Mechanism<S, D> for System<B, E> {
    type Pose = B::Pose;
    type Memory = E::Memory;
    type Linearisation = Lu<S, D>;
    type Slopes = Slopes<S, D>;

    #[inline(always)]
    fn advanced(&self, pose: &B::Pose, velocity: &SVector<S, D>, dt: S) -> B::Pose {
        self.bodies.advanced(pose, velocity, dt)
    }

    #[inline(always)]
    fn moved(&self, pose: &B::Pose, velocity: &SVector<S, D>, dt: S) -> B::Pose {
        self.bodies.moved(pose, velocity, dt)
    }

    #[inline(always)]
    fn shifted(&self, base: &B::Pose, from: &B::Pose, to: &B::Pose, weight: S) -> B::Pose {
        self.bodies.shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn memory_shifted(&self, base: &E::Memory, from: &E::Memory, to: &E::Memory, weight: S) -> E::Memory {
        self.elements.shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn normalised(&self, pose: &B::Pose) -> B::Pose {
        self.bodies.normalised(pose)
    }

    #[inline(always)]
    fn fresh(&self) -> E::Memory {
        self.elements.fresh()
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: (&B::Pose, &E::Memory), kept: (&mut B::Pose, &mut E::Memory)) {
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
        velocity.zip_map(self.bodies.per_lever(), |x, per_lever| settled(x, unit * per_lever))
    }

    #[inline(always)]
    fn momentum(&self, pose: &B::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.bodies.mass(&self.bodies.placed(pose, &SVector::zeros())) * velocity
    }

    #[inline(always)]
    fn velocity(&self, pose: &B::Pose, momentum: &SVector<S, D>) -> SVector<S, D> {
        Lu::of(self.bodies.mass(&self.bodies.placed(pose, &SVector::zeros()))).solve(momentum)
    }

    #[inline(always)]
    fn momentum_by(&self, slopes: &Slopes<S, D>, _: &B::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        slopes.mass * velocity
    }

    #[inline(always)]
    fn forces_by(
        &self,
        slopes: &Slopes<S, D>,
        t: S,
        pose: &B::Pose,
        memory: &E::Memory,
        velocity: &SVector<S, D>,
        a: S,
    ) -> SVector<S, D> {
        let placed = self.bodies.placed(pose, velocity);
        if B::MASS_IS_CONSTANT {
            return self.sum(t, &placed, self.bodies.own_force(&placed), memory, a, None);
        }
        let (mass, own) = self.bodies.mass_and_own_force(&placed);
        slopes.mass * Lu::of(mass).solve(&self.sum(t, &placed, own, memory, a, None))
    }

    #[inline(always)]
    fn forces(
        &self,
        t: S,
        pose: &B::Pose,
        memory: &E::Memory,
        velocity: &SVector<S, D>,
        a: S,
        remembered: Option<&mut E::Memory>,
    ) -> SVector<S, D> {
        let placed = self.bodies.placed(pose, velocity);
        self.sum(t, &placed, self.bodies.own_force(&placed), memory, a, remembered)
    }

    #[inline(always)]
    fn linearised(
        &self,
        t: S,
        pose: &B::Pose,
        memory: &E::Memory,
        velocity: &SVector<S, D>,
        a: S,
        tangent_share: S,
    ) -> Linearised<S, Lu<S, D>, D> {
        let placed = self.bodies.placed(pose, velocity);
        let rate = S::one() / a;
        let way = Way { a, mass_rate: self.bodies.least_mass() * rate, tangent_share };
        let (mass, force) = self.bodies.mass_and_own_force(&placed);
        let mut sum = Balance { force, matrix: mass * rate, a };
        self.elements.act((t, way), (&self.bodies, &placed), memory, None, &mut sum);
        Linearised { force: sum.force, linearisation: Lu::of(sum.matrix) }
    }

    #[inline(always)]
    fn solve(&self, linearisation: &Lu<S, D>, residual: &SVector<S, D>) -> SVector<S, D> {
        linearisation.solve(residual)
    }

    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, D>) -> S {
        let weighted = imbalance.component_mul(self.bodies.per_lever());
        weighted.dot(&weighted).sqrt()
    }

    /// The least mass times the speed, angles by their levers: what counts is each coordinate, not what it weighs.
    #[inline(always)]
    fn weighed(&self, _: &B::Pose, change: &SVector<S, D>) -> S {
        let speeds = change.component_div(self.bodies.per_lever());
        self.bodies.least_mass() * speeds.dot(&speeds).sqrt()
    }

    #[inline(always)]
    fn differentiated(
        &self,
        t: S,
        pose: &B::Pose,
        memory: &E::Memory,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, Slopes<S, D>, D> {
        let placed = self.bodies.placed(pose, velocity);
        let way = Way { a: S::zero(), mass_rate: S::zero(), tangent_share: S::one() };
        let (mass, force) = self.bodies.mass_and_own_force(&placed);
        let zero = SMatrix::zeros();
        let mut sum = Derivatives { force, per_time: SVector::zeros(), damping: zero, stiffness: zero };
        self.elements.act((t, way), (&self.bodies, &placed), memory, None, &mut sum);
        let acceleration = if B::MASS_IS_CONSTANT { SVector::zeros() } else { Lu::of(mass).solve(&sum.force) };
        self.bodies.own_slopes(&placed, &acceleration, &mut sum.damping, &mut sum.stiffness);
        let Derivatives { force, per_time, damping, stiffness } = sum;
        Differentiated { force, per_time, slopes: Slopes { mass, damping, stiffness } }
    }

    #[inline(always)]
    fn linearisation(&self, slopes: &Slopes<S, D>, a: S) -> Lu<S, D> {
        Lu::of(slopes.mass * (S::one() / a) + slopes.damping + slopes.stiffness * a)
    }

    #[inline(always)]
    fn pushed(&self, slopes: &Slopes<S, D>, displacement: &SVector<S, D>) -> SVector<S, D> {
        -(slopes.stiffness * displacement)
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
        memory: &E::Memory,
        a: S,
        remembered: Option<&mut E::Memory>,
    ) -> SVector<S, D>
    where
        B: Bodies<S, D>,
        E: Elements<S, B, D>,
    {
        let way = Way { a, mass_rate: self.bodies.least_mass() / a, tangent_share: S::one() };
        let mut sum = Sum(own);
        self.elements.act((t, way), (&self.bodies, placed), memory, remembered, &mut sum);
        sum.0
    }
}

#[cfg(test)]
mod tests;
