//! Units worth a closer look.

use std::cmp::Ordering;

use super::{Unit, production::Production, unit::scene_of};
use crate::{
    dynamics::{
        film::{Film, film},
        outcome::Verdict,
        simulate::SimulateError,
    },
    scene::Scene,
};

/// The worst `count` units: of those that malfunction the ones that come least far; then those that need most force.
pub fn worst<G>(units: &[Unit<G>], count: usize) -> Vec<&Unit<G>> {
    let mut sorted: Vec<&Unit<G>> = units.iter().collect();
    sorted.sort_by(|one, other| {
        let key = |unit: &Unit<G>| (!unit.outcome.verdict.is_malfunction(), unit.outcome.end.z);
        let ((runs, z), (other_runs, other_z)) = (key(one), key(other));
        let by_travel = if runs { Ordering::Equal } else { z.total_cmp(&other_z) };
        runs.cmp(&other_runs).then(by_travel).then_with(|| {
            let force = |unit: &Unit<G>| unit.outcome.peak_force.unwrap_or(f64::NEG_INFINITY);
            force(other).total_cmp(&force(one))
        })
    });
    sorted.truncate(count);
    sorted
}

/// One unit for each thing that units do: of those that jam, crawl and run the one whose greatest force is in their middle.
pub fn one_of_each(units: &[Unit]) -> Vec<&Unit> {
    let middle = |verdict: Verdict| {
        let mut own: Vec<&Unit> = units.iter().filter(|unit| unit.outcome.verdict == verdict).collect();
        let force = |unit: &Unit| unit.outcome.peak_force.unwrap_or(f64::NEG_INFINITY);
        own.sort_by(|one, other| force(one).total_cmp(&force(other)).then(one.number.cmp(&other.number)));
        own.get(own.len() / 2).copied()
    };
    [Verdict::Jammed, Verdict::Crawls, Verdict::Runs].into_iter().filter_map(middle).collect()
}

/// The unit of this `number` in a `production` of `scene` at about `count` moments.
///
/// # Errors
/// See [`SimulateError`].
pub fn filmed(scene: &Scene, production: &Production, number: u64, count: usize) -> Result<Film, SimulateError> {
    let (drawn, i) = production.draw_one(number);
    film(&scene_of(scene, &drawn, i), &drawn.gaps[i], count)
}
