//! Random stacks and assemblies, whose results are compared with plain sampling, with corners and a search inside, and with
//! themselves in other units, names, orders and frames, all of which is computed without slipfit.
//!
//! By default they take less than a minute. `SLIPFIT_RANDOM=N` compares N % as many, so that 10000 takes an hour or two;
//! `SLIPFIT_RANDOM_FROM=K` starts at number K, and `SLIPFIT_RANDOM_SHOWN=N` shows as many scenes that are wrong. A number is the
//! same scene on every machine.

mod assembly;
mod chance;
mod compare;
mod expected;
mod expression;
mod law;
mod rigid;
mod stack;
mod unchanged;

use rayon::prelude::*;
use slipfit::tolerance::sampling::sampler::Method;

use self::{
    assembly::Product,
    chance::{Chance, decimal},
    compare::{Deviations, compare, compare_assembly},
    expected::Units,
    stack::{Stack, Writing},
};

/// A number from the environment, or the default.
fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name} is {text}")))
}

/// Gives the measures of a stack limits that some of its units miss.
fn limit(stack: &mut Stack, chance: &mut Chance) {
    let units = Units::new(stack);
    let drawn: Vec<_> = (0..1000).map(|_| stack.values(&units.draw(chance))).collect();
    for (i, measure) in stack.measures.iter_mut().enumerate().skip(stack.dimensions.len()) {
        let scale = if measure.kind == expression::Kind::Angle { 180.0 / std::f64::consts::PI } else { 1.0 };
        let mut values: Vec<f64> = drawn.iter().map(|unit| unit[i] * scale).filter(|x| x.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        let width = values.last().copied().unwrap_or_default() - values.first().copied().unwrap_or_default();
        // A limit of a constant would lie on it.
        if values.len() < 100 || width < 1e-4 {
            continue;
        }
        let point = |rank: usize| values[rank * (values.len() - 1) / 1000];
        let low = chance.one_of(&[None, Some(values[0] - 0.3 * width), Some(point(10)), Some(point(200)), Some(0.0)]);
        let high =
            chance.one_of(&[None, Some(values[values.len() - 1] + 0.1 * width), Some(point(990)), Some(point(600))]);
        let [low, high] = [low, high].map(|limit| limit.map(|limit| decimal(limit, 5)));
        measure.limits = if low.zip(high).is_none_or(|(low, high)| low < high) { [low, high] } else { [low, None] };
    }
}

/// The stack number `number` and what is wrong with slipfit's results of it.
fn stack_checked(number: u64) -> (String, Vec<String>) {
    let mut chance = Chance::new(number, 1);
    let mut stack = Stack::random(&mut chance);
    limit(&mut stack, &mut chance);
    let text = Writing::plain(&stack.dimensions).text(&stack);
    let method =
        chance.one_of(&[Method::PseudoRandom, Method::PseudoRandom, Method::LatinHypercube, Method::ScrambledSobol]);
    let mut wrong = Deviations::default();
    compare(&stack, &text, method, &mut chance, &mut wrong);
    (text, wrong.all)
}

/// The assembly number `number` and what is wrong with slipfit's results of it.
fn assembly_checked(number: u64) -> (String, Vec<String>) {
    let mut chance = Chance::new(number, 2);
    let product = Product::random(&mut chance);
    let turned = [0, 1, 2].map(|_| chance.one_of(&[0.0, 0.0, 90.0, 37.0, -120.0]));
    let text = product.text(&Writing::plain(&[]), turned, [0, 1, 2].map(|_| chance.decimal(-200.0, 200.0, 0)));
    let method = chance.one_of(&[Method::PseudoRandom, Method::PseudoRandom, Method::ScrambledSobol]);
    let mut wrong = Deviations::default();
    compare_assembly(&product, &text, method, &mut chance, &mut wrong);
    (text, wrong.all)
}

/// The same of changes that change nothing.
fn unchanged(number: u64) -> (String, Vec<String>) {
    let mut chance = Chance::new(number, 3);
    let mut wrong = Deviations::default();
    if chance.happens(0.4) {
        let product = Product::random(&mut chance);
        unchanged::assembly(&product, &mut chance, &mut wrong);
        return (product.text(&Writing::plain(&[]), [0.0; 3], [0.0; 3]), wrong.all);
    }
    let mut stack = Stack::random(&mut chance);
    limit(&mut stack, &mut chance);
    unchanged::stack(&stack, &mut chance, &mut wrong);
    (Writing::plain(&stack.dimensions).text(&stack), wrong.all)
}

/// Runs `checked` of `count` numbers, or of the percentage of that which the environment says; panics with what is wrong.
fn all(checked: fn(u64) -> (String, Vec<String>), count: u64) {
    let (from, count) = (number("SLIPFIT_RANDOM_FROM", 0), (number("SLIPFIT_RANDOM", 100) * count).div_ceil(100));
    let failed: Vec<_> = (from..from + count)
        .into_par_iter()
        .map(|number| {
            // The next ones are compared all the same.
            let outcome = std::panic::catch_unwind(|| checked(number));
            (number, outcome.unwrap_or_else(|_| (String::new(), vec!["panics".into()])))
        })
        .filter(|(_, (_, wrong))| !wrong.is_empty())
        .collect();
    for (number, (text, wrong)) in failed.iter().take(number("SLIPFIT_RANDOM_SHOWN", 3) as usize) {
        println!("number {number}\n{text}\n{}\n", wrong.join("\n"));
    }
    for (number, (_, wrong)) in &failed {
        wrong.iter().for_each(|wrong| println!("{number}: {wrong}"));
    }
    assert!(failed.is_empty(), "{} of {count}", failed.len());
}

#[test]
fn random_stacks_agree_with_sampling_and_enumeration() {
    all(stack_checked, 40);
}

#[test]
fn random_assemblies_agree_with_sampling_and_corners() {
    all(assembly_checked, 20);
}

/// Assemblies whose searches have many hills, and one in which a wall leans so much that the order of its turns counts.
#[test]
fn assemblies_that_are_hard_to_search_agree() {
    for number in [1036, 1041, 1059, 1411, 1412] {
        let (text, wrong) = assembly_checked(number);
        assert!(wrong.is_empty(), "number {number}\n{text}\n{}", wrong.join("\n"));
    }
}

#[test]
fn units_names_order_and_frames_change_nothing() {
    all(unchanged, 30);
}
