//! Expressions operation by operation, which the faster ways are compared with.

use super::operation::{Expression, One, Operation, Source, Two};
use crate::numeric::lanes::Lanes;

/// An intermediate result: its value, the sum of the absolute values of all that it adds up, and whether it is constant.
#[derive(Clone, Copy)]
struct Sized {
    value: f64,
    size: f64,
    constant: bool,
}

/// By how much two ways to add up a linear expression may differ, for the unit in lane 0: 4·2⁻⁵³ an operation of the absolute
/// values that it adds up. `sizes` are those of the earlier measures, and the operations in them. Gives the same of this one.
pub(crate) fn bound(expression: &Expression, variables: &[Lanes], sizes: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let mut stack: Vec<Sized> = Vec::new();
    let mut operations = 1.0;
    for step in &expression.steps {
        operations += 1.0;
        let sized = match step.operation {
            Operation::Constant(value) => Sized { value, size: value.abs(), constant: true },
            Operation::Read(Source::Variable(i)) => {
                Sized { value: variables[i].0[0], size: variables[i].0[0].abs(), constant: false }
            }
            Operation::Read(Source::Measure(i)) => {
                operations += sizes[i][1];
                Sized { value: f64::NAN, size: sizes[i][0], constant: false }
            }
            Operation::One(one) => {
                let x = stack.pop().unwrap();
                let value = one.of(Lanes::splat(x.value)).0[0];
                Sized { value, size: if one == One::Negate { x.size } else { value.abs() }, constant: x.constant }
            }
            Operation::Two(two) => {
                let (b, a) = (stack.pop().unwrap(), stack.pop().unwrap());
                let value = two.of(Lanes::splat(a.value), Lanes::splat(b.value)).0[0];
                let constant = a.constant && b.constant;
                let size = match two {
                    _ if constant => value.abs(),
                    Two::Add | Two::Subtract => a.size + b.size,
                    Two::Multiply => a.size * b.size,
                    Two::Divide => a.size / b.size,
                    _ => value.abs(),
                };
                Sized { value, size, constant }
            }
        };
        stack.push(sized);
    }
    let size = stack.pop().unwrap().size;
    // And the least number that there is, for each.
    (operations * (4.0 * f64::EPSILON / 2.0 * size + 1e-320), [size, operations])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{
        super::{Affine, Kind, Source, parse},
        Lanes, bound,
    };
    use crate::{
        model::Function,
        numeric::lanes::LANES,
        product::function::{Formula, Measures},
    };

    const VARIABLES: usize = 5;

    /// Texts of expressions of variables `v0`, …, and measures `m0`, …, of which the first is linear.
    fn expressions() -> impl Strategy<Value = Vec<String>> {
        let constant = || prop_oneof![(-40..40i32).prop_map(|k| format!("{}", f64::from(k) / 8.0)), Just("pi".into())];
        let name = (0..VARIABLES).prop_map(|k| format!("v{k}"));
        let leaf = prop_oneof![constant(), name.clone(), name, (0..2usize).prop_map(|k| format!("m{k}"))];
        let any = leaf.clone().prop_recursive(5, 24, 2, |inner| {
            let pair = (inner.clone(), inner.clone());
            prop_oneof![
                (pair.clone(), prop::sample::select(vec!["+", "-", "*", "/", "^"]))
                    .prop_map(|((a, b), sign)| format!("({a} {sign} {b})")),
                (pair, prop::sample::select(vec!["min", "max"])).prop_map(|((a, b), name)| format!("{name}({a}, {b})")),
                (inner, prop::sample::select(vec!["-", "sqrt", "abs", "sin", "cos", "tan", "asin", "acos", "atan"]))
                    .prop_map(|(x, name)| format!("{name}({x})")),
            ]
        });
        let linear = leaf.prop_recursive(6, 32, 2, move |inner| {
            prop_oneof![
                (inner.clone(), inner.clone(), prop::sample::select(vec!["+", "-"]))
                    .prop_map(|(a, b, sign)| format!("({a} {sign} {b})")),
                (inner.clone(), constant(), prop::sample::select(vec!["*", "/"]))
                    .prop_map(|(a, c, sign)| format!("({a} {sign} ({c}))")),
                (inner, constant()).prop_map(|(a, c)| format!("-({c} * {a})")),
            ]
        });
        prop::collection::vec(prop_oneof![any, linear], 1..5)
    }

    proptest! {
        #[test]
        fn tape_and_product_give_what_operation_by_operation_does(
            texts in expressions(),
            values in prop::array::uniform5(prop::array::uniform8(-3.0..3.0f64)),
        ) {
            let variables = values.map(Lanes);
            let (mut function, mut affine, mut parsed) = (Measures::default(), Vec::new(), Vec::new());
            for text in ["v0 / 3 - 2 * (v1 - 0.125)", "v2 * v3 - sqrt(abs(v4))"].into_iter().chain(texts.iter().map(String::as_str)) {
                let resolve = |name: &str| {
                    let number = name.get(1..)?.parse().ok()?;
                    Some((if name.starts_with('v') { Source::Variable(number) } else { Source::Measure(number) }, Kind::PLAIN))
                };
                let Ok(expression) = parse(text, resolve) else { return Err(TestCaseError::reject("not parsed")) };
                affine.push(Affine::of(&expression, &affine));
                function.push(Formula::Expression(expression.clone()));
                parsed.push(expression);
            }
            let mut found = vec![Lanes::ZERO; parsed.len()];
            function.evaluate(&variables, &mut found);
            // With the measures that were found: no error adds up.
            let expected: Vec<_> = parsed.iter().map(|expression| expression.evaluate(&variables, &found)).collect();
            for lane in 0..LANES {
                let here = variables.map(|variable| Lanes::splat(variable.0[lane]));
                let mut sizes = Vec::new();
                for (i, expression) in parsed.iter().enumerate() {
                    let (bound, size) = bound(expression, &here, &sizes);
                    sizes.push(size);
                    let (found, expected) = (found[i].0[lane], expected[i].0[lane]);
                    // What is infinite has no value as a measure.
                    let same = found.to_bits() == expected.to_bits() || found.is_nan() && !expected.is_finite();
                    let near = affine[i].is_some() && (found - expected).abs() <= bound;
                    prop_assert!(same || near, "{found} {expected} {bound:e}");
                }
            }
        }
    }
}
