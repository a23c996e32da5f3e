//! Parameters of a slide that vary over the production, beside its gaps.

use super::{
    Scene, SceneError,
    product::{SIGMA_DEFAULT, deviation},
    unit::{self, Quantity},
    value::Field,
};
use crate::tolerance::model::Contributor;
use slipfit_core::menu::FrictionData;

/// A parameter that varies, and by how much from the scene's value.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    /// Which.
    pub parameter: Parameter,
    /// Its deviation (SI) from the scene's value.
    pub deviation: Contributor,
}

/// A parameter that can vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Coefficient of friction.
    Friction,
    /// Stiffness of the contacts.
    Stiffness,
    /// Damping of the contacts.
    Damping,
    /// Mass; the inertia goes with it.
    Mass,
    /// Gain of the drive.
    Gain,
    /// End of the drive's ramp.
    RampEnd,
    /// Direction of gravity: rotation about the frame's x.
    TiltX,
    /// Direction of gravity: rotation about the frame's z.
    TiltZ,
}

impl Parameter {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Friction,
        Self::Stiffness,
        Self::Damping,
        Self::Mass,
        Self::Gain,
        Self::RampEnd,
        Self::TiltX,
        Self::TiltZ,
    ];

    /// Table and key under `[vary]`.
    pub const fn key(self) -> [&'static str; 2] {
        match self {
            Self::Friction => ["friction", "coefficient"],
            Self::Stiffness => ["contact", "stiffness"],
            Self::Damping => ["contact", "damping"],
            Self::Mass => ["slide", "mass"],
            Self::Gain => ["drive", "gain"],
            Self::RampEnd => ["drive", "ramp_end"],
            Self::TiltX => ["slide", "tilt_x"],
            Self::TiltZ => ["slide", "tilt_z"],
        }
    }

    /// What its deviation may be. A stiffness varies by shares of itself.
    const fn quantity(self) -> Quantity {
        let (units, range) = match self {
            Self::Friction | Self::Stiffness => (unit::ONE, [-100.0, 100.0]),
            Self::Damping | Self::Gain => (unit::DAMPING, [-1e6, 1e6]),
            Self::Mass => (unit::MASS, [-1e7, 1e7]),
            Self::RampEnd => (unit::SECONDS, [-1000.0, 1000.0]),
            Self::TiltX | Self::TiltZ => (unit::ANGLE, [-180.0, 180.0]),
        };
        Quantity { units, range }
    }

    /// Moves the parameter of `scene` by a `deviation` (SI).
    pub fn apply(self, scene: &mut Scene, deviation: f64) {
        match self {
            Self::Friction => match &mut scene.friction {
                FrictionData::Regularised { coefficient, .. } | FrictionData::Exact { coefficient } => {
                    *coefficient += deviation;
                }
                FrictionData::None => {}
            },
            Self::Stiffness => scene.contact.stiffness *= 1.0 + deviation,
            Self::Damping => scene.contact.damping += deviation,
            Self::Mass => scene.slide.mass += deviation,
            Self::Gain => scene.drive.gain += deviation,
            Self::RampEnd => scene.drive.ramp_end += deviation,
            Self::TiltX => {
                let [x, y, z] = scene.slide.gravity;
                let (sin, cos) = (libm::sin(deviation), libm::cos(deviation));
                scene.slide.gravity = [x, cos * y - sin * z, sin * y + cos * z];
            }
            Self::TiltZ => {
                let [x, y, z] = scene.slide.gravity;
                let (sin, cos) = (libm::sin(deviation), libm::cos(deviation));
                scene.slide.gravity = [cos * x - sin * y, sin * x + cos * y, z];
            }
        }
    }
}

/// Reads the optional table `[vary]`.
pub(super) fn vary(root: &Field) -> Result<Vec<Varied>, SceneError> {
    let Some(table) = root.get("vary") else { return Ok(Vec::new()) };
    table.expect_table()?;
    let mut varied = Vec::new();
    for parameter in Parameter::ALL {
        let [group, key] = parameter.key();
        let Some(of_group) = table.get(group) else { continue };
        of_group.expect_table()?;
        let Some(field) = of_group.get(key) else { continue };
        let spread = deviation(&field, &parameter.quantity(), SIGMA_DEFAULT)?;
        varied.push(Varied { parameter, deviation: spread.contributor(format!("{group}.{key}")) });
    }
    Ok(varied)
}
