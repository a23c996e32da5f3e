//! Drives.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use slipfit_core::drive::{Drive, Piece, TrainData};
use slipfit_desk::drive::Pieces;
use slipfit_tolerance::unit::{self, Quantity};

use super::{
    names::{Names, tables},
    place::{direction, place},
    segment::{Commanded, pieces},
};
use crate::{
    mechanism::{Action, Joint, JointKind, Mechanism, NamedDrive, UNLIMITED},
    scene::{
        Problem, SceneError, plausible,
        quantity::{GAIN, LEAST_RAMP, POINT, RAMP, STICK_BAND},
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
pub(super) fn drives(root: &Field, planar: bool, names: &Names) -> Result<Vec<NamedDrive>, SceneError> {
    tables(root, "drive")?.into_iter().map(|(name, table)| drive(name, &table, planar, names)).collect()
}

/// What a drive acts on, read from its `table`.
struct Acts {
    body: usize,
    action: Action,
    gain: f64,
}

fn drive(name: String, table: &Field, planar: bool, names: &Names) -> Result<NamedDrive, SceneError> {
    let Acts { body, action, gain } = acts(table, planar, names)?;
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
    let units = Commanded::new(turns);
    let (drive, command) = match table.get("segment") {
        Some(segments) => {
            let start = table.get("ramp_start").map(|field| field.to_number(&RAMP)).transpose()?.unwrap_or_default();
            for key in ["ramp_end", "speed"] {
                if let Some(field) = table.get(key) {
                    return Err(field.no_effect("beside segments", "the segments alone, each with its own speed"));
                }
            }
            let pieces = pieces(&segments, table.get("cycles"), start, &units)?;
            let drive = spanning(&pieces, gain, point_b);
            if drive.speed == 0.0 {
                return Err(segments.out_of_range("", "at least one segment with a speed other than 0"));
            }
            (drive, Some(Pieces(pieces.into())))
        }
        None => {
            if let Some(field) = table.get("cycles") {
                return Err(field.no_effect("without segments", "tables [[drive.segment]]"));
            }
            // Without a gain nothing is commanded.
            let states = |key: &&str| table.get(key).is_some();
            let is_idle = gain == 0.0 && train.is_some() && !["ramp_start", "ramp_end", "speed"].iter().any(states);
            let (ramp_start, ramp_end) = if is_idle { (0.0, 1.0) } else { ramp(table)? };
            let speed = if is_idle { 0.0 } else { table.number("speed", &units.speed)? };
            (Drive { gain, ramp_start, ramp_end, speed, point_b }, None)
        }
    };
    let rotor = rotor(table, turns)?;
    Ok(NamedDrive { name, body, drive, action, command, train, at_centre: at_centre(table, turns)?, rotor })
}

fn acts(table: &Field, planar: bool, names: &Names) -> Result<Acts, SceneError> {
    match (table.get("pushes"), table.get("turns")) {
        (Some(field), None) => {
            let action = Action::Pushes { axis: direction(table, "axis", planar)? };
            Ok(Acts { body: names.body(&field)?, action, gain: table.number("gain", &GAIN)? })
        }
        (None, Some(field)) => {
            let axis = if planar { [0.0, 0.0, 1.0] } else { direction(table, "axis", false)? };
            let action = Action::Turns { axis };
            Ok(Acts { body: names.body(&field)?, action, gain: table.number("gain", &TORQUE_GAIN)? })
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

/// When the ramp starts and ends (s).
fn ramp(table: &Field) -> Result<(f64, f64), SceneError> {
    let start = table.number("ramp_start", &RAMP)?;
    let field = table.require("ramp_end", &RAMP.units())?;
    let end = field.to_number(&RAMP)?;
    if end - start < LEAST_RAMP {
        return Err(field.out_of_range("s", format!("more than ramp_start, {start} s, by 1 µs or more")));
    }
    Ok((start, end))
}

/// A ramp from the start to the end of `pieces` to the greatest speed that they command.
fn spanning(pieces: &[Piece<f64>], gain: f64, point_b: Vector3<f64>) -> Drive<f64> {
    let moves = pieces.iter().find(|piece| piece.coefficients.iter().any(|of| *of != 0.0));
    let ramp_start = moves.map_or(0.0, |piece| piece.start);
    // Sums of durations are rounded: a run that is as long as all segments comes to their end.
    let end = pieces.last().map_or(ramp_start, |piece| piece.start * (1.0 - 1e-12));
    let ramp_end = end.max(ramp_start + LEAST_RAMP);
    let ends = pieces.windows(2).map(|two| two[0].speed(two[1].start)).chain(pieces.iter().map(|p| p.coefficients[0]));
    let speed = ends.fold(0.0, |most: f64, speed| if speed.abs() > most.abs() { speed } else { most });
    Drive { gain, ramp_start, ramp_end, speed, point_b }
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

/// Whether what drives push has a rotor only where an ideal joint leaves it no other motion: mass that moves along one direction alone is
/// known there.
pub(super) fn check(mechanism: &Mechanism, root: &Field) -> Result<(), SceneError> {
    let fields = tables(root, "drive")?;
    for (named, (_, table)) in mechanism.drives.iter().zip(fields) {
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
