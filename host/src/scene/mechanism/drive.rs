//! Drives and torsion springs.

use slipfit_core::drive::Drive;
use slipfit_tolerance::unit::{self, Quantity};

use super::{
    names::{Names, tables},
    place::{direction, place},
};
use crate::{
    mechanism::{Action, NamedDrive, Spring},
    scene::{
        Problem, SceneError, plausible,
        quantity::{GAIN, LEAST_RAMP, POINT, RAMP, SPEED},
        value::Field,
    },
};

pub(super) const TORQUE_GAIN: Quantity = Quantity { units: unit::TORQUE_GAIN, range: [0.0, 1e9] };
const ROTATION: Quantity = Quantity { units: unit::ROTATION, range: [-1e6, 1e6] };
const TORSION: Quantity = Quantity { units: unit::TORSION, range: [0.0, 1e12] };

/// Reads the drives.
pub(super) fn drives(root: &Field, planar: bool, names: &Names) -> Result<Vec<NamedDrive>, SceneError> {
    tables(root, "drive")?.into_iter().map(|(name, table)| drive(name, &table, planar, names)).collect()
}

fn drive(name: String, table: &Field, planar: bool, names: &Names) -> Result<NamedDrive, SceneError> {
    let ramp_start = table.number("ramp_start", &RAMP)?;
    let end = table.require("ramp_end", &RAMP.units())?;
    let ramp_end = end.to_number(&RAMP)?;
    if ramp_end - ramp_start < LEAST_RAMP {
        return Err(end.out_of_range("s", format!("more than ramp_start, {ramp_start} s, by 1 µs or more")));
    }
    let (body, action, gain, speed) = match (table.get("pushes"), table.get("turns")) {
        (Some(field), None) => {
            let action = Action::Pushes { axis: direction(table, "axis", planar)? };
            (names.body(&field)?, action, table.number("gain", &GAIN)?, table.number("speed", &SPEED)?)
        }
        (None, Some(field)) => {
            let axis = if planar { [0.0, 0.0, 1.0] } else { direction(table, "axis", false)? };
            let action = Action::Turns { axis };
            (names.body(&field)?, action, table.number("gain", &TORQUE_GAIN)?, table.number("speed", &ROTATION)?)
        }
        (None, None) => {
            return Err(table
                .error(Problem::Missing("drive.pushes".into()), "pushes = BODY, a force, or turns = BODY, a torque"));
        }
        (Some(_), Some(field)) => {
            let problem = Problem::Duplicate { key: "drive.pushes".into(), name: "turns".into() };
            return Err(field.error(problem, "one of pushes and turns"));
        }
    };
    // A torque has no point.
    let point = match action {
        Action::Pushes { .. } => table.get("point").map(|point| place(&point, planar, &POINT)).transpose()?,
        Action::Turns { .. } => None,
    };
    let point = point.unwrap_or_default();
    table.get("gain").iter().for_each(|field| plausible::gain(field, gain));
    Ok(NamedDrive { name, body, drive: Drive { gain, ramp_start, ramp_end, speed, point_b: point.into() }, action })
}

/// Reads the springs, which turn about the plane's normal.
pub(super) fn springs(root: &Field, planar: bool, names: &Names) -> Result<Vec<Spring>, SceneError> {
    let spring = |(name, table): (String, Field)| {
        if !planar {
            let what = "a torsion spring in space".into();
            return Err(table.error(Problem::Unsupported { what }, "none, or a mechanism in a plane"));
        }
        Ok(Spring {
            name,
            between: names.between(&table)?,
            stiffness: table.number("stiffness", &TORSION)?,
            damping: table.get("damping").map(|field| field.to_number(&TORQUE_GAIN)).transpose()?.unwrap_or_default(),
        })
    };
    tables(root, "spring")?.into_iter().map(spring).collect()
}
