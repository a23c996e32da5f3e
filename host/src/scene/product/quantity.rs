//! What kinds of numbers dimensions and measures are, and in which units a scene has them.

use slipfit_tolerance::{
    model::Quantity as Measured,
    unit::{self, Quantity},
};

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

pub(super) const LENGTH: Quantity = Quantity { units: unit::LENGTH, range: [-1e7, 1e7] };

/// A kind's name in a scene, its units and its range.
struct Known {
    name: &'static str,
    measured: Measured,
    quantity: Quantity,
}

const fn known(name: &'static str, measured: Measured, units: &'static [unit::Unit]) -> Known {
    Known { name, measured, quantity: Quantity { units, range: [-1e12, 1e12] } }
}

const KNOWN: [Known; 9] = [
    Known { name: "length", measured: Measured::Length, quantity: LENGTH },
    Known {
        name: "angle",
        measured: Measured::Angle,
        quantity: Quantity { units: unit::ANGLE, range: [-3600.0, 3600.0] },
    },
    known("number", Measured::Ratio, unit::ONE),
    known("force", Measured::Force, unit::FORCE),
    known("stiffness", Measured::Stiffness, unit::STIFFNESS),
    known("mass", Measured::Mass, unit::MASS),
    known("moment", Measured::Moment, unit::MOMENT),
    known("pressure", Measured::Pressure, unit::PRESSURE),
    known("time", Measured::Time, unit::SECONDS),
];

/// The units and the range of a kind.
pub(in crate::scene) fn units(measured: Measured) -> &'static Quantity {
    KNOWN.iter().find(|known| known.measured == measured).map_or(&LENGTH, |known| &known.quantity)
}

/// What kind of number a dimension is: by its key `quantity`, by the unit of its `value`, or a length.
pub(in crate::scene) fn of(table: &Field, value: &Field) -> Result<Measured, SceneError> {
    if let Some(field) = table.get("quantity") {
        let name = field.to_text()?;
        let known = KNOWN.iter().find(|known| known.name == name).map(|known| known.measured);
        return known.ok_or_else(|| {
            let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
            field.error(problem, KNOWN.map(|known| known.name).join(", "))
        });
    }
    if !matches!(value.node.value, Value::Text(_)) {
        return Ok(Measured::Length);
    }
    let unit = value.measure("a number with its unit")?.unit.unwrap_or_default();
    let has = |known: &&Known| known.quantity.units.iter().any(|known| !unit.is_empty() && known.is(unit));
    Ok(KNOWN.iter().find(has).map_or(Measured::Length, |known| known.measured))
}
