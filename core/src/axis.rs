//! One body on one axis at one stop: the smallest mechanism.

use crate::{
    ParameterError, SVector, Scalar,
    drive::{Drive, Push},
    error::bounded,
    law::{Elastic, Impact, Pad, Stop, stop::Resistance},
    mechanism::{Differentiated, Driven, Linearised, Mechanism},
};

/// A body that moves along one axis, with a stop, by default a pad below it, and a drive, by default none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisBody<S, E, C = Pad<S>, P = ()> {
    mass: S,
    gravity: S,
    stop: C,
    contact: Impact<S, E>,
    push: P,
}

impl<S: Scalar + PartialOrd, E: Elastic<S>> AxisBody<S, E> {
    /// A body of `mass` (kg) with the acceleration of free fall `gravity` (m/s², positive upwards) and the `gap` (m) to
    /// the pad at position 0.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(mass: S, gravity: S, gap: S, contact: Impact<S, E>) -> Result<Self, ParameterError<S>> {
        Self::driven(mass, gravity, Pad::new(gap)?, contact, ())
    }
}

impl<S: Scalar + PartialOrd, E: Elastic<S>, C: Stop<S>, P: Push<S>> AxisBody<S, E, C, P> {
    /// A body of `mass` (kg) with the acceleration `gravity` (m/s², along the axis) at `stop`, driven by `push`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds, of the drive too. The stop is
    /// validated where it is made.
    pub fn driven(mass: S, gravity: S, stop: C, contact: Impact<S, E>, push: P) -> Result<Self, ParameterError<S>> {
        Ok(Self {
            mass: bounded("mass", mass, [1e-6, 1e6])?,
            gravity: bounded("gravity", gravity, [-1e4, 1e4])?,
            stop,
            contact,
            push: push.checked()?,
        })
    }
}

impl<S: Scalar, E: Elastic<S>, C: Stop<S>, P: Push<S>> AxisBody<S, E, C, P> {
    /// Force of the stop on the body (N) at `position` (m) and `velocity` (m/s), all positive along the axis.
    pub fn pad_force(&self, position: S, velocity: S) -> S {
        self.stop.resistance(&self.contact, -position, velocity).force()
    }
}

impl<S: Scalar, E: Elastic<S>, C: Stop<S>, P: Push<S>> Mechanism<S, 1> for AxisBody<S, E, C, P> {
    /// Position (m), positive upwards.
    type Pose = S;

    type Memory = ();

    /// Effective impedance (N·s/m).
    type Linearisation = S;

    /// Damping (N·s/m), the drive's with it, and stiffness (N/m) of the stop.
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
    fn accept(&self, condition: S, (next, ()): (&S, &()), (kept, ()): (&mut S, &mut ())) {
        *kept = next.or_old(condition, *kept);
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &S) -> S {
        *pose * S::zero()
    }

    #[inline(always)]
    fn momentum(&self, _: &S, velocity: &SVector<S, 1>) -> SVector<S, 1> {
        velocity * self.mass
    }

    #[inline(always)]
    fn velocity(&self, _: &S, momentum: &SVector<S, 1>) -> SVector<S, 1> {
        momentum / self.mass
    }

    #[inline(always)]
    fn forces(&self, t: S, pose: &S, memory: &(), velocity: &SVector<S, 1>, _: S, _: Option<&mut ()>) -> SVector<S, 1> {
        self.differentiated(t, pose, memory, velocity).force
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
    fn differentiated(&self, t: S, pose: &S, (): &(), velocity: &SVector<S, 1>) -> Differentiated<S, [S; 2], 1> {
        let stop = self.stop.resistance(&self.contact, -*pose, velocity.x);
        let [damping, _] = stop.impedances(S::zero());
        let [stiffness, _] = stop.stiffnesses();
        Differentiated {
            force: SVector::<S, 1>::new(stop.force() + self.push.force(t, velocity.x) + self.mass * self.gravity),
            per_time: SVector::<S, 1>::new(self.push.force_rate(t)),
            slopes: [damping + self.push.gain(), stiffness],
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

impl<S: Scalar, E: Elastic<S>, C: Stop<S>> Driven<S, 1> for AxisBody<S, E, C, Drive<S>> {
    fn drive(&self) -> &Drive<S> {
        &self.push
    }

    fn mass(&self) -> S {
        self.mass
    }

    fn speed(&self, velocity: &SVector<S, 1>) -> S {
        velocity.x
    }
}

#[cfg(test)]
mod tests {
    use super::AxisBody;
    use crate::{
        Vector3,
        drive::Drive,
        law::{Impact, Pad, ThreeHalves},
    };

    #[test]
    fn refuses_a_drive_that_is_none() {
        let contact = Impact::new(ThreeHalves::new(3e6f32).unwrap(), 1000.0, 1e-4).unwrap();
        let good = Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() };
        let made = |drive| AxisBody::driven(0.1, 0.0, Pad::new(0.0).unwrap(), contact, drive).map(drop);
        assert_eq!(made(good), Ok(()));
        for (bad, parameter) in [
            (Drive { gain: f32::NAN, ..good }, "drive.gain"),
            (Drive { gain: -1.0, ..good }, "drive.gain"),
            (Drive { ramp_end: 0.05, ..good }, "drive.ramp_duration"),
            (Drive { ramp_end: 0.0, ..good }, "drive.ramp_end"),
            (Drive { speed: f32::INFINITY, ..good }, "drive.speed"),
        ] {
            assert_eq!(made(bad).unwrap_err().parameter, parameter);
        }
    }
}
