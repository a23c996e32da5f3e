//! What an integrator sees of a scene: generalised velocities, momenta, forces and their linearisation.

use crate::{SVector, Scalar};

/// A mechanism with `D` generalised velocities.
///
/// Implicit schemes solve momentum(V) − momentum(V₀) = a·force(t, Q, V) with Q = advanced(Q₀, V, a) for V. `a` (s) is
/// the implicit part of the step.
pub trait Mechanism<S: Scalar, const D: usize> {
    /// Where the bodies are.
    type Pose: Copy;

    /// Whatever [`solve`](Self::solve) needs of a linearisation.
    type Linearisation;

    /// The pose Q = `pose` + `dt`·Q̇(Q, `velocity`), implicit in Q.
    fn advanced(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose;

    /// `from + weight·(to − from)` in the coordinates in which poses are integrated.
    fn extrapolated(&self, from: &Self::Pose, to: &Self::Pose, weight: S) -> Self::Pose;

    /// The same pose with rounding's drift of its constraints taken out.
    fn normalised(&self, pose: &Self::Pose) -> Self::Pose;

    /// `yes` where `condition` > 0, else `no` (also where it is NaN).
    fn selected(&self, condition: S, yes: &Self::Pose, no: &Self::Pose) -> Self::Pose;

    /// 0 if all coordinates of `pose` are finite, else NaN.
    fn nought(&self, pose: &Self::Pose) -> S;

    /// M·`velocity`: generalised momentum (N·s, N·m·s).
    fn momentum(&self, velocity: &SVector<S, D>) -> SVector<S, D>;

    /// The generalised force (N, N·m) at time `t` (s), and the linearisation of momentum − `a`·force with respect to
    /// the velocity, through the pose too. The linearisation may be approximate; it steers, the force decides.
    fn linearised(
        &self,
        t: S,
        pose: &Self::Pose,
        velocity: &SVector<S, D>,
        a: S,
    ) -> (SVector<S, D>, Self::Linearisation);

    /// The velocity change that brings the linearised momentum balance from `residual` to zero, negated.
    fn solve(&self, linearisation: &Self::Linearisation, residual: &SVector<S, D>) -> SVector<S, D>;

    /// One number for an imbalance of momentum (N·s): angular components over a length of the mechanism.
    fn impulse(&self, imbalance: &SVector<S, D>) -> S;
}
