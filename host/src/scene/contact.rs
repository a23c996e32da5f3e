//! Reading the law along a contact's normal.

use slipfit_core::menu::ContactData;
use slipfit_tolerance::unit::{self, Quantity};

use super::{Problem, SceneError, value::Field};
use crate::mechanism::{NormalData, Rebound};

const EXPONENT: Quantity = Quantity { units: unit::ONE, range: [1.0, 4.0] };
const DAMPING: Quantity = Quantity { units: unit::DAMPING, range: [0.0, 1e6] };
const DEPTH: Quantity = Quantity { units: unit::LENGTH, range: [1e-6, 1000.0] };
const RESTITUTION: Quantity = Quantity { units: unit::ONE, range: [0.0, 1.0] };
const SPEED: Quantity = Quantity { units: unit::SPEED, range: [1e-3, 1e7] };
/// N/m^e.
const STIFFNESS: [f64; 2] = [1e-9, 1e20];

/// Names of the laws in scene files.
const IMPACT: &str = "impact";
const HUNT_CROSSLEY: &str = "hunt-crossley";
const LANKARANI_NIKRAVESH: &str = "lankarani-nikravesh";

/// Reads the contact of a slide, which has one law.
pub(super) fn impact(table: &Field) -> Result<ContactData<f64>, SceneError> {
    match normal(table)? {
        NormalData::Impact(data) => Ok(data),
        NormalData::HuntCrossley(_) | NormalData::LankaraniNikravesh(_) => {
            let law = table.require("law", IMPACT)?;
            let what = format!("the contact law {} of a slide", law.written(""));
            Err(law.error(Problem::Unsupported { what }, format!("{IMPACT}; the others are for mechanisms")))
        }
    }
}

/// Reads any law; [`IMPACT`] where none is named.
pub(super) fn normal(table: &Field) -> Result<NormalData, SceneError> {
    let law = table.get("law");
    let name = law.as_ref().map_or(Ok(IMPACT), Field::to_text)?;
    let exponent = table.number("exponent", &EXPONENT)?;
    let stiffness = stiffness(table, exponent)?;
    let rebound = || {
        none_of(table, ["damping", "depth"], name)?;
        let (restitution, speed) = (table.number("restitution", &RESTITUTION)?, table.number("speed", &SPEED)?);
        Ok(Rebound { stiffness, exponent, restitution, speed })
    };
    match (name, law) {
        (HUNT_CROSSLEY, _) => rebound().map(NormalData::HuntCrossley),
        (LANKARANI_NIKRAVESH, _) => rebound().map(NormalData::LankaraniNikravesh),
        (IMPACT, _) | (_, None) => {
            none_of(table, ["restitution", "speed"], name)?;
            let (damping, depth) = (table.number("damping", &DAMPING)?, table.number("depth", &DEPTH)?);
            Ok(NormalData::Impact(ContactData { stiffness, exponent, damping, depth }))
        }
        (_, Some(law)) => {
            let problem = Problem::Choice { key: law.key.clone(), written: law.written("") };
            Err(law.error(problem, [IMPACT, HUNT_CROSSLEY, LANKARANI_NIKRAVESH].join(", ")))
        }
    }
}

/// Refuses `keys`, which the `law` does not have.
fn none_of(table: &Field, keys: [&str; 2], law: &str) -> Result<(), SceneError> {
    match keys.into_iter().find_map(|key| table.get(key)) {
        None => Ok(()),
        Some(field) => {
            let what = format!("`{}` of the law \"{law}\"", field.key);
            let has = if law == IMPACT { "damping and depth" } else { "restitution and speed" };
            Err(field.error(Problem::Unsupported { what }, format!("stiffness, exponent, {has}")))
        }
    }
}

/// The stiffness (N/m^e); its unit has the contact's exponent.
fn stiffness(table: &Field, exponent: f64) -> Result<f64, SceneError> {
    let units = format!("a number in N/mm^{exponent}, or a text with its unit: N/mm^{exponent}, N/m^{exponent}");
    stiffness_of(&table.require("stiffness", &units)?, exponent)
}

/// The stiffness (N/m^e) in a `field`, whose unit has the contact's exponent.
pub(super) fn stiffness_of(field: &Field, exponent: f64) -> Result<f64, SceneError> {
    let units = format!("a number in N/mm^{exponent}, or a text with its unit: N/mm^{exponent}, N/m^{exponent}");
    let measure = field.measure(&units)?;
    let (key, written) = (field.key.clone(), field.written(""));

    let (length, power) = match measure.unit.map(stiffness_unit) {
        None => ("mm", exponent),
        Some(Some(unit)) => unit,
        Some(None) => return Err(field.error(Problem::Unit { key, written }, units)),
    };
    if power != exponent {
        return Err(field.error(Problem::Exponent { key, written, exponent }, units));
    }
    let number = measure.number;
    let value = match length {
        // k·1000^e under the root, where 1000^1.5 is not yet rounded: the nearest double for the paper's contact.
        "mm" => libm::copysign(libm::sqrt(number * number * libm::pow(1e6, exponent)), number),
        _ => number,
    };
    let [least, greatest] = STIFFNESS;
    if (least..=greatest).contains(&value) {
        return Ok(value);
    }
    Err(field.out_of_range(&format!("N/mm^{exponent}"), format!("{least:e} to {greatest:e} N/m^{exponent}")))
}

/// Length and exponent of a unit such as N/mm^1.5.
fn stiffness_unit(unit: &str) -> Option<(&str, f64)> {
    let (length, power) = unit.strip_prefix("N/")?.split_once('^').unwrap_or((unit.strip_prefix("N/")?, "1"));
    let power = power.parse().ok()?;
    matches!(length, "mm" | "m").then_some((length, power))
}
