//! Drive trains: the limit of the motor and the friction between the motor and the body that it drives.

use super::{Commandable, Push, Pushed};
use crate::{ParameterError, Scalar, error::bounded, law::Regularised};

/// Parameters of a drive train, SI units; of a torque in N·m and rad instead of N and m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainData<S> {
    /// The most that the motor gives (N), either way.
    pub limit: S,
    /// Coulomb friction (N) while the body moves along the axis, and while it moves against it.
    pub coulomb: [S; 2],
    /// Speed (m/s) below which Coulomb friction fades.
    pub stick_band: S,
    /// Viscous friction (N·s/m).
    pub viscous: S,
    /// What the motor has to give more along the axis than against it (N).
    pub offset: S,
}

crate::cast::cast!([] [] TrainData: TrainData<f64> => T TrainData<T> { limit, coulomb, stick_band, viscous, offset });

/// A `controller` whose effort is limited, on a drive train with friction:
/// force = clamp(effort, ± limit) − coulomb·w(3 − w²)/2 − viscous·v − offset, with w = v/stick band held within ± 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Train<S, P> {
    controller: P,
    data: TrainData<S>,
    /// Friction with a coefficient of 1.
    band: Regularised<S>,
}

crate::cast::cast!([P] [] Train: Train<f64, P> => T Train<T, P::Of<T>> { controller, data, band });

impl<S: Scalar> TrainData<S> {
    /// What the motor gives (N) of the `effort` (N) that its controller asks for.
    #[inline(always)]
    pub fn limited(&self, effort: S) -> S {
        effort.within(-self.limit, self.limit)
    }
}

impl<S: Scalar + PartialOrd, P: Push<S>> Train<S, P> {
    /// The `controller` on the drive train of `data`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(controller: P, data: TrainData<S>) -> Result<Self, ParameterError<S>> {
        bounded("drive.limit", data.limit, [0.0, 1e12])?;
        for friction in data.coulomb {
            bounded("drive.coulomb", friction, [0.0, 1e9])?;
        }
        bounded("drive.viscous", data.viscous, [0.0, 1e9])?;
        bounded("drive.offset", data.offset, [-1e9, 1e9])?;
        Ok(Self { controller: controller.checked()?, data, band: Regularised::new(S::one(), data.stick_band)? })
    }
}

impl<S: Scalar, P: Push<S>> Push<S> for Train<S, P> {
    fn checked(self) -> Result<Self, ParameterError<S>>
    where
        S: PartialOrd,
    {
        Self::new(self.controller, self.data)
    }

    #[inline(always)]
    fn effort(&self, t: S, v: S) -> S {
        self.data.limited(self.controller.effort(t, v))
    }

    #[inline(always)]
    fn pushed(&self, t: S, v: S) -> Pushed<S> {
        let TrainData { limit, coulomb: [along, against], viscous, offset, .. } = self.data;
        let asked = self.controller.pushed(t, v);
        // A saturated motor does not answer to speed or time.
        let free = asked.force.magnitude().select_gt(limit, S::zero(), S::one());
        let coulomb = v.select_gt(S::zero(), along, against);
        let square = v * v;
        let (ratio, ratio_slope) = self.band.per_speed(square);
        Pushed {
            force: self.data.limited(asked.force) - (coulomb * ratio + viscous) * v - offset,
            per_speed: free * asked.per_speed + coulomb * (ratio + (ratio_slope + ratio_slope) * square) + viscous,
            per_time: free * asked.per_time,
        }
    }
}

impl<S, P: Commandable<S>> Commandable<S> for Train<S, P> {
    #[inline(always)]
    fn set_command(&mut self, v: S) {
        self.controller.set_command(v);
    }
}

#[cfg(test)]
mod tests {
    use super::{Push, Train, TrainData};
    use crate::{Vector3, drive::Drive};

    const DATA: TrainData<f64> =
        TrainData { limit: 3.0, coulomb: [0.5, 0.7], stick_band: 1e-4, viscous: 2.0, offset: -0.1 };

    fn train() -> Train<f64, Drive<f64>> {
        let drive = Drive { gain: 40.0, ramp_start: 0.0, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() };
        Train::new(drive, DATA).unwrap()
    }

    #[test]
    fn the_motor_is_limited_and_the_train_takes_its_friction() {
        let train = train();
        assert_eq!(
            [train.effort(2.0, 0.0), train.effort(2.0, 0.09), train.effort(2.0, 0.3)],
            [3.0, 0.4, -3.0].map(near)
        );
        // 0.4 N of the controller; 0.5 and 0.18 N of friction; an offset of 0.1 N along the axis.
        assert!(libm::fabs(train.pushed(2.0, 0.09).force - (0.4 - 0.5 - 0.18 + 0.1)) < 1e-12);
        assert!(libm::fabs(train.pushed(2.0, -0.09).force - (3.0 + 0.7 + 0.18 + 0.1)) < 1e-12);
        // At rest there is no friction, within the stick band w(3 − w²)/2 of it.
        assert!(libm::fabs(train.pushed(2.0, 0.0).force - 3.1) < 1e-12);
        let within = 0.5 * 0.5 * (3.0 - 0.25) / 2.0;
        assert!(libm::fabs(train.pushed(2.0, 5e-5).force - (3.1 - within - 1e-4)) < 1e-12);
    }

    /// What the subtraction of the controller makes of 0.4.
    fn near(effort: f64) -> f64 {
        if effort == 0.4 { 40.0 * (0.1 - 0.09) } else { effort }
    }

    #[test]
    fn slopes_are_derivatives() {
        let train = train();
        let h = 1e-7;
        for (t, v) in [(0.5, 0.03), (0.5, -0.002), (2.0, 0.04), (0.2, 4e-5), (0.2, -7e-5), (2.0, -0.1)] {
            let at = train.pushed(t, v);
            let by_speed = (train.pushed(t, v - h * 1e-2).force - train.pushed(t, v + h * 1e-2).force) / (2e-2 * h);
            let by_time = (train.pushed(t + h, v).force - train.pushed(t - h, v).force) / (2.0 * h);
            assert!(libm::fabs(at.per_speed - by_speed) < 1e-4 * (1.0 + libm::fabs(by_speed)), "{t} {v}: {by_speed}");
            assert!(libm::fabs(at.per_time - by_time) < 1e-5, "{t} {v}: {by_time}");
        }
    }

    #[test]
    fn bad_parameters_are_refused() {
        let drive = train().controller;
        for (data, name) in [
            (TrainData { limit: f64::NAN, ..DATA }, "drive.limit"),
            (TrainData { coulomb: [0.1, -0.1], ..DATA }, "drive.coulomb"),
            (TrainData { viscous: -1.0, ..DATA }, "drive.viscous"),
            (TrainData { offset: f64::INFINITY, ..DATA }, "drive.offset"),
            (TrainData { stick_band: 0.0, ..DATA }, "friction.stick_band"),
        ] {
            assert_eq!(Train::new(drive, data).unwrap_err().parameter, name);
        }
    }
}
