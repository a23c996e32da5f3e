//! Maximum and least material condition: which size a zone or a datum goes with, and how far.

use slipfit_tolerance::product::{
    feature::{Bonus, Shape},
    float::Size,
};

use crate::scene::{
    Problem, SceneError,
    drawing::{Modifier, named, split},
    tree::Value,
    value::Field,
};

use super::{
    diameter::{Diameter, Material},
    draft::FeatureDraft,
};

/// What may be written for a condition of material.
const CONDITIONS: &str = "\"maximum\" (MMC, Ⓜ), \"least\" (LMC, Ⓛ)";
/// What a zone at a condition of material has to have.
pub(super) const SIZED: &str = "the axis of a pin or hole that has a diameter";

/// The condition of a modifier, `None` regardless of feature size; an error for those that mean something else.
fn condition(field: &Field, Modifier { symbol, meaning, .. }: &Modifier) -> Result<Option<Material>, SceneError> {
    match symbol {
        'Ⓜ' => Ok(Some(Material::Maximum)),
        'Ⓛ' => Ok(Some(Material::Least)),
        'Ⓢ' => Ok(None),
        _ => Err(field.error(Problem::Unsupported { what: format!("{symbol}, {meaning},") }, CONDITIONS)),
    }
}

/// The name of a datum, and the condition of material at which it is referenced: "plate.bore Ⓜ", "plate.bore (M)".
pub(super) fn of_datum<'t>(field: &Field<'t, '_>) -> Result<(&'t str, Option<Material>), SceneError> {
    let text = field.to_text()?;
    match split(text) {
        Some((name, modifier)) => Ok((name, condition(field, modifier)?)),
        None => Ok((text, None)),
    }
}

/// Refuses a modifier behind the width of a zone, which stands in a key of its own.
pub(super) fn refuse_in_width(zone: &Field) -> Result<(), SceneError> {
    let Value::Text(text) = &zone.node.value else { return Ok(()) };
    let Some((_, modifier)) = split(text) else { return Ok(()) };
    let what = format!("{}, {}, behind the width of a zone", modifier.symbol, modifier.meaning);
    condition(zone, modifier)?;
    Err(zone.error(Problem::Unsupported { what }, "{ zone = …, material = \"maximum\" } or \"least\""))
}

/// Reads the key `material` of a tolerance.
pub(super) fn of_zone(callout: &Field) -> Result<Option<Material>, SceneError> {
    let Some(field) = callout.get("material") else { return Ok(None) };
    let text = field.to_text()?.trim();
    if let Some((_, modifier)) = split(text).filter(|(rest, _)| rest.is_empty()) {
        return condition(&field, modifier);
    }
    let is = |names: [&str; 2]| names.iter().any(|name| name.eq_ignore_ascii_case(text));
    if is(["maximum", "M"]) {
        return Ok(Some(Material::Maximum));
    }
    if is(["least", "L"]) {
        return Ok(Some(Material::Least));
    }
    if let Some(modifier) = named(text) {
        return condition(&field, modifier);
    }
    let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
    Err(field.error(problem, CONDITIONS))
}

/// How the zone of a tolerance `name`, `width` (m) wide without a bonus, goes with the size of the feature.
pub(super) fn bonus(
    callout: &Field,
    name: &str,
    width: f64,
    material: Material,
    made: &FeatureDraft,
) -> Result<Bonus, SceneError> {
    let refuse = |what: String| Err(callout.error(Problem::Unsupported { what }, SIZED));
    if made.feature.shape != Shape::Axis {
        return refuse(format!("{name} at {} of {}", material.named(), made.feature.shape.article()));
    }
    let Some(diameter) = made.diameter else {
        return refuse(format!("{name} at {} without a diameter", material.named()));
    };
    let limit = material.limit(&diameter, &made.name, callout)?;
    Ok(Bonus { width, size: diameter.variable, limit, sign: if limit == diameter.limits[0] { 1.0 } else { -1.0 } })
}

/// The hole and the pin in which a datum lies in its boundary: the size at the condition, beyond it by the width of the datum's
/// own tolerance at the same condition.
pub(super) fn boundary(
    field: &Field,
    name: &str,
    material: Material,
    diameter: &Diameter,
) -> Result<[Size; 2], SceneError> {
    let limit = material.limit(diameter, name, field)?;
    let own = diameter.own[material as usize];
    let actual = Size::Actual(diameter.variable);
    // A hole at maximum, and a pin at least material, goes around its boundary.
    let around = limit == diameter.limits[0];
    Ok(if around { [actual, Size::Boundary(limit - own)] } else { [Size::Boundary(limit + own), actual] })
}
