//! Parameters of a mechanism, beside its gaps, that a table names.

use super::{
    body::MASS,
    contour::SLOPE,
    drive::{FORCE, FORCE_OFFSET, TORQUE, TORQUE_GAIN, TORQUE_OFFSET},
    names::{Names, tables},
};
use crate::{
    mechanism::{Action, Mechanism, NormalData, Parameter, UNLIMITED, Walls},
    scene::{
        Problem, SceneError,
        contact::{DAMPING, DEPTH},
        parameter::{BANDLESS, FRICTIONLESS, Kind, Named, UNTILTED, across},
        quantity::{COEFFICIENT, GAIN, STICK_BAND, TILT},
        value::Field,
    },
};

/// Where another value of this parameter changes nothing, if it does so in the `mechanism`.
fn no_effect(parameter: Parameter, mechanism: &Mechanism) -> Option<&'static str> {
    let mut laws = mechanism.joints.iter().filter(|joint| !joint.kind.is_ideal()).map(|joint| joint.laws);
    let untilted = |axis| (across(mechanism.gravity, axis) == 0.0).then_some(UNTILTED);
    match parameter {
        Parameter::Friction => laws.all(|laws| laws.friction.holds() == 0.0).then_some(FRICTIONLESS),
        Parameter::StickBand => {
            let is_regularised = laws.any(|laws| laws.friction.stick_band().is_some());
            (!is_regularised).then_some(BANDLESS)
        }
        Parameter::Stiffness => laws.next().is_none().then_some("where no joint has play, so that there is no contact"),
        Parameter::Damping | Parameter::Depth => {
            let undamped = laws.all(|laws| !matches!(laws.contact, NormalData::Impact(_)));
            undamped.then_some("where no contact has the law \"impact\"; the others state their losses as restitution")
        }
        Parameter::TiltX => untilted(0),
        Parameter::TiltZ => untilted(2),
        Parameter::RampEnd(drive) => {
            mechanism.drives[drive].command.as_ref().map(|_| "where segments stand in place of a ramp")
        }
        Parameter::Limit(drive) => {
            let limited = mechanism.drives[drive].train.is_some_and(|train| train.limit < UNLIMITED);
            (!limited).then_some("of a drive without a limit")
        }
        Parameter::Coulomb(drive) => {
            let rubs = mechanism.drives[drive].train.is_some_and(|train| train.coulomb != [0.0; 2]);
            (!rubs).then_some("of a drive that states no `coulomb`, which a deviation adds to")
        }
        Parameter::Viscous(drive) | Parameter::Offset(drive) => {
            let has_train = mechanism.drives[drive].train.is_some();
            (!has_train).then_some("of a drive that states no limit and no friction; state 0 there")
        }
        Parameter::Slope(joint) => {
            let Walls::Stated(contours) = &mechanism.joints[joint].walls else {
                return Some("of a joint without `slope`");
            };
            let slopes = contours.iter().any(|contour| contour.slope != 0.0);
            (!slopes).then_some("of a joint without `slope`")
        }
        Parameter::Gain(drive) => mechanism.drives[drive].is_prescribed.then_some("of a prescribed motion"),
        Parameter::Mass(_) => None,
    }
}

/// The exponent of all contacts, if they have the same.
fn exponent(mechanism: &Mechanism) -> Option<f64> {
    let joints = mechanism.joints.iter().filter(|joint| !joint.kind.is_ideal());
    let mut exponents = joints.map(|joint| joint.laws.contact.spring()[1]);
    let first = exponents.next()?;
    exponents.all(|other| other == first).then_some(first)
}

/// The parameters of a `mechanism`, with bodies of these `names`, in the optional table of this `name`.
pub(super) fn named<'t, 's>(
    root: &Field<'t, 's>,
    name: &str,
    names: &Names,
    mechanism: &Mechanism,
) -> Result<Vec<Named<'t, 's, Parameter>>, SceneError> {
    let drives = &mechanism.drives;
    let Some(table) = root.get(name) else { return Ok(Vec::new()) };
    table.expect_table()?;
    if let Some(field) = table.get("slide") {
        let what = format!("`{name}.slide` in a mechanism");
        let allowed = format!("[[{name}.body]] with a name, {name}.mechanism.tilt_z");
        return Err(field.error(Problem::Unsupported { what }, allowed));
    }
    let find = |of: &Field<'t, 's>, key: [&str; 2], parameter, kind| {
        Named::find(of, key, parameter, kind, no_effect(parameter, mechanism))
    };
    let mut found = Vec::new();
    for (key, parameter, kind) in [
        (["friction", "coefficient"], Parameter::Friction, Kind::Number(&COEFFICIENT)),
        (["friction", "stick_band"], Parameter::StickBand, Kind::Number(&STICK_BAND)),
        (["contact", "stiffness"], Parameter::Stiffness, Kind::Stiffness(exponent(mechanism))),
        (["contact", "damping"], Parameter::Damping, Kind::Number(&DAMPING)),
        (["contact", "depth"], Parameter::Depth, Kind::Number(&DEPTH)),
        (["mechanism", "tilt_x"], Parameter::TiltX, Kind::Number(&TILT)),
        (["mechanism", "tilt_z"], Parameter::TiltZ, Kind::Number(&TILT)),
    ] {
        let Some(of) = table.get(key[0]) else { continue };
        of.expect_table()?;
        if let Some(field) = of.get(key[1]).filter(|_| mechanism.planar && parameter == Parameter::TiltX) {
            let what = "gravity that leaves the plane".into();
            return Err(field.error(Problem::Unsupported { what }, "tilt_z, which turns it within the plane"));
        }
        found.extend(find(&of, key, parameter, kind));
    }
    for (name, of) in tables(&table, "body")? {
        let body = names.body(&of.get("name").unwrap_or_else(|| of.clone()))?;
        found.extend(find(&of, [&name, "mass"], Parameter::Mass(body), Kind::Number(&MASS)));
    }
    for (name, of) in tables(&table, "joint")? {
        let Some(i) = mechanism.joints.iter().position(|joint| joint.name == name) else {
            let known: Vec<&str> = mechanism.joints.iter().map(|joint| joint.name.as_str()).collect();
            let problem = Problem::UnknownName { of: "joint".into(), name };
            return Err(of.get("name").unwrap_or(of).error(problem, known.join(", ")));
        };
        found.extend(find(&of, [&name, "slope"], Parameter::Slope(i), Kind::Number(&SLOPE)));
    }
    for (name, of) in tables(&table, "drive")? {
        let Some(i) = drives.iter().position(|drive| drive.name == name) else {
            let known: Vec<&str> = drives.iter().map(|drive| drive.name.as_str()).collect();
            let problem = Problem::UnknownName { of: "drive".into(), name };
            return Err(of.get("name").unwrap_or(of).error(problem, known.join(", ")));
        };
        let turns = matches!(drives[i].action, Action::Turns { .. });
        let gain = if turns { &TORQUE_GAIN } else { &GAIN };
        found.extend(find(&of, [&name, "gain"], Parameter::Gain(i), Kind::Number(gain)));
        let start = drives[i].drive.ramp_start;
        found.extend(find(&of, [&name, "ramp_end"], Parameter::RampEnd(i), Kind::RampEnd(start)));
        let [effort, offset] = if turns { [&TORQUE, &TORQUE_OFFSET] } else { [&FORCE, &FORCE_OFFSET] };
        for (key, parameter, quantity) in [
            ("limit", Parameter::Limit(i), effort),
            ("coulomb", Parameter::Coulomb(i), effort),
            ("viscous", Parameter::Viscous(i), gain),
            ("offset", Parameter::Offset(i), offset),
        ] {
            found.extend(find(&of, [&name, key], parameter, Kind::Number(quantity)));
        }
    }
    Ok(found)
}
