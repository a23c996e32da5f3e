//! Bodies that move together by some coordinates.

use crate::{SMatrix, SVector, Scalar};

/// Bodies with `D` generalised velocities. Ideal joints are in the coordinates: what they forbid has none.
pub trait Bodies<S: Scalar, const D: usize> {
    /// Where the bodies are.
    type Pose: Copy + PartialEq;

    /// Where they are and how they move, worked out for links.
    type Placed;

    /// Whether the mass matrix is the same at every pose.
    const MASS_IS_CONSTANT: bool;

    /// `pose` + `dt`·Q̇(Q, `velocity`), implicit in Q.
    fn advanced(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose;

    /// `pose` + `dt`·Q̇(`pose`, `velocity`), explicit.
    fn moved(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose;

    /// `base + weight·(to − from)`, number by number.
    fn shifted(&self, base: &Self::Pose, from: &Self::Pose, to: &Self::Pose, weight: S) -> Self::Pose;

    /// The same pose with rounding's drift taken out of what has unit length.
    fn normalised(&self, pose: &Self::Pose) -> Self::Pose;

    /// Makes `kept` `next`, number by number where it is finite and `condition` > 0.
    fn accept(&self, condition: S, next: &Self::Pose, kept: &mut Self::Pose);

    /// 0 if all numbers of `pose` are finite, else NaN.
    fn finiteness_probe(&self, pose: &Self::Pose) -> S;

    /// See [`Mechanism::rate`](crate::mechanism::Mechanism::rate).
    fn rate(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D>;

    /// The bodies at `pose`, moving with `velocity`.
    fn placed(&self, pose: &Self::Pose, velocity: &SVector<S, D>) -> Self::Placed;

    /// The mass matrix (kg, kg·m, kg·m²).
    fn mass(&self, placed: &Self::Placed) -> SMatrix<S, D, D>;

    /// What gravity does and what turning resists (N, N·m): force = M·V̇ where no element acts.
    fn own_force(&self, placed: &Self::Placed) -> SVector<S, D>;

    /// [`mass`](Self::mass) and [`own_force`](Self::own_force), for bodies that find both by the same way.
    #[inline(always)]
    fn mass_and_own_force(&self, placed: &Self::Placed) -> (SMatrix<S, D, D>, SVector<S, D>) {
        (self.mass(placed), self.own_force(placed))
    }

    /// Adds how [`own_force`](Self::own_force) less M·`acceleration` goes by velocity and by place, negated; the acceleration
    /// is held, and not looked at where the mass matrix is constant.
    fn own_slopes(
        &self,
        placed: &Self::Placed,
        acceleration: &SVector<S, D>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    );

    /// The least mass (kg) that an element may meet: what friction that sticks yields by.
    fn least_mass(&self) -> S;

    /// 1 for a coordinate that is a length, 1 over a length (1/m) for an angle: what makes momenta, and speeds, comparable.
    fn per_lever(&self) -> &SVector<S, D>;
}
