//! Parameters with one unknown value in the whole production.

use slipfit_tolerance::{
    number::ten_digits,
    product::correlation,
    unit::{self, Quantity},
};

use super::{
    Problem, SceneError,
    parameter::{Kind, Named},
    tree::Value,
    value::Field,
};
use crate::setup::{Adjustable, Belief, REACH, Uncertain};

/// What may be stated of an unknown value.
const ALLOWED: &str = "[least, greatest], { mean, deviation } or { median, factor }: values of the parameter itself, not deviations from it";
const COEFFICIENT: Quantity = Quantity { units: unit::ONE, range: [-1.0, 1.0] };
const FACTOR: Quantity = Quantity { units: unit::ONE, range: [1.0, 1000.0] };

/// Reads what is known of the `named` parameters of a scene, which states values of its own, and how they are correlated.
pub(super) fn uncertain<P: Adjustable>(
    root: &Field,
    named: Vec<Named<P>>,
    scene: &P::Of,
) -> Result<Vec<Uncertain<P>>, SceneError> {
    let read = |named: Named<P>| {
        let Named { parameter, name, kind, field } = named;
        let belief = belief(&field, kind)?;
        let shown_in = kind.shown_in();
        let values = parameter.values(scene);
        let is_one = values.windows(2).all(|pair| pair[0] == pair[1]);
        if !is_one || matches!(kind, Kind::Stiffness(None)) {
            let what = format!("`{}` whose values differ in the scene", field.key);
            return Err(field.error(
                Problem::Unsupported { what },
                "one value wherever the scene has it, and one exponent for all joints with play",
            ));
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
        Ok(Uncertain { parameter, name, belief, shown_in, weights: Vec::new() })
    };
    let mut unknown = named.into_iter().map(read).collect::<Result<Vec<_>, SceneError>>()?;
    if let Some(list) = root.get("uncertain").and_then(|table| table.get("correlation")) {
        let names: Vec<String> = unknown.iter().map(|one| one.name.clone()).collect();
        let coefficients = correlations(&list, &names)?;
        let factor = correlation::factor(names.len(), &coefficients).ok_or_else(|| {
            list.error(Problem::NotPositiveDefinite, "coefficients that can belong to random numbers")
        })?;
        unknown.iter_mut().zip(factor).enumerate().for_each(|(k, (own, row))| own.weights = row[..=k].to_vec());
    }
    Ok(unknown)
}

/// The pairs of the tables in `list`, each of two of the unknowns `names`: row, column, coefficient.
fn correlations(list: &Field, names: &[String]) -> Result<Vec<(usize, usize, f64)>, SceneError> {
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type("tables [[uncertain.correlation]]")) };
    let mut found: Vec<(usize, usize, f64)> = Vec::new();
    for node in nodes {
        let table = Field { key: list.key.clone(), node };
        table.expect_table()?;
        let of = table.require("of", "a list of 2 unknowns by their names")?;
        let Value::List(pair) = &of.node.value else {
            return Err(of.wrong_type("a list of 2 unknowns by their names"));
        };
        let place = |node| {
            let field = Field { key: of.key.clone(), node };
            let name = field.to_text()?;
            names.iter().position(|known| known == name).ok_or_else(|| {
                let problem = Problem::UnknownName { of: "unknown".into(), name: name.into() };
                field.error(problem, names.join(", "))
            })
        };
        let [one, other] = &pair[..] else {
            return Err(of.error(Problem::Length { key: of.key.clone(), found: pair.len() }, "a list of 2 unknowns"));
        };
        let [one, other] = [place(one)?, place(other)?];
        let is_known =
            |(row, column, _): &(usize, usize, f64)| [*row, *column] == [one, other] || [*row, *column] == [other, one];
        if one == other || found.iter().any(is_known) {
            let problem = Problem::Duplicate { key: of.key.clone(), name: names[one].clone() };
            return Err(of.error(problem, "each pair of two unknowns once"));
        }
        found.push((one, other, table.number("coefficient", &COEFFICIENT)?));
    }
    Ok(found)
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
            let order = "a least value that is below the greatest, such as [0.2, 0.3]";
            Ok(Belief::Between(kind.range(field, [least, greatest], order)?))
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

#[cfg(test)]
mod tests {
    use crate::{
        mechanism::Mechanism,
        scene::{Override, SceneError, SceneFile, shipped},
        setup::{Adjustable, Belief, Scene},
    };

    fn file(name: &str, more: &str, set: &[&str]) -> Result<SceneFile, SceneError> {
        let text = format!("{}\n{more}", shipped(name).unwrap());
        let set: Vec<_> = set.iter().map(|text| Override::set(text)).collect();
        SceneFile::parse("scene.toml", &text, &set)
    }

    fn slide(more: &str, set: &[&str]) -> Scene {
        file("cd-rom-slide", more, set).unwrap_or_else(|error| panic!("{error}")).slide.unwrap()
    }

    fn mechanism(name: &str, more: &str) -> Mechanism {
        file(name, more, &[]).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap()
    }

    #[test]
    fn values_are_read_in_their_units() {
        let scene = slide(
            "[uncertain]\nfriction.coefficient = [0.2, 0.3]\nfriction.stick_band = { median = 0.1, factor = 3 }\n\
             contact.stiffness = { median = \"1e5 N/m^1.5\", factor = 3 }\nslide.mass = { mean = \"0.08 kg\", deviation = 1 }\n\
             slide.tilt_x = [-2, 2]\ndrive.ramp_end = [0.5, 1.5]\n",
            &[],
        );
        let of = |name: &str| scene.uncertain.iter().find(|one| one.name == name).unwrap();
        assert_eq!(of("friction.coefficient").belief, Belief::Between([0.2, 0.3]));
        assert_eq!(of("friction.stick_band").belief, Belief::Factor { median: 1e-4, factor: 3.0 });
        assert_eq!(of("contact.stiffness").belief, Belief::Factor { median: 1e5, factor: 3.0 });
        assert_eq!(of("contact.stiffness").shown_in.unit, "N/mm^1.5");
        assert_eq!(of("slide.mass").belief, Belief::Normal { mean: 0.08, deviation: 0.001 });
        // What is unknown is set, and varies about the value that is set.
        let (mut own, unknown) = (scene.clone(), of("slide.tilt_x"));
        unknown.parameter.set(&mut own, 0.1);
        unknown.parameter.vary(&mut own, -0.1);
        assert!((own.slide.gravity[1] - scene.slide.gravity[1]).abs() < 1e-12 && own.slide.gravity[2].abs() < 1e-12);
        of("contact.stiffness").parameter.set(&mut own, 1e5);
        of("contact.stiffness").parameter.vary(&mut own, 0.1);
        assert!((own.contact.stiffness - 1.1e5).abs() < 1e-6);
        assert_eq!(slide("", &["uncertain.friction.coefficient=[0.2, 0.3]"]).uncertain.len(), 1);
    }

    #[test]
    fn parameters_of_mechanisms_are_read() {
        let crank = mechanism(
            "slider-crank",
            "[uncertain]\ncontact.stiffness = { median = 3000, factor = 10 }\n[[uncertain.body]]\nname = \"slider\"\n\
             mass = [100, 300]\n[[uncertain.drive]]\nname = \"motor\"\nramp_end = [0.02, 0.2]\n",
        );
        let names: Vec<&str> = crank.uncertain.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["contact.stiffness", "slider.mass", "motor.ramp_end"]);
        let mut own = crank.clone();
        crank.uncertain[1].parameter.set(&mut own, 0.3);
        let body = own.bodies.iter().position(|body| body.name == "slider").unwrap();
        let [before, after] = [&crank, &own].map(|mechanism| &mechanism.bodies[body]);
        assert_eq!(after.mass, 0.3);
        assert!((after.inertia[2] / before.inertia[2] - 0.3 / before.mass).abs() < 1e-12);
    }

    #[test]
    fn a_stated_value_that_is_held_to_be_impossible_is_warned_of() {
        let warned = |range: &str| {
            let scene = slide(&format!("[uncertain]\nfriction.coefficient = {range}\n"), &[]);
            scene.warnings.iter().any(|warning| warning.contains("states 0.3, which") && warning.contains("0.1 to 0.2"))
        };
        assert!(warned("[0.1, 0.2]") && !warned("[0.2, 0.3]"));
    }

    #[test]
    fn what_cannot_be_is_an_error_at_its_place() {
        let refused = |name: &str, more: &str, at: &str, told: &str| {
            let error = file(name, &format!("[uncertain]\n{more}\n"), &[]).map(|_| ()).unwrap_err().to_string();
            let line = shipped(name).unwrap().lines().count() + 3;
            assert!(error.contains(told) && error.contains(&format!("scene.toml:{line}:{at}")), "{more}: {error}");
        };
        let slide = |more: &str, at: &str, told: &str| refused("cd-rom-slide", more, at, told);
        slide("friction.coefficient = [-0.1, 0.3]", "25", "0 to 100");
        slide("friction.coefficient = [0.3, 0.2]", "24", "below the greatest");
        slide("friction.coefficient = [0.3]", "24", "is a list of 1");
        slide("friction.coefficient = 0.3", "24", "values of the parameter itself");
        slide("friction.coefficient = { mean = 0.1, deviation = 0.03 }", "50", "within 0 to 100");
        slide("friction.coefficient = { mean = 0.1 }", "24", "`uncertain.friction.coefficient.deviation` is missing");
        slide("friction.coefficient = { median = 0.1, factor = 1 }", "49", "more than 1");
        slide("friction.coefficient = { median = 0.1, factor = 2, mean = 3 }", "52", "has no effect");
        slide("friction.coefficeint = [0.2, 0.3]", "10", "unknown key");
        slide("contact.stiffness = [\"1 N/mm\", 200]", "22", "`contact.exponent` is 1.5");
        slide("drive.ramp_end = [0.04, 1]", "19", "more than the ramp's start");
        slide("body = [{ name = \"slide\", mass = 1 }]", "8", "without a mechanism");
        refused("slider-crank", "slide.mass = [1, 2]", "", "in a mechanism");
    }
}
