//! Reads toleranced numbers.

use crate::{
    product::{
        dimension::{Shape, ShapeError, Toleranced},
        expression::{Kind, Source},
        iso286,
        iso2768::{self, BandError, General, SizeClass},
    },
    scene::{
        Problem, SceneError,
        tree::Value,
        unit::{self, Quantity},
        value::Field,
    },
};

use super::{Draft, SIGMA, name};

pub(super) const LENGTH: Quantity = Quantity { units: unit::LENGTH, range: [-1e7, 1e7] };
const ANGLE: Quantity = Quantity { units: unit::ANGLE, range: [-3600.0, 3600.0] };
/// A component of a unit vector.
pub(super) const RATIO: Quantity = Quantity { units: unit::ONE, range: [-1.0, 1.0] };
const SKEWNESS: Quantity = Quantity { units: unit::ONE, range: [-10.0, 10.0] };

const TOLERANCE: &str = "± as one number in mm or a text with its unit, \"0.004 in\"; [lower, upper] deviations; a class \
                         of ISO 2768-1: f, m, c, v; an ISO 286 class with its size: H7, g6";
/// The same of what has no size.
const DEVIATION: &str = "± as one number, or [lower, upper] deviations, in mm or as texts with their units";
pub(in crate::scene) const SHAPES: &str =
    "normal, truncated-normal, uniform, triangular, trapezoidal, skewed, table, constant";

/// Reads a `[[dimension]]`.
pub(super) fn dimension(table: &Field, draft: &mut Draft) -> Result<(), SceneError> {
    let (name, name_field) = name(table)?;
    let value = table.require("value", "a length in mm, or a text with its unit: \"30°\"")?;
    let (toleranced, kind) = toleranced(table, &value, draft)?;
    let variable = draft.add(toleranced.contributor(name.into()), &[toleranced.nominal]);
    draft.name(&name_field, name, Source::Variable(variable), kind)
}

/// The diameter of an axis.
#[derive(Clone, Copy)]
pub(super) struct Diameter {
    /// Its variable.
    pub variable: usize,
    /// Least and greatest (m).
    pub limits: [f64; 2],
    /// Whether it is a hole's, if that is said.
    pub hole: Option<bool>,
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
    let Some(field) = axis.get("diameter") else { return Ok(None) };
    let value = match field.node.value {
        Value::Table(_) => field.require("value", "a length in mm")?,
        _ => field.clone(),
    };
    let (diameter, length) = toleranced(&field, &value, draft)?;
    if diameter.limits[0] <= 0.0 || length != Kind::LENGTH {
        return Err(value.out_of_range("mm", "a length that stays above 0"));
    }
    let name = format!("{name}.diameter");
    let variable = draft.add(diameter.contributor(name.clone()), &[diameter.nominal]);
    draft.name(&field, &name, Source::Variable(variable), length)?;
    let of_class = || fit(&field.get("tolerance")?).map(|class| class.is_hole());
    Ok(Some(Diameter { variable, limits: diameter.limits, hole: kind.or_else(of_class) }))
}

/// Reads the size by which a feature lies off: deviations, or a table like a dimension's.
pub(super) fn offset(field: &Field, draft: &Draft) -> Result<Toleranced, SceneError> {
    match field.get("value") {
        Some(value) => Ok(toleranced(field, &value, draft)?.0),
        None => deviation(field, &LENGTH, draft.defaults.sigma),
    }
}

/// Reads a deviation from 0: a tolerance, or a table of `tolerance`, `sigma`, which is the given one if not written, and
/// `distribution`.
pub(in crate::scene) fn deviation(field: &Field, quantity: &Quantity, sigma: f64) -> Result<Toleranced, SceneError> {
    let tolerance = match field.node.value {
        Value::Table(_) => field.require("tolerance", DEVIATION)?,
        _ => field.clone(),
    };
    let shape = shape(field, quantity, sigma)?;
    Toleranced::new(0.0, deviations(&tolerance, quantity, DEVIATION)?, &shape)
        .map_err(|error| field.error(Problem::Shape { key: field.key.clone(), error }, DEVIATION))
}

/// Reads the keys `tolerance`, `sigma`, `distribution`, `side` and `edge` of a table, and its `value`.
pub(super) fn toleranced(table: &Field, value: &Field, draft: &Draft) -> Result<(Toleranced, Kind), SceneError> {
    let is_angle = matches!(value.node.value, Value::Text(_))
        && value.measure("a length or an angle")?.unit.is_some_and(|text| unit::ANGLE.iter().any(|unit| unit.is(text)));
    let (quantity, kind) = if is_angle { (&ANGLE, Kind::ANGLE) } else { (&LENGTH, Kind::LENGTH) };
    let nominal = value.to_number(quantity)?;
    let shape = shape(table, quantity, draft.defaults.sigma)?;
    let tolerance = table.get("tolerance");
    let deviations = match (&tolerance, &shape) {
        (None, Shape::Constant | Shape::Table(_)) => [0.0; 2],
        (Some(field), Shape::Constant | Shape::Table(_)) => {
            let problem = Problem::Shape { key: field.key.clone(), error: ShapeError::Excess };
            return Err(field.error(problem, "no tolerance with this distribution"));
        }
        (Some(field), _) => match (class(field), fit(field)) {
            (Some(class), _) => general(table, value, kind, nominal, class)?,
            (None, Some(class)) => of_fit(field, value, kind, nominal, &class)?,
            (None, None) => deviations(field, quantity, TOLERANCE)?,
        },
        (None, _) => match draft.defaults.general.size {
            Some(class) => general(table, value, kind, nominal, class)?,
            None => return Err(table.error(Problem::Missing(format!("{}.tolerance", table.key)), TOLERANCE)),
        },
    };
    let at = table.get("distribution").or(tolerance).unwrap_or(value.clone());
    let made = Toleranced::new(nominal, deviations, &shape);
    let toleranced = made.map_err(|error| at.error(Problem::Shape { key: at.key.clone(), error }, TOLERANCE))?;
    Ok((toleranced, kind))
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

/// The deviations of a class of ISO 286 for the size `nominal` (m).
fn of_fit(
    field: &Field,
    value: &Field,
    kind: Kind,
    nominal: f64,
    class: &iso286::Class,
) -> Result<[f64; 2], SceneError> {
    if kind != Kind::LENGTH {
        let problem = Problem::Unsupported { what: format!("the class {} of an angle", class.name()) };
        return Err(field.error(problem, TOLERANCE));
    }
    // The digits that the conversion to metres made up would push a size over the end of its range.
    let size = (nominal * 1e12).round() / 1e9;
    let deviations = class.deviations(size).map_err(|error| {
        let at = if matches!(error, iso286::ClassError::Size(_)) { value } else { field };
        at.error(Problem::Class { key: at.key.clone(), error }, iso286::ALLOWED)
    })?;
    Ok(deviations.map(|mm| mm / 1e3))
}

/// Lower and upper deviation; `allowed` is all that may be written.
fn deviations(field: &Field, quantity: &Quantity, allowed: &str) -> Result<[f64; 2], SceneError> {
    let plain = |problem| field.error(problem, allowed);
    match &field.node.value {
        Value::List(_) => {
            let [lower, upper] = field.to_numbers(quantity)?;
            if lower >= upper {
                let error = if lower > upper { ShapeError::Reversed } else { ShapeError::Width };
                let problem = Problem::Shape { key: field.key.clone(), error };
                return Err(field.error(problem, "a lower deviation that is below the upper one, such as [-0.1, 0.3]"));
            }
            Ok([lower, upper])
        }
        Value::Text(text) if !text.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) => {
            Err(plain(Problem::Choice { key: field.key.clone(), written: field.written("") }))
        }
        Value::Text(_) | Value::Number(_) => {
            let half = field.to_number(quantity)?;
            if half > 0.0 {
                return Ok([-half, half]);
            }
            let written = field.written(quantity.units[0].symbol);
            let problem = Problem::OutOfRange { key: field.key.clone(), written };
            let constant = "more than 0; distribution = \"constant\" without a tolerance is for what does not vary";
            Err(field.error(problem, if half == 0.0 { constant } else { "more than 0" }))
        }
        _ => Err(field.wrong_type(allowed)),
    }
}

/// A width or half of one: more than 0.
pub(super) fn positive(field: &Field, quantity: &Quantity) -> Result<f64, SceneError> {
    let width = field.to_number(quantity)?;
    let symbol = quantity.units[0].symbol;
    if width > 0.0 { Ok(width) } else { Err(field.out_of_range(symbol, "more than 0")) }
}

/// The general tolerance of `value`, as deviations.
fn general(table: &Field, value: &Field, kind: Kind, nominal: f64, class: SizeClass) -> Result<[f64; 2], SceneError> {
    let edge = table.get("edge").map(|field| match field.to_text()? {
        "broken" => Ok(()),
        _ => {
            let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
            Err(field.error(problem, "broken: an external radius or a chamfer"))
        }
    });
    let (found, at) = if kind == Kind::ANGLE {
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

/// The keys `sigma` and `distribution`.
fn shape(table: &Field, quantity: &Quantity, sigma: f64) -> Result<Shape, SceneError> {
    let sigma = table.get("sigma").map_or(Ok(sigma), |field| field.to_number(&SIGMA))?;
    let Some(field) = table.get("distribution") else { return Ok(Shape::Normal { sigma }) };
    let kind = match &field.node.value {
        Value::Table(_) => field.require("kind", SHAPES)?,
        _ => field.clone(),
    };
    let deviation = |key: &str| field.get(key).map(|field| field.to_number(quantity)).transpose();
    Ok(match kind.to_text()? {
        "constant" => Shape::Constant,
        "normal" => Shape::Normal { sigma },
        "truncated-normal" => Shape::TruncatedNormal { sigma },
        "uniform" => Shape::Uniform,
        "triangular" => Shape::Triangular { mode: deviation("mode")? },
        "trapezoidal" => Shape::Trapezoidal { shoulders: field.numbers("shoulders", quantity)? },
        "skewed" => Shape::Skewed { sigma, skewness: field.number("skewness", &SKEWNESS)? },
        "table" => {
            const ALLOWED: &str = "a list of two or more deviations from the value, ascending";
            let list = field.require("deviations", ALLOWED)?;
            let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(ALLOWED)) };
            let number = |node| Field { key: list.key.clone(), node }.to_number(quantity);
            Shape::Table(nodes.iter().map(number).collect::<Result<_, _>>()?)
        }
        _ => {
            let problem = Problem::Choice { key: kind.key.clone(), written: kind.written("") };
            return Err(kind.error(problem, SHAPES));
        }
    })
}
