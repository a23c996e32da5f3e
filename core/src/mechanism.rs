//! What an integrator sees of a scene: generalised velocities, momenta, forces and their linearisation.

use crate::{SVector, Scalar, law::friction::Rubbing};

/// How forces are to be linearised.
#[derive(Clone, Copy, Debug)]
pub struct Way<S> {
    /// Implicit part of the step (s): over it a velocity moves the body.
    pub a: S,
    /// Mass over the implicit part that friction's memory yields over (kg/s).
    pub mass_rate: S,
    /// See [`Rubbing`].
    pub tangent_share: S,
}

impl<S: Scalar> Way<S> {
    /// What friction acts upon at a contact with the velocity `sliding` (m/s) of the body and the force `normal` (N).
    #[inline(always)]
    pub fn rubbing(&self, sliding: [S; 2], normal: S) -> Rubbing<S> {
        Rubbing { sliding, normal, mass_rate: self.mass_rate, tangent_share: self.tangent_share }
    }
}

/// Forces at one motion and their linearisation.
#[derive(Clone, Copy, Debug)]
pub struct Linearised<S, L, const D: usize> {
    /// The generalised force (N, N·m).
    pub force: SVector<S, D>,
    /// Linearisation of momentum/a − force with respect to the velocity. It may be approximate; it steers, the force
    /// decides.
    pub linearisation: L,
}

/// Forces at one motion and all their derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Differentiated<S, L, const D: usize> {
    /// The generalised force (N, N·m).
    pub force: SVector<S, D>,
    /// ∂force/∂t (N/s, N·m/s).
    pub per_time: SVector<S, D>,
    /// Derivatives by velocity and displacement.
    pub slopes: L,
}

/// A mechanism with `D` generalised velocities.
///
/// Implicit schemes solve momentum(V) − momentum(V₀) = a·force(t, Q, V) with Q = advanced(Q₀, V, a) for V. `a` (s) is
/// the implicit part of the step.
pub trait Mechanism<S: Scalar, const D: usize> {
    /// Where the bodies are.
    type Pose: Copy;

    /// What force laws remember from one step to the next, such as friction forces; `()` where nothing.
    type Memory: Copy;

    /// Whatever [`solve`](Self::solve) needs of a linearisation.
    type Linearisation: Copy + Default;

    /// Derivatives of the force by velocity and displacement.
    type Slopes;

    /// The pose Q = `pose` + `dt`·Q̇(Q, `velocity`), implicit in Q.
    fn advanced(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose;

    /// The pose `pose` + `dt`·Q̇(`pose`, `velocity`), explicit.
    fn moved(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose;

    /// `base + weight·(to − from)` in the coordinates in which poses are integrated.
    fn shifted(&self, base: &Self::Pose, from: &Self::Pose, to: &Self::Pose, weight: S) -> Self::Pose;

    /// `base + weight·(to − from)`.
    fn memory_shifted(&self, base: &Self::Memory, from: &Self::Memory, to: &Self::Memory, weight: S) -> Self::Memory;

    /// The same pose with rounding's drift of its constraints taken out.
    fn normalised(&self, pose: &Self::Pose) -> Self::Pose;

    /// The memory of laws that nothing has happened to yet.
    fn fresh(&self) -> Self::Memory;

    /// Makes `kept` `next`, number by number where it is finite and `condition` > 0. In place, since a copy would take stack.
    fn adopt(&self, condition: S, next: (&Self::Pose, &Self::Memory), kept: (&mut Self::Pose, &mut Self::Memory));

    /// 0 if all coordinates of `pose` are finite, else NaN.
    fn nought(&self, pose: &Self::Pose) -> S;

    /// `velocity` with what can only be rounding taken out of it, where the mechanism can be truly at rest.
    fn settled(&self, velocity: &SVector<S, D>) -> SVector<S, D> {
        *velocity
    }

    /// M·`velocity`: generalised momentum (N·s, N·m·s).
    fn momentum(&self, velocity: &SVector<S, D>) -> SVector<S, D>;

    /// M⁻¹·`momentum`: generalised velocities (m/s, rad/s).
    fn velocity(&self, momentum: &SVector<S, D>) -> SVector<S, D>;

    /// Forces (N, N·m) at time `t` (s); `a` (s) is the implicit part of the step. Writes to `remembered` what the laws
    /// remember if the motion is accepted.
    fn forces(
        &self,
        t: S,
        pose: &Self::Pose,
        memory: &Self::Memory,
        velocity: &SVector<S, D>,
        a: S,
        remembered: Option<&mut Self::Memory>,
    ) -> SVector<S, D>;

    /// Forces at time `t` (s), and how momentum/`a` − force changes with the velocity, through the pose too. Of the
    /// friction's change along the sliding direction the linearisation takes `tangent_share` from the law's tangent, the
    /// rest from its secant.
    fn linearised(
        &self,
        t: S,
        pose: &Self::Pose,
        memory: &Self::Memory,
        velocity: &SVector<S, D>,
        a: S,
        tangent_share: S,
    ) -> Linearised<S, Self::Linearisation, D>;

    /// The velocity change that brings the linearised balance of forces from `residual` (N, N·m) to zero, negated.
    fn solve(&self, linearisation: &Self::Linearisation, residual: &SVector<S, D>) -> SVector<S, D>;

    /// One number for an imbalance of momentum (N·s): angular components over a length of the mechanism.
    fn impulse(&self, imbalance: &SVector<S, D>) -> S;

    /// Forces at time `t` (s) and their derivatives, for laws without memory.
    fn differentiated(
        &self,
        t: S,
        pose: &Self::Pose,
        memory: &Self::Memory,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, Self::Slopes, D>;

    /// Linearisation of momentum/`a` − force with respect to a velocity that also moves the pose over the time `a` (s).
    fn linearisation(&self, slopes: &Self::Slopes, a: S) -> Self::Linearisation;

    /// How the force changes (N, N·m) with a small `displacement` (m, rad).
    fn pushed(&self, slopes: &Self::Slopes, displacement: &SVector<S, D>) -> SVector<S, D>;

    /// The rate (m/s, rad/s) of a `displacement` x from a pose, such that `moved(pose, x, 1)` is the pose, while the body
    /// moves with `velocity`. It is the velocity at no displacement, and everywhere where coordinates are straight.
    fn rate(&self, _displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        *velocity
    }
}
