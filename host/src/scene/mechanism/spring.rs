//! Reading springs.

use slipfit_tolerance::unit::{self, Quantity};

use super::{
    drive::TORQUE_GAIN,
    names::{Names, tables},
    place::place,
};
use crate::{
    mechanism::{Spring, SpringKind},
    scene::{
        Problem, SceneError,
        quantity::{GAIN, POINT},
        tree::Value,
        value::Field,
    },
};

const TORSION: Quantity = Quantity { units: unit::TORSION, range: [0.0, 1e12] };
const STIFFNESS: Quantity = Quantity { units: unit::STIFFNESS, range: [0.0, 1e9] };
const TORQUE: Quantity = Quantity { units: unit::MOMENT, range: [-1e9, 1e9] };
const FORCE: Quantity = Quantity { units: unit::FORCE, range: [-1e9, 1e9] };
const FREE_LENGTH: Quantity = Quantity { units: unit::LENGTH, range: [0.0, 1e5] };

/// How near (m) the ends of a spring may be: nearer, it has no direction.
const NEAREST: f64 = 1e-6;

/// Reads the springs.
pub(super) fn springs(root: &Field, planar: bool, names: &Names) -> Result<Vec<Spring>, SceneError> {
    tables(root, "spring")?.into_iter().map(|(name, table)| spring(name, &table, planar, names)).collect()
}

fn spring(name: String, table: &Field, planar: bool, names: &Names) -> Result<Spring, SceneError> {
    let between = names.between(table)?;
    let optional = |key: &str, quantity| table.get(key).map(|field| field.to_number(quantity)).transpose();
    let Some(ends) = table.get("ends") else {
        if !planar {
            let what = "a torsion spring in space".into();
            return Err(table
                .error(Problem::Unsupported { what }, "`ends` of a spring along a line, or a mechanism in a plane"));
        }
        let stiffness = table.number("stiffness", &TORSION)?;
        let rest = preload(table, &TORQUE, stiffness)?.map_or(0.0, |preload| preload / stiffness);
        let damping = optional("damping", &TORQUE_GAIN)?.unwrap_or_default();
        return Ok(Spring { name, between, stiffness, damping, kind: SpringKind::Torsion { rest } });
    };
    let stiffness = table.number("stiffness", &STIFFNESS)?;
    let allowed = "a list of 2 places in the drawn pose, one on each body";
    let nodes = match &ends.node.value {
        Value::List(nodes) if nodes.len() == 2 => nodes,
        Value::List(nodes) => {
            return Err(ends.error(Problem::Length { key: ends.key.clone(), found: nodes.len() }, allowed));
        }
        _ => return Err(ends.wrong_type(allowed)),
    };
    let mut places = [[0.0; 3]; 2];
    for (place_of, node) in places.iter_mut().zip(nodes) {
        *place_of = place(&Field { key: ends.key.clone(), node }, planar, &POINT)?;
    }
    let [first, second] = places;
    let length = libm::sqrt(first.iter().zip(second).map(|(a, b)| (a - b) * (a - b)).sum());
    if length < NEAREST {
        return Err(ends.out_of_range("mm", "two places that are 1 µm apart or more"));
    }
    let preload = preload(table, &FORCE, stiffness)?;
    let stated = table.get("free_length");
    let free_length = match (preload, &stated) {
        (None, None) => length,
        (Some(preload), None) => length - preload / stiffness,
        (None, Some(field)) => field.to_number(&FREE_LENGTH)?,
        (Some(_), Some(field)) => return Err(field.no_effect("beside `preload`", "one of free_length and preload")),
    };
    let damping = optional("damping", &GAIN)?.unwrap_or_default();
    Ok(Spring { name, between, stiffness, damping, kind: SpringKind::Line { ends: places, free_length } })
}

/// The preload (N, N·m), if one is stated; it needs a stiffness.
fn preload(table: &Field, quantity: &Quantity, stiffness: f64) -> Result<Option<f64>, SceneError> {
    let Some(field) = table.get("preload") else { return Ok(None) };
    let preload = field.to_number(quantity)?;
    if stiffness == 0.0 {
        return Err(field.no_effect("of a spring without stiffness", "a stiffness greater than 0"));
    }
    Ok(Some(preload))
}
