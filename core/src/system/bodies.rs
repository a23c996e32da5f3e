//! Bodies that move together by some coordinates.

use super::{Axes, Jacobian};
use crate::{SVector, Scalar};

/// Bodies whose elements add up by generalised velocities, so that a link need only tell its gradient
/// ([`GradientLink`](super::GradientLink)).
pub trait ByCoordinate {}

/// Bodies with `D` generalised velocities. Ideal joints are in the coordinates: what they forbid has none.
pub trait Bodies<S: Scalar, const D: usize> {
    /// Where the bodies are.
    type Pose: Copy + PartialEq;

    /// Where they are and how they move, worked out for links.
    type Placed;

    /// What [`inertia`](Self::inertia) is made of at a pose: the mass matrix (kg, kg·m, kg·m²), or what turning the axes makes of it;
    /// `()` where it is the same at every pose in the axes of the sum.
    type Mass: Copy;

    /// The axes in which elements add up.
    type Axes: Axes<S, D>;

    /// What derivatives add up in.
    type Jacobian: Jacobian<S, D>;

    /// Whether the mass matrix is the same at every pose in the axes of the velocities.
    const MASS_IS_CONSTANT: bool;

    /// Whether a stage's matrix takes from a law how its force goes by rates that also move places over the implicit part of the
    /// step, as one matrix, and leaves out how links turn meanwhile. It steers, the force decides.
    const MATRIX_IS_LEAN: bool = false;

    /// `pose` + `dt`·Q̇(Q, `velocity`), implicit in Q.
    fn implicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose;

    /// `pose` + `dt`·Q̇(`pose`, `velocity`), explicit.
    fn explicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose;

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

    /// See [`Mechanism::displacement`](crate::mechanism::Mechanism::displacement).
    #[inline(always)]
    fn displacement(&self, _velocity: &SVector<S, D>, rate: &SVector<S, D>, a: S) -> SVector<S, D> {
        rate * a
    }

    /// `matrix` with the `stiffness` of what a rate displaces over the time `a` (s); both are in the `axes` in which elements add up,
    /// the `velocity` is not.
    #[inline(always)]
    fn stiffened(
        &self,
        matrix: Self::Jacobian,
        stiffness: &Self::Jacobian,
        (_axes, _velocity): (&Self::Axes, &SVector<S, D>),
        a: S,
    ) -> Self::Jacobian {
        matrix.plus(stiffness, a)
    }

    /// The bodies at `pose`, moving with `velocity`.
    fn placed(&self, pose: &Self::Pose, velocity: &SVector<S, D>) -> Self::Placed;

    /// The axes in which elements add up.
    fn axes(&self, placed: &Self::Placed) -> Self::Axes;

    /// That of the bodies as they are placed.
    fn mass(&self, placed: &Self::Placed) -> Self::Mass;

    /// M·`rate`, in the axes in which elements add up.
    fn inertia(&self, mass: &Self::Mass, rate: S) -> Self::Jacobian;

    /// M·`velocity` (N·s, N·m·s).
    fn momentum(&self, mass: &Self::Mass, velocity: &SVector<S, D>) -> SVector<S, D>;

    /// M⁻¹·`momentum` (m/s, rad/s).
    fn velocity(&self, mass: &Self::Mass, momentum: &SVector<S, D>) -> SVector<S, D>;

    /// What the sum over the elements begins with (N, N·m), in the axes in which they add up.
    fn own_force(&self, placed: &Self::Placed) -> SVector<S, D>;

    /// The generalised force (N, N·m), force = M·V̇, where the elements have added up to `sum`: with gravity and what turning
    /// resists, where these are not in [`own_force`](Self::own_force), and in the axes of the frame.
    #[inline(always)]
    fn total(&self, placed: &Self::Placed, sum: &SVector<S, D>) -> SVector<S, D> {
        self.axes(placed).to_velocities(sum)
    }

    /// [`mass`](Self::mass) and [`own_force`](Self::own_force), for bodies that find both by the same way.
    #[inline(always)]
    fn mass_and_own_force(&self, placed: &Self::Placed) -> (Self::Mass, SVector<S, D>) {
        (self.mass(placed), self.own_force(placed))
    }

    /// Adds how gravity and what turning resists, less M·`acceleration`, go by velocity and by place, negated, in the axes in which
    /// elements add up; the acceleration is held, and not looked at where the mass matrix is constant.
    fn own_jacobians(
        &self,
        placed: &Self::Placed,
        mass: &Self::Mass,
        acceleration: &SVector<S, D>,
        damping: &mut Self::Jacobian,
        stiffness: &mut Self::Jacobian,
    );

    /// The least mass (kg) that an element may meet: what friction that sticks yields by.
    fn least_mass(&self) -> S;

    /// 1 for a coordinate that is a length, 1 over a length (1/m) for an angle: what makes momenta, and speeds, comparable.
    fn per_lever(&self) -> SVector<S, D>;

    /// See [`Mechanism::impulse`](crate::mechanism::Mechanism::impulse).
    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, D>) -> S {
        let weighted = imbalance.component_mul(&self.per_lever());
        weighted.dot(&weighted).sqrt()
    }

    /// See [`Mechanism::weighed`](crate::mechanism::Mechanism::weighed). By default the least mass times the speed, angles by their
    /// levers: what counts is each coordinate, not what it weighs.
    #[inline(always)]
    fn weighed(&self, change: &SVector<S, D>) -> S {
        let speeds = change.component_div(&self.per_lever());
        self.least_mass() * speeds.dot(&speeds).sqrt()
    }
}
