//! Drives.

use std::f64::consts::TAU;

use slipfit_core::drive::TrainData;
use slipfit_tolerance::unit::{self, Quantity};

use super::{
    command::{Context, Controls, controls},
    names::{Names, tables},
    place::{direction, place},
};
use crate::{
    mechanism::{Action, Joint, JointKind, Mechanism, NamedDrive, UNLIMITED},
    scene::{
        Problem, SceneError,
        parse::choice,
        plausible,
        quantity::{GAIN, POINT, STICK_BAND},
        value::{Field, OneOrEach},
    },
};

pub(super) const TORQUE_GAIN: Quantity = Quantity { units: unit::TORQUE_GAIN, range: [0.0, 1e9] };
/// Limit, friction and offset of a drive: a force, or a torque.
pub(super) const FORCE: Quantity = Quantity { units: unit::FORCE, range: [0.0, 1e9] };
pub(super) const FORCE_OFFSET: Quantity = Quantity { units: unit::FORCE, range: [-1e9, 1e9] };
pub(super) const TORQUE: Quantity = Quantity { units: unit::TORQUE, range: [0.0, 1e9] };
pub(super) const TORQUE_OFFSET: Quantity = Quantity { units: unit::TORQUE, range: [-1e9, 1e9] };
/// Stick band of a drive that turns.
const ROTATION_BAND: Quantity = Quantity { units: unit::ROTATION, range: [1e-9, 1e3] };
const ROTOR: Quantity = Quantity { units: unit::INERTIA, range: [1e-6, 1e15] };
const GEAR: Quantity = Quantity { units: unit::ONE, range: [1e-3, 1e5] };
const TRAVEL: Quantity = Quantity { units: unit::LENGTH, range: [1e-3, 1e5] };

/// Reads the drives.
pub(super) fn drives(
    root: &Field,
    planar: bool,
    names: &Names,
    file_name: &str,
) -> Result<Vec<NamedDrive>, SceneError> {
    tables(root, "drive")?.into_iter().map(|(name, table)| drive(name, &table, planar, names, file_name)).collect()
}

/// What a drive acts on, read from its `table`.
struct Acts {
    body: usize,
    action: Action,
    gain: f64,
}

fn drive(name: String, table: &Field, planar: bool, names: &Names, file_name: &str) -> Result<NamedDrive, SceneError> {
    let is_prescribed = is_prescribed(table)?;
    let Acts { body, action, gain } = acts(table, planar, names, is_prescribed)?;
    let turns = matches!(action, Action::Turns { .. });
    // A torque has no point.
    let point = match action {
        Action::Pushes { .. } => table.get("point").map(|point| place(&point, planar, &POINT)).transpose()?,
        Action::Turns { .. } => None,
    };
    let point_b = point.unwrap_or_default().into();
    let train = train(table, turns)?;
    if train.is_none() {
        table.get("gain").iter().for_each(|field| plausible::gain(field, gain));
    }
    let context = Context { turns, is_prescribed, has_train: train.is_some(), file_name };
    let Controls { drive, command, sampling } = controls(table, gain, point_b, &context)?;
    let rotor = rotor(table, turns)?;
    let at_centre = at_centre(table, turns)?;
    Ok(NamedDrive { name, body, drive, action, command, sampling, is_prescribed, train, at_centre, rotor })
}

/// Whether the body moves as commanded, whatever that takes.
fn is_prescribed(table: &Field) -> Result<bool, SceneError> {
    let name = |is_prescribed| if is_prescribed { "prescribed" } else { "controlled" };
    let motion = table.get("motion").map(|field| choice(&field, [false, true], name)).transpose()?;
    let is_prescribed = motion.unwrap_or(false);
    if let Some(field) = ["gain", "limit"].iter().find_map(|key| table.get(key)).filter(|_| is_prescribed) {
        return Err(field.no_effect("of a prescribed motion", "no such key, or no motion = \"prescribed\""));
    }
    Ok(is_prescribed)
}

fn acts(table: &Field, planar: bool, names: &Names, is_prescribed: bool) -> Result<Acts, SceneError> {
    // That of a prescribed motion is known with the mechanism.
    let gain = |quantity| if is_prescribed { Ok(1.0) } else { table.number("gain", quantity) };
    match (table.get("pushes"), table.get("turns")) {
        (Some(field), None) => {
            let action = Action::Pushes { axis: direction(table, "axis", planar)? };
            Ok(Acts { body: names.body(&field)?, action, gain: gain(&GAIN)? })
        }
        (None, Some(field)) => {
            let axis = if planar { [0.0, 0.0, 1.0] } else { direction(table, "axis", false)? };
            let action = Action::Turns { axis };
            Ok(Acts { body: names.body(&field)?, action, gain: gain(&TORQUE_GAIN)? })
        }
        (None, None) => {
            Err(table
                .error(Problem::Missing("drive.pushes".into()), "pushes = BODY, a force, or turns = BODY, a torque"))
        }
        (Some(_), Some(field)) => {
            let problem = Problem::Duplicate { key: "drive.pushes".into(), name: "turns".into() };
            Err(field.error(problem, "one of pushes and turns"))
        }
    }
}

/// The limit of the motor and the friction of the drive train, if any is stated.
fn train(table: &Field, turns: bool) -> Result<Option<TrainData<f64>>, SceneError> {
    let [force, signed] = if turns { [&TORQUE, &TORQUE_OFFSET] } else { [&FORCE, &FORCE_OFFSET] };
    let number = |key: &str, quantity| table.get(key).map(|field: Field| field.to_number(quantity)).transpose();
    let limit = number("limit", force)?;
    let coulomb = match table.get("coulomb") {
        None => None,
        Some(field) => Some(match field.one_or_each(force)? {
            OneOrEach::One(both) => [both; 2],
            OneOrEach::Each(each) => each,
        }),
    };
    let viscous = number("viscous", if turns { &TORQUE_GAIN } else { &GAIN })?;
    let offset = number("offset", signed)?;
    if limit.is_none() && coulomb.is_none() && viscous.is_none() && offset.is_none() {
        return Ok(None);
    }
    let band = if turns { &ROTATION_BAND } else { &STICK_BAND };
    let stick_band = if coulomb.is_some() { table.number("stick_band", band)? } else { 1.0 };
    Ok(Some(TrainData {
        limit: limit.unwrap_or(UNLIMITED),
        coulomb: coulomb.unwrap_or_default(),
        stick_band,
        viscous: viscous.unwrap_or_default(),
        offset: offset.unwrap_or_default(),
    }))
}

/// Whether a drive controls the speed of the centre of mass.
fn at_centre(table: &Field, turns: bool) -> Result<bool, SceneError> {
    let Some(field) = table.get("controls") else { return Ok(false) };
    if turns {
        return Err(field.no_effect("of a drive that turns", "pushes, or no such key"));
    }
    match field.to_text()? {
        "point" => Ok(false),
        "centre" => Ok(true),
        _ => Err(field.error(Problem::Choice { key: field.key.clone(), written: field.written("") }, "point, centre")),
    }
}

/// The friction of an ideal joint that `turns` or slides, if any is stated.
pub(super) fn drag(table: &Field, turns: bool) -> Result<Option<TrainData<f64>>, SceneError> {
    train(table, turns)
}

/// The inertia of the rotor as the body feels it (kg, kg·m²); 0 if none is stated.
fn rotor(table: &Field, turns: bool) -> Result<f64, SceneError> {
    let Some(field) = table.get("rotor") else {
        if let Some(field) = ["gear", "travel"].iter().find_map(|key| table.get(key)) {
            return Err(field.no_effect("without `rotor`", "the rotor's moment of inertia beside it"));
        }
        return Ok(0.0);
    };
    let inertia = field.to_number(&ROTOR)?;
    let ratio = if turns { table.number("gear", &GEAR)? } else { TAU / table.number("travel", &TRAVEL)? };
    Ok(inertia * ratio * ratio)
}

/// Most samples of a controller in a run, each of which ends a step.
const MOST_SAMPLES: f64 = 2e6;

/// Whether controllers sample no more often than steps can end, and what drives push has a rotor only where an ideal joint leaves it no other motion: mass that moves along one direction alone is
/// known there.
pub(super) fn check(mechanism: &Mechanism, root: &Field) -> Result<(), SceneError> {
    let fields = tables(root, "drive")?;
    for (named, (_, table)) in mechanism.drives.iter().zip(fields) {
        let least = mechanism.run.duration / MOST_SAMPLES;
        if named.sampling.as_ref().is_some_and(|sampling| sampling.period < least) {
            let field = table.get("sampling").unwrap_or(table);
            return Err(
                field.out_of_range("s", format!("{least:e} s or more in a run of {} s", mechanism.run.duration))
            );
        }
        let of_body = |joint: &&Joint| joint.between.contains(&Some(named.body)) && joint.between.contains(&None);
        let is_held = |joint: &Joint| match (named.action, &joint.kind) {
            (Action::Turns { .. }, _) => true,
            (Action::Pushes { axis }, JointKind::Prismatic { axis: along }) => {
                let cosine: f64 = axis.iter().zip(along).map(|(a, b)| a * b).sum();
                cosine.abs() > 1.0 - 1e-9
            }
            _ => false,
        };
        let turns = matches!(named.action, Action::Turns { .. });
        let is_axial = named.action.axis().iter().filter(|of| **of != 0.0).count() == 1;
        if named.rotor == 0.0 || (turns && is_axial) || mechanism.joints.iter().filter(of_body).any(is_held) {
            continue;
        }
        let field = table.get("rotor").unwrap_or(table);
        let what = match turns {
            true => "a rotor about an axis that is none of x, y and z".into(),
            false => format!("a rotor that moves \"{}\"", mechanism.bodies[named.body].name),
        };
        let allowed = "a body on an ideal prismatic joint of the frame along the drive's axis; else a body for the nut, with the \
                       rotor's inertia as mass, and a spring between the two";
        return Err(field.error(Problem::Unsupported { what }, allowed));
    }
    Ok(())
}
