//! A mechanism whose forces are compiled once, not once for every scheme that calls them.
//!
//! Firmware wants the forces inlined into its one step. At the desk every scheme steps every kind of mechanism; calls cost
//! nothing beside what they do, and building takes a fraction of the time. The bits are the same.

use slipfit_core::{
    SVector, Scalar,
    mechanism::{Differentiated, Linearised, Mechanism},
};

/// The mechanism `M`, its forces out of line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutOfLine<M>(pub M);

impl<S: Scalar, M: Mechanism<S, D>, const D: usize> Mechanism<S, D> for OutOfLine<M> {
    type Pose = M::Pose;
    type Memory = M::Memory;
    type Linearisation = M::Linearisation;
    type Slopes = M::Slopes;

    fn advanced(&self, pose: &M::Pose, velocity: &SVector<S, D>, dt: S) -> M::Pose {
        self.0.advanced(pose, velocity, dt)
    }

    fn moved(&self, pose: &M::Pose, velocity: &SVector<S, D>, dt: S) -> M::Pose {
        self.0.moved(pose, velocity, dt)
    }

    fn shifted(&self, base: &M::Pose, from: &M::Pose, to: &M::Pose, weight: S) -> M::Pose {
        self.0.shifted(base, from, to, weight)
    }

    fn memory_shifted(&self, base: &M::Memory, from: &M::Memory, to: &M::Memory, weight: S) -> M::Memory {
        self.0.memory_shifted(base, from, to, weight)
    }

    fn normalised(&self, pose: &M::Pose) -> M::Pose {
        self.0.normalised(pose)
    }

    fn fresh(&self) -> M::Memory {
        self.0.fresh()
    }

    fn adopt(&self, condition: S, next: (&M::Pose, &M::Memory), kept: (&mut M::Pose, &mut M::Memory)) {
        self.0.adopt(condition, next, kept);
    }

    fn nought(&self, pose: &M::Pose) -> S {
        self.0.nought(pose)
    }

    fn settled(&self, velocity: &SVector<S, D>, a: S) -> SVector<S, D> {
        self.0.settled(velocity, a)
    }

    fn momentum(&self, pose: &M::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.0.momentum(pose, velocity)
    }

    fn velocity(&self, pose: &M::Pose, momentum: &SVector<S, D>) -> SVector<S, D> {
        self.0.velocity(pose, momentum)
    }

    fn referred(&self, start: &M::Pose, pose: &M::Pose, force: SVector<S, D>) -> SVector<S, D> {
        self.0.referred(start, pose, force)
    }

    #[inline(never)]
    fn forces(
        &self,
        t: S,
        pose: &M::Pose,
        memory: &M::Memory,
        velocity: &SVector<S, D>,
        a: S,
        remembered: Option<&mut M::Memory>,
    ) -> SVector<S, D> {
        self.0.forces(t, pose, memory, velocity, a, remembered)
    }

    #[inline(never)]
    fn linearised(
        &self,
        t: S,
        pose: &M::Pose,
        memory: &M::Memory,
        velocity: &SVector<S, D>,
        a: S,
        tangent_share: S,
    ) -> Linearised<S, M::Linearisation, D> {
        self.0.linearised(t, pose, memory, velocity, a, tangent_share)
    }

    #[inline(never)]
    fn solve(&self, linearisation: &M::Linearisation, residual: &SVector<S, D>) -> SVector<S, D> {
        self.0.solve(linearisation, residual)
    }

    fn impulse(&self, imbalance: &SVector<S, D>) -> S {
        self.0.impulse(imbalance)
    }

    fn weighed(&self, pose: &M::Pose, change: &SVector<S, D>) -> S {
        self.0.weighed(pose, change)
    }

    #[inline(never)]
    fn differentiated(
        &self,
        t: S,
        pose: &M::Pose,
        memory: &M::Memory,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, M::Slopes, D> {
        self.0.differentiated(t, pose, memory, velocity)
    }

    #[inline(never)]
    fn linearisation(&self, slopes: &M::Slopes, a: S) -> M::Linearisation {
        self.0.linearisation(slopes, a)
    }

    fn pushed(&self, slopes: &M::Slopes, displacement: &SVector<S, D>) -> SVector<S, D> {
        self.0.pushed(slopes, displacement)
    }

    fn rate(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.0.rate(displacement, velocity)
    }
}
