//! Reads how a dimension is distributed.

use slipfit_tolerance::{
    number::fixed,
    product::dimension::{Component, Deviation, Mean, Shape, ShapeError, Spread, Toleranced},
    unit::{self, Quantity},
};

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

use super::defaults::SIGMA;

/// What may be stated of what has no size of its own, such as a part of a mixture.
const DEVIATION: &str = "± as one number or [lower, upper] deviations, of a length in mm, or texts with their units";
const WEIGHT: Quantity = Quantity { units: unit::ONE, range: [0.0, 1e6] };
/// The share of units outside of their own tolerance that is a mistake of the scene rather than a poor process.
const DOUBTFUL: f64 = 0.1;
const SKEWNESS: Quantity = Quantity { units: unit::ONE, range: [-10.0, 10.0] };
pub(in crate::scene) const SHAPES: &str = "normal, truncated-normal, uniform, triangular, trapezoidal, beta, skewed, lognormal, weibull, gumbel, \
                      gumbel-smallest, mixture, table, constant";
/// Beyond, moments are not finite enough to be computed.
const WEIBULL: Quantity = Quantity { units: unit::ONE, range: [0.5, 100.0] };
const BETA: Quantity = Quantity { units: unit::ONE, range: [0.1, 1000.0] };
const CPK: Quantity = Quantity { units: unit::ONE, range: [0.1, 10.0] };

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
pub(super) fn shape(table: &Field, quantity: &Quantity, sigma: f64, nominal: f64) -> Result<Shape, SceneError> {
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

/// A deviation as a part of the mixture of a dimension with the value `nominal` (SI), and alone.
pub(super) fn component(
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
pub(super) fn excess(tolerance: &Field) -> SceneError {
    let problem = Problem::Shape { key: tolerance.key.clone(), error: ShapeError::Excess };
    tolerance.error(problem, "no tolerance with this distribution")
}

/// Warns of a distribution that is far wider than its tolerance, or lies beside it.
pub(super) fn doubt(at: &Field, made: &Toleranced) {
    let outside = made.outside();
    if outside > DOUBTFUL {
        let percent = fixed(outside * 100.0, 0);
        at.warn(&format!("by `{}` {percent} % of the units are outside of the tolerance", at.key));
    }
}

/// Warns of numbers that count from the value of their dimension, `nominal` (SI), and are all nearer to it than to 0.
pub(super) fn doubt_absolute(field: &Field, nominal: f64, numbers: &[f64]) {
    if numbers.iter().all(|number| (number - nominal).abs() < number.abs()) {
        let key = &field.key;
        field.warn(&format!("`{key}` counts from `value`, and is nearer to `value` itself than to 0: is it absolute?"));
    }
}

/// Lower and upper deviation; `allowed` is all that may be written.
pub(super) fn deviations(field: &Field, quantity: &Quantity, allowed: &str) -> Result<[f64; 2], SceneError> {
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
