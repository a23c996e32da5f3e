//! Reads measures and sums of them.

use slipfit_tolerance::{
    model::{Function, Measure, Quantity as Measured, Sum, loss::Loss},
    numeric::lanes::Lanes,
    product::{
        expression::{Expression, ExpressionError, Kind, Source, parse},
        feature::Shape,
        function::{Between, Formula, Measures},
    },
    unit::{self, Quantity},
};

use crate::scene::{Problem, SceneError, value::Field};

use super::{
    draft::Draft,
    quantity::units,
    tables::{name, tables, texts},
    toleranced,
};

const COST: Quantity = Quantity { units: unit::ONE, range: [0.0, 1e12] };

/// Reads every `[[measure]]` and adds its formula to `function`.
pub(super) fn measures(root: &Field, draft: &mut Draft, function: &mut Measures) -> Result<Vec<Measure>, SceneError> {
    let mut measures = Vec::new();
    for table in tables(root, "measure")? {
        let number = measures.len();
        measures.push(match measure(&table, number, draft, function) {
            Ok(measure) => measure,
            Err(error) => {
                table.found().note(error);
                stand_in(&table, number, draft, function)
            }
        });
    }
    if measures.is_empty() {
        return Err(root.error(Problem::Missing("measure".into()), "one or more tables [[measure]]"));
    }
    Ok(measures)
}

/// Reads the measure of this `number` and adds its formula to `function`.
fn measure(table: &Field, number: usize, draft: &mut Draft, function: &mut Measures) -> Result<Measure, SceneError> {
    let (name, name_field) = name(table)?;
    let formula = formula(table, draft, function)?;
    let quantity = formula.quantity();
    if let Formula::Expression(expression) = &formula {
        draft.used.extend(expression.variables());
    }
    function.push(formula);
    draft.name(&name_field, name, Source::Measure(number), Kind::of(quantity))?;
    let limits = limits(table, quantity)?;
    function.losses.push(loss(table, quantity, limits)?);
    Ok(Measure { name: name.into(), quantity, limits })
}

/// A constant in place of the measure of this `number`, which cannot be read: what uses its name is not wrong as well.
fn stand_in(table: &Field, number: usize, draft: &mut Draft, function: &mut Measures) -> Measure {
    let one = parse("1 mm", |_| None);
    if let (true, Ok(one)) = (function.count() == number, one) {
        function.push(Formula::Expression(one));
    }
    function.losses.resize(function.count(), None);
    let name = name(table);
    if let Ok((name, field)) = &name {
        // Another measure may have the name: then that stands for it.
        let _ = draft.name(field, name, Source::Measure(number), Kind::of(Measured::Length));
    }
    Measure {
        name: name.map_or_else(|_| String::new(), |(name, _)| name.into()),
        quantity: Measured::Length,
        limits: [None; 2],
    }
}

/// Reads the one of the keys `is`, `distance` and `angle` that a measure has.
fn formula(table: &Field, draft: &Draft, function: &Measures) -> Result<Formula, SceneError> {
    const ALLOWED: &str =
        "one of: is = \"an expression\", distance = [\"PART.FEATURE\", \"PART.FEATURE\"], angle = […]";
    let given: Vec<_> = ["is", "distance", "angle"].iter().filter_map(|key| Some((*key, table.get(key)?))).collect();
    let (key, field) = match &given[..] {
        [] => return Err(table.error(Problem::Missing(format!("{}.is", table.key)), ALLOWED)),
        [only] => only,
        [_, (_, second), ..] => {
            let problem = Problem::Unsupported { what: "a measure of two kinds".into() };
            return Err(second.error(problem, ALLOWED));
        }
    };
    if *key == "is" {
        return Ok(Formula::Expression(expression(field, draft, function)?));
    }
    let pair = texts(table, key, "a list of two features, PART.FEATURE")?;
    let [(_, one), (_, two)] = &pair[..] else {
        let problem = Problem::Length { key: field.key.clone(), found: pair.len() };
        return Err(field.error(problem, "a list of two features, PART.FEATURE"));
    };
    let (one, two) = (draft.feature(one)?, draft.feature(two)?);
    if *key == "angle" && [one, two].iter().any(|i| function.assembly.features[*i].shape == Shape::Point) {
        return Err(field.error(Problem::Unsupported { what: "an angle of a point".into() }, "planes and axes"));
    }
    let distance = || Between::distance(&function.assembly, one, two);
    Ok(Formula::Features(if *key == "angle" { Between::Angle(one, two) } else { distance() }))
}

/// Reads an expression of what `draft` and the measures of `function` so far name; finite at the nominal values.
fn expression(field: &Field, draft: &Draft, function: &Measures) -> Result<Expression, SceneError> {
    let text = field.to_text()?;
    let wrong = |error: ExpressionError| {
        let problem = Problem::Expression { key: field.key.clone(), fault: error.fault };
        field.error_within(error.place, problem, error.allowed)
    };
    let known =
        |name: &str| draft.names.iter().find(|(known, ..)| known == name).map(|(_, source, kind)| (*source, *kind));
    let expression = parse(text, known).map_err(wrong)?;
    let nominal: Vec<_> = draft.nominal.iter().map(|value| Lanes::splat(*value)).collect();
    let mut before = vec![Lanes::ZERO; function.count()];
    function.evaluate(&nominal, &mut before);
    expression.check(&nominal, &before).map_err(wrong)?;
    Ok(expression)
}

/// The keys `lower` and `upper`.
fn limits(table: &Field, quantity: Measured) -> Result<[Option<f64>; 2], SceneError> {
    let quantity = units(quantity);
    let (lower, upper) = (table.get("lower"), table.get("upper"));
    let value = |field: &Option<Field>| field.as_ref().map(|field| field.to_number(quantity)).transpose();
    let limits = [value(&lower)?, value(&upper)?];
    if let ([Some(low), Some(high)], Some(lower), Some(upper)) = (limits, lower, upper)
        && low >= high
    {
        let symbol = quantity.units[0].symbol;
        let (key, written) = (upper.key.clone(), upper.written(symbol));
        let problem = Problem::Limits { key, written, lower: lower.written(symbol) };
        return Err(upper.error(problem, "an upper limit above the lower one"));
    }
    Ok(limits)
}

/// The key `loss`. The target is the middle of the limits, and a unit at a limit has the full cost, unless they are stated.
fn loss(table: &Field, quantity: Measured, limits: [Option<f64>; 2]) -> Result<Option<Loss>, SceneError> {
    const AT: &str = "how far off the target a unit has that cost; or both limits";
    let Some(loss) = table.get("loss") else { return Ok(None) };
    loss.expect_table()?;
    let number = |key: &str| loss.get(key).map(|field| field.to_number(units(quantity))).transpose();
    let middle = limits[0].zip(limits[1]).map(|(lower, upper)| (0.5 * (lower + upper), 0.5 * (upper - lower)));
    let missing = |key: &str, allowed: &str| loss.error(Problem::Missing(format!("{}.{key}", loss.key)), allowed);
    let target = number("target")?.or(middle.map(|(middle, _)| middle));
    let target = target.ok_or_else(|| missing("target", "the best value; or both limits, whose middle it is"))?;
    let at = match loss.get("at") {
        Some(field) => toleranced::positive(&field, units(quantity))?,
        None => middle.map(|(_, half)| half).ok_or_else(|| missing("at", AT))?,
    };
    let cost =
        toleranced::positive(&loss.require("cost", "what a unit costs that is so far off, in any currency")?, &COST)?;
    let repair = loss.get("repair").map(|field| toleranced::positive(&field, &COST)).transpose()?;
    Ok(Some(Loss { cost, at, target, repair }))
}

/// Reads every `[[sum]]`.
pub(super) fn sums(root: &Field, measures: &[Measure]) -> Result<Vec<Sum>, SceneError> {
    const ALLOWED: &str = "a list of measures";
    let mut sums: Vec<Sum> = Vec::new();
    for table in tables(root, "sum")? {
        let (name, name_field) = name(&table)?;
        if sums.iter().any(|sum| sum.name == name) {
            let problem = Problem::Duplicate { key: name_field.key.clone(), name: name.into() };
            return Err(name_field.error(problem, "a name of its own for each sum"));
        }
        let mut indices = Vec::new();
        for (name, field) in texts(&table, "of", ALLOWED)? {
            let at = measures.iter().position(|measure| measure.name == name);
            let at = at.ok_or_else(|| {
                let names: Vec<_> = measures.iter().map(|measure| measure.name.as_str()).collect();
                field.error(Problem::UnknownName { of: "measure".into(), name: name.into() }, names.join(", "))
            })?;
            if indices.first().is_some_and(|first: &usize| measures[*first].quantity != measures[at].quantity) {
                let problem = Problem::Choice { key: field.key.clone(), written: name.into() };
                return Err(field.error(problem, "measures of one kind, such as lengths"));
            }
            indices.push(at);
        }
        if indices.is_empty() {
            let of = table.require("of", ALLOWED)?;
            return Err(of.error(Problem::Length { key: of.key.clone(), found: 0 }, ALLOWED));
        }
        sums.push(Sum { name: name.into(), measures: indices });
    }
    Ok(sums)
}
