//! The watch by a production, and what is known of a unit.

use std::ptr;

use slipfit_capi::*;
use slipfit_core::{
    production::{Production, Record, Sample, Unit, Watch},
    table::{AxisKind, layout},
};

use super::{
    common::zeroed,
    table::{table, table_over},
};

/// A production of one mode over 1 s: all rows rise by 2 N from node to node, one after the other.
fn production() -> Vec<u8> {
    let mut record = Record {
        moving: 0.2,
        period: 1e-2,
        noise: 0.01,
        friction: 0.03,
        completing: 0.9,
        units: 1000.0,
        band: 1.0,
        untaught: [1.0, 2.0, 3.0, 4.0, 5.0],
        taught: [1.0, 2.0, 3.0, 4.0, 5.0],
        drift: [2.0, 3.0, 4.0, 5.0, 6.0],
        deviation: 0.03,
        doubt: 1.0,
        response: 1000.0,
        margin: 0.5,
        ..Record::default()
    };
    record.norms[0] = 1.2e6;
    let mut bytes = table_over(&[(AxisKind::Row, 6, 1.0), (AxisKind::Time, 101, 0.01)]);
    // All motions of a production run.
    let verdicts = bytes.len() - layout::CHECKSUM_SIZE - 8;
    bytes[verdicts..].fill(0);
    bytes[verdicts..verdicts + 6].fill(2);
    bytes.truncate(verdicts + 8);
    bytes.extend(record.numbers().flat_map(f32::to_le_bytes));
    let length = (bytes.len() + layout::CHECKSUM_SIZE) as u32;
    bytes[layout::LENGTH_AT..][..4].copy_from_slice(&length.to_le_bytes());
    bytes.extend(layout::checksum(&bytes).to_le_bytes());
    bytes
}

#[test]
fn a_unit_is_taught_watched_saved_and_loaded_as_in_rust() {
    let bytes: &'static [u8] = production().leak();
    let length = bytes.len() as u32;
    let rust = Watch::new(Production::open(bytes).unwrap(), 1e-3).unwrap();
    let mut in_rust = Unit::default();
    let (mut watch, mut unit) = (zeroed::<slipfit_watch>(), zeroed::<slipfit_unit>());
    let (mut report, mut end) = (zeroed::<slipfit_production_report>(), zeroed::<slipfit_stroke_end>());
    let mut wear = zeroed::<slipfit_wear>();
    let mut saved = [0u8; SLIPFIT_UNIT_SIZE as usize];
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        assert_eq!(slipfit_watch_start(&mut watch), SLIPFIT_NOT_MADE);
        let init = |watch: &mut slipfit_watch, over, hash, rate| {
            slipfit_watch_init(watch, bytes.as_ptr(), length, over, hash, rate)
        };
        assert_eq!(init(&mut watch, SLIPFIT_AXIS_POSITION, 7, 1e-3), SLIPFIT_TABLE_KIND);
        assert_eq!(init(&mut watch, 4, 7, 1e-3), SLIPFIT_PARAMETER);
        assert_eq!(init(&mut watch, SLIPFIT_AXIS_TIME, 8, 1e-3), SLIPFIT_TABLE_SCENE);
        assert_eq!(init(&mut watch, SLIPFIT_AXIS_TIME, 7, 0.1), SLIPFIT_PARAMETER);
        assert_eq!(init(&mut watch, SLIPFIT_AXIS_TIME, 7, 1e-3), SLIPFIT_OK);
        let sample = slipfit_production_sample { at: 0.0, force: 0.0, speed: 0.1, command: 0.1 };
        assert_eq!(slipfit_watch_step(&mut watch, &unit, &sample, &mut report), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_unit_init(&mut unit), SLIPFIT_OK);
        assert_eq!(slipfit_watch_wear(&watch, &unit, &mut wear), SLIPFIT_UNIT_STROKES);
        for k in 0..30u8 {
            assert_eq!(slipfit_watch_start(&mut watch), SLIPFIT_OK);
            let mut stroke = rust.start();
            for i in 0..=100u8 {
                let at = f32::from(i) * 0.01;
                let force = 2.0 * f32::from(i) + 0.001 * f32::from(k);
                let sample = slipfit_production_sample { at, force, speed: 0.1, command: 0.1 };
                assert_eq!(slipfit_watch_step(&mut watch, &unit, &sample, &mut report), SLIPFIT_OK);
                let expected = rust.step(&in_rust, &mut stroke, &Sample { at, force, speed: 0.1, command: 0.1 });
                assert_eq!((report.own, report.expected), (expected.own, expected.expected));
                assert_eq!(
                    (report.excess, report.limit, report.speed),
                    (expected.excess, expected.limit, expected.speed)
                );
                assert_eq!(report.verdict, SLIPFIT_FREE);
            }
            assert_eq!(slipfit_watch_finish(&watch, &mut unit, &mut end), SLIPFIT_OK);
            let expected = rust.finish(&mut in_rust, &stroke);
            assert_eq!((end.rise, end.deviation), (expected.rise, expected.deviation));
            assert_eq!((end.learned, end.verdict), (expected.is_learned.into(), SLIPFIT_FREE));
            // As after a reset.
            assert_eq!(slipfit_unit_save(&unit, 7, saved.as_mut_ptr()), SLIPFIT_OK);
            assert_eq!(saved, in_rust.to_bytes(7));
            unit = zeroed();
            assert_eq!(slipfit_unit_load(&mut unit, 7, saved.as_ptr()), SLIPFIT_OK);
        }
        assert_eq!(slipfit_watch_wear(&watch, &unit, &mut wear), SLIPFIT_OK);
        let line = in_rust.drift().trend().line(0.03).unwrap();
        assert_eq!((wear.rise, wear.slope, wear.deviation), (line.rise, line.slope, line.deviation));
        assert_eq!([wear.strokes_left, wear.strokes_left_least], line.strokes_until(0.5));

        assert_eq!(slipfit_unit_load(&mut unit, 8, saved.as_ptr()), SLIPFIT_UNIT_SCENE);
        assert_eq!(slipfit_unit_save(&unit, 7, saved.as_mut_ptr()), SLIPFIT_NOT_MADE);
        saved[60] ^= 1;
        assert_eq!(slipfit_unit_load(&mut unit, 7, saved.as_ptr()), SLIPFIT_UNIT_CHECKSUM);
        assert_eq!(slipfit_unit_load(&mut unit, 7, [0xff; 112].as_ptr()), SLIPFIT_UNIT_MAGIC);
        let levels: &'static [u8] = table().leak();
        let opened = slipfit_watch_init(&mut watch, levels.as_ptr(), levels.len() as u32, SLIPFIT_AXIS_TIME, 7, 1e-3);
        assert_eq!(opened, SLIPFIT_TABLE_KIND);
        assert_eq!(slipfit_watch_finish(&watch, &mut unit, &mut end), SLIPFIT_NOT_MADE);
        // Null pointers.
        assert_eq!(slipfit_unit_init(ptr::null_mut()), SLIPFIT_NULL);
        assert_eq!(slipfit_unit_save(&unit, 7, ptr::null_mut()), SLIPFIT_NULL);
        assert_eq!(slipfit_unit_load(&mut unit, 7, ptr::null()), SLIPFIT_NULL);
        assert_eq!(slipfit_watch_init(&mut watch, ptr::null(), 4, SLIPFIT_AXIS_TIME, 7, 1e-3), SLIPFIT_NULL);
        assert_eq!(slipfit_watch_step(ptr::null_mut(), &unit, &sample, &mut report), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_watch_finish(ptr::null(), &mut unit, &mut end), SLIPFIT_NULL);
        assert_eq!(slipfit_watch_wear(&watch, &unit, ptr::null_mut()), SLIPFIT_NULL);
    }
}

/// The table of a watch is checked while the watch is in use.
#[test]
fn the_table_of_a_watch_is_scrubbed() {
    let mut bytes = production();
    let (pointer, length) = (bytes.as_mut_ptr(), bytes.len() as u32);
    let (mut watch, mut scrubber, mut rounds) = (zeroed::<slipfit_watch>(), zeroed::<slipfit_scrubber>(), 0);
    // SAFETY: every pointer is to a local of its type, and the bytes outlive the watch; only a raw pointer changes them.
    unsafe {
        assert_eq!(slipfit_scrubber_init_watch(&mut scrubber, &watch), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_watch_init(&mut watch, pointer, length, SLIPFIT_AXIS_TIME, 7, 1e-3), SLIPFIT_OK);
        assert_eq!(slipfit_scrubber_init_watch(&mut scrubber, &watch), SLIPFIT_OK);
        assert_eq!(slipfit_scrubber_check(&mut scrubber, u32::MAX, &mut rounds), SLIPFIT_OK);
        if !cfg!(miri) {
            *pointer.add(layout::HEADER_SIZE + 9) ^= 4;
            assert_eq!(slipfit_scrubber_check(&mut scrubber, u32::MAX, &mut rounds), SLIPFIT_TABLE_CHECKSUM);
            assert_eq!(rounds, 2);
        }
    }
}
