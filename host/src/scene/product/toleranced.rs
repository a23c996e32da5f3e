//! Reads toleranced numbers.

use slipfit_tolerance::{
    model::{Contributor, Distribution, Quantity as Measured, Variation},
    product::{
        dimension::Toleranced,
        expression::{Kind, Source},
        iso286,
        iso2768::{self, BandError, General, SizeClass},
    },
    unit::{self, Quantity},
};

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

pub(super) use super::distribution::positive;
pub(super) use super::quantity::LENGTH;
use super::{
    diameter::Diameter,
    distribution::{component, deviations, doubt, doubt_absolute, excess, shape},
    draft::Draft,
    quantity,
    tables::name,
};

/// A component of a unit vector.
pub(super) const RATIO: Quantity = Quantity { units: unit::ONE, range: [-1.0, 1.0] };

const TOLERANCE: &str = "± as one number, of a length in mm, or a text with its unit, \"0.004 in\"; [lower, upper] deviations; a class \
                         of ISO 2768-1: f, m, c, v; an ISO 286 class with its size: H7, g6";

/// Reads a `[[dimension]]`.
pub(super) fn dimension(table: &Field, draft: &mut Draft) -> Result<(), SceneError> {
    let (name, name_field) = name(table)?;
    let value = table.require("value", "a length in mm, or a text with its unit: \"30°\", \"5 N\"")?;
    let (toleranced, measured) = toleranced(table, &value, draft)?;
    let variable = draft.add(toleranced.contributor(name.into()), &[toleranced.nominal]);
    draft.quantities[variable] = measured;
    draft.name(&name_field, name, Source::Variable(variable), Kind::of(measured))
}

/// Gives the name of a dimension that cannot be read to a constant.
pub(super) fn stand_in(table: &Field, draft: &mut Draft) {
    let Ok((name, field)) = name(table) else { return };
    if draft.names.iter().all(|(known, ..)| known != name) {
        let variation = Variation::Scalar { distribution: Distribution::Constant(1.0), limits: [1.0; 2] };
        let variable = draft.add(Contributor { name: name.into(), variation }, &[1.0]);
        // Nobody else has the name.
        let _ = draft.name(&field, name, Source::Variable(variable), Kind::of(Measured::Length));
    }
}

/// Reads the diameter of an axis: a bare length under the general tolerance, or a table like a dimension's. It is a hole's or a
/// pin's as `kind` says, or the class of ISO 286.
pub(super) fn diameter(axis: &Field, name: &str, draft: &mut Draft) -> Result<Option<Diameter>, SceneError> {
    let kind = axis.get("kind").map(|field| match field.to_text()? {
        "hole" => Ok(true),
        "pin" => Ok(false),
        _ => {
            let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
            Err(field
                .error(problem, "hole or pin; without, the letter of an ISO 286 class or the larger one is the hole's"))
        }
    });
    let kind = kind.transpose()?;
    let Some(field) = axis.get("diameter") else {
        return match axis.get("kind") {
            Some(kind) => Err(kind.no_effect("without a `diameter`", "an axis with a diameter")),
            None => Ok(None),
        };
    };
    let value = match field.node.value {
        Value::Table(_) => field.require("value", "a length in mm")?,
        _ => field.clone(),
    };
    let (diameter, measured) = toleranced(&field, &value, draft)?;
    if diameter.limits[0] <= 0.0 || measured != Measured::Length {
        return Err(value.out_of_range("mm", "a length that stays above 0"));
    }
    let name = format!("{name}.diameter");
    let variable = draft.add(diameter.contributor(name.clone()), &[diameter.nominal]);
    draft.name(&field, &name, Source::Variable(variable), Kind::LENGTH)?;
    let of_class = || fit(&field.get("tolerance")?).map(|class| class.is_hole());
    Ok(Some(Diameter { variable, limits: diameter.limits, hole: kind.or_else(of_class), own: [0.0; 2] }))
}

/// What a `side` is for.
const SIDE: &str = "a side of an angle that a class of ISO 2768-1 tolerates";
/// What an `edge` is for.
const EDGE: &str = "an edge of a length that a class of ISO 2768-1 tolerates";

/// Reads the size by which a feature lies off: deviations, or a table like a dimension's.
pub(super) fn offset(field: &Field, draft: &Draft) -> Result<Toleranced, SceneError> {
    if let Some(value) = field.get("value") {
        return match toleranced(field, &value, draft)? {
            (offset, Measured::Length) => Ok(offset),
            _ => Err(value.out_of_range("mm", "a length")),
        };
    }
    if let Some(edge) = field.get("edge") {
        return Err(edge.no_effect("without a `value`", EDGE));
    }
    deviation(field, &LENGTH, draft.defaults.sigma)
}

/// Reads a deviation from 0: a tolerance, or a table of `tolerance`, `sigma`, which is the given one if not written, and
/// `distribution`.
pub(in crate::scene) fn deviation(field: &Field, quantity: &Quantity, sigma: f64) -> Result<Toleranced, SceneError> {
    Ok(component(field, quantity, sigma, 0.0)?.1)
}

/// Reads the keys `tolerance`, `sigma`, `distribution`, `side` and `edge` of a table, and its `value`.
pub(super) fn toleranced(table: &Field, value: &Field, draft: &Draft) -> Result<(Toleranced, Measured), SceneError> {
    let measured = quantity::of(table, value)?;
    let quantity = quantity::units(measured);
    let nominal = value.to_number(quantity)?;
    let shape = shape(table, quantity, draft.defaults.sigma, nominal)?;
    let tolerance = table.get("tolerance");
    let mut by_class = None;
    let mut general = |class| {
        by_class = Some(measured);
        general(table, value, measured, nominal, class)
    };
    let deviations = match (&tolerance, &shape) {
        (None, shape) if shape.is_whole() || shape.has_width() => [0.0; 2],
        (Some(field), shape) if shape.is_whole() => return Err(excess(field)),
        (Some(field), _) => match (class(field), fit(field)) {
            (Some(class), _) if is_geometric(measured) => general(class)?,
            (Some(_), _) => return Err(no_class(field, measured)),
            (None, Some(class)) => of_fit(field, value, measured, nominal, &class)?,
            (None, None) => {
                let [lower, upper] = deviations(field, quantity, TOLERANCE)?;
                doubt_absolute(field, nominal, &[lower, upper]);
                [lower, upper]
            }
        },
        (None, _) => match draft.defaults.general.size {
            Some(class) if is_geometric(measured) => general(class)?,
            _ => return Err(table.error(Problem::Missing(format!("{}.tolerance", table.key)), TOLERANCE)),
        },
    };
    for (key, of, allowed) in [("side", Measured::Angle, SIDE), ("edge", Measured::Length, EDGE)] {
        if let Some(field) = table.get(key).filter(|_| by_class != Some(of)) {
            return Err(field.no_effect("here", allowed));
        }
    }
    let at = table.get("distribution").or(table.get("sigma")).or(tolerance).unwrap_or(value.clone());
    let made = Toleranced::new(nominal, deviations, &shape);
    let toleranced = made.map_err(|error| at.error(Problem::Shape { key: at.key.clone(), error }, TOLERANCE))?;
    doubt(&at, &toleranced);
    Ok((toleranced, measured))
}

/// The class that a tolerance names instead of stating a width.
fn class(field: &Field) -> Option<SizeClass> {
    let Value::Text(text) = &field.node.value else { return None };
    match text.parse() {
        Ok(General { size, geometry: None }) => size,
        _ => None,
    }
}

/// The class of ISO 286 that a tolerance names.
fn fit(field: &Field) -> Option<iso286::Class> {
    let Value::Text(text) = &field.node.value else { return None };
    text.trim().parse().ok()
}

/// Whether ISO 2768-1 has tolerances for it.
fn is_geometric(measured: Measured) -> bool {
    matches!(measured, Measured::Length | Measured::Angle)
}

/// A class beside something that the standard has none for.
fn no_class(field: &Field, measured: Measured) -> SceneError {
    let what = format!("the class {} of {}", field.written(""), Kind::of(measured));
    field.error(Problem::Unsupported { what }, "± as one number, or [lower, upper] deviations")
}

/// The deviations of a class of ISO 286 for the size `nominal` (m).
fn of_fit(
    field: &Field,
    value: &Field,
    measured: Measured,
    nominal: f64,
    class: &iso286::Class,
) -> Result<[f64; 2], SceneError> {
    if measured != Measured::Length {
        return Err(no_class(field, measured));
    }
    // The digits that the conversion to metres made up would push a size over the end of its range.
    let size = (nominal * 1e12).round() / 1e9;
    let deviations = class.deviations(size).map_err(|error| {
        let at = if matches!(error, iso286::ClassError::Size(_)) { value } else { field };
        at.error(Problem::Class { key: at.key.clone(), error }, iso286::ALLOWED)
    })?;
    Ok(deviations.map(|mm| mm / 1e3))
}

/// The general tolerance of `value`, as deviations.
fn general(
    table: &Field,
    value: &Field,
    measured: Measured,
    nominal: f64,
    class: SizeClass,
) -> Result<[f64; 2], SceneError> {
    let edge = table.get("edge").map(|field| match field.to_text()? {
        "broken" => Ok(()),
        _ => {
            let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
            Err(field.error(problem, "broken: an external radius or a chamfer"))
        }
    });
    let (found, at) = if measured == Measured::Angle {
        let side =
            table.require("side", "the length of the shorter side in mm, by which ISO 2768-1 tolerates angles")?;
        (iso2768::angle(class, positive(&side, &LENGTH)?), side)
    } else if edge.transpose()?.is_some() {
        (iso2768::broken_edge(class, nominal.abs()), value.clone())
    } else {
        (iso2768::linear(class, nominal.abs()), value.clone())
    };
    let half = found.map_err(|error| band(&at, error))?;
    Ok([-half, half])
}

/// The standard has no value for this length.
pub(super) fn band(field: &Field, error: BandError) -> SceneError {
    let [least, greatest] = error.allowed;
    let upper = if greatest.is_finite() { format!(" up to {greatest} mm") } else { " mm on".into() };
    field.error(Problem::Band { key: field.key.clone(), error }, format!("from {least}{upper}, or a stated tolerance"))
}
