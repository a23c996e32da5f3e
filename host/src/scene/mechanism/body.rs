//! Bodies.

use slipfit_core::system::planar::Coordinate;

use super::{Field, Problem, Quantity, SceneError, note, place, tables, unit};
use crate::{
    mechanism::{Body, Mechanism, Mounts, Start},
    scene::parse::POINT,
};

const MASS: Quantity = Quantity { units: unit::MASS, range: [1e-6, 1e7] };
const INERTIA: Quantity = Quantity { units: unit::INERTIA, range: [1e-6, 1e15] };
const ANGLE: Quantity = Quantity { units: unit::ANGLE, range: [-1e4, 1e4] };
const SPIN: Quantity = Quantity { units: unit::ROTATION, range: [-1e6, 1e6] };
const SPEED: Quantity = Quantity { units: unit::SPEED, range: [-1e6, 1e6] };

/// Reads the bodies, with the tables that they stand in.
pub(super) fn bodies<'t, 's>(
    root: &Field<'t, 's>,
    planar: bool,
) -> Result<(Vec<Body>, Vec<Field<'t, 's>>), SceneError> {
    root.require("body", "tables [[body]]")?;
    let mut bodies = Vec::new();
    let mut fields = Vec::new();
    for (name, table) in tables(root, "body")? {
        bodies.push(body(name, &table, planar)?);
        fields.push(table);
    }
    Ok((bodies, fields))
}

fn body(name: String, table: &Field, planar: bool) -> Result<Body, SceneError> {
    let mass = table.number("mass", &MASS)?;
    let inertia =
        if planar { [0.0, 0.0, table.number("inertia", &INERTIA)?] } else { table.numbers("inertia", &INERTIA)? };
    let centre = table.require("centre", if planar { "a place [x, y] in mm" } else { "a place [x, y, z] in mm" })?;
    let centre = place(&centre, planar, &POINT)?;
    let start = |key: &str, quantity| -> Result<f64, SceneError> {
        let Some(field) = table.get(key) else { return Ok(0.0) };
        if !planar {
            return Err(field.error(Problem::Unsupported { what: format!("`{key}` of a body in space") }, "rest"));
        }
        field.to_number(quantity)
    };
    let start = Start { angle: start("angle", &ANGLE)?, spin: start("spin", &SPIN)?, speed: start("speed", &SPEED)? };
    Ok(Body { name, mass, inertia, centre, start })
}

/// Whether something holds or moves each body.
pub(super) fn check(mechanism: &Mechanism, fields: &[Field]) -> Result<(), SceneError> {
    for (i, body) in mechanism.bodies.iter().enumerate() {
        let joined = mechanism.joints.iter().any(|joint| joint.between.contains(&Some(i)));
        let sprung = mechanism.springs.iter().any(|spring| spring.between.contains(&Some(i)));
        if !joined && !sprung {
            let name = fields[i].get("name").unwrap_or_else(|| fields[i].clone());
            let error = name.error(Problem::Floating { body: body.name.clone() }, "a [[joint]] that joins it");
            note(fields[i].found(), Err(error));
        }
    }
    // A loop of joints is told elsewhere.
    if let Some(mounts) = mechanism.planar.then(|| Mounts::of(mechanism).ok()).flatten() {
        fields.iter().enumerate().for_each(|(i, table)| check_start(&mounts, i, table));
    }
    Ok(())
}

/// Whether body `i`, read from `table`, can start as it says: turned where it turns by itself, with a speed where its own joint lets it
/// slide along one axis.
fn check_start(mounts: &Mounts, i: usize, table: &Field) {
    let own = || mounts.coordinates().iter().filter(|owned| owned.body == i).map(|owned| &owned.coordinate);
    let turns = own().any(|coordinate| matches!(coordinate, Coordinate::Turn));
    let slides = own().filter(|coordinate| matches!(coordinate, Coordinate::Slide { .. })).count() == 1;
    for (key, can) in [("angle", turns), ("spin", turns), ("speed", slides)] {
        if let Some(field) = table.get(key).filter(|_| !can) {
            let what = format!("`{key}` at the start of a body that no joint lets move so");
            note(table.found(), Err(field.error(Problem::Unsupported { what }, "to leave it out")));
        }
    }
}
