//! What is sought: parameters, levels of gaps, and the delay of a sensor.

use slipfit_tolerance::unit::{self, Quantity};

use crate::{
    identify::{Sought, SoughtValue},
    scene::{
        Problem, SceneError,
        parameter::{Kind, Named},
        tree::Value,
        value::Field,
    },
    setup::Adjustable,
};

const LEVEL: Quantity = Quantity { units: unit::ONE, range: [-100.0, 100.0] };
const DELAY: Quantity = Quantity { units: unit::SECONDS, range: [0.0, 10.0] };
const BOUNDS: &str = "a lower and a higher bound";

/// The gaps of a unit, by their indices.
pub struct Gaps<'a> {
    /// Their names.
    pub names: Vec<&'a str>,
    /// Whether one varies.
    pub varies: &'a dyn Fn(usize) -> bool,
    /// The levels at which one is possible.
    pub possible: &'a dyn Fn(usize) -> [f64; 2],
    /// Whether a name means one; `all` means every one.
    pub is_meant: &'a dyn Fn(&str, usize) -> bool,
    /// The names that mean gaps, for a message.
    pub groups: String,
}

/// The `named` parameters with their bounds, each in the list of the scene that `list` says.
pub fn parameters<P: Adjustable>(
    named: &[Named<P>],
    list: impl Fn(P) -> Option<&'static str>,
) -> Result<Vec<Sought<P>>, SceneError> {
    let read = |named: &Named<P>| {
        let Named { parameter, name, kind, field } = named;
        let (bounds, prior) = known(field, *kind)?;
        let value = SoughtValue::Parameter(*parameter);
        Ok(Sought { value, name: name.clone(), list: list(*parameter), unit: kind.si_unit(), bounds, prior })
    };
    named.iter().map(read).collect()
}

/// The bounds (SI) of a value of this `kind`, and what is known of it: `[low, high]`, or a table with `between`, `mean` and `deviation`.
fn known(field: &Field, kind: Kind) -> Result<([f64; 2], Option<[f64; 2]>), SceneError> {
    if !matches!(field.node.value, Value::Table(_)) {
        return Ok((bounds(field, kind)?, None));
    }
    let between = field.require("between", BOUNDS)?;
    let [low, high] = bounds(&between, kind)?;
    let mean = field.require("mean", "what the value is likely to be")?;
    let middle = kind.value(&mean)?;
    if !(low..=high).contains(&middle) {
        return Err(mean.out_of_range("", "a value between the bounds"));
    }
    let width = field.require("deviation", "the standard deviation of what is known")?;
    let deviation = kind.value(&width)?;
    if deviation <= 0.0 {
        return Err(width.out_of_range("", "more than 0"));
    }
    Ok(([low, high], Some([middle, deviation])))
}

/// Two bounds (SI) of a value of this `kind`.
fn bounds(field: &Field, kind: Kind) -> Result<[f64; 2], SceneError> {
    let Value::List(nodes) = &field.node.value else { return Err(field.wrong_type(BOUNDS)) };
    let [low, high] = &nodes[..] else {
        return Err(field.error(Problem::Length { key: field.key.clone(), found: nodes.len() }, BOUNDS));
    };
    kind.range(field, [low, high], BOUNDS)
}

/// The time by which the record lags behind, if it is sought.
pub fn delay<P>(table: &Field) -> Result<Option<Sought<P>>, SceneError> {
    let Some(field) = table.get("delay") else { return Ok(None) };
    let (bounds, prior) = known(&field, Kind::Number(&DELAY))?;
    Ok(Some(Sought { value: SoughtValue::Delay, name: "delay".into(), list: None, unit: "s", bounds, prior }))
}

/// The tolerance levels that are sought.
pub fn levels<P>(table: &Field, gaps: &Gaps) -> Result<Vec<Sought<P>>, SceneError> {
    let Some(list) = table.get("gaps") else { return Ok(Vec::new()) };
    const LIST: &str = "a list such as [{ of = \"all\", n = [-3, 3] }], or \"production\"";
    if let Value::Text(text) = &list.node.value {
        let found = of_production(gaps);
        return match (&text[..], found.is_empty()) {
            ("production", false) => Ok(found),
            ("production", true) => Err(list.no_effect("where no gap varies", "a scene with a gap that varies")),
            _ => Err(list.out_of_range("", LIST)),
        };
    }
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(LIST)) };
    let mut sought: Vec<Sought<P>> = Vec::new();
    for node in nodes {
        let entry = Field { key: list.key.clone(), node };
        entry.expect_table()?;
        let of = entry.require("of", "all, or the name of gaps")?;
        let name = of.to_text()?;
        let is_meant = |i: &usize| (gaps.varies)(*i) && (name == "all" || (gaps.is_meant)(name, *i));
        let meant: Vec<usize> = (0..gaps.names.len()).filter(is_meant).collect();
        if meant.is_empty() {
            let problem = Problem::UnknownName { of: "varying gap".into(), name: name.into() };
            return Err(of.error(problem, gaps.groups.clone()));
        }
        let is_taken = |other: &Sought<P>| matches!(&other.value, SoughtValue::Level(taken) if taken.iter().any(|one| meant.contains(one)));
        if sought.iter().any(is_taken) {
            let problem = Problem::Duplicate { key: of.key.clone(), name: name.into() };
            return Err(of.error(problem, "gaps of which none is sought twice"));
        }
        let n = entry.require("n", "a list of 2 levels")?;
        let (bounds, prior) = known(&n, Kind::Number(&LEVEL))?;
        let name = format!("n of {name}");
        sought.push(Sought { value: SoughtValue::Level(meant), name, list: None, unit: "", bounds, prior });
    }
    Ok(sought)
}

/// The level of every gap that varies, known beforehand as the production has it: normal about 0, with a deviation of 1,
/// each independent of the others.
fn of_production<P>(gaps: &Gaps) -> Vec<Sought<P>> {
    const FARTHEST: f64 = 5.0;
    let of = |i: usize| {
        let [low, high] = (gaps.possible)(i);
        Sought {
            value: SoughtValue::Level(vec![i]),
            name: format!("n of {}", gaps.names[i]),
            list: None,
            unit: "",
            bounds: [low.max(-FARTHEST), high.min(FARTHEST)],
            prior: Some([0.0, 1.0]),
        }
    };
    (0..gaps.names.len()).filter(|i| (gaps.varies)(*i)).map(of).collect()
}
