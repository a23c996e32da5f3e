//! Parameters that have one value in the whole production, which is not known.

use slipfit_tolerance::{
    number::ten_digits,
    unit::{self, Quantity},
};

use super::{
    Problem, SceneError,
    parameter::{Kind, Named},
    tree::Value,
    value::Field,
};
use crate::setup::{Adjustable, Belief, REACH, Uncertain};

/// What may be stated of a value that is not known.
const ALLOWED: &str = "[least, greatest], { mean, deviation } or { median, factor }: values of the parameter itself, not deviations from it";
const FACTOR: Quantity = Quantity { units: unit::ONE, range: [1.0, 1000.0] };

/// Reads what is known of the `named` parameters of a scene, which states values of its own.
pub(super) fn uncertain<P: Adjustable>(named: Vec<Named<P>>, scene: &P::Of) -> Result<Vec<Uncertain<P>>, SceneError> {
    let read = |named: Named<P>| {
        let Named { parameter, name, kind, field } = named;
        let belief = belief(&field, kind)?;
        let shown_in = kind.shown_in();
        let values = parameter.values(scene);
        let is_one = values.windows(2).all(|pair| pair[0] == pair[1]);
        if !is_one || matches!(kind, Kind::Stiffness(None)) {
            let what = format!("`{}` of joints that differ in it", field.key);
            return Err(
                field.error(Problem::Unsupported { what }, "one value and one exponent for all joints with play")
            );
        }
        let [low, high] = belief.bounds();
        if let Some(stated) = values.first().filter(|stated| **stated < low || **stated > high) {
            let number = |value: f64| format!("{} {}", ten_digits(value / shown_in.size), shown_in.unit);
            let [stated, low, high] = [*stated, low, high].map(|value| number(value).trim_end().to_owned());
            field.warn(&format!(
                "the scene states {stated}, which `{}` holds to be impossible: {low} to {high}",
                field.key
            ));
        }
        Ok(Uncertain { parameter, name, belief, shown_in })
    };
    named.into_iter().map(read).collect()
}

/// What `field` says of a value of this `kind`.
fn belief(field: &Field, kind: Kind) -> Result<Belief, SceneError> {
    let wrong = |field: &Field, allowed: String| {
        field.error(Problem::OutOfRange { key: field.key.clone(), written: field.written("") }, allowed)
    };
    // That a value far from the middle makes no scene is a mistake of what states how far.
    let checked = |belief: Belief, width: &Field| {
        if belief.bounds().into_iter().all(|value| kind.allows(value)) {
            return Ok(belief);
        }
        let allowed = format!(
            "a width that leaves every value within {} up to {REACH} standard deviations from the middle",
            kind.limits()
        );
        Err(wrong(width, allowed))
    };
    match &field.node.value {
        Value::List(nodes) => {
            let [least, greatest] = &nodes[..] else {
                return Err(field.error(Problem::Length { key: field.key.clone(), found: nodes.len() }, ALLOWED));
            };
            let [least, greatest] = [least, greatest].map(|node| Field { key: field.key.clone(), node });
            let [low, high] = [kind.value(&least)?, kind.value(&greatest)?];
            if low >= high && !field.found().any() {
                return Err(wrong(field, "a least value that is below the greatest, such as [0.2, 0.3]".into()));
            }
            for (end, value) in [(&least, low), (&greatest, high)] {
                if !kind.allows(value) && !field.found().any() {
                    return Err(wrong(end, kind.limits()));
                }
            }
            Ok(Belief::Between([low, high]))
        }
        Value::Table(_) => {
            if let Some(of_median) = field.get("median") {
                let width = field.require(
                    "factor",
                    "more than 1: with 95 % the value is within median / factor and median · factor",
                )?;
                let (median, factor) = (kind.value(&of_median)?, width.to_number(&FACTOR)?);
                if median <= 0.0 {
                    return Err(wrong(&of_median, "more than 0".into()));
                }
                if factor == 1.0 {
                    return Err(wrong(&width, "more than 1".into()));
                }
                return checked(Belief::Factor { median, factor }, &width);
            }
            let mean = kind.value(&field.require("mean", ALLOWED)?)?;
            let width = field.require("deviation", "the standard deviation")?;
            let deviation = kind.value(&width)?;
            if deviation <= 0.0 {
                return Err(wrong(&width, "more than 0".into()));
            }
            checked(Belief::Normal { mean, deviation }, &width)
        }
        _ => Err(field.wrong_type(ALLOWED)),
    }
}
