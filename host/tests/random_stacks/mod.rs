//! Random stacks against sampling and enumeration of the test's own.

mod chance;
mod compare;
mod expected;
mod expression;
mod law;
mod stack;

use rayon::prelude::*;
use slipfit::tolerance::sampling::sampler::Method;

use self::{
    chance::{Chance, decimal},
    compare::{Deviations, compare},
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
        if values.len() < 100 {
            continue;
        }
        let width = values[values.len() - 1] - values[0];
        let point = |rank: usize| values[rank * (values.len() - 1) / 1000];
        let low = chance.one_of(&[None, Some(values[0] - 0.3 * width), Some(point(10)), Some(point(200)), Some(0.0)]);
        let high = chance.one_of(&[None, Some(values[values.len() - 1] + 0.1 * width), Some(point(990)), Some(point(600))]);
        let [low, high] = [low, high].map(|limit| limit.map(|limit| decimal(limit, 5)));
        measure.limits = if low.zip(high).is_none_or(|(low, high)| low < high) { [low, high] } else { [low, None] };
    }
}

/// The stack number `number` and what is wrong with slipfit's results of it.
fn stack_checked(number: u64) -> (String, Vec<String>) {
    let mut chance = Chance::new(number, 1);
    let mut stack = Stack::random(&mut chance);
    limit(&mut stack, &mut chance);
    let text = Writing::plain(&stack).text(&stack);
    let method = chance.one_of(&[Method::PseudoRandom, Method::PseudoRandom, Method::LatinHypercube, Method::ScrambledSobol]);
    let mut wrong = Deviations::default();
    compare(&stack, &text, method, &mut chance, &mut wrong);
    (text, wrong.all)
}

#[test]
fn random_stacks_agree_with_sampling_and_enumeration() {
    let (from, count) = (number("SLIPFIT_RANDOM_FROM", 0), number("SLIPFIT_RANDOM_STACKS", 200));
    let failed: Vec<_> = (from..from + count)
        .into_par_iter()
        .map(|number| (number, stack_checked(number)))
        .filter(|(_, (_, wrong))| !wrong.is_empty())
        .collect();
    for (number, (text, wrong)) in failed.iter().take(number("SLIPFIT_RANDOM_SHOWN", 3) as usize) {
        println!("stack {number}\n{text}\n{}\n", wrong.join("\n"));
    }
    for (number, (_, wrong)) in &failed {
        wrong.iter().for_each(|wrong| println!("{number}: {wrong}"));
    }
    assert!(failed.is_empty(), "{} of {count} stacks", failed.len());
}
