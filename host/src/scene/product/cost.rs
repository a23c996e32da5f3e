//! Reads what tolerances cost and what is required of measures.
//!
//! ```toml
//! [[dimension]]
//! name = "hub"
//! value = 55.29
//! tolerance = 0.1
//! cost = [                     # processes to choose from; or one, without the brackets
//!   { name = "grinding", fixed = 10, reciprocal = 0.015, range = [0.015, 0.08] },
//!   { name = "turning", fixed = 3.5, reciprocal = 0.75, range = [0.12, 0.25] },
//! ]
//!
//! [[measure]]
//! name = "gap"
//! require = "rss"              # or rss-off-centre, worst-case, { ppm = 100 }, { ppk = 1.33 }
//!
//! [allocate]
//! yield = 0.999                # share of units with all measures within their limits
//! malfunction = 0.01           # share of units that crawl, jam, or need more than force_limit (N)
//! ```
//!
//! A tolerance t costs fixed, fixed + reciprocal · (at/t)^power, or fixed + exponential · exp(−t/at). `at` is 1 mm (or 1°) and `power`
//! 1 unless they are stated. `range` has the tightest and the widest tolerance that the process holds; with `step` only every
//! so often between, with `grades` the standard tolerances of ISO 286 instead.

use slipfit_tolerance::{
    allocate::{
        cost::{Law, Process, Values},
        requirement::{Kind, Requirement},
    },
    model::{Contributor, Measure, Quantity as Measured, Variation},
    product::{
        costed::{Callout, Costed, Written},
        iso286,
    },
    unit::{self, Quantity},
};

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

use super::{quantity, tables::tables, toleranced::positive};

const MONEY: Quantity = Quantity { units: unit::ONE, range: [0.0, 1e12] };
const POWER: Quantity = Quantity { units: unit::ONE, range: [0.01, 10.0] };
const GRADE: Quantity = Quantity { units: unit::ONE, range: [1.0, 18.0] };
const PPM: Quantity = Quantity { units: unit::ONE, range: [1e-9, 999_999.0] };
const PPK: Quantity = Quantity { units: unit::ONE, range: [0.01, 10.0] };
const SHARE: Quantity = Quantity { units: unit::ONE, range: [1e-6, 0.5] };
const FORCE: Quantity = Quantity { units: unit::FORCE, range: [0.0, 1e9] };
const YIELD: Quantity = Quantity { units: unit::ONE, range: [1e-6, 1.0 - 1e-15] };
/// The most values of a process with steps.
const MOST_VALUES: f64 = 10_000.0;
const REQUIREMENTS: &str = "rss, rss-off-centre, worst-case, { ppm = 100 }, { ppk = 1.33 }";

/// Every tolerance in `root` that has a cost.
pub(super) fn costs(root: &Field, contributors: &[Contributor]) -> Result<Vec<Costed>, SceneError> {
    let mut found = Vec::new();
    for table in tables(root, "dimension")? {
        let place = Callout { part: None, feature: named(&table), key: None, nominal: None, frame: String::new() };
        collect(&table, place, contributors, &mut found)?;
    }
    for part in tables(root, "part")? {
        for kind in ["plane", "point", "axis"] {
            for feature in tables(&part, kind)? {
                let Value::Table(entries) = &feature.node.value else { continue };
                for entry in entries.iter().filter(|entry| matches!(entry.node.value, Value::Table(_))) {
                    let field = Field { key: format!("{}.{}", feature.key, entry.key), node: &entry.node };
                    let part = named(&part);
                    let frame = frame(&field, &part);
                    let (feature, key) = (named(&feature), Some(entry.key.clone().into_owned()));
                    let place = Callout { part: Some(part), feature, key, nominal: None, frame };
                    collect(&field, place, contributors, &mut found)?;
                }
            }
        }
    }
    Ok(found)
}

fn named(table: &Field) -> String {
    table.get("name").and_then(|name| name.to_text().ok().map(str::to_owned)).unwrap_or_default()
}

/// What follows the width of the zone in `table` on a drawing of `part`, whose own features are called by their short names.
fn frame(table: &Field, part: &str) -> String {
    let short = |field: &Field| field.to_text().map(|text| text.replace(&format!("{part}."), "")).unwrap_or_default();
    let datums = |key: &str| match table.get(key) {
        None => String::new(),
        Some(field) => match &field.node.value {
            Value::List(nodes) => nodes
                .iter()
                .map(|node| format!(" | {}", short(&Field { key: field.key.clone(), node })))
                .collect::<String>(),
            _ => format!(" | {}", short(&field)),
        },
    };
    let material = match table.get("material").as_ref().and_then(|material| material.to_text().ok()) {
        Some("maximum") => " (M)",
        Some("least") => " (L)",
        _ => "",
    };
    let within = table.get("within").map(|within| format!(", within {}{}", within.written(""), datums("within_datum")));
    format!("{material}{}{}", datums("datum"), within.unwrap_or_default())
}

/// Reads the cost of the tolerance in `table`, if it has one.
fn collect(
    table: &Field,
    place: Callout,
    contributors: &[Contributor],
    found: &mut Vec<Costed>,
) -> Result<(), SceneError> {
    let Some(cost) = table.get("cost") else { return Ok(()) };
    let (key, width) = match table.get("zone") {
        Some(zone) => ("zone", zone),
        None => ("tolerance", table.require("tolerance", "a tolerance to begin with")?),
    };
    refuse_shapes(table)?;
    let value = table.get("value");
    let measured = value.as_ref().map_or(Ok(Measured::Length), |value| quantity::of(table, value))?;
    let quantity = quantity::units(measured);
    let name = place.name();
    let (stated, form) = stated(&width, quantity, &name, value.as_ref(), contributors)?;
    let written = Written { key, ..form };
    let nominal = value.map(|value| value.to_number(quantity)).transpose()?;
    let size = nominal.filter(|_| measured == Measured::Length);
    let list = match &cost.node.value {
        Value::List(nodes) if nodes.is_empty() => {
            return Err(cost.error(Problem::Length { key: cost.key.clone(), found: 0 }, "one or more processes"));
        }
        Value::List(nodes) => nodes.iter().map(|node| Field { key: cost.key.clone(), node }).collect(),
        _ => vec![cost.clone()],
    };
    let processes = list.iter().map(|field| process(field, quantity, size)).collect::<Result<_, _>>()?;
    found.push(Costed {
        name,
        stated,
        processes,
        quantity: measured,
        written,
        callout: Callout { nominal, ..place },
        place: width.node.place.in_file(),
    });
    Ok(())
}

/// Distributions whose place and width the tolerance gives.
const SCALED: [&str; 6] = ["normal", "truncated-normal", "uniform", "triangular", "beta", "skewed"];

/// Refuses distributions with lengths of their own, which do not follow the tolerance.
fn refuse_shapes(table: &Field) -> Result<(), SceneError> {
    let Some(field) = table.get("distribution") else { return Ok(()) };
    let kind = field.get("kind").unwrap_or(field.clone());
    let own = ["mode", "mean", "shift", "deviation"];
    let fixed = !SCALED.contains(&kind.to_text()?) || own.iter().any(|key| field.get(key).is_some());
    if !fixed {
        return Ok(());
    }
    let problem = Problem::Unsupported { what: "a cost beside a distribution with lengths of its own".into() };
    Err(field.error(
        problem,
        "normal, truncated-normal, uniform, triangular, beta, skewed, without a mode, mean, shift or deviation",
    ))
}

/// The tolerance that the scene has, and how it is written.
fn stated(
    width: &Field,
    quantity: &Quantity,
    name: &str,
    value: Option<&Field>,
    contributors: &[Contributor],
) -> Result<(f64, Written), SceneError> {
    let plain = |unit, middle| {
        let unit: Option<&unit::Unit> = unit;
        let per_si = 1.0 / unit.unwrap_or(&quantity.units[0]).to_si(1.0);
        Written { key: "", unit: unit.map(|unit| unit.symbol), per_si, middle }
    };
    let unit_of = |field: &Field| {
        let text = field.measure("").ok()?.unit?;
        quantity.units.iter().find(|unit| unit.is(text))
    };
    match &width.node.value {
        Value::List(nodes) => {
            let [lower, upper] = width.to_numbers(quantity)?;
            let first = nodes.first().map(|node| Field { key: width.key.clone(), node });
            let unit = first.as_ref().and_then(unit_of);
            Ok((0.5 * (upper - lower), plain(unit, 0.5 * (lower + upper))))
        }
        Value::Text(text) if !text.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) => {
            // A class: what it comes to is known by now.
            let scalar = contributors.iter().find(|contributor| contributor.name == name);
            let limits = scalar.and_then(|contributor| match contributor.variation {
                Variation::Scalar { limits, .. } => Some(limits),
                _ => None,
            });
            let (Some([low, high]), Some(value)) = (limits, value) else {
                let problem = Problem::Choice { key: width.key.clone(), written: width.written("") };
                return Err(width.error(problem, "a tolerance in figures, beside a cost"));
            };
            let nominal = value.to_number(quantity)?;
            Ok((0.5 * (high - low), plain(None, 0.5 * (low + high) - nominal)))
        }
        _ => Ok((positive(width, quantity)?, plain(unit_of(width), 0.0))),
    }
}

/// Reads a process; `size` (m) is what grades are for.
fn process(table: &Field, quantity: &Quantity, size: Option<f64>) -> Result<Process, SceneError> {
    const ALLOWED: &str = "fixed = A alone, reciprocal = B: B·(at/t)^power, or exponential = B: B·exp(−t/at)";
    table.expect_table()?;
    let number =
        |key: &str, quantity, otherwise| table.get(key).map_or(Ok(otherwise), |f: Field| f.to_number(quantity));
    let fixed = number("fixed", &MONEY, 0.0)?;
    let unit = table.get("at").map_or(Ok(quantity.units[0].to_si(1.0)), |field| positive(&field, quantity))?;
    let law = match (table.get("reciprocal"), table.get("exponential")) {
        (Some(factor), None) => {
            Law::Reciprocal { fixed, factor: factor.to_number(&MONEY)?, unit, power: number("power", &POWER, 1.0)? }
        }
        (None, Some(factor)) => {
            if let Some(power) = table.get("power") {
                return Err(power.no_effect("beside `exponential`", ALLOWED));
            }
            Law::Exponential { fixed, factor: factor.to_number(&MONEY)?, unit }
        }
        (Some(_), Some(second)) => {
            return Err(second.error(Problem::Unsupported { what: "a cost by two laws".into() }, ALLOWED));
        }
        // A fixed price, whatever the tolerance.
        (None, None) if table.get("fixed").is_some() && ["at", "power"].iter().all(|key| table.get(key).is_none()) => {
            Law::Reciprocal { fixed, factor: 0.0, unit, power: 1.0 }
        }
        (None, None) => {
            return Err(table.error(Problem::Missing(format!("{}.reciprocal", table.key)), ALLOWED));
        }
    };
    let name = table.get("name").map(|name| name.to_text()).transpose()?.unwrap_or_default();
    Ok(Process { name: name.into(), law, values: values(table, quantity, size)? })
}

fn values(table: &Field, quantity: &Quantity, size: Option<f64>) -> Result<Values, SceneError> {
    const RANGE: &str = "the tightest and the widest tolerance that the process holds, such as [0.01, 0.05]";
    if let Some(field) = table.get("grades") {
        if let Some(ignored) = table.get("range").or(table.get("step")) {
            return Err(ignored.no_effect("beside `grades`", "a range, with or without a step, or grades"));
        }
        const ALLOWED: &str = "the finest and the coarsest grade of ISO 286, such as [6, 11], of a length up to 500 mm";
        let grades: [f64; 2] = field.to_numbers(&GRADE)?;
        let size = size.map_or(f64::NAN, |size| (size * 1e12).round() / 1e9);
        let wrong = || field.error(Problem::OutOfRange { key: field.key.clone(), written: field.written("") }, ALLOWED);
        if grades.iter().any(|grade| grade.fract() != 0.0) || grades[0] > grades[1] {
            return Err(wrong());
        }
        let half = |grade| Some(0.5e-6 * iso286::standard_tolerance(size, grade)?);
        let list: Option<Vec<f64>> = (grades[0] as usize..=grades[1] as usize).map(half).collect();
        return list.map(Values::List).ok_or_else(wrong);
    }
    let field = table.require("range", RANGE)?;
    let [low, high] = field.to_numbers(quantity)?;
    if !(low > 0.0 && low <= high) {
        return Err(field.error(Problem::OutOfRange { key: field.key.clone(), written: field.written("") }, RANGE));
    }
    let Some(step) = table.get("step") else { return Ok(Values::Range([low, high])) };
    let width = positive(&step, quantity)?;
    let count = libm::floor((high - low) / width * (1.0 + 1e-12));
    if count > MOST_VALUES {
        return Err(step.out_of_range(quantity.units[0].symbol, format!("at most {MOST_VALUES} steps in the range")));
    }
    Ok(Values::List((0..=count as usize).map(|k| low + width * k as f64).collect()))
}

/// Every requirement in `root` of its `measures`.
pub(super) fn requirements(root: &Field, measures: &[Measure]) -> Result<Vec<Requirement>, SceneError> {
    let mut found = Vec::new();
    for (i, table) in tables(root, "measure")?.iter().enumerate() {
        let Some(field) = table.get("require") else { continue };
        let kind = kind(&field)?;
        if measures.get(i).is_some_and(|measure| measure.limits == [None; 2]) {
            let problem = Problem::Missing(format!("{}.lower", table.key));
            return Err(field.error(problem, "a lower or an upper limit, of which something is required"));
        }
        found.push(Requirement { measure: Some(i), kind });
    }
    if let Some(table) = root.get("allocate") {
        table.expect_table()?;
        if let Some(field) = table.get("yield") {
            let share = field.to_number(&YIELD)?;
            found.push(Requirement { measure: None, kind: Kind::Defects(1.0 - share) });
        }
        let force_limit = table.get("force_limit");
        if let Some(field) = table.get("malfunction") {
            let allowed = field.to_number(&SHARE)?;
            let force_limit = force_limit.map(|limit| positive(&limit, &FORCE)).transpose()?;
            found.push(Requirement { measure: None, kind: Kind::Malfunction { allowed, force_limit } });
        } else if let Some(limit) = force_limit {
            let problem = Problem::Missing(format!("{}.malfunction", table.key));
            return Err(
                limit.error(problem, "the share of units that may malfunction, such as 0.01, beside a force limit")
            );
        }
    }
    Ok(found)
}

fn kind(field: &Field) -> Result<Kind, SceneError> {
    let choice = || {
        let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
        field.error(problem, REQUIREMENTS)
    };
    match &field.node.value {
        Value::Text(text) => match &**text {
            "rss" => Ok(Kind::Rss),
            "rss-off-centre" => Ok(Kind::RssOffCentre),
            "worst-case" => Ok(Kind::WorstCase),
            _ => Err(choice()),
        },
        Value::Table(_) => match (field.get("ppm"), field.get("ppk")) {
            (Some(ppm), None) => Ok(Kind::Defects(ppm.to_number(&PPM)? * 1e-6)),
            (None, Some(ppk)) => Ok(Kind::Ppk(ppk.to_number(&PPK)?)),
            _ => Err(field.wrong_type(REQUIREMENTS)),
        },
        _ => Err(field.wrong_type(REQUIREMENTS)),
    }
}
