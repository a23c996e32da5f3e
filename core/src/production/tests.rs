//! A production of two modes whose forces, limits and units are known in closed form.

use std::vec::Vec;

use super::{Production, ProductionError, Record, Report, Row, Sample, Stroke, StrokeEnd, Unit, Watch};
use crate::{
    monitor::Verdict,
    table::{AnyNodes, AxisKind, TableError, example},
};

/// Rows of the table.
const ROWS: u32 = 7;
/// Nodes over a stroke of 1 s.
const NODES: u32 = 101;
/// Time between samples (s).
const PERIOD: f32 = 1e-3;
/// The mean, and the two modes: constant, and one that is up in the first half and down in the second, so that they are orthogonal.
const MEAN: f32 = 2.0;
const MODES: [f32; 2] = [0.25, 0.125];
/// Widths above, below, and of taught units.
const WIDTHS: [f32; 3] = [0.5, 0.25, 1.0];
const WEIGHT: f32 = 1.0;

/// A stroke of a mode: 1, or its sign at the time `t`.
fn shape(mode: usize, t: f32) -> f32 {
    if mode == 1 && t >= 0.5 { -1.0 } else { 1.0 }
}

fn record() -> Record {
    let mut record = Record {
        moving: 0.2,
        period: PERIOD,
        noise: 0.0,
        friction: 0.03,
        completing: 0.9,
        units: 1000.0,
        band: 2.0,
        untaught: [1.0, 2.0, 3.0, 4.0, 5.0],
        taught: [2.0, 3.0, 4.0, 5.0, 6.0],
        drift: [2.5, 3.5, 4.0, 4.5, 5.0],
        deviation: 0.03,
        doubt: 1e6,
        // All of the force is friction.
        response: MEAN * WEIGHT,
        margin: 0.2,
        residual: 0.05,
        ..Record::default()
    };
    record.norms[..2].copy_from_slice(&[MODES[0] * MODES[0], MODES[1] * MODES[1]]);
    record.responses[..2].copy_from_slice(&[MODES[0] * WEIGHT, 0.0]);
    record.variances[..2].copy_from_slice(&[0.1, 0.5]);
    record
}

fn bytes_of(record: &Record) -> Vec<u8> {
    let force = |node: u32| {
        let (row, t) = (node / NODES, (node % NODES) as f32 * 0.01);
        match row as usize {
            0 => MEAN,
            row @ 1..=3 => WIDTHS[row - 1],
            4 => WEIGHT,
            row => MODES[row - 5] * shape(row - 5, t),
        }
    };
    let mut bytes = example::table(&[(AxisKind::Row, ROWS, 1.0), (AxisKind::Time, NODES, 0.01)], force);
    example::insert_record(&mut bytes, record.numbers());
    bytes
}

fn bytes() -> Vec<u8> {
    bytes_of(&record())
}

fn watch(bytes: &[u8], rate: f32) -> Watch<'_, AnyNodes<'_>> {
    Watch::new(Production::open(bytes).unwrap(), rate).unwrap()
}

/// A stroke with the given force over time, seen to the end.
fn seen(watch: &Watch<'_, AnyNodes<'_>>, unit: &Unit, force: impl Fn(f32) -> f32) -> (Stroke, Vec<Report>) {
    let mut stroke = watch.start();
    let samples = (0..=1000).map(|i| i as f32 * PERIOD);
    let reports =
        samples.map(|at| watch.step(unit, &mut stroke, &Sample { at, force: force(at), speed: 0.1, command: 0.1 }));
    let reports = reports.collect();
    (stroke, reports)
}

/// The force of a unit with these coefficients, whose friction is by a share higher in a stroke.
fn force_of(coefficients: [f32; 2], rise: f32) -> impl Fn(f32) -> f32 {
    move |t| {
        let modes = (0..2).map(|k| coefficients[k] * MODES[k] * shape(k, t)).sum::<f32>();
        (MEAN + modes) + rise * (MEAN + coefficients[0] * MODES[0])
    }
}

fn made(watch: &Watch<'_, AnyNodes<'_>>, unit: &mut Unit, coefficients: [f32; 2], rise: f32) -> StrokeEnd {
    let (stroke, _) = seen(watch, unit, force_of(coefficients, rise));
    watch.finish(unit, &stroke)
}

#[test]
fn every_flipped_bit_and_every_bad_number_is_refused() {
    let bytes = bytes();
    assert_eq!(Production::open(&bytes).unwrap().record(), &record());
    for bit in (0..bytes.len() * 8).step_by(if cfg!(miri) { 9973 } else { 13 }) {
        let mut flipped = bytes.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(Production::open(&flipped).is_err(), "{bit}");
    }
    let numbers = record().numbers().count();
    for bad in [f32::NAN, f32::INFINITY, -1e31] {
        for k in 0..numbers {
            let mut all: Vec<f32> = record().numbers().collect();
            all[k] = bad;
            let mut bytes = self::bytes();
            example::replace_record(&mut bytes, all.into_iter());
            assert!(matches!(Production::open(&bytes), Err(TableError::Header(_))), "{k} {bad}");
        }
    }
    // A table over levels is no production, and the other way round.
    let levels = example::table(&[(AxisKind::Level, 3, 1.0), (AxisKind::Time, 3, 1.0)], |node| node as f32);
    assert!(matches!(Production::open(&levels), Err(TableError::Kind { axis: 0, .. })));
    let hash = Production::open(&bytes).unwrap().expect_scene(8).map(drop);
    assert_eq!(hash, Err(TableError::Scene { found: example::SCENE }));
    assert!(Production::open(&bytes).unwrap().i16().is_none() && Production::open(&bytes).unwrap().f32().is_some());
}

#[test]
fn rows_and_band_are_those_of_the_table() {
    let bytes = bytes();
    let production = Production::open(&bytes).unwrap();
    assert_eq!((production.modes(), production.places().last()), (2, 1.0));
    assert_eq!(production.row(Row::Mean as usize, 0.305).unwrap()[0], MEAN);
    assert_eq!(production.row(Row::Mode as usize + 1, 0.7).unwrap()[0], -MODES[1]);
    assert_eq!(production.row(ROWS as usize, 0.1), None);
    assert_eq!(production.band(0.3), [MEAN - 2.0 * WIDTHS[1], MEAN + 2.0 * WIDTHS[0]]);
}

#[test]
fn three_strokes_teach_a_unit_and_more_of_them_shrink_less() {
    let bytes = bytes();
    let watch = watch(&bytes, 1e-3);
    let (mut unit, own) = (Unit::default(), [1.2, -0.8]);
    for strokes in 0..22u32 {
        let (_, reports) = seen(&watch, &unit, force_of(own, 0.0));
        assert_eq!((unit.strokes(), unit.is_taught()), (strokes.min(20), strokes >= 3));
        let expected = |t: f32| {
            // What is known by n strokes of the variances within units and between them.
            let n = strokes.min(20) as f32;
            let share = |within: f32| if n >= 3.0 { n * (1.0 - within) / (n * (1.0 - within) + within) } else { 0.0 };
            MEAN + share(0.1) * own[0] * MODES[0] + share(0.5) * own[1] * MODES[1] * shape(1, t)
        };
        for i in [100, 700] {
            let at = i as f32 * PERIOD;
            assert!((reports[i].own - expected(at)).abs() < 4e-3, "{strokes} {at} {} {}", reports[i].own, expected(at));
            assert_eq!(reports[i].verdict, Verdict::Free);
        }
        let end = made(&watch, &mut unit, own, 0.0);
        assert_eq!((end.verdict, end.is_learned), (Verdict::Free, strokes < 20));
        assert_eq!(end.deviation.is_finite(), strokes >= 3);
        assert!(end.rise.abs() < 1e-4, "{end:?}");
    }
}

#[test]
fn samples_may_be_few_or_many_but_not_missing() {
    let bytes = bytes();
    let watch = watch(&bytes, 1e-3);
    let force = force_of([1.0, 1.0], 0.0);
    let coefficients = |step: usize| {
        let (unit, mut stroke) = (Unit::default(), watch.start());
        for i in (0..=1000).step_by(step) {
            let at = i as f32 * PERIOD;
            let _ = watch.step(&unit, &mut stroke, &Sample { at, force: force(at), speed: 0.1, command: 0.1 });
        }
        let mut unit = Unit::default();
        let end = watch.finish(&mut unit, &stroke);
        (watch.coefficients(&stroke), end.verdict, unit.strokes())
    };
    for step in [1, 4, 20, 30] {
        let (found, verdict, strokes) = coefficients(step);
        // The jump of the second mode lies between two samples.
        let apart = step as f32 * PERIOD + 0.011;
        assert!((found[0] - 1.0).abs() < apart && (found[1] - 1.0).abs() < 4.0 * apart, "{step} {found:?}");
        assert_eq!((verdict, strokes), (Verdict::Free, 1));
    }
    // Gaps of more than four nodes.
    let (_, verdict, strokes) = coefficients(50);
    assert_eq!((verdict, strokes), (Verdict::NoData, 0));
    // Cut off.
    let (unit, mut stroke) = (Unit::default(), watch.start());
    for i in 0..900 {
        let at = i as f32 * PERIOD;
        let _ = watch.step(&unit, &mut stroke, &Sample { at, force: force(at), speed: 0.1, command: 0.1 });
    }
    assert_eq!(watch.finish(&mut Unit::default(), &stroke).verdict, Verdict::NoData);
}

#[test]
fn limits_follow_the_rate_and_the_direction() {
    let bytes = bytes();
    for (rate, untaught) in [(1e-2, 1.0), (1e-3, 2.0), (1e-6, 5.0), (3.162_277_7e-4, 2.5)] {
        let watch = watch(&bytes, rate);
        let excess = |by: f32, command: f32| {
            let (unit, mut stroke, mut last) = (Unit::default(), watch.start(), Report::default());
            for i in 0..400 {
                let at = i as f32 * PERIOD;
                let sample = Sample { at, force: MEAN + by, speed: command, command };
                last = watch.step(&unit, &mut stroke, &sample);
            }
            last
        };
        let limit = untaught * WIDTHS[0];
        assert!((excess(0.0, 0.1).limit - limit).abs() < 1e-5, "{rate} {}", excess(0.0, 0.1).limit);
        assert_eq!(excess(0.99 * limit, 0.1).verdict, Verdict::Free);
        assert_eq!(excess(1.01 * limit, 0.1).verdict, Verdict::Tight);
        assert_eq!(excess(-2.0 * limit, 0.1).verdict, Verdict::Free);
        // The other way it is the width below.
        let limit = untaught * WIDTHS[1];
        assert_eq!(excess(-0.99 * limit, -0.1).verdict, Verdict::Free);
        assert_eq!(excess(-1.01 * limit, -0.1).verdict, Verdict::Tight);
    }
    for rate in [0.0, 9e-7, 0.011, f32::NAN] {
        let refused = Watch::new(Production::open(&bytes).unwrap(), rate);
        assert!(matches!(refused, Err(ProductionError::Parameter(_))), "{rate}");
    }
}

#[test]
fn noise_widens_the_limits() {
    let noisy = bytes_of(&Record { noise: 1.0, ..record() });
    let watch = watch(&noisy, 1e-2);
    let (_, reports) = seen(&watch, &Unit::default(), |_| MEAN);
    // Smoothing over 20 samples leaves 1/39 of the variance.
    let expected = libm::sqrtf(WIDTHS[0] * WIDTHS[0] + 9.0 / 39.0);
    assert!((reports[500].limit - expected).abs() < 1e-5);
}

#[test]
fn a_rise_of_the_friction_is_found_and_never_learned() {
    let bytes = bytes();
    let watch = watch(&bytes, 1e-3);
    let own = [1.0, 0.5];
    let mut unit = Unit::default();
    for k in 0..20 {
        // 3 % up and down, whose mean is none.
        let rise = if k % 2 == 0 { 0.03 } else { -0.03 };
        assert_eq!(made(&watch, &mut unit, own, rise).verdict, Verdict::Free);
    }
    let reference = unit;
    // One stroke shows 13 %: 3.5 · 3 % · √(1 + 1/20) = 11 %.
    let end = made(&watch, &mut unit, own, 0.13);
    assert!((end.rise - 0.13).abs() < 0.003 && (end.deviation - 0.03 * libm::sqrtf(1.05)).abs() < 1e-6, "{end:?}");
    assert_eq!((end.verdict, end.is_learned), (Verdict::Tight, false));
    // 7 % shows in three: 3.5 · 3 % · √(1/3 + 1/20) = 6.5 %; in two it is 7.8 %.
    let mut unit = reference;
    let verdicts = [0; 3].map(|_| made(&watch, &mut unit, own, 0.07).verdict);
    assert_eq!(verdicts, [Verdict::Free, Verdict::Free, Verdict::Tight]);
    // A fall is none.
    let mut unit = reference;
    assert!((0..5).all(|_| made(&watch, &mut unit, own, -0.2).verdict == Verdict::Free));
    // While the reference grows: against the first three.
    let mut unit = Unit::default();
    for _ in 0..3 {
        let _ = made(&watch, &mut unit, own, 0.0);
    }
    let end = made(&watch, &mut unit, own, 0.2);
    assert_eq!((end.verdict, unit.strokes()), (Verdict::Tight, 3));
    assert!((end.deviation - 0.03 * libm::sqrtf(1.0 + 1.0 / 3.0)).abs() < 1e-6);
    let end = made(&watch, &mut unit, own, 0.0);
    assert_eq!((end.verdict, end.is_learned), (Verdict::Free, true));
}

#[test]
fn an_event_at_another_time_is_no_rise_of_the_friction() {
    let bytes = bytes();
    let watch = watch(&bytes, 1e-3);
    let mut unit = Unit::default();
    for _ in 0..20 {
        let _ = made(&watch, &mut unit, [0.0, 0.0], 0.0);
    }
    // 50 N for a twentieth of a stroke would be 1.25 of the friction; of these two widths of 1 N count.
    let (stroke, _) = seen(&watch, &unit, |t| if (0.5..0.55).contains(&t) { 52.0 } else { MEAN });
    let end = watch.finish(&mut unit, &stroke);
    assert!((end.rise - 0.1 / MEAN).abs() < 1e-3, "{end:?}");
    let (stroke, _) = seen(&watch, &unit, |t| if (0.5..0.55).contains(&t) { -48.0 } else { MEAN });
    assert!((watch.weighted(&stroke) + 0.1).abs() < 1e-3);
}

#[test]
fn wear_has_a_slope_and_an_end() {
    let bytes = bytes();
    let watch = watch(&bytes, 1e-6);
    let own = [0.0, 0.0];
    let mut unit = Unit::default();
    for _ in 0..20 {
        let _ = made(&watch, &mut unit, own, 0.0);
    }
    assert_eq!(unit.drift().trend().line(0.03), None);
    for k in 1..=40 {
        let _ = made(&watch, &mut unit, own, 0.001 * k as f32);
        assert_eq!(unit.drift().trend().line(0.03).is_some(), k >= 3, "{k}");
    }
    let line = unit.drift().trend().line(0.03).unwrap();
    assert!((line.slope / 0.001 - 1.0).abs() < 0.01 && (line.rise / 0.04 - 1.0).abs() < 0.01, "{line:?}");
    // Least squares over 40 strokes, all but equally weighted: σ·√(12/n³) = 0.41 ‰.
    let expected = 0.03 * libm::sqrtf(12.0 / (40.0 * 40.0 * 40.0));
    assert!((line.deviation / expected - 1.0).abs() < 0.1, "{line:?} {expected}");
    let [likely, soonest] = line.strokes_until(0.2);
    assert!((likely - 160.0).abs() < 3.0 && soonest < likely, "{likely} {soonest}");
    assert_eq!(line.strokes_until(0.03), [0.0; 2]);
    let falling = super::drift::Line { slope: -1.0, deviation: 0.1, ..line };
    assert_eq!(falling.strokes_until(0.2), [f32::INFINITY; 2]);
}

#[test]
fn what_a_stroke_tells_of_its_friction_is_expected_within_it() {
    let believing = bytes_of(&Record { doubt: 0.01, ..record() });
    let watch = watch(&believing, 1e-3);
    let mut unit = Unit::default();
    for _ in 0..20 {
        let _ = made(&watch, &mut unit, [0.0, 0.0], 0.0);
    }
    let (_, reports) = seen(&watch, &unit, force_of([0.0, 0.0], 0.05));
    for (i, report) in reports.iter().enumerate() {
        let t = i as f32 * PERIOD;
        // Of 0.1 N as much as t is of t and the doubt.
        let told = if i > 0 { 0.1 * (t - PERIOD) / (t - PERIOD + 0.01) } else { 0.0 };
        assert!((report.own - MEAN).abs() < 1e-5 && (report.expected - MEAN - told).abs() < 1e-3, "{i} {report:?}");
    }
    // Of a unit that is not taught it would tell where the unit differs.
    let (_, reports) = seen(&watch, &Unit::default(), force_of([0.0, 0.0], 0.05));
    assert!(reports.iter().all(|report| report.expected == report.own));
}

#[test]
fn jams_dead_sensors_and_the_end_are_told() {
    let bytes = bytes();
    let watch = watch(&bytes, 1e-3);
    let unit = Unit::default();
    let verdicts = |samples: &mut dyn Iterator<Item = Sample>| -> Vec<Verdict> {
        let mut stroke = watch.start();
        samples.map(|sample| watch.step(&unit, &mut stroke, &sample).verdict).collect()
    };
    let good = |i: usize| Sample { at: i as f32 * PERIOD, force: MEAN, speed: 0.1, command: 0.1 };
    // Where all move, ten samples below a tenth of the command are no jam, eleven are; before nothing is.
    let stop = |from: usize, speed: f32| {
        let sample = move |i: usize| if i >= from { Sample { speed, ..good(i) } } else { good(i) };
        verdicts(&mut (0..600).map(sample)).iter().position(|verdict| *verdict == Verdict::Jam)
    };
    assert_eq!(stop(300, 0.0), Some(310));
    assert_eq!((stop(300, 0.009), stop(300, -0.1), stop(300, 0.011)), (Some(310), Some(310), None));
    assert_eq!(stop(0, 0.0), Some(210));
    let rest = verdicts(&mut (0..600).map(|i| Sample { command: 0.0, speed: 0.0, ..good(i) }));
    assert!(!rest.contains(&Verdict::Jam));
    // Missing numbers neither count nor start anew.
    for dead in [f32::NAN, f32::INFINITY] {
        let without: [fn(f32, Sample) -> Sample; 4] = [
            |dead, sample| Sample { at: dead, ..sample },
            |dead, sample| Sample { force: dead, ..sample },
            |dead, sample| Sample { speed: dead, ..sample },
            |dead, sample| Sample { command: dead, ..sample },
        ];
        for without in without {
            let found = verdicts(&mut (0..400).map(|i| if i >= 300 { without(dead, good(i)) } else { good(i) }));
            assert_eq!(found.iter().position(|verdict| *verdict == Verdict::NoData), Some(310), "{dead}");
            let jam = |i: usize| {
                let stopped = Sample { speed: 0.0, ..good(i) };
                if i < 300 {
                    good(i)
                } else if i.is_multiple_of(2) {
                    without(dead, stopped)
                } else {
                    stopped
                }
            };
            let found = verdicts(&mut (0..400).map(jam));
            assert_eq!(found.iter().position(|verdict| *verdict == Verdict::Jam), Some(321), "{dead}");
        }
    }
    let found = verdicts(&mut [-0.5, 0.0, 1.0, 1.001, 2.0].into_iter().map(|at| Sample { at, ..good(0) }));
    assert_eq!(found, [Verdict::Blind, Verdict::Free, Verdict::Free, Verdict::Ended, Verdict::Ended]);
}

#[test]
fn what_strokes_tell_survives_a_reset() {
    let bytes = bytes();
    let watch = watch(&bytes, 1e-3);
    let mut unit = Unit::default();
    for k in 0..30 {
        let _ = made(&watch, &mut unit, [0.5, -0.25], 0.002 * k as f32);
        assert_eq!(Unit::from_bytes(&unit.to_bytes(7), 7), Ok(unit), "{k}");
    }
    assert!(size_of::<Unit>() + size_of::<Stroke>() <= 256);
}
