//! Units worth a closer look.

use super::{Unit, tally::Tally};
use crate::dynamics::outcome::Verdict;

/// One unit for each thing that units do: of the first that jam, crawl and run, and have a run to show, the one whose greatest
/// force is in their middle.
pub fn one_of_each(tally: &Tally) -> Vec<&Unit> {
    let middle = |verdict: Verdict| {
        let of_verdict = |unit: &&Unit| unit.outcome.verdict == verdict && unit.outcome.fault.is_none();
        let mut own: Vec<&Unit> = tally.first.iter().flatten().filter(of_verdict).collect();
        let force = |unit: &Unit| unit.outcome.peak_force.unwrap_or(f64::NEG_INFINITY);
        own.sort_by(|one, other| force(one).total_cmp(&force(other)).then(one.number.cmp(&other.number)));
        own.get(own.len() / 2).copied()
    };
    [Verdict::Overruns, Verdict::Jammed, Verdict::Crawls, Verdict::Runs].into_iter().filter_map(middle).collect()
}
