//! How often the intervals of every family hold the truth.
#![cfg(test)]

use super::{estimate::Estimate, points::figures, sample::Sample};
use crate::families::{
    Family, Kind,
    tests::{draw, examples},
};

/// Per cent of `repeats` samples in which the intervals of mean, standard deviation, Ppk and failing share hold the truth,
/// and the number of samples that have no intervals.
fn coverage(kind: Kind, family: &dyn Family, parts: usize, stated: bool, repeats: u64) -> ([f64; 4], u64) {
    // Half a per cent of the production is below its limits, and one per cent above.
    let limits = [0.005, 0.99].map(|probability| Some(family.quantile(probability)));
    let [low, middle, high] = super::SCORES.map(|score| family.value(score));
    let index =
        ((middle - family.quantile(0.005)) / (middle - low)).min((family.quantile(0.99) - middle) / (high - middle));
    let truths = [family.mean(), family.deviation(), index, 0.015];
    let (mut held, mut none) = ([0u64; 4], 0);
    for repeat in 0..repeats {
        let values: Vec<_> = draw(family, parts, 1000 + repeat).into_iter().map(Some).collect();
        let sample = Sample::new("a", &values).expect("a sample");
        let Ok((_, found)) = figures(&sample, stated.then_some(kind), limits) else {
            none += 1;
            continue;
        };
        let least = found.performance.least.expect("an index");
        let both = found.failing.both.expect("a share");
        for (k, Estimate { interval: [low, high], .. }) in
            [found.mean, found.deviation, least, both].into_iter().enumerate()
        {
            held[k] += u64::from(low <= truths[k] && truths[k] <= high);
        }
    }
    (held.map(|held| 100.0 * held as f64 / (repeats - none) as f64), none)
}

/// Families without the normal, whose intervals are exact and tested apart, with a distribution of each.
fn others() -> impl Iterator<Item = (Kind, Box<dyn Family>)> {
    examples().into_iter().filter(|(kind, _)| *kind != Kind::Normal)
}

fn is_near(held: [f64; 4], [least, most]: [f64; 2]) -> bool {
    held.iter().all(|held| (least..=most).contains(held))
}

#[test]
fn few_repeats_of_families_that_start_at_zero_hold() {
    for (kind, family) in others().filter(|(kind, _)| kind.parameters() == 2) {
        let (held, none) = coverage(kind, family.as_ref(), 6, true, 60);
        assert!(none == 0 && is_near(held, [85.0, 100.0]), "{kind}: {held:.1?} %");
    }
}

#[test]
#[ignore = "takes minutes"]
fn study_how_often_intervals_of_every_family_hold() {
    for (kind, family) in others() {
        for parts in [6, 30, 100].into_iter().filter(|parts| *parts >= kind.least_parts()) {
            let (held, none) = coverage(kind, family.as_ref(), parts, true, 300);
            println!("{kind} of {parts} parts: {held:.1?} %, {none} without");
            assert!(is_near(held, [92.0, 99.0]) && none <= 15, "{kind} of {parts} parts: {held:.1?} %, {none} without");
        }
    }
}

#[test]
#[ignore = "takes ten seconds"]
fn few_repeats_of_every_family_hold() {
    for (kind, family) in others() {
        let (held, none) = coverage(kind, family.as_ref(), kind.least_parts().max(30), true, 30);
        assert!(none <= 3 && is_near(held, [80.0, 100.0]), "{kind}: {held:.1?} %, {none} without");
    }
}

#[test]
#[ignore = "takes ten seconds"]
fn few_repeats_of_a_chosen_family_hold() {
    for (kind, family) in examples().into_iter().filter(|(kind, _)| kind.least_parts() <= 30) {
        let (held, none) = coverage(kind, family.as_ref(), 30, false, 10);
        assert!(is_near(held, [60.0, 100.0]), "{kind}: {held:.1?} %, {none} without");
    }
}

#[test]
#[ignore = "takes minutes"]
fn study_how_often_intervals_of_a_chosen_family_hold() {
    for (kind, family) in examples() {
        for parts in [30, 100] {
            let (held, none) = coverage(kind, family.as_ref(), parts, false, 60);
            println!("{kind} of {parts} parts: {held:.1?} %, {none} without");
            let least = if parts < kind.least_parts() { 0.0 } else { 90.0 };
            assert!(is_near(held, [least, 100.0]), "{kind} of {parts} parts: {held:.1?} %");
        }
    }
}
