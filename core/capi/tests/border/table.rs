//! Flash tables, and everything that takes one.

use std::ptr;

use proptest::prelude::*;
use slipfit_capi::*;
use slipfit_core::table::{AxisKind, MotionVerdict, Table, layout, motions, verdict_bytes};

use super::{SPECIAL, common::zeroed, slots::slots};

/// A table in f32 whose values count up: along each axis its nodes and their distance, from 0 on.
pub fn table_over(axes: &[(AxisKind, u32, f32)]) -> Vec<u8> {
    let nodes: u32 = axes.iter().map(|(_, count, _)| count).product();
    let mut bytes = Vec::from(*b"SLFT");
    bytes.extend([3, 0, axes.len() as u8, 1]);
    bytes.extend(7u64.to_le_bytes());
    let motions = motions(axes.iter().map(|(_, count, _)| *count as usize)).unwrap();
    let length = layout::HEADER_SIZE + (nodes as usize + 1) * 8 + motions.next_multiple_of(4) + layout::CHECKSUM_SIZE;
    bytes.extend((length as u32).to_le_bytes());
    for (kind, count, step) in axes {
        bytes.extend([*kind as u8, 0, 0, 0]);
        bytes.extend(count.to_le_bytes());
        bytes.extend([0.0, *step].map(f32::to_le_bytes).concat());
    }
    bytes.resize(layout::CHANNELS_AT, 0);
    bytes.extend([1.0f32, 0.0, 0.0, 1.0, 0.0, 0.0].map(f32::to_le_bytes).concat());
    bytes.extend((0..2 * nodes).flat_map(|i| (i as f32).to_le_bytes()));
    bytes.extend([0; 8]);
    // The last motion jams, the others run.
    let mut verdicts = vec![MotionVerdict::Runs; motions];
    verdicts[motions - 1] = MotionVerdict::Jammed;
    bytes.extend(verdict_bytes(&verdicts, axes.get(2).map_or(1, |(_, count, _)| *count as usize)));
    bytes.resize(length - layout::CHECKSUM_SIZE, 0);
    sealed(bytes)
}

/// A table over 3 levels and 4 instants.
pub fn table() -> Vec<u8> {
    table_over(&[(AxisKind::Level, 3, 1.0), (AxisKind::Time, 4, 0.1)])
}

/// The table with its checksum at the end.
pub fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(layout::checksum(&bytes).to_le_bytes());
    bytes
}

/// Everything that takes a table, with every number.
fn uses_of_a_table(bytes: &'static [u8], numbers: &[f32]) -> Result<slipfit_status, TestCaseError> {
    let mut table = zeroed::<slipfit_table>();
    let (mut monitor, mut bank) = (zeroed::<slipfit_monitor>(), zeroed::<slipfit_bank>());
    let (mut found, mut report, mut estimate) =
        (zeroed::<slipfit_lookup>(), zeroed::<slipfit_report>(), zeroed::<slipfit_estimate>());
    let (mut scrubber, mut rounds) = (zeroed::<slipfit_scrubber>(), 0);
    let at = |i: usize| numbers[i % numbers.len()];
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let opened = slipfit_table_open(&mut table, bytes.as_ptr(), bytes.len() as u32, SLIPFIT_AXIS_TIME, 7);
        let expected = if opened == SLIPFIT_OK { SLIPFIT_OK } else { SLIPFIT_NOT_MADE };
        for (i, n) in numbers.iter().enumerate() {
            prop_assert_eq!(slipfit_table_look_up(&table, *n, at(i + 1), &mut found), expected);
            prop_assert!(
                found.force.is_finite() && found.velocity.is_finite() && found.clamped.max(found.mixed) <= 1,
                "{found:?}"
            );
            let _ = slipfit_scrubber_init(&mut scrubber, &table);
            let _ = slipfit_scrubber_check(&mut scrubber, n.to_bits(), &mut rounds);
            let limits = slipfit_limits {
                period: at(i + 1),
                blind: at(i + 2),
                force_most: at(i + 3),
                hold: at(i + 4),
                smoothing: at(i + 5),
                band: at(i + 6),
                margin: at(i + 7),
                rise: at(i + 8),
            };
            let _ = slipfit_monitor_init(&mut monitor, &table, *n, &limits);
            let sample = slipfit_sample { time: *n, force: at(i + 1), speed: at(i + 2), command: at(i + 3) };
            if slipfit_monitor_step(&mut monitor, &sample, &mut report) == SLIPFIT_OK {
                prop_assert!(report.verdict <= SLIPFIT_NO_DATA && report.expected.is_finite(), "{report:?}");
            }
            let _ = slipfit_bank_init(&mut bank, &table);
            for k in 0..40 {
                let _ = slipfit_bank_add(&mut bank, at(i + k), at(i * k));
            }
            if slipfit_bank_estimate(&bank, &mut estimate) == SLIPFIT_OK {
                let slipfit_estimate { low, level, high, .. } = estimate;
                prop_assert!(low <= level && level <= high && low.is_finite() && high.is_finite(), "{estimate:?}");
                let adapted = slipfit_monitor_adapt(&mut monitor, &estimate);
                prop_assert!([SLIPFIT_OK, SLIPFIT_MONITOR_BAND, SLIPFIT_NOT_MADE].contains(&adapted), "{adapted}");
            }
        }
        Ok(opened)
    }
}

#[test]
fn special_numbers_in_every_call_with_a_table() {
    assert_eq!(uses_of_a_table(table().leak(), &SPECIAL).unwrap(), SLIPFIT_OK);
    // Within the table's grid too.
    assert_eq!(uses_of_a_table(table().leak(), &[0.1, 0.25, 1e-3, f32::NAN, 0.3, -0.0, 1e-45]).unwrap(), SLIPFIT_OK);
}

#[test]
fn every_short_length_is_refused() {
    let whole: &'static [u8] = table().leak();
    assert!(Table::<2>::open(whole).is_ok());
    for length in (0..whole.len()).step_by(if cfg!(miri) { 19 } else { 1 }) {
        let status = uses_of_a_table(&whole[..length], &[0.5]).unwrap();
        assert!([SLIPFIT_TABLE_TRUNCATED, SLIPFIT_TABLE_MAGIC].contains(&status), "{length}: {status}");
    }
}

#[test]
fn a_table_over_position_is_no_table_over_time() {
    assert_eq!([SLIPFIT_AXIS_TIME, SLIPFIT_AXIS_POSITION], [AxisKind::Time as u32, AxisKind::Position as u32]);
    let mut bytes = table_over(&[(AxisKind::Level, 3, 1.0), (AxisKind::Position, 4, 0.1)]);
    bytes.resize(bytes.len() + 8, 0xff);
    let bytes: &'static [u8] = bytes.leak();
    let length = bytes.len() as u32;
    let (mut table, mut found, mut spare) =
        (zeroed::<slipfit_table>(), zeroed::<slipfit_lookup>(), zeroed::<slipfit_spare>());
    let (mut monitor, mut bank, limits) =
        (zeroed::<slipfit_monitor>(), zeroed::<slipfit_bank>(), zeroed::<slipfit_limits>());
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let mut open = |over| {
            let opened = slipfit_table_open(&mut table, bytes.as_ptr(), length, over, 7);
            assert_eq!(slipfit_slots_open(&mut table, &slots(bytes, bytes, 1), over, 7, &mut spare), opened, "{over}");
            opened
        };
        assert_eq!(open(SLIPFIT_AXIS_TIME), SLIPFIT_TABLE_KIND);
        for none in [0, 1, 4, 5, u32::MAX] {
            assert_eq!(open(none), SLIPFIT_PARAMETER);
        }
        assert_eq!(open(SLIPFIT_AXIS_POSITION), SLIPFIT_OK);
        assert_eq!(slipfit_table_look_up(&table, 1.0, 0.1, &mut found), SLIPFIT_OK);
        assert_eq!(found, slipfit_lookup { force: 10.0, velocity: 11.0, clamped: 0, mixed: 0 });
        assert_eq!(slipfit_table_look_up(&table, 1.5, 0.1, &mut found), SLIPFIT_OK);
        assert_eq!(found, slipfit_lookup { force: 14.0, velocity: 15.0, clamped: 0, mixed: 1 });
        // What works on time does not take it.
        assert_eq!(slipfit_monitor_init(&mut monitor, &table, 1.0, &limits), SLIPFIT_TABLE_KIND);
        assert_eq!(slipfit_bank_init(&mut bank, &table), SLIPFIT_TABLE_KIND);
    }
}

#[test]
fn a_table_over_three_axes() {
    let axes = [(AxisKind::Level, 3, 1.0), (AxisKind::Position, 4, 0.1), (AxisKind::Velocity, 2, 0.05)];
    let bytes: &'static [u8] = table_over(&axes).leak();
    let length = bytes.len() as u32;
    let (mut plane, mut table) = (zeroed::<slipfit_table>(), zeroed::<slipfit_table3>());
    let (mut found, mut scrubber, mut rounds) = (zeroed::<slipfit_lookup>(), zeroed::<slipfit_scrubber>(), 0);
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let refused = slipfit_table_open(&mut plane, bytes.as_ptr(), length, SLIPFIT_AXIS_POSITION, 7);
        assert_eq!(refused, SLIPFIT_TABLE_AXES);
        assert_eq!(slipfit_table3_look_up(&table, 1.0, 0.1, 0.05, &mut found), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_scrubber_init3(&mut scrubber, &table), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_table3_open(&mut table, bytes.as_ptr(), length, 8), SLIPFIT_TABLE_SCENE);
        assert_eq!(slipfit_table3_open(&mut table, ptr::null(), length, 7), SLIPFIT_NULL);
        assert_eq!(slipfit_table3_open(&mut table, bytes.as_ptr(), length - 1, 7), SLIPFIT_TABLE_TRUNCATED);
        assert_eq!(slipfit_table3_open(&mut table, bytes.as_ptr(), length, 7), SLIPFIT_OK);
        assert_eq!(slipfit_table3_look_up(&table, 1.0, 0.1, 0.05, &mut found), SLIPFIT_OK);
        assert_eq!(found, slipfit_lookup { force: 22.0, velocity: 23.0, clamped: 0, mixed: 0 });
        assert_eq!(slipfit_table3_look_up(&table, 2.0, 0.1, 0.025, &mut found), SLIPFIT_OK);
        assert_eq!(found.mixed, 1);
        for special in SPECIAL {
            assert_eq!(slipfit_table3_look_up(&table, special, special, special, &mut found), SLIPFIT_OK);
            assert!(found.force.is_finite() && found.velocity.is_finite());
        }
        assert_eq!(slipfit_scrubber_init3(&mut scrubber, &table), SLIPFIT_OK);
        for _ in 0..4 {
            assert_eq!(slipfit_scrubber_check(&mut scrubber, length / 2, &mut rounds), SLIPFIT_OK);
        }
        assert_eq!(rounds, 2);
        let other = table_over(&[(AxisKind::Level, 3, 1.0), (AxisKind::Time, 4, 0.1), (AxisKind::Velocity, 2, 0.05)]);
        let other: &'static [u8] = other.leak();
        assert_eq!(slipfit_table3_open(&mut table, other.as_ptr(), length, 7), SLIPFIT_TABLE_KIND);
    }
}

#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn no_flip_in_an_open_table_gives_what_the_table_has_not() {
    // 128,320 bits of forces and velocities.
    let (levels, instants) = (5u32, 401u32);
    let mut bytes = table_over(&[(AxisKind::Level, levels, 1.0), (AxisKind::Time, instants, 0.01)]);
    let nodes = levels * instants;
    // Forces and velocities of the order of those of a drive, and of either sign.
    for (place, word) in bytes[layout::HEADER_SIZE..].chunks_exact_mut(4).take(2 * nodes as usize).enumerate() {
        word.copy_from_slice(&(3.0 * ((place * 37 % 193) as f32 / 96.0 - 1.0)).to_le_bytes());
    }
    bytes.truncate(bytes.len() - layout::CHECKSUM_SIZE);
    let bytes = sealed(bytes).leak();
    let (start, length) = (bytes.as_mut_ptr(), bytes.len() as u32);
    let (mut table, mut found) = (zeroed::<slipfit_table>(), zeroed::<slipfit_lookup>());
    let (mut flips, mut flagged) = (0, 0);
    // SAFETY: every pointer is to a local of its type or into the bytes, which only this test uses.
    unsafe {
        assert_eq!(slipfit_table_open(&mut table, start, length, SLIPFIT_AXIS_TIME, 7), SLIPFIT_OK);
        for node in 0..nodes {
            let at = [(node / instants) as f32, (node % instants) as f32 * 0.01];
            for bit in 0..64 {
                let byte = start.add(layout::HEADER_SIZE + 8 * node as usize + bit / 8);
                *byte ^= 1 << (bit % 8);
                let status = slipfit_table_look_up(&table, at[0], at[1], &mut found);
                let words = [found.force, found.velocity];
                assert!(words.iter().all(|word| word.abs() <= 3.000_01), "{node} {bit} {found:?}");
                assert!([SLIPFIT_OK, SLIPFIT_TABLE_VALUE].contains(&status), "{node} {bit} {status}");
                flips += 1;
                flagged += u32::from(status != SLIPFIT_OK);
                *byte ^= 1 << (bit % 8);
            }
            assert_eq!(slipfit_table_look_up(&table, at[0], at[1], &mut found), SLIPFIT_OK);
        }
    }
    assert_eq!(flips, 128_320);
    assert!(flagged > 2000, "{flagged}");
}

proptest! {
    #![proptest_config(super::cases())]

    #[test]
    fn any_table_is_refused_or_gives_finite_numbers(
        changes in prop::collection::vec((0usize..188, any::<u8>()), 0..4),
        numbers in prop::collection::vec(any::<f32>(), 1..12),
    ) {
        let mut bytes = table();
        bytes.truncate(bytes.len() - layout::CHECKSUM_SIZE);
        for (place, byte) in changes {
            bytes[place] = byte;
        }
        uses_of_a_table(sealed(bytes).leak(), &numbers)?;
    }
}
