//! Parameters of a slide, beside its gaps, that a table names.

use slipfit_core::menu::FrictionData;

use super::{
    Problem, SceneError,
    contact::{DAMPING, DEPTH},
    parameter::{BANDLESS, FRICTIONLESS, Kind, Named, UNTILTED, across},
    quantity::{COEFFICIENT, GAIN, MASS, STICK_BAND, TILT},
    value::Field,
};
use crate::setup::{Scene, SlideParameter};

/// Every parameter with its table and key.
const KEYS: [(SlideParameter, [&str; 2]); 10] = [
    (SlideParameter::Friction, ["friction", "coefficient"]),
    (SlideParameter::StickBand, ["friction", "stick_band"]),
    (SlideParameter::Stiffness, ["contact", "stiffness"]),
    (SlideParameter::Damping, ["contact", "damping"]),
    (SlideParameter::Depth, ["contact", "depth"]),
    (SlideParameter::Mass, ["slide", "mass"]),
    (SlideParameter::Gain, ["drive", "gain"]),
    (SlideParameter::RampEnd, ["drive", "ramp_end"]),
    (SlideParameter::TiltX, ["slide", "tilt_x"]),
    (SlideParameter::TiltZ, ["slide", "tilt_z"]),
];

fn kind(parameter: SlideParameter, scene: &Scene) -> Kind {
    match parameter {
        SlideParameter::Friction => Kind::Number(&COEFFICIENT),
        SlideParameter::StickBand => Kind::Number(&STICK_BAND),
        SlideParameter::Stiffness => Kind::Stiffness(Some(scene.contact.exponent)),
        SlideParameter::Damping => Kind::Number(&DAMPING),
        SlideParameter::Depth => Kind::Number(&DEPTH),
        SlideParameter::Mass => Kind::Number(&MASS),
        SlideParameter::Gain => Kind::Number(&GAIN),
        SlideParameter::RampEnd => Kind::RampEnd(scene.drive.ramp_start),
        SlideParameter::TiltX | SlideParameter::TiltZ => Kind::Number(&TILT),
    }
}

/// Where another value of this parameter changes nothing, if it does so in `scene`.
fn no_effect(parameter: SlideParameter, scene: &Scene) -> Option<&'static str> {
    let untilted = |axis| (across(scene.slide.gravity, axis) == 0.0).then_some(UNTILTED);
    match parameter {
        SlideParameter::Friction => (scene.friction == FrictionData::None).then_some(FRICTIONLESS),
        SlideParameter::StickBand => {
            let is_regularised = matches!(scene.friction, FrictionData::Regularised { .. });
            (!is_regularised).then_some(BANDLESS)
        }
        SlideParameter::TiltX => untilted(0),
        SlideParameter::TiltZ => untilted(2),
        _ => None,
    }
}

/// The parameters of `scene` in the optional table of this `name`.
pub(super) fn named<'t, 's>(
    root: &Field<'t, 's>,
    name: &str,
    scene: &Scene,
) -> Result<Vec<Named<'t, 's, SlideParameter>>, SceneError> {
    let Some(table) = root.get(name) else { return Ok(Vec::new()) };
    table.expect_table()?;
    for of_mechanism in ["body", "mechanism"] {
        if let Some(field) = table.get(of_mechanism) {
            let what = format!("`{name}.{of_mechanism}` without a mechanism");
            let allowed = format!("{name}.slide, whose mass and tilts are those of the slide");
            return Err(field.error(Problem::Unsupported { what }, allowed));
        }
    }
    let mut found = Vec::new();
    for (parameter, key) in KEYS {
        let Some(group) = table.get(key[0]) else { continue };
        group.expect_table()?;
        found.extend(Named::find(&group, key, parameter, kind(parameter, scene), no_effect(parameter, scene)));
    }
    Ok(found)
}
