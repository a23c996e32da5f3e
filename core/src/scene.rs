//! A scene as a constant: every unit of a production, until its tolerance level is known.

use crate::{
    ParameterError, Scalar, Vector3,
    clearance::{GapStatistics, checked_level},
    drive::Drive,
    error::bounded,
    menu::{ContactData, FrictionData, SlideData},
    slide::{Body, CONTACTS, PINS},
};

/// A slide over the production, SI units: what [`SlideData`] holds, but gaps by their statistics.
///
/// `slipfit kernel` writes one for a scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneData<S> {
    /// Mass (kg).
    pub mass: S,
    /// Principal moments of inertia about the centre of mass (kg·m²), along the body's axes.
    pub inertia_b: [S; 3],
    /// Gravity (m/s²).
    pub gravity_w: [S; 3],
    /// Pins, from the centre of mass at the nominal pose (m).
    pub pins_w: [[S; 3]; PINS],
    /// Means of the gaps at the nominal pose (m), in the order of [`Body::gaps`]; [`ABSENT`](crate::slide::ABSENT) for
    /// none.
    pub gap_means: [S; CONTACTS],
    /// Standard deviations of the gaps (m), not negative; 0 where there is none.
    pub gap_deviations: [S; CONTACTS],
    /// Contact law.
    pub contact: ContactData<S>,
    /// Friction law.
    pub friction: FrictionData<S>,
    /// Gain of the drive (N·s/m).
    pub drive_gain: S,
    /// Start and end of the drive's ramp (s).
    pub drive_ramp: [S; 2],
    /// Commanded speed at the end of the ramp (m/s).
    pub drive_speed: S,
    /// Where the drive pushes, from the centre of mass (m).
    pub drive_point_b: [S; 3],
}

impl<S: Scalar + PartialOrd> SceneData<S> {
    /// The unit of tolerance level `n`: its gaps are x − n·σ (eq. 9), computed in `S`.
    ///
    /// # Errors
    /// [`ParameterError`] if the level exceeds [`LEVEL_MOST`](crate::clearance::LEVEL_MOST), or a deviation is negative, above
    /// 1 m or not finite. All else is validated where a slide is made.
    pub fn at(&self, n: S) -> Result<SlideData<S>, ParameterError<S>> {
        let n = checked_level(n)?;
        let mut gaps = self.gap_means;
        for ((gap, mean), deviation) in gaps.iter_mut().zip(self.gap_means).zip(self.gap_deviations) {
            *gap = GapStatistics { mean, deviation: bounded("gap.deviation", deviation, [0.0, 1.0])? }.at(n);
        }
        let [ramp_start, ramp_end] = self.drive_ramp;
        Ok(SlideData {
            body: Body {
                mass: self.mass,
                inertia_b: Vector3::from(self.inertia_b),
                gravity_w: Vector3::from(self.gravity_w),
                pins_w: self.pins_w.map(Vector3::from),
                gaps,
            },
            contact: self.contact,
            friction: self.friction,
            drive: Drive {
                gain: self.drive_gain,
                ramp_start,
                ramp_end,
                speed: self.drive_speed,
                point_b: Vector3::from(self.drive_point_b),
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slide::ABSENT;

    #[test]
    fn refuses_deviations_that_are_none() {
        let scene = |deviation: f32| SceneData {
            mass: 0.1,
            inertia_b: [1e-4; 3],
            gravity_w: [0.0; 3],
            pins_w: [[0.0; 3]; PINS],
            gap_means: [ABSENT as f32; CONTACTS],
            gap_deviations: [deviation; CONTACTS],
            contact: ContactData { stiffness: 1e6, exponent: 1.5, damping: 1e3, depth: 1e-4 },
            friction: FrictionData::None,
            drive_gain: 0.0,
            drive_ramp: [0.0, 1.0],
            drive_speed: 0.0,
            drive_point_b: [0.0; 3],
        };
        for bad in [-1e-9, -1.0, 1.1, f32::NAN, f32::INFINITY] {
            assert_eq!(scene(bad).at(0.0).unwrap_err().parameter, "gap.deviation", "{bad}");
        }
        for level in [-1000.0, -50.0, -20.1, 20.1, 50.0, f32::NAN, f32::INFINITY] {
            assert_eq!(scene(1e-5).at(level).unwrap_err().parameter, "n", "{level}");
        }
        assert!(scene(1e-5).at(-20.0).is_ok() && scene(1e-5).at(20.0).is_ok());
        assert!(scene(0.0).at(3.0).is_ok() && scene(-0.0).at(3.0).is_ok() && scene(1e-5).at(3.0).is_ok());
    }
}
