//! The scene that units are predicted for.

use slipfit_core::{
    law::{Friction, Impact, ThreeHalves},
    menu::{ContactData, FrictionData, NormalType},
    scene::SceneData,
    slide::Slide,
};

use crate::status::{Refusal, SLIPFIT_LAW};

/// A unit with its friction law.
pub(crate) type Unit<F> = Slide<f32, ThreeHalves<f32>, F>;

/// A scene: a slide over the production, SI units, as `slipfit kernel SCENE -o scene.h` writes it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_scene {
    /// SLIPFIT_SCHEME_IMPLICIT_EULER.
    pub scheme: u32,
    /// Step (s).
    pub step: f32,
    /// Mass (kg).
    pub mass: f32,
    /// Principal moments of inertia about the centre of mass (kg·m²).
    pub inertia: [f32; 3],
    /// Gravity (m/s²).
    pub gravity: [f32; 3],
    /// Positions of the pins from the centre of mass (m): x, y, z of each.
    pub pins: [[f32; 3]; 4],
    /// Means of the gaps (m): left, right, rail, wall of each pin; 1e6 for none.
    pub gap_means: [f32; 16],
    /// Standard deviations of the gaps (m), not negative.
    pub gap_deviations: [f32; 16],
    /// Contact stiffness (N/m^e).
    pub stiffness: f32,
    /// Contact exponent e; the library is built for 1.5.
    pub exponent: f32,
    /// Contact damping (N·s/m).
    pub damping: f32,
    /// Depth of full damping (m).
    pub depth: f32,
    /// SLIPFIT_FRICTION_REGULARISED or SLIPFIT_FRICTION_EXACT; the library is built for one of the two.
    pub friction_law: u32,
    /// Coefficient of friction.
    pub friction_coefficient: f32,
    /// Stick band of regularised friction (m/s); ignored by exact friction.
    pub friction_stick_band: f32,
    /// Gain of the drive (N·s/m).
    pub drive_gain: f32,
    /// Start and end of the drive's ramp (s).
    pub drive_ramp: [f32; 2],
    /// Commanded speed at the end of the ramp (m/s).
    pub drive_speed: f32,
    /// Where the drive pushes, from the centre of mass (m).
    pub drive_point: [f32; 3],
}

/// Implicit Euler with four Newton passes.
pub const SLIPFIT_SCHEME_IMPLICIT_EULER: u32 = 1;

/// Regularised Coulomb friction.
pub const SLIPFIT_FRICTION_REGULARISED: u32 = 1;
/// Coulomb friction with true stick.
pub const SLIPFIT_FRICTION_EXACT: u32 = 2;

impl slipfit_scene {
    fn data(&self) -> Result<SceneData<f32>, Refusal> {
        let coefficient = self.friction_coefficient;
        Ok(SceneData {
            mass: self.mass,
            inertia_b: self.inertia,
            gravity_w: self.gravity,
            pins_w: self.pins,
            gap_means: self.gap_means,
            gap_deviations: self.gap_deviations,
            contact: ContactData {
                stiffness: self.stiffness,
                exponent: self.exponent,
                damping: self.damping,
                depth: self.depth,
            },
            friction: match self.friction_law {
                SLIPFIT_FRICTION_REGULARISED => {
                    FrictionData::Regularised { coefficient, stick_band: self.friction_stick_band }
                }
                SLIPFIT_FRICTION_EXACT => FrictionData::Exact { coefficient },
                _ => return Err(Refusal(SLIPFIT_LAW)),
            },
            drive_gain: self.drive_gain,
            drive_ramp: self.drive_ramp,
            drive_speed: self.drive_speed,
            drive_point_b: self.drive_point,
        })
    }

    /// What the drive can push with, and the weight (N).
    pub(crate) fn greatest_force(&self) -> f32 {
        let [x, y, z] = self.gravity.map(|part| part * self.mass);
        (self.drive_gain * self.drive_speed).abs() + x.abs() + y.abs() + z.abs()
    }

    /// The unit of tolerance level `n`, whose friction is what `friction` makes of the scene's.
    pub(crate) fn slide<F: Friction<f32>>(
        &self,
        n: f32,
        friction: impl FnOnce(FrictionData<f32>) -> Result<F, Refusal>,
    ) -> Result<Unit<F>, Refusal> {
        let unit = self.data()?.at(n)?;
        if unit.contact.normal_type() != NormalType::ThreeHalves {
            return Err(Refusal(SLIPFIT_LAW));
        }
        let ContactData { stiffness, damping, depth, .. } = unit.contact;
        let contact = Impact::new(ThreeHalves::new(stiffness)?, damping, depth)?;
        Ok(unit.body.slide(contact, friction(unit.friction)?, unit.drive)?)
    }
}
