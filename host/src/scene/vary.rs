//! Parameters of a slide that vary over the production, beside its gaps.

use slipfit_core::menu::FrictionData;
use slipfit_tolerance::unit::{self, Quantity};

use super::{
    Problem, SceneError,
    product::{SIGMA_DEFAULT, deviation},
    value::Field,
};
use crate::setup::Scene;
use crate::setup::{SlideParameter as Parameter, Varied};

/// A deviation that is a number without a unit.
pub(super) const SHARE: Quantity = Quantity { units: unit::ONE, range: [-100.0, 100.0] };
/// A deviation of damping, or of a gain.
pub(super) const DAMPING: Quantity = Quantity { units: unit::DAMPING, range: [-1e6, 1e6] };
/// A deviation of a mass.
pub(super) const MASS: Quantity = Quantity { units: unit::MASS, range: [-1e7, 1e7] };
/// A deviation of a ramp's end.
pub(super) const RAMP_END: Quantity = Quantity { units: unit::SECONDS, range: [-1000.0, 1000.0] };
/// A rotation of gravity.
pub(super) const TILT: Quantity = Quantity { units: unit::ANGLE, range: [-180.0, 180.0] };

/// Where friction that varies changes nothing.
pub(super) const FRICTIONLESS: &str = "where the law of friction is \"none\"";
/// Where a tilt of gravity changes nothing.
pub(super) const UNTILTED: &str = "where gravity is zero, or along the axis of the tilt";

/// The greatest component (m/s²) of `gravity` across the frame's axis of this index, about which a tilt turns it.
pub(super) fn across(gravity: [f64; 3], axis: usize) -> f64 {
    (0..3).filter(|i| *i != axis).map(|i| gravity[i].abs()).fold(0.0, f64::max)
}

impl Parameter {
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
    const fn quantity(self) -> &'static Quantity {
        match self {
            Self::Friction | Self::Stiffness => &SHARE,
            Self::Damping | Self::Gain => &DAMPING,
            Self::Mass => &MASS,
            Self::RampEnd => &RAMP_END,
            Self::TiltX | Self::TiltZ => &TILT,
        }
    }

    /// Where a deviation of this parameter changes nothing, if it does so in `scene`.
    fn no_effect(self, scene: &Scene) -> Option<&'static str> {
        match self {
            Self::Friction => (scene.friction == FrictionData::None).then_some(FRICTIONLESS),
            Self::TiltX => (across(scene.slide.gravity, 0) == 0.0).then_some(UNTILTED),
            Self::TiltZ => (across(scene.slide.gravity, 2) == 0.0).then_some(UNTILTED),
            Self::Stiffness | Self::Damping | Self::Mass | Self::Gain | Self::RampEnd => None,
        }
    }
}

/// Reads the optional table `[vary]` of a `scene`.
pub(super) fn vary(root: &Field, scene: &Scene) -> Result<Vec<Varied>, SceneError> {
    let Some(table) = root.get("vary") else { return Ok(Vec::new()) };
    table.expect_table()?;
    for of_mechanism in ["body", "mechanism"] {
        if let Some(field) = table.get(of_mechanism) {
            let what = format!("`vary.{of_mechanism}` without a mechanism");
            return Err(
                field.error(Problem::Unsupported { what }, "vary.slide, whose mass and tilts are those of the slide")
            );
        }
    }
    // A value that stands for a wrong one may leave a parameter without effect.
    let sound = !root.found().any();
    let mut varied = Vec::new();
    for parameter in Parameter::ALL {
        let [group, key] = parameter.key();
        let Some(of_group) = table.get(group) else { continue };
        of_group.expect_table()?;
        let Some(field) = of_group.get(key) else { continue };
        if let Some(why) = parameter.no_effect(scene).filter(|_| sound) {
            field.found().note(field.no_effect(why, "to leave it out"));
        }
        let spread = deviation(&field, parameter.quantity(), SIGMA_DEFAULT)?;
        varied.push(Varied { parameter, deviation: spread.contributor(format!("{group}.{key}")) });
    }
    Ok(varied)
}
