//! Maximum and least material condition: which size a zone or a datum goes with, and how far.

use crate::{
    product::{
        feature::{Bonus, Shape},
        float::Size,
    },
    scene::{Problem, SceneError, tree::Value, value::Field},
};

use super::{part::FeatureDraft, toleranced::Diameter};

/// A condition of material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Material {
    /// The largest pin, the smallest hole: Ⓜ.
    Maximum,
    /// The smallest pin, the largest hole: Ⓛ.
    Least,
}

/// What may be written for a condition of material.
const CONDITIONS: &str = "\"maximum\" (MMC, Ⓜ), \"least\" (LMC, Ⓛ)";
/// What a zone at a condition of material has to have.
pub(super) const SIZED: &str = "the axis of a pin or hole that has a diameter";

/// The modifiers of drawings: a letter in a circle, how else it is written, and what it means.
const MODIFIERS: [(char, &str, &str); 13] = [
    ('Ⓜ', "MMC", "the maximum material condition"),
    ('Ⓛ', "LMC", "the least material condition"),
    ('Ⓢ', "RFS", "regardless of feature size"),
    ('Ⓟ', "projected", "a projected tolerance zone"),
    ('Ⓣ', "tangent", "a tangent plane"),
    ('Ⓕ', "free", "the free state"),
    ('Ⓡ', "reciprocity", "the reciprocity requirement"),
    ('Ⓔ', "envelope", "the envelope requirement"),
    ('Ⓘ', "independency", "independency"),
    ('Ⓤ', "UZ", "an unequally disposed profile"),
    ('Ⓐ', "derived", "a derived feature"),
    ('Ⓒ', "CZ", "a combined zone"),
    ('Ⓖ', "gauss", "an associated feature"),
];

/// A text without the modifier at its end, and that modifier.
fn split(text: &str) -> Option<(&str, char, &'static str)> {
    let text = text.trim_end();
    MODIFIERS.iter().find_map(|(symbol, _, meaning)| {
        let letter = char::from_u32(*symbol as u32 - 'Ⓐ' as u32 + 'A' as u32)?;
        let ends = [symbol.to_string(), format!("({letter})"), format!("({})", letter.to_ascii_lowercase())];
        let rest = ends.iter().find_map(|end| text.strip_suffix(end.as_str()))?;
        Some((rest.trim_end(), *symbol, *meaning))
    })
}

/// The condition of a modifier, `None` regardless of feature size; an error for those that mean something else.
fn condition(field: &Field, symbol: char, meaning: &str) -> Result<Option<Material>, SceneError> {
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
        Some((name, symbol, meaning)) => Ok((name, condition(field, symbol, meaning)?)),
        None => Ok((text, None)),
    }
}

/// Refuses a modifier behind the width of a zone, which stands in a key of its own.
pub(super) fn refuse_in_width(zone: &Field) -> Result<(), SceneError> {
    let Value::Text(text) = &zone.node.value else { return Ok(()) };
    let Some((_, symbol, meaning)) = split(text) else { return Ok(()) };
    let what = format!("{symbol}, {meaning}, behind the width of a zone");
    condition(zone, symbol, meaning)?;
    Err(zone.error(Problem::Unsupported { what }, "{ zone = …, material = \"maximum\" } or \"least\""))
}

/// Reads the key `material` of a tolerance.
pub(super) fn of_zone(callout: &Field) -> Result<Option<Material>, SceneError> {
    let Some(field) = callout.get("material") else { return Ok(None) };
    let text = field.to_text()?.trim();
    if let Some((_, symbol, meaning)) = split(text).filter(|(rest, ..)| rest.is_empty()) {
        return condition(&field, symbol, meaning);
    }
    let is = |names: &[&str]| names.iter().any(|name| name.eq_ignore_ascii_case(text));
    if is(&["maximum", "MMC", "MMR", "M"]) {
        return Ok(Some(Material::Maximum));
    }
    if is(&["least", "LMC", "LMR", "L"]) {
        return Ok(Some(Material::Least));
    }
    if let Some((symbol, _, meaning)) = MODIFIERS.iter().find(|(_, name, _)| name.eq_ignore_ascii_case(text)) {
        return condition(&field, *symbol, meaning);
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

impl Material {
    /// In a sentence.
    pub fn named(self) -> &'static str {
        match self {
            Self::Maximum => "maximum material condition",
            Self::Least => "least material condition",
        }
    }

    /// The size (m) of the feature called `name` at the condition.
    pub fn limit(self, diameter: &Diameter, name: &str, field: &Field) -> Result<f64, SceneError> {
        let hole = diameter.hole.ok_or_else(|| {
            field.error(
                Problem::Missing(format!("{name}.kind")),
                "kind = \"hole\" or \"pin\", or an ISO 286 class of the diameter",
            )
        })?;
        Ok(diameter.limits[usize::from(hole == (self == Self::Least))])
    }
}

#[cfg(test)]
mod tests {
    use super::split;

    #[test]
    fn modifiers_are_known_in_each_way_to_write_them() {
        for text in ["part.bore Ⓜ", "part.bore(M)", "part.bore (m) "] {
            assert!(matches!(split(text), Some(("part.bore", 'Ⓜ', _))), "{text}");
        }
        assert!(matches!(split("0.2 (P)"), Some(("0.2", 'Ⓟ', "a projected tolerance zone"))));
        assert!(split("part.bore").is_none() && split("part.(X)").is_none());
    }
}
