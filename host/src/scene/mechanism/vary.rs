//! What varies of a mechanism from unit to unit, beside its gaps.

use super::{Field, Names, Problem, SceneError, tables};
use crate::{
    mechanism::{Action, NamedDrive, Parameter, Varied},
    scene::{
        product::{SIGMA_DEFAULT, deviation},
        unit::{self, Quantity},
        vary::{DAMPING, MASS, RAMP_END, SHARE, TILT},
    },
};

/// Gain of a drive that turns.
const TORQUE_GAIN: Quantity = Quantity { units: unit::TORQUE_GAIN, range: [-1e6, 1e6] };

/// Reads the optional table `[vary]` of a mechanism with these bodies and `drives`.
pub(super) fn vary(
    root: &Field,
    planar: bool,
    names: &Names,
    drives: &[NamedDrive],
) -> Result<Vec<Varied>, SceneError> {
    let Some(table) = root.get("vary") else { return Ok(Vec::new()) };
    table.expect_table()?;
    if let Some(field) = table.get("slide") {
        let what = "`vary.slide` in a mechanism".into();
        return Err(field.error(Problem::Unsupported { what }, "[[vary.body]] with a name, vary.mechanism.tilt_z"));
    }
    let mut varied = Vec::new();
    let mut read = |of: &Field, key: &str, named: &str, parameter: Parameter, quantity: &Quantity| {
        let Some(field) = of.get(key) else { return Ok(()) };
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
        if let Some(field) = of.get(key).filter(|_| planar && parameter == Parameter::TiltX) {
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
