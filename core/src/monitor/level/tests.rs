//! The estimate beside another computation of it: all samples kept, in f64, every level tried.

use std::{string::ToString, vec::Vec};

use super::{BATCH, BankError, CHI_SQUARED, Estimate, LevelBank, TABLE_SAMPLES};
use crate::table::{AxisKind, MotionVerdict, Table, TableError, example, layout, verdict_bytes};

const LEVELS: u32 = 5;
const INSTANTS: u32 = 21;

/// The force (N) of a level at an instant, not linear in either.
fn force(level: u32, instant: u32) -> f32 {
    let (n, t) = (level as f32, instant as f32 / (INSTANTS - 1) as f32);
    1.0 + n * t + 0.15 * n * n * (1.0 - t) * (1.0 - t)
}

/// A table from level −1 on, 0.5 apart, over a second. All units run; its interpolation has the error `rms` (N).
fn bytes(rms: f32) -> Vec<u8> {
    let axes = [(AxisKind::Level, LEVELS, 0.5), (AxisKind::Time, INSTANTS, 1.0 / (INSTANTS - 1) as f32)];
    let mut bytes = example::table(&axes, |node| force(node / INSTANTS, node % INSTANTS));
    bytes[layout::AXES_AT + layout::AXIS_FIRST_AT..][..4].copy_from_slice(&(-1f32).to_le_bytes());
    for error in [layout::CHANNEL_WORST_AT, layout::CHANNEL_RMS_AT] {
        bytes[layout::CHANNELS_AT + error..][..4].copy_from_slice(&rms.to_le_bytes());
    }
    let body = bytes.len() - layout::CHECKSUM_SIZE;
    bytes.truncate(body - 8);
    bytes.extend(verdict_bytes(&[MotionVerdict::Runs; LEVELS as usize], 1));
    bytes.resize(body, 0);
    bytes.extend(layout::checksum(&bytes).to_le_bytes());
    bytes
}

/// Numbers from −1 to 1.
struct Noise(u32);

impl Noise {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / 8_388_608.0 - 1.0
    }
}

/// `count` samples of a unit of level `n`, with white noise and with noise that stays for 50 samples.
fn samples(table: &Table<'_>, n: f32, count: u32, [white, slow]: [f32; 2]) -> Vec<(f32, f32)> {
    let (mut noise, mut held) = (Noise(7), 0.0);
    (0..count)
        .map(|i| {
            let t = i as f32 / count as f32;
            if i.is_multiple_of(50) {
                held = slow * noise.next();
            }
            (t, table.lookup([n, t]).force + white * noise.next() + held)
        })
        .collect()
}

/// Level, deviation, interval and residual, from all samples at once.
fn estimated(table: &Table<'_>, samples: &[(f32, f32)], rms: f64) -> (f64, f64, [f64; 2], f64) {
    let residuals = |n: f64| samples.iter().map(move |(t, force)| f64::from(*force) - expected(table, n, *t));
    let sum = |n: f64| residuals(n).map(|residual| residual * residual).sum::<f64>();
    let levels: Vec<f64> = (0..=8000).map(|i| -1.0 + 2.0 * f64::from(i) / 8000.0).collect();
    let sums: Vec<f64> = levels.iter().map(|n| sum(*n)).collect();
    let best = (0..levels.len()).min_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap();
    let degrees = samples.len() as f64 - 1.0;
    let variance = sums[best] / degrees;
    // Of the nearest level of the table.
    let nearest = -1.0 + 0.5 * libm::round((levels[best] + 1.0) / 0.5);
    let all: Vec<f64> = residuals(nearest).collect();
    let batches = all.chunks_exact(BATCH as usize);
    let whole = batches.len() * BATCH as usize;
    let batches: f64 = batches.map(|batch| batch.iter().sum::<f64>()).map(|sum| sum * sum).sum();
    let squares: f64 = all.iter().map(|residual| residual * residual).sum();
    let together = if whole > 0 { batches * degrees / (whole as f64 * squares) } else { f64::from(BATCH) };
    let limit =
        sums[best] + f64::from(CHI_SQUARED) * (variance * together.max(1.0) + f64::from(TABLE_SAMPLES) * rms * rms);
    let within: Vec<f64> = levels.iter().zip(&sums).filter(|(_, sum)| **sum <= limit).map(|(n, _)| *n).collect();
    let interval = [within[0], within[within.len() - 1]];
    (levels[best], (interval[1] - interval[0]) / (2.0 * 1.959_964), interval, libm::sqrt(variance))
}

/// The table's force at a level and a time, in f64.
fn expected(table: &Table<'_>, n: f64, t: f32) -> f64 {
    let place = ((n + 1.0) / 0.5).clamp(0.0, f64::from(LEVELS - 1));
    let lower = libm::floor(place).min(f64::from(LEVELS - 2));
    let at = |level: f64| f64::from(table.lookup([(-1.0 + 0.5 * level) as f32, t]).force);
    at(lower) + (place - lower) * (at(lower + 1.0) - at(lower))
}

fn found(table: &Table<'_>, samples: &[(f32, f32)]) -> Option<Estimate> {
    let mut bank = LevelBank::<_, 8>::new(*table).unwrap();
    samples.iter().for_each(|(t, force)| bank.add(*t, *force));
    bank.estimate()
}

#[test]
#[cfg_attr(miri, ignore = "an interpreter has no time for so many levels")]
fn is_what_all_samples_at_once_say() {
    for (n, count, noise, rms) in [
        (0.27, 1000, [0.1, 0.0], 0.0),
        (-0.6, 1000, [0.2, 0.0], 0.01),
        (0.5, 700, [0.05, 0.15], 0.0),
        (0.93, 330, [0.1, 0.1], 0.02),
        (-0.2, 25, [0.3, 0.0], 0.0),
        (0.27, 25, [0.02, 0.0], 0.0),
        (-1.0, 500, [0.1, 0.0], 0.0),
        (1.0, 500, [0.1, 0.02], 0.005),
    ] {
        let bytes = bytes(rms);
        let table = Table::<2>::open(&bytes).unwrap();
        let samples = samples(&table, n, count, noise);
        let (level, deviation, interval, residual) = estimated(&table, &samples, rms.into());
        let found = found(&table, &samples).unwrap();
        let near = |found: f32, expected: f64| (f64::from(found) - expected).abs() < 2e-3 * (1.0 + expected.abs());
        assert!(near(found.level, level) && near(found.residual, residual), "{n}: {found:?} {level} {residual}");
        assert!(
            near(found.interval[0], interval[0]) && near(found.interval[1], interval[1]),
            "{n}: {found:?} {interval:?}"
        );
        assert!(near(found.deviation, deviation) || found.deviation == f32::INFINITY, "{n}: {found:?} {deviation}");
        // Any level would do only where the interval is the table.
        assert_eq!(found.deviation == f32::INFINITY, interval == [-1.0, 1.0], "{n}: {found:?} {interval:?}");
    }
}

#[test]
fn noise_beyond_all_levels_leaves_every_level_possible() {
    let bytes = bytes(0.0);
    let table = Table::<2>::open(&bytes).unwrap();
    let Estimate { deviation, interval, .. } = found(&table, &samples(&table, 0.0, 40, [50.0, 0.0])).unwrap();
    assert_eq!((deviation, interval), (f32::INFINITY, [-1.0, 1.0]));
}

#[test]
fn counts_the_samples_that_say_something() {
    let bytes = bytes(0.0);
    let table = Table::<2>::open(&bytes).unwrap();
    let mut bank = LevelBank::<_, 5>::new(table).unwrap();
    for i in 0..10 {
        assert_eq!(bank.estimate(), None, "{i}");
        bank.add(0.05 * i as f32, table.lookup([0.25, 0.05 * i as f32]).force);
        // Beyond what counts: in force, in time, and what is no number.
        for (time, force) in
            [(0.5, 1.001e6), (0.5, -1.001e6), (0.5, f32::NAN), (1.001, 1.0), (-0.001, 1.0), (f32::NAN, 1.0)]
        {
            bank.add(time, force);
        }
    }
    let Estimate { level, residual, .. } = bank.estimate().unwrap();
    assert!((level - 0.25).abs() < 1e-3 && residual < 1e-3, "{level} {residual}");
    // The greatest that counts does.
    bank.add(0.5, 1e6);
    assert!(bank.estimate().unwrap().residual > 1e5);
}

#[test]
fn banks_of_other_tables_are_refused_and_say_why() {
    let bytes = bytes(0.0);
    let table = Table::<2>::open(&bytes).unwrap();
    assert!(LevelBank::<_, 5>::new(table).is_ok());
    let error = LevelBank::<_, 4>::new(table).unwrap_err();
    assert_eq!(error, BankError::Levels { found: 5, most: 4 });
    assert_eq!(error.to_string(), "the table has 5 levels, allowed are at most 4");
    let over_position = example::table(&[(AxisKind::Level, 3, 1.0), (AxisKind::Position, 4, 0.1)], |_| 1.0);
    let error = LevelBank::<_, 5>::new(Table::open(&over_position).unwrap()).unwrap_err();
    assert!(matches!(error, BankError::Table(TableError::Kind { axis: 1, .. })), "{error:?}");
    assert!(error.to_string().starts_with("no table over tolerance level and time: "), "{error}");
}
