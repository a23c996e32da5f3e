//! A mechanism whose forces are compiled once, not once for every scheme that calls them.
//!
//! Firmware wants the forces inlined into its one step. At the desk every scheme steps every kind of mechanism; calls cost
//! nothing beside what they do, and building takes a fraction of the time. The bits are the same.

use slipfit_core::{
    SVector, Scalar,
    mechanism::{Balance, Differentiated, Mechanism},
};

/// How the forces of a mechanism `M` are computed where their derivatives are known, as methods with error control ask for
/// them.
pub trait Contacts<S: Scalar, M: Mechanism<S, D>, const D: usize> {
    /// As [`Mechanism::forces_by`].
    #[expect(clippy::too_many_arguments, reason = "those of the mechanism")]
    fn forces_by(
        &self,
        mechanism: &M,
        jacobians: &M::Jacobians,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
    ) -> SVector<S, D>;

    /// As [`Mechanism::differentiated`].
    fn differentiated(
        &self,
        mechanism: &M,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, M::Jacobians, D>;
}

/// One contact after the other, as the mechanism does it.
#[derive(Clone, Copy, Debug)]
pub struct InTurn;

impl<S: Scalar, M: Mechanism<S, D>, const D: usize> Contacts<S, M, D> for InTurn {
    #[inline(always)]
    fn forces_by(
        &self,
        mechanism: &M,
        jacobians: &M::Jacobians,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
    ) -> SVector<S, D> {
        mechanism.forces_by(jacobians, t, pose, internal, velocity, a)
    }

    #[inline(always)]
    fn differentiated(
        &self,
        mechanism: &M,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, M::Jacobians, D> {
        mechanism.differentiated(t, pose, internal, velocity)
    }
}

/// The mechanism `M`, its forces out of line.
pub struct OutOfLine<M, C = InTurn> {
    mechanism: M,
    contacts: C,
}

impl<M> OutOfLine<M> {
    /// `mechanism`, its laws without internal variables where it is differentiated.
    pub fn new(mechanism: M) -> Self {
        Self::by(mechanism, InTurn)
    }
}

impl<M, C> OutOfLine<M, C> {
    /// The same, with what computes its contacts.
    pub fn by(mechanism: M, contacts: C) -> Self {
        Self { mechanism, contacts }
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &M {
        &self.mechanism
    }
}

impl<S: Scalar, M: Mechanism<S, D>, const D: usize, C: Contacts<S, M, D>> Mechanism<S, D> for OutOfLine<M, C> {
    type Pose = M::Pose;
    type Internal = M::Internal;
    type IterationMatrix = M::IterationMatrix;
    type Jacobians = M::Jacobians;

    const STICKS: bool = M::STICKS;

    fn implicit_update(&self, pose: &M::Pose, velocity: &SVector<S, D>, dt: S) -> M::Pose {
        self.mechanism.implicit_update(pose, velocity, dt)
    }

    fn explicit_update(&self, pose: &M::Pose, velocity: &SVector<S, D>, dt: S) -> M::Pose {
        self.mechanism.explicit_update(pose, velocity, dt)
    }

    fn shifted(&self, base: &M::Pose, from: &M::Pose, to: &M::Pose, weight: S) -> M::Pose {
        self.mechanism.shifted(base, from, to, weight)
    }

    fn internal_shifted(&self, base: &M::Internal, from: &M::Internal, to: &M::Internal, weight: S) -> M::Internal {
        self.mechanism.internal_shifted(base, from, to, weight)
    }

    fn normalised(&self, pose: &M::Pose) -> M::Pose {
        self.mechanism.normalised(pose)
    }

    fn fresh(&self) -> M::Internal {
        self.mechanism.fresh()
    }

    fn accept(&self, condition: S, next: (&M::Pose, &M::Internal), kept: (&mut M::Pose, &mut M::Internal)) {
        self.mechanism.accept(condition, next, kept);
    }

    fn finiteness_probe(&self, pose: &M::Pose) -> S {
        self.mechanism.finiteness_probe(pose)
    }

    fn settled(&self, velocity: &SVector<S, D>, a: S) -> SVector<S, D> {
        self.mechanism.settled(velocity, a)
    }

    fn momentum(&self, pose: &M::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.momentum(pose, velocity)
    }

    fn velocity(&self, pose: &M::Pose, momentum: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.velocity(pose, momentum)
    }

    fn momentum_by(&self, jacobians: &M::Jacobians, pose: &M::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.momentum_by(jacobians, pose, velocity)
    }

    #[inline(never)]
    fn forces_by(
        &self,
        jacobians: &M::Jacobians,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
    ) -> SVector<S, D> {
        self.contacts.forces_by(&self.mechanism, jacobians, t, pose, internal, velocity, a)
    }

    #[inline(never)]
    fn forces(
        &self,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
        updated: Option<&mut M::Internal>,
    ) -> SVector<S, D> {
        self.mechanism.forces(t, pose, internal, velocity, a, updated)
    }

    #[inline(never)]
    fn balance(
        &self,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
        tangent_share: S,
    ) -> Balance<S, M::IterationMatrix, D> {
        self.mechanism.balance(t, pose, internal, velocity, a, tangent_share)
    }

    #[inline(never)]
    fn solve(&self, iteration_matrix: &M::IterationMatrix, residual: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.solve(iteration_matrix, residual)
    }

    fn impulse(&self, imbalance: &SVector<S, D>) -> S {
        self.mechanism.impulse(imbalance)
    }

    fn weighed(&self, pose: &M::Pose, change: &SVector<S, D>) -> S {
        self.mechanism.weighed(pose, change)
    }

    #[inline(never)]
    fn differentiated(
        &self,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, M::Jacobians, D> {
        self.contacts.differentiated(&self.mechanism, t, pose, internal, velocity)
    }

    #[inline(never)]
    fn iteration_matrix(&self, jacobians: &M::Jacobians, velocity: &SVector<S, D>, a: S) -> M::IterationMatrix {
        self.mechanism.iteration_matrix(jacobians, velocity, a)
    }

    fn pushed(&self, jacobians: &M::Jacobians, displacement: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.pushed(jacobians, displacement)
    }

    fn displacement(&self, velocity: &SVector<S, D>, rate: &SVector<S, D>, a: S) -> SVector<S, D> {
        self.mechanism.displacement(velocity, rate, a)
    }

    fn rate(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.rate(displacement, velocity)
    }
}
