//! What varies of a mechanism from unit to unit, beside its gaps.

use slipfit_core::menu::FrictionData;
use slipfit_tolerance::unit::{self, Quantity};

use super::names::{Names, tables};
use crate::{
    mechanism::{Action, Mechanism, NormalData, Parameter, Varied},
    scene::{
        Problem, SceneError,
        product::{SIGMA_DEFAULT, deviation},
        value::Field,
        vary::{DAMPING, FRICTIONLESS, MASS, RAMP_END, SHARE, TILT, UNTILTED, across},
    },
};

/// Gain of a drive that turns.
const TORQUE_GAIN: Quantity = Quantity { units: unit::TORQUE_GAIN, range: [-1e6, 1e6] };

/// Where a deviation of this parameter changes nothing, if it does so in the `mechanism`.
fn no_effect(parameter: Parameter, mechanism: &Mechanism) -> Option<&'static str> {
    let mut laws = mechanism.joints.iter().filter(|joint| !joint.kind.is_ideal()).map(|joint| joint.laws);
    let untilted = |axis| (across(mechanism.gravity, axis) == 0.0).then_some(UNTILTED);
    match parameter {
        Parameter::Friction => laws.all(|laws| laws.friction == FrictionData::None).then_some(FRICTIONLESS),
        Parameter::Stiffness => laws.next().is_none().then_some("where no joint has play, so that there is no contact"),
        Parameter::Damping => {
            let undamped = laws.all(|laws| !matches!(laws.contact, NormalData::Impact(_)));
            undamped.then_some("where no contact has the law \"impact\"; the others state their losses as restitution")
        }
        Parameter::TiltX => untilted(0),
        Parameter::TiltZ => untilted(2),
        Parameter::Mass(_) | Parameter::Gain(_) | Parameter::RampEnd(_) => None,
    }
}

/// Reads the optional table `[vary]` of a `mechanism` with bodies of these `names`.
pub(super) fn vary(root: &Field, names: &Names, mechanism: &Mechanism) -> Result<Vec<Varied>, SceneError> {
    let drives = &mechanism.drives;
    let Some(table) = root.get("vary") else { return Ok(Vec::new()) };
    table.expect_table()?;
    if let Some(field) = table.get("slide") {
        let what = "`vary.slide` in a mechanism".into();
        return Err(field.error(Problem::Unsupported { what }, "[[vary.body]] with a name, vary.mechanism.tilt_z"));
    }
    // A value that stands for a wrong one may leave a parameter without effect.
    let sound = !root.found().any();
    let mut varied = Vec::new();
    let mut read = |of: &Field, key: &str, named: &str, parameter: Parameter, quantity: &Quantity| {
        let Some(field) = of.get(key) else { return Ok(()) };
        if let Some(why) = no_effect(parameter, mechanism).filter(|_| sound) {
            field.found().note(field.no_effect(why, "to leave it out"));
        }
        let spread = deviation(&field, quantity, SIGMA_DEFAULT)?;
        varied.push(Varied { parameter, deviation: spread.contributor(format!("{named}.{key}")) });
        Ok(())
    };
    for (group, key, parameter, quantity) in [
        ("friction", "coefficient", Parameter::Friction, &SHARE),
        ("contact", "stiffness", Parameter::Stiffness, &SHARE),
        ("contact", "damping", Parameter::Damping, &DAMPING),
        ("mechanism", "tilt_x", Parameter::TiltX, &TILT),
        ("mechanism", "tilt_z", Parameter::TiltZ, &TILT),
    ] {
        let Some(of) = table.get(group) else { continue };
        of.expect_table()?;
        if let Some(field) = of.get(key).filter(|_| mechanism.planar && parameter == Parameter::TiltX) {
            let what = "gravity that leaves the plane".into();
            return Err(field.error(Problem::Unsupported { what }, "tilt_z, which turns it within the plane"));
        }
        read(&of, key, group, parameter, quantity)?;
    }
    for (name, of) in tables(&table, "body")? {
        let body = names.body(&of.get("name").unwrap_or_else(|| of.clone()))?;
        read(&of, "mass", &name, Parameter::Mass(body), &MASS)?;
    }
    for (name, of) in tables(&table, "drive")? {
        let Some(i) = drives.iter().position(|drive| drive.name == name) else {
            let known: Vec<&str> = drives.iter().map(|drive| drive.name.as_str()).collect();
            let problem = Problem::UnknownName { of: "drive".into(), name };
            return Err(of.get("name").unwrap_or(of).error(problem, known.join(", ")));
        };
        let gain = if matches!(drives[i].action, Action::Turns { .. }) { &TORQUE_GAIN } else { &DAMPING };
        read(&of, "gain", &name, Parameter::Gain(i), gain)?;
        read(&of, "ramp_end", &name, Parameter::RampEnd(i), &RAMP_END)?;
    }
    Ok(varied)
}
