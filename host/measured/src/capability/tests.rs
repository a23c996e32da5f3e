//! Intervals against the true production, and whole reports.
#![cfg(test)]

use proptest::prelude::*;
use slipfit_core::sampling::{
    normal::score,
    stream::{Rng, unit_stream},
};
use slipfit_tolerance::numeric::normal::tail;

use super::{CapabilityError, Estimate, Known, Options, Sample, capability};
use crate::{
    csv,
    families::Kind,
    table::{Column, MeasuredTable},
};

/// Repeats of which the slower interval, that of the failing share, is found.
const SHARES: u64 = 300;
const REPEATS: u64 = 1000;

/// How often intervals of mean, standard deviation, Ppk and failing share hold the truth of a normal production with limits
/// at two distances from the mean, in standard deviations; in per cent.
fn coverage(parts: usize, limits: [Option<f64>; 2]) -> [f64; 4] {
    let index = limits.iter().flatten().map(|limit| limit.abs() / 3.0).fold(f64::INFINITY, f64::min);
    let share: f64 = limits.iter().flatten().map(|limit| tail(limit.abs())).sum();
    let mut held = [0u64; 4];
    for repeat in 0..REPEATS {
        let mut stream = unit_stream(11, repeat);
        let values: Vec<Option<f64>> = (0..parts).map(|_| Some(score(stream.next_u64()))).collect();
        let known = Known::of(&Sample::new("a", &values).expect("a sample"));
        let mut count = |figure: usize, estimate: Estimate, truth: f64| {
            held[figure] += u64::from(estimate.interval[0] <= truth && truth <= estimate.interval[1]);
        };
        count(0, known.mean_estimate(), 0.0);
        count(1, known.deviation_estimate(), 1.0);
        count(2, known.indices(limits).least.expect("an index"), index);
        if repeat < SHARES {
            count(3, known.failing(limits).both.expect("a share"), share);
        }
    }
    let of = [REPEATS, REPEATS, REPEATS, SHARES];
    [0, 1, 2, 3].map(|i| 100.0 * held[i] as f64 / of[i] as f64)
}

#[test]
fn intervals_hold_in_95_per_cent() {
    for parts in [6, 30, 100] {
        for limits in [
            [None, Some(4.0)],
            [Some(-3.0), Some(3.0)],
            [Some(-3.0), Some(5.0)],
            [Some(-2.0), Some(2.2)],
            [Some(-1.0), Some(3.2)],
        ] {
            let held = coverage(parts, limits);
            assert!(held.iter().all(|held| (92.0..=98.0).contains(held)), "{parts} parts, {limits:?}: {held:?} %");
        }
    }
}

fn table(text: &str) -> MeasuredTable {
    csv::read(text.as_bytes(), &csv::Options { groups: vec!["cavity".into()], ..csv::Options::default() })
        .expect("a table")
}

/// Parts of two cavities with means 4 standard deviations apart, and one part that is far away.
fn two_cavities() -> MeasuredTable {
    let mut text = String::from("part,cavity,length [mm]\nnominal,,10\nlower,,9.9\nupper,,10.1\n");
    let mut stream = unit_stream(5, 0);
    for part in 0..80 {
        let (cavity, mean) = if part % 2 == 0 { ("A", 10.0) } else { ("B", 10.02) };
        let value = mean + 0.005 * score::<f64>(stream.next_u64());
        text += &format!("s{part},{cavity},{value:.4}\n");
    }
    table(&(text + "far,A,10.2\nlost,B,-\n"))
}

#[test]
fn subgroups_outliers_and_family_are_told() {
    let table = two_cavities();
    let found = capability(&table, 0, &Options { grouping: Some(0), ..Options::default() }).expect("capability");
    assert_eq!((found.count, found.missing), (81, 1));
    let [outlier] = &found.outliers[..] else { panic!("{:?}", found.outliers) };
    assert_eq!((outlier.label.as_str(), outlier.value), ("far", 10.2));
    assert_eq!(found.counted.map(|counted| counted.parts), Some([0, 1]));
    assert!(found.normality.is_some_and(|normality| normality.p < 1e-6));
    let within = found.within.as_ref().expect("subgroups");
    assert_eq!((within.freedom, within.groups[0].count, within.groups[1].count), (79, 41, 40));
    assert!(!found.distribution.stated && !found.distribution.allowed.is_empty());
    // The order of the rows and of the columns changes nothing.
    let json = serde_json::to_string(&found).expect("JSON");
    let again = csv::read(
        csv::write(&table).as_bytes(),
        &csv::Options { groups: vec!["cavity".into()], ..csv::Options::default() },
    );
    let again = capability(&again.expect("a table"), 0, &Options { grouping: Some(0), ..Options::default() });
    assert_eq!(json, serde_json::to_string(&again.expect("capability")).expect("JSON"));
}

#[test]
fn few_or_equal_parts_are_refused_with_what_is_needed() {
    let of = |values: &str| capability(&table(&format!("cavity,a\n{values}")), 0, &Options::default());
    assert_eq!(
        of("x,1\n").expect_err("few").to_string(),
        "\"a\" has 1 measured parts, but capability needs at least 2"
    );
    assert_eq!(
        of("x,1.5\nx,1.5\nx,1.5\n").expect_err("equal").to_string(),
        "all 3 measured parts have \"a\" 1.5; a finer reading is needed to tell its variation"
    );
    assert!(matches!(of("x,1e308\nx,-1e308\n"), Err(CapabilityError::TooFarApart { .. })));
    let six = table("cavity,a\nx,1\nx,2\nx,3\nx,4\nx,5\nx,6\n");
    let of_six = |family| capability(&six, 0, &Options { family, ..Options::default() });
    assert_eq!(
        of_six(None).expect_err("no family").to_string(),
        "\"a\": to choose a distribution takes 30 measured parts, but there are 6"
    );
    assert_eq!(
        of_six(Some(Kind::JohnsonSu)).expect_err("few").to_string(),
        "\"a\": johnson-su needs 30 measured parts, but there are 6"
    );
    let six = of_six(Some(Kind::Normal)).expect("capability");
    assert_eq!(six.tolerance_intervals[0].any_distribution, None);
    assert_eq!(six.tolerance_intervals[0].parts_for_any, 93);
}

proptest! {
    #[test]
    fn any_values_end(
        values in prop::collection::vec(prop_oneof![
            4 => any::<f64>().prop_filter("finite", |x| x.is_finite()).prop_map(Some),
            4 => (-5i32..5).prop_map(|x| Some(f64::from(x))),
            1 => Just(None)
        ], 1..45),
        lower in prop::option::of(-4.0f64..0.0),
        upper in prop::option::of(0.5f64..1e3),
    ) {
        let column = Column { name: "a".into(), values, limits: [lower, upper], ..Column::default() };
        let table = MeasuredTable::new(vec![column]).expect("a table");
        let _ = capability(&table, 0, &Options { family: Some(Kind::Normal), ..Options::default() });
    }
}
