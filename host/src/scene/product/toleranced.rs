//! Reads toleranced numbers.

use slipfit_tolerance::{
    model::{Contributor, Distribution, Quantity as Measured, Variation},
    number::fixed,
    product::{
        dimension::{Component, Deviation, Mean, Shape, ShapeError, Spread, Toleranced},
        expression::{Kind, Source},
        iso286,
        iso2768::{self, BandError, General, SizeClass},
    },
    unit::{self, Quantity},
};

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

pub(super) use super::quantity::LENGTH;
use super::{Draft, SIGMA, name, quantity};

/// A component of a unit vector.
pub(super) const RATIO: Quantity = Quantity { units: unit::ONE, range: [-1.0, 1.0] };
const SKEWNESS: Quantity = Quantity { units: unit::ONE, range: [-10.0, 10.0] };

const TOLERANCE: &str = "± as one number, of a length in mm, or a text with its unit, \"0.004 in\"; [lower, upper] deviations; a class \
                         of ISO 2768-1: f, m, c, v; an ISO 286 class with its size: H7, g6";
/// The same of what has no size.
const DEVIATION: &str = "± as one number or [lower, upper] deviations, of a length in mm, or texts with their units";
pub(in crate::scene) const SHAPES: &str = "normal, truncated-normal, uniform, triangular, trapezoidal, beta, skewed, lognormal, weibull, gumbel, \
                      gumbel-smallest, mixture, table, constant";
/// Beyond, moments are not finite enough to be computed.
const WEIBULL: Quantity = Quantity { units: unit::ONE, range: [0.5, 100.0] };
const BETA: Quantity = Quantity { units: unit::ONE, range: [0.1, 1000.0] };
const WEIGHT: Quantity = Quantity { units: unit::ONE, range: [0.0, 1e6] };
const CPK: Quantity = Quantity { units: unit::ONE, range: [0.1, 10.0] };
/// The share of units outside of their own tolerance that is a mistake of the scene rather than a poor process.
const DOUBTFUL: f64 = 0.1;

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

/// The diameter of an axis.
#[derive(Clone, Copy)]
pub(super) struct Diameter {
    /// Its variable.
    pub variable: usize,
    /// Least and greatest (m).
    pub limits: [f64; 2],
    /// Whether it is a hole's, if that is said.
    pub hole: Option<bool>,
    /// Widths (m) of the axis's own tolerance at maximum and at least material condition.
    pub own: [f64; 2],
}

impl Diameter {
    /// The middle of its limits (m).
    pub fn middle(&self) -> f64 {
        0.5 * (self.limits[0] + self.limits[1])
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

/// The same as a part of the mixture of a dimension with the value `nominal` (SI), and alone.
fn component(
    field: &Field,
    quantity: &Quantity,
    sigma: f64,
    nominal: f64,
) -> Result<(Component, Toleranced), SceneError> {
    let shape = shape(field, quantity, sigma, nominal)?;
    let tolerance = match field.node.value {
        Value::Table(_) => field.get("tolerance"),
        _ => Some(field.clone()),
    };
    let deviations = match tolerance {
        Some(tolerance) if shape.is_whole() => return Err(excess(&tolerance)),
        Some(tolerance) => {
            let [lower, upper] = deviations(&tolerance, quantity, DEVIATION)?;
            doubt_absolute(&tolerance, nominal, &[lower, upper]);
            [lower, upper]
        }
        None if shape.is_whole() || shape.has_width() => [0.0; 2],
        None => return Err(field.error(Problem::Missing(format!("{}.tolerance", field.key)), DEVIATION)),
    };
    let made = Toleranced::new(0.0, deviations, &shape)
        .map_err(|error| field.error(Problem::Shape { key: field.key.clone(), error }, DEVIATION))?;
    doubt(&field.get("distribution").unwrap_or(field.clone()), &made);
    let weight = field.get("weight").map_or(Ok(1.0), |field| positive(&field, &WEIGHT))?;
    Ok((Component { weight, deviations, shape }, made))
}

/// A tolerance beside a shape that stands without one.
fn excess(tolerance: &Field) -> SceneError {
    let problem = Problem::Shape { key: tolerance.key.clone(), error: ShapeError::Excess };
    tolerance.error(problem, "no tolerance with this distribution")
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

/// Warns of a distribution that is far wider than its tolerance, or lies beside it.
fn doubt(at: &Field, made: &Toleranced) {
    let outside = made.outside();
    if outside > DOUBTFUL {
        let percent = fixed(outside * 100.0, 0);
        at.warn(&format!("by `{}` {percent} % of the units are outside of the tolerance", at.key));
    }
}

/// Warns of numbers that count from the value of their dimension, `nominal` (SI), and are all nearer to it than to 0.
fn doubt_absolute(field: &Field, nominal: f64, numbers: &[f64]) {
    if numbers.iter().all(|number| (number - nominal).abs() < number.abs()) {
        let key = &field.key;
        field.warn(&format!("`{key}` counts from `value`, and is nearer to `value` itself than to 0: is it absolute?"));
    }
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

/// Keys of a distribution beside its `kind`.
const PARAMETERS: [(&str, &[&str]); 14] = [
    ("normal", &["mean", "shift", "deviation", "cpk"]),
    ("truncated-normal", &["mean", "shift", "deviation", "cpk"]),
    ("skewed", &["mean", "shift", "deviation", "cpk", "skewness"]),
    ("uniform", &[]),
    ("triangular", &["mode"]),
    ("trapezoidal", &["shoulders"]),
    ("beta", &["shapes"]),
    ("lognormal", &["mean", "deviation", "location"]),
    ("weibull", &["shape", "scale", "location"]),
    ("gumbel", &["mode", "scale"]),
    ("gumbel-smallest", &["mode", "scale"]),
    ("mixture", &["of"]),
    ("table", &["deviations"]),
    ("constant", &[]),
];

/// Notes every key of the distribution in `field` that does nothing for its `kind`, and a `sigma` beside it that does nothing.
fn note_ignored(field: &Field, kind: &str, sigma: Option<&Field>) {
    let Some((_, own)) = PARAMETERS.iter().find(|(known, _)| *known == kind) else { return };
    let with = format!("with the distribution `{kind}`");
    let allowed = match own {
        [] => "no further key".to_owned(),
        own => own.join(", "),
    };
    let mut others: Vec<&str> = PARAMETERS.iter().flat_map(|(_, keys)| *keys).copied().collect();
    others.sort_unstable();
    others.dedup();
    for ignored in others.iter().filter(|key| !own.contains(key)).filter_map(|key| field.get(key)) {
        field.found().note(ignored.no_effect(with.as_str(), allowed.as_str()));
    }
    let Some(sigma) = sigma else { return };
    let stated = ["deviation", "cpk"].into_iter().find(|key| field.get(key).is_some());
    if let (true, Some(stated)) = (own.contains(&"cpk"), stated) {
        field.found().note(sigma.no_effect(format!("beside `{stated}`"), "one of both"));
    } else if !own.contains(&"cpk") {
        let allowed = "normal, truncated-normal, skewed; of a mixture the `sigma` of its components";
        field.found().note(sigma.no_effect(with, allowed));
    }
}

/// Mean and standard deviation of a normal or skewed distribution in `field`, of a dimension with the value `nominal` (SI).
/// Half the tolerance is `sigma` standard deviations unless something else is stated.
fn spread(field: &Field, quantity: &Quantity, sigma: f64, nominal: f64) -> Result<Spread, SceneError> {
    let mean = match (field.get("mean"), field.get("shift")) {
        (Some(_), Some(shift)) => return Err(shift.no_effect("beside `mean`", "one of both")),
        (Some(mean), None) => {
            let number = mean.to_number(quantity)?;
            doubt_absolute(&mean, nominal, &[number]);
            Mean::FromNominal(number)
        }
        (None, shift) => Mean::FromMiddle(shift.map_or(Ok(0.0), |shift| shift.to_number(quantity))?),
    };
    let deviation = match (field.get("deviation"), field.get("cpk")) {
        (Some(_), Some(cpk)) => return Err(cpk.no_effect("beside `deviation`", "one of both")),
        (Some(deviation), None) => Deviation::Stated(positive(&deviation, quantity)?),
        (None, Some(cpk)) => Deviation::Cpk(cpk.to_number(&CPK)?),
        (None, None) => Deviation::Sigmas(sigma),
    };
    Ok(Spread { mean, deviation })
}

/// A `sigma` in `field`. Below 1 a third of the units would be outside: then someone has stated the standard deviation itself.
fn sigmas(field: &Field) -> Result<f64, SceneError> {
    if field.as_number(&Quantity { range: [0.0, SIGMA.range[0]], ..SIGMA }).is_ok_and(|sigma| sigma < SIGMA.range[0]) {
        let problem = Problem::OutOfRange { key: field.key.clone(), written: field.written("") };
        let allowed = "1 to 100: how many standard deviations half the tolerance is, not the standard deviation itself, which is \
                       `deviation` of the distribution";
        return Err(field.error(problem, allowed));
    }
    field.to_number(&SIGMA)
}

/// The keys `sigma` and `distribution` of a dimension with the value `nominal` (SI).
fn shape(table: &Field, quantity: &Quantity, sigma: f64, nominal: f64) -> Result<Shape, SceneError> {
    let stated = table.get("sigma");
    let own = stated.as_ref().map_or(Ok(sigma), sigmas)?;
    let Some(field) = table.get("distribution") else {
        return Ok(Shape::Normal(Spread::sigmas(own)));
    };
    let kind = match &field.node.value {
        Value::Table(_) => field.require("kind", SHAPES)?,
        _ => field.clone(),
    };
    note_ignored(&field, kind.to_text()?, stated.as_ref());
    let spread = || spread(&field, quantity, own, nominal);
    // A place on the scale.
    let deviation = |key: &str| {
        let Some(field) = field.get(key) else { return Ok(None) };
        let number = field.to_number(quantity)?;
        doubt_absolute(&field, nominal, &[number]);
        Ok(Some(number))
    };
    let width = |key: &str| {
        let allowed = format!("more than 0: {}", quantity.units());
        positive(&field.require(key, &allowed)?, quantity)
    };
    Ok(match kind.to_text()? {
        "constant" => Shape::Constant,
        "normal" => Shape::Normal(spread()?),
        "truncated-normal" => Shape::TruncatedNormal(spread()?),
        "uniform" => Shape::Uniform,
        "triangular" => Shape::Triangular { mode: deviation("mode")? },
        "trapezoidal" => Shape::Trapezoidal { shoulders: field.numbers("shoulders", quantity)? },
        "skewed" => Shape::Skewed { spread: spread()?, skewness: field.number("skewness", &SKEWNESS)? },
        "beta" => Shape::Beta { shapes: field.numbers("shapes", &BETA)? },
        "weibull" => Shape::Weibull {
            shape: field.number("shape", &WEIBULL)?,
            scale: width("scale")?,
            location: deviation("location")?.unwrap_or(0.0),
        },
        largest @ ("gumbel" | "gumbel-smallest") => {
            let (mode, scale) = (deviation("mode")?.unwrap_or(0.0), width("scale")?);
            Shape::Gumbel { mode, scale: if largest == "gumbel" { scale } else { -scale } }
        }
        "lognormal" => Shape::Lognormal {
            mean: match deviation("mean")? {
                Some(mean) => mean,
                None => field.number("mean", quantity)?,
            },
            deviation: width("deviation")?,
            location: deviation("location")?.unwrap_or(0.0),
        },
        "mixture" => {
            const ALLOWED: &str = "a list of two or more: { weight = 2, tolerance = [-0.1, 0] }, …, each with a distribution if \
                                   it is not normal";
            let list = field.require("of", ALLOWED)?;
            let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(ALLOWED)) };
            if nodes.len() < 2 {
                return Err(list.error(Problem::Length { key: list.key.clone(), found: nodes.len() }, ALLOWED));
            }
            let part = |node| Ok(component(&Field { key: list.key.clone(), node }, quantity, sigma, nominal)?.0);
            Shape::Mixture(nodes.iter().map(part).collect::<Result<_, SceneError>>()?)
        }
        "table" => {
            const ALLOWED: &str = "a list of two or more deviations from the value, ascending";
            let list = field.require("deviations", ALLOWED)?;
            let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(ALLOWED)) };
            let number = |node| Field { key: list.key.clone(), node }.to_number(quantity);
            let values: Vec<f64> = nodes.iter().map(number).collect::<Result<_, _>>()?;
            if !values.is_empty() {
                doubt_absolute(&list, nominal, &values);
            }
            Shape::Table(values)
        }
        _ => {
            let problem = Problem::Choice { key: kind.key.clone(), written: kind.written("") };
            return Err(kind.error(problem, SHAPES));
        }
    })
}
