//! What an integrator sees of a scene: generalised velocities, momenta, forces, iteration matrices and Jacobians.

use crate::{SVector, Scalar, drive::SetpointDrive, law::friction::SlidingContact};

/// How forces are to be linearised.
#[derive(Clone, Copy, Debug)]
pub struct Way<S> {
    /// The time (s) over which a velocity also moves the bodies, where derivatives by the one take in those by the other; `None`
    /// where the two are told apart.
    pub over: Option<S>,
    /// Mass over the implicit part that friction's internal variables yield over (kg/s).
    pub mass_rate: S,
    /// See [`SlidingContact`].
    pub tangent_share: S,
}

impl<S: Scalar> Way<S> {
    /// What friction acts upon at a contact with the velocity `sliding` (m/s) of the body and the force `normal` (N).
    #[inline(always)]
    pub fn sliding(&self, sliding: [S; 2], normal: S) -> SlidingContact<S> {
        SlidingContact { sliding, normal, mass_rate: self.mass_rate, tangent_share: self.tangent_share }
    }
}

/// Forces at one motion, and the iteration matrix there.
#[derive(Clone, Copy, Debug)]
pub struct Balance<S, M, const D: usize> {
    /// The generalised force (N, N·m).
    pub force: SVector<S, D>,
    /// Iteration matrix of momentum/a − force with respect to the velocity. It may be approximate; it steers, the force
    /// decides.
    pub iteration_matrix: M,
}

/// Forces at one motion and all their derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Differentiated<S, J, const D: usize> {
    /// The generalised force (N, N·m).
    pub force: SVector<S, D>,
    /// ∂force/∂t (N/s, N·m/s).
    pub per_time: SVector<S, D>,
    /// Derivatives by velocity and displacement.
    pub jacobians: J,
}

/// Accelerations are rounded to the last place of this (m/s²): 9e-13 m/s² in f64, 5e-4 m/s² in f32.
const SETTLED: f64 = 4000.0;

/// The greatest speed (m/s) to whose last place velocities are rounded.
const SETTLED_MOST: f64 = 4.0;

/// The speed (m/s) to whose last place [`settled`] rounds velocities over the implicit part `a` (s) of a step. What rounding of
/// the contact forces stirs up in it stays below, and grows with it; so does what a force that counts makes of a velocity.
#[inline(always)]
pub(crate) fn settling<S: Scalar>(a: S) -> S {
    let unit = a * S::from_f64(SETTLED);
    unit.select_gt(S::from_f64(SETTLED_MOST), S::from_f64(SETTLED_MOST), unit)
}

/// `x` rounded to about the last place of `unit`, the same either way: nearer to zero than a quarter of that it is zero.
#[inline(always)]
pub(crate) fn settled<S: Scalar>(x: S, unit: S) -> S {
    (((x + unit) - unit) + ((x - unit) + unit)) * S::from_f64(0.5)
}

/// A mechanism with `D` generalised velocities.
///
/// Implicit schemes solve momentum(V) − momentum(V₀) = a·force(t, Q, V) with Q = implicit_update(Q₀, V, a) for V. `a` (s) is
/// the implicit part of the step.
pub trait Mechanism<S: Scalar, const D: usize> {
    /// Where the bodies are.
    type Pose: Copy + PartialEq;

    /// Internal variables of force laws, kept from one step to the next, such as friction forces; `()` where there are none.
    type Internal: Copy;

    /// Whatever [`solve`](Self::solve) needs of an iteration matrix.
    type IterationMatrix: Copy + Default;

    /// Derivatives of the force by velocity and displacement.
    type Jacobians: Copy;

    /// Whether friction can hold it at rest. Only implicit schemes can follow that; a kernel of another one does not compile.
    const STICKS: bool;

    /// The pose Q = `pose` + `dt`·Q̇(Q, `velocity`), implicit in Q.
    fn implicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose;

    /// The pose `pose` + `dt`·Q̇(`pose`, `velocity`), explicit.
    fn explicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose;

    /// `base + weight·(to − from)` in the coordinates in which poses are integrated.
    fn shifted(&self, base: &Self::Pose, from: &Self::Pose, to: &Self::Pose, weight: S) -> Self::Pose;

    /// `base + weight·(to − from)`.
    fn internal_shifted(
        &self,
        base: &Self::Internal,
        from: &Self::Internal,
        to: &Self::Internal,
        weight: S,
    ) -> Self::Internal;

    /// The same pose with rounding's drift of its constraints taken out.
    fn normalised(&self, pose: &Self::Pose) -> Self::Pose;

    /// The internal variables of laws that nothing has happened to yet.
    fn fresh(&self) -> Self::Internal;

    /// The internal variables after a step that led to `pose`, of a scheme that takes no forces there: for laws that remember places alone.
    fn remembered(&self, pose: &Self::Pose, internal: &Self::Internal) -> Self::Internal;

    /// Makes `kept` `next`, number by number where it is finite and `condition` > 0. In place, since a copy would take stack.
    fn accept(&self, condition: S, next: (&Self::Pose, &Self::Internal), kept: (&mut Self::Pose, &mut Self::Internal));

    /// 0 if all coordinates of `pose` are finite, else NaN.
    fn finiteness_probe(&self, pose: &Self::Pose) -> S;

    /// `velocity` with what can only be rounding taken out of it, where the mechanism can be truly at rest; `a` (s) is the
    /// implicit part of the step.
    fn settled(&self, velocity: &SVector<S, D>, _a: S) -> SVector<S, D> {
        *velocity
    }

    /// M·`velocity` at `pose`: generalised momentum (N·s, N·m·s).
    fn momentum(&self, pose: &Self::Pose, velocity: &SVector<S, D>) -> SVector<S, D>;

    /// M⁻¹·`momentum` at `pose`: generalised velocities (m/s, rad/s).
    fn velocity(&self, pose: &Self::Pose, momentum: &SVector<S, D>) -> SVector<S, D>;

    /// M·`velocity` (N·s, N·m·s) at the motion whose `jacobians` these are, at its `pose`.
    #[inline(always)]
    fn momentum_by(&self, _jacobians: &Self::Jacobians, pose: &Self::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.momentum(pose, velocity)
    }

    /// What has at the motion whose `jacobians` these are the effect (m/s², rad/s²) that the [`forces`](Self::forces) have at another
    /// one: the forces themselves where the mass matrix is the same everywhere.
    #[inline(always)]
    fn forces_by(
        &self,
        _jacobians: &Self::Jacobians,
        t: S,
        pose: &Self::Pose,
        internal: &Self::Internal,
        velocity: &SVector<S, D>,
        a: S,
    ) -> SVector<S, D> {
        self.forces(t, pose, internal, velocity, a, None)
    }

    /// Forces (N, N·m) at time `t` (s); `a` (s) is the implicit part of the step. Writes to `updated` what the laws
    /// remember if the motion is accepted.
    fn forces(
        &self,
        t: S,
        pose: &Self::Pose,
        internal: &Self::Internal,
        velocity: &SVector<S, D>,
        a: S,
        updated: Option<&mut Self::Internal>,
    ) -> SVector<S, D>;

    /// Forces at time `t` (s), and how momentum/`a` − force changes with the velocity, through the pose too. Of the
    /// friction's change along the sliding direction the iteration matrix takes `tangent_share` from the law's tangent, the
    /// rest from its secant.
    fn balance(
        &self,
        t: S,
        pose: &Self::Pose,
        internal: &Self::Internal,
        velocity: &SVector<S, D>,
        a: S,
        tangent_share: S,
    ) -> Balance<S, Self::IterationMatrix, D>;

    /// The velocity change that brings the linearised balance of forces from `residual` (N, N·m) to zero, negated.
    fn solve(&self, iteration_matrix: &Self::IterationMatrix, residual: &SVector<S, D>) -> SVector<S, D>;

    /// One number for an imbalance of momentum (N·s): angular components over a length of the mechanism.
    fn impulse(&self, imbalance: &SVector<S, D>) -> S;

    /// One number (N·s) for a change of velocity, or with the place of which it is the rate (N·s²), at `pose`: the impulse that
    /// makes it.
    #[inline(always)]
    fn weighed(&self, pose: &Self::Pose, change: &SVector<S, D>) -> S {
        self.impulse(&self.momentum(pose, change))
    }

    /// Forces at time `t` (s) and their derivatives, for laws without internal variables.
    fn differentiated(
        &self,
        t: S,
        pose: &Self::Pose,
        internal: &Self::Internal,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, Self::Jacobians, D>;

    /// Iteration matrix of momentum/`a` − force with respect to a velocity that also moves the pose over the time `a` (s), by
    /// [`displacement`](Self::displacement); these are the `jacobians` of a motion with this `velocity`.
    fn iteration_matrix(&self, jacobians: &Self::Jacobians, velocity: &SVector<S, D>, a: S) -> Self::IterationMatrix;

    /// How the force changes (N, N·m) with a small `displacement` (m, rad).
    fn pushed(&self, jacobians: &Self::Jacobians, displacement: &SVector<S, D>) -> SVector<S, D>;

    /// The displacement x (m, rad) that solves x = `a`·(`rate` + ∂R/∂x·x) over the time `a` (s), where R is the
    /// [`rate`](Self::rate) at no displacement and with the `velocity`: `a`·`rate` where coordinates are straight.
    #[inline(always)]
    fn displacement(&self, _velocity: &SVector<S, D>, rate: &SVector<S, D>, a: S) -> SVector<S, D> {
        rate * a
    }

    /// The rate (m/s, rad/s) of a `displacement` x from a pose, such that `explicit_update(pose, x, 1)` is the pose, while the body
    /// moves with `velocity`. It is the velocity at no displacement, and everywhere where coordinates are straight.
    fn rate(&self, _displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        *velocity
    }
}

/// A mechanism that a drive pushes by setpoints, and whose laws have no internal variables.
pub trait Driven<S: Scalar, const D: usize>: Mechanism<S, D> {
    /// The drive.
    fn drive(&self) -> &SetpointDrive<S>;

    /// The drive, to be given the command of the next step.
    fn drive_mut(&mut self) -> &mut SetpointDrive<S>;

    /// The mass (kg) that the drive pushes.
    fn mass(&self) -> S;

    /// The speed (m/s) along the drive of a `velocity`.
    fn speed(&self, velocity: &SVector<S, D>) -> S;

    /// How far (m) along the drive a `pose` is.
    fn position(&self, pose: &Self::Pose) -> S;
}

#[cfg(test)]
mod tests {
    use super::{settled, settling};

    #[test]
    fn rounding_to_rest_is_the_same_either_way() {
        let mut bits = 1u32;
        for _ in 0..if cfg!(miri) { 200 } else { 20_000 } {
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let x = f32::from_bits(bits >> 1);
            if x.is_finite() && x < 1e6 {
                for unit in [settling(1e-3f32), settling(1e-7), 0.3] {
                    assert_eq!(settled(-x, unit), -settled(x, unit), "{x:e} {unit}");
                    assert!((settled(x, unit) - x).abs() <= 1.2e-7 * unit.max(x), "{x:e} {unit}");
                }
            }
        }
        for (x, zero) in [(1.1e-7f32, true), (2.5e-7, false)] {
            assert_eq!([settled(x, 4.0) == 0.0, settled(-x, 4.0) == 0.0], [zero; 2]);
        }
    }

    #[test]
    fn it_shrinks_with_the_step() {
        assert_eq!(settling(1.0f64), 4.0);
        assert_eq!(settling(1e-4f64), 0.4);
        // What 0.01 m/s² makes of a velocity in one step stays.
        for step in [1e-3f32, 1e-5, 1e-7, 1e-9] {
            assert!(settled(0.01 * step, settling(step)) > 0.0, "{step}");
        }
    }
}
