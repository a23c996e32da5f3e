//! The drive: a P-velocity controller behind a ramp (eq. 12).

use super::{Commandable, Push, Pushed};
use crate::{
    ParameterError, Scalar, Vector3,
    error::bounded,
    law::step::{cubic, step},
};

/// F_z = K_p·(STEP(t, t0, 0, t1, V) − v_z) along the frame's z, at a point fixed in the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive<S> {
    /// Gain K_p (N·s/m).
    pub gain: S,
    /// Start of the ramp t0 (s).
    pub ramp_start: S,
    /// End of the ramp t1 (s), after its start.
    pub ramp_end: S,
    /// Commanded speed V at the end of the ramp (m/s).
    pub speed: S,
    /// Where the force acts, from the centre of mass (m).
    pub point_b: Vector3<S>,
}

crate::cast::cast!([] [] Drive: Drive<f64> => T Drive<T> { gain, ramp_start, ramp_end, speed, point_b });

/// The commanded speed `v` (m/s, rad/s), if a drive can be told it.
///
/// # Errors
/// If it is not finite or outside ± 1000.
pub fn checked_command<S: Scalar + PartialOrd>(v: S) -> Result<S, ParameterError<S>> {
    bounded("drive.speed", v, [-1e3, 1e3])
}

impl<S: Scalar + PartialOrd> Drive<S> {
    /// This drive, if its parameters can be stepped without failing.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn checked(self) -> Result<Self, ParameterError<S>> {
        bounded("drive.gain", self.gain, [0.0, 1e9])?;
        bounded("drive.ramp_start", self.ramp_start, [-1e6, 1e6])?;
        bounded("drive.ramp_end", self.ramp_end, [self.ramp_start.to_f64(), 1e6])?;
        bounded("drive.ramp_duration", self.ramp_end - self.ramp_start, [1e-6, 1e6])?;
        checked_command(self.speed)?;
        for component in self.point_b.iter() {
            bounded("drive.point", *component, [-1e3, 1e3])?;
        }
        Ok(self)
    }
}

impl<S: Scalar> Drive<S> {
    /// The commanded speed (m/s) at time `t` (s).
    #[inline(always)]
    pub fn command(&self, t: S) -> S {
        step(t, self.ramp_start, S::zero(), self.ramp_end, self.speed)
    }

    /// How fast the command changes (m/s²) at time `t` (s).
    #[inline(always)]
    pub fn command_rate(&self, t: S) -> S {
        let per_duration = S::one() / (self.ramp_end - self.ramp_start);
        S::from_f64(6.0) * self.speed * per_duration * cubic((t - self.ramp_start) * per_duration).1
    }

    /// How fast the force (N/s) changes with time `t` (s) alone.
    #[inline(always)]
    pub fn force_rate(&self, t: S) -> S {
        self.gain * self.command_rate(t)
    }

    /// The force (N) along the frame's z at time `t` (s) and speed `v_z` (m/s) of the centre of mass.
    #[inline(always)]
    pub fn force(&self, t: S, v_z: S) -> S {
        self.gain * (self.command(t) - v_z)
    }
}

impl<S: Scalar> Push<S> for Drive<S> {
    fn checked(self) -> Result<Self, ParameterError<S>>
    where
        S: PartialOrd,
    {
        self.checked()
    }

    #[inline(always)]
    fn effort(&self, t: S, v: S) -> S {
        self.force(t, v)
    }

    #[inline(always)]
    fn pushed(&self, t: S, v: S) -> Pushed<S> {
        Pushed { force: self.force(t, v), per_speed: self.gain, per_time: self.force_rate(t) }
    }
}

impl<S: Scalar> Commandable<S> for Drive<S> {
    /// The end of a ramp that was over long before any time.
    #[inline(always)]
    fn set_command(&mut self, v: S) {
        (self.ramp_start, self.ramp_end, self.speed) = (S::from_f64(-1e6), S::from_f64(-999_999.0), v);
    }
}

#[cfg(test)]
mod tests {
    use super::{Commandable, Drive};
    use crate::Vector3;

    #[test]
    fn the_rate_is_the_derivative_of_the_command() {
        let drive = Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() };
        for t in [0.0, 0.06, 0.5, 0.9, 1.5] {
            let slope = (drive.command(t + 1e-6) - drive.command(t - 1e-6)) / 2e-6;
            assert!(libm::fabs(drive.command_rate(t) - slope) < 1e-9, "{t}");
        }
    }

    #[test]
    fn blocked_at_full_speed_gives_four_newton() {
        let drive = Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() };
        assert_eq!(drive.force(2.0, 0.0), 4.0);
        assert_eq!(drive.force(0.0, 0.1), -4.0);
    }

    #[test]
    fn a_command_that_is_set_holds_exactly() {
        let mut drive = Drive { gain: 40.0f32, ramp_start: 0.05, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() };
        for v in [0.07, -0.1, 0.0, 1e-30] {
            drive.set_command(v);
            for t in [-1000.0, 0.0, 0.5, 1e5] {
                assert_eq!((drive.command(t), drive.command_rate(t)), (v, 0.0));
            }
            assert!(drive.checked().is_ok());
        }
    }
}
