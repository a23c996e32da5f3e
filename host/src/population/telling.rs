//! Units worth a closer look.

use super::{Unit, production::Production, slide::scene_of, tally::Tally};
use crate::{
    dynamics::{
        film::{Film, film},
        outcome::Verdict,
        simulate::SimulateError,
    },
    setup::Scene,
};

/// One unit for each thing that units do: of the first that jam, crawl and run, and have a run to show, the one whose greatest
/// force is in their middle.
pub fn one_of_each<G>(tally: &Tally<G>) -> Vec<&Unit<G>> {
    let middle = |verdict: Verdict| {
        let of_verdict = |unit: &&Unit<G>| unit.outcome.verdict == verdict && unit.outcome.fault.is_none();
        let mut own: Vec<&Unit<G>> = tally.first.iter().flatten().filter(of_verdict).collect();
        let force = |unit: &Unit<G>| unit.outcome.peak_force.unwrap_or(f64::NEG_INFINITY);
        own.sort_by(|one, other| force(one).total_cmp(&force(other)).then(one.number.cmp(&other.number)));
        own.get(own.len() / 2).copied()
    };
    [Verdict::Overruns, Verdict::Jammed, Verdict::Crawls, Verdict::Runs].into_iter().filter_map(middle).collect()
}

/// The unit of this `number` in a `production` of `scene` at about `count` moments.
///
/// # Errors
/// See [`SimulateError`].
pub fn filmed(scene: &Scene, production: &Production, number: u64, count: usize) -> Result<Film, SimulateError> {
    let (drawn, i) = production.draw_one(number);
    film(&scene_of(scene, &drawn, i), &drawn.gaps[i], count)
}
