//! One body on one axis above one pad: the smallest mechanism.

use crate::{
    ParameterError, SVector, Scalar,
    error::bounded,
    law::{Elastic, Impact},
    mechanism::{Differentiated, Linearised, Mechanism},
};

/// A body that moves along one axis, with a pad below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisBody<S, E> {
    mass: S,
    gravity: S,
    gap: S,
    contact: Impact<S, E>,
}

impl<S: Scalar + PartialOrd, E: Elastic<S>> AxisBody<S, E> {
    /// A body of `mass` (kg) with the acceleration of free fall `gravity` (m/s², positive upwards) and the `gap` (m) to
    /// the pad at position 0.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(mass: S, gravity: S, gap: S, contact: Impact<S, E>) -> Result<Self, ParameterError<S>> {
        Ok(Self {
            mass: bounded("mass", mass, [1e-6, 1e6])?,
            gravity: bounded("gravity", gravity, [-1e4, 1e4])?,
            gap: bounded("gap", gap, [-1.0, 1e3])?,
            contact,
        })
    }
}

impl<S: Scalar, E: Elastic<S>> AxisBody<S, E> {
    /// Force of the pad on the body (N) at `position` (m) and `velocity` (m/s), both positive upwards.
    pub fn pad_force(&self, position: S, velocity: S) -> S {
        self.contact.response(-(self.gap + position), -velocity).force
    }
}

impl<S: Scalar, E: Elastic<S>> Mechanism<S, 1> for AxisBody<S, E> {
    /// Position (m), positive upwards.
    type Pose = S;

    type Memory = ();

    /// Effective impedance (N·s/m).
    type Linearisation = S;

    /// Damping (N·s/m) and stiffness (N/m) of the pad.
    type Slopes = [S; 2];

    #[inline(always)]
    fn advanced(&self, pose: &S, velocity: &SVector<S, 1>, dt: S) -> S {
        *pose + velocity.x * dt
    }

    #[inline(always)]
    fn moved(&self, pose: &S, velocity: &SVector<S, 1>, dt: S) -> S {
        *pose + velocity.x * dt
    }

    #[inline(always)]
    fn shifted(&self, base: &S, from: &S, to: &S, weight: S) -> S {
        *base + (*to - *from) * weight
    }

    #[inline(always)]
    fn memory_shifted(&self, (): &(), (): &(), (): &(), _: S) {}

    #[inline(always)]
    fn normalised(&self, pose: &S) -> S {
        *pose
    }

    #[inline(always)]
    fn fresh(&self) {}

    #[inline(always)]
    fn selected(&self, condition: S, (yes, ()): (&S, &()), (no, ()): (&S, &())) -> (S, ()) {
        (condition.select_gt(S::zero(), *yes, *no), ())
    }

    #[inline(always)]
    fn nought(&self, pose: &S) -> S {
        *pose * S::zero()
    }

    #[inline(always)]
    fn momentum(&self, velocity: &SVector<S, 1>) -> SVector<S, 1> {
        velocity * self.mass
    }

    #[inline(always)]
    fn velocity(&self, momentum: &SVector<S, 1>) -> SVector<S, 1> {
        momentum / self.mass
    }

    #[inline(always)]
    fn forces(&self, t: S, pose: &S, memory: &(), velocity: &SVector<S, 1>, _: S) -> (SVector<S, 1>, ()) {
        (self.differentiated(t, pose, memory, velocity).force, ())
    }

    #[inline(always)]
    fn linearised(&self, t: S, pose: &S, memory: &(), velocity: &SVector<S, 1>, a: S, _: S) -> Linearised<S, S, 1> {
        let Differentiated { force, slopes, .. } = self.differentiated(t, pose, memory, velocity);
        Linearised { force, linearisation: self.linearisation(&slopes, a) }
    }

    #[inline(always)]
    fn solve(&self, impedance: &S, residual: &SVector<S, 1>) -> SVector<S, 1> {
        SVector::<S, 1>::new(residual.x / *impedance)
    }

    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, 1>) -> S {
        imbalance.x.magnitude()
    }

    #[inline(always)]
    fn differentiated(&self, _: S, pose: &S, (): &(), velocity: &SVector<S, 1>) -> Differentiated<S, [S; 2], 1> {
        let pad = self.contact.response(-(self.gap + *pose), -velocity.x);
        Differentiated {
            force: SVector::<S, 1>::new(pad.force + self.mass * self.gravity),
            per_time: SVector::zeros(),
            slopes: [pad.damping, pad.stiffness],
        }
    }

    #[inline(always)]
    fn linearisation(&self, [damping, stiffness]: &[S; 2], a: S) -> S {
        self.mass / a + *damping + a * *stiffness
    }

    #[inline(always)]
    fn pushed(&self, [_, stiffness]: &[S; 2], displacement: &SVector<S, 1>) -> SVector<S, 1> {
        displacement * -*stiffness
    }
}
