//! What the monitor and the bank make of a table whose units end differently, of its end, of dead sensors and of damage.

use std::vec::Vec;

use super::{Estimate, LevelBank, Limits, Monitor, MonitorError, Sample, Verdict, Watch};
use crate::table::{AxisKind, MotionVerdict, Table, example, layout, verdict_bytes};

const AXES: [(AxisKind, u32, f32); 2] = [(AxisKind::Level, 4, 1.0), (AxisKind::Time, 3, 0.5)];

/// Levels 0 to 3 over a second, of 1, 2, 3 and 80 N. The last one jams, the others run.
fn jams_at_three() -> Vec<u8> {
    let [_, runs, _, jammed] = MotionVerdict::ALL;
    judged(|level| if level < 3 { (1 + level) as f32 } else { 80.0 }, &[runs, runs, runs, jammed])
}

/// A table of so many levels as there are `verdicts`.
fn judged(force: impl Fn(u32) -> f32, verdicts: &[MotionVerdict; 4]) -> Vec<u8> {
    let mut bytes = example::table(&AXES, |node| force(node / 3));
    let body = bytes.len() - layout::CHECKSUM_SIZE;
    bytes.truncate(body - 4);
    bytes.extend(verdict_bytes(verdicts, 1));
    bytes.extend(layout::checksum(&bytes).to_le_bytes());
    bytes
}

/// Held for 9 samples of 1 ms.
fn limits() -> Limits {
    Limits { hold: 0.0085, margin: 0.1, rise: 1e6, ..Limits::for_noise(1e-3, 0.0) }
}

fn at(time: f32, force: f32) -> Sample {
    Sample { time, force, speed: 0.1, command: 0.1 }
}

/// The last verdict on `samples` of a unit of `level`.
fn last(bytes: &[u8], level: f32, samples: impl Iterator<Item = Sample>) -> Verdict {
    let monitor = Monitor::new(Table::open(bytes).unwrap(), level, limits()).unwrap();
    let mut watch = Watch::default();
    samples.map(|sample| monitor.step(&mut watch, &sample).verdict).last().unwrap()
}

#[test]
fn the_band_ends_where_units_end_differently() {
    let bytes = jams_at_three();
    let table = Table::<2>::open(&bytes).unwrap();
    // Half a level above 2.0 a lookup interpolates to 41.5 N, the force of no unit, and says so.
    assert!(table.lookup([2.5, 0.5]).mixed && table.lookup([2.5, 0.5]).force == 41.5);
    for level in [2.000_001, 2.5, 2.999] {
        let error = Monitor::new(table, level, limits()).unwrap_err();
        assert_eq!(error, MonitorError::Mixed { level, between: [2.0, 3.0] });
    }
    for (level, band) in [(0.0, 0.5), (1.25, 0.5), (1.75, 0.25), (2.0, 0.0), (3.0, 0.0)] {
        let monitor = Monitor::new(table, level, limits()).unwrap();
        let report = monitor.step(&mut Watch::default(), &at(0.5, 1.0));
        assert!((report.tightness.band - (band + 0.1)).abs() < 1e-6, "{level}: {report:?}");
    }
    // A unit of level 2 that needs 3.5 N instead of 3 N is tight, and one that needs 3.05 N is free.
    let stroke = |force| last(&bytes, 2.0, core::iter::repeat_n(at(0.5, force), 500));
    assert_eq!([3.05, 3.5].map(stroke), [Verdict::Free, Verdict::Tight]);
    // A band over several levels ends before the first that differs.
    let wide = Monitor::new(table, 0.25, Limits { band: 100.0, ..limits() }).unwrap();
    assert_eq!(wide.step(&mut Watch::default(), &at(0.5, 1.0)).tightness.band, 1.85);
}

#[test]
fn adapts_to_units_of_the_table_alone() {
    let bytes = jams_at_three();
    let mut monitor = Monitor::new(Table::open(&bytes).unwrap(), 2.0, Limits { band: 1.0, ..limits() }).unwrap();
    let mut adapts = |level, deviation| {
        let taken = monitor.adapt(&Estimate { level, deviation, interval: [0.0, 3.0], residual: 0.0 });
        assert_eq!(monitor.level() == level, taken, "{level} {deviation}");
        taken
    };
    for deviation in [-1.0, -f32::MIN_POSITIVE, -f32::INFINITY, f32::NAN, 1.1] {
        assert!(!adapts(1.5, deviation), "{deviation}");
    }
    assert!(!adapts(2.5, 0.1) && !adapts(2.01, 0.1));
    assert!(adapts(1.5, 0.0) && adapts(3.0, 0.1) && adapts(1.0, 1.0));
}

#[test]
fn beyond_the_tables_end_there_is_nothing_to_compare_with() {
    let bytes = jams_at_three();
    // Free to the end, then for the hold as before, then without data.
    let beyond = |more: u32| (0..=1000 + more).map(|i| at(i as f32 * 1e-3, 1.0));
    for (more, verdict) in [(0, Verdict::Free), (8, Verdict::Free), (9, Verdict::NoData), (5000, Verdict::NoData)] {
        assert_eq!(last(&bytes, 0.0, beyond(more)), verdict, "{more}");
    }
    // The end's force is no force of then: 9 N would be tight.
    let late = beyond(0).chain((1..9).map(|i| at(1.0 + i as f32 * 1e-3, 9.0)));
    assert_eq!(last(&bytes, 0.0, late), Verdict::Free);
    // A jam is one at any time.
    let standing = |i: u32| Sample { speed: 0.0, ..at(1.0 + i as f32 * 1e-3, 1.0) };
    assert_eq!(last(&bytes, 0.0, beyond(0).chain((1..40).map(standing))), Verdict::Jam);
}

#[test]
fn a_dead_sensor_is_no_data() {
    let bytes = jams_at_three();
    let good = at(0.5, 1.0);
    for dead in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for sample in [
            Sample { time: dead, ..good },
            Sample { force: dead, ..good },
            Sample { speed: dead, ..good },
            Sample { command: dead, ..good },
        ] {
            // It used to be free 1,099 times of 1,099.
            let monitor = Monitor::new(Table::open(&bytes).unwrap(), 0.0, limits()).unwrap();
            let mut watch = Watch::default();
            let verdicts: Vec<_> = (0..1099).map(|_| monitor.step(&mut watch, &sample).verdict).collect();
            assert!(verdicts[..8].iter().all(|verdict| *verdict != Verdict::NoData), "{sample:?}");
            assert!(verdicts[8..].iter().all(|verdict| *verdict == Verdict::NoData), "{sample:?}");
            assert_eq!(monitor.step(&mut watch, &good).verdict, Verdict::Free);
        }
    }
}

#[test]
fn the_bank_finds_units_of_the_table_alone() {
    let bytes = jams_at_three();
    let estimate = |bytes: &[u8], force: f32| {
        let mut bank = LevelBank::<_, 4>::new(Table::open(bytes).unwrap()).unwrap();
        // Noise of 0.1 N by turns; and later ones, which the table does not know.
        (0..1000).for_each(|i| bank.add(i as f32 * 1e-3, force + if i % 2 == 0 { 0.1 } else { -0.1 }));
        (0..1000).for_each(|i| bank.add(1.1 + i as f32 * 1e-3, 1e3));
        bank.estimate().unwrap()
    };
    // Between two units that run, any; between one that runs and one that jams, the nearer one.
    for (force, level) in [(1.0, 0.0), (2.3, 1.3), (3.0, 2.0), (5.0, 2.0), (41.0, 2.0), (42.0, 3.0), (80.0, 3.0)] {
        let Estimate { level: found, interval: [low, high], deviation, .. } = estimate(&bytes, force);
        assert!((found - level).abs() < 1e-3, "{force}: {found}");
        assert!(low <= found && found <= high && !(low > 2.0 && low < 3.0) && !(high > 2.0 && high < 3.0), "{force}");
        // A force that no level has may leave every level possible.
        assert!(deviation.is_finite() || (40.0..43.0).contains(&force), "{force}");
    }
    // A level between two that end differently counts by itself.
    let [undecided, runs, crawls, jammed] = MotionVerdict::ALL;
    for verdicts in [[runs, crawls, jammed, undecided], [jammed, runs, jammed, runs]] {
        let alone = judged(|level| (1 + level) as f32, &verdicts);
        for (force, level) in [(1.0, 0.0), (1.4, 0.0), (1.6, 1.0), (2.4, 1.0), (2.6, 2.0), (4.0, 3.0), (9.0, 3.0)] {
            let found = estimate(&alone, force);
            assert_eq!((found.level, found.interval), (level, [level; 2]), "{force}");
        }
    }
}
