//! Pointers that are null or misaligned.

use std::ptr;

use slipfit_capi::*;

use super::{ahead::LIMITS, common::zeroed, regularised, scene, slots::slots, table::table};

#[test]
fn null_and_misaligned_pointers_are_refused() {
    let bytes: &'static [u8] = table().leak();
    let length = bytes.len() as u32;
    let (mut predictor, mut table) = (zeroed::<slipfit_predictor>(), zeroed::<slipfit_table>());
    let (mut monitor, mut bank) = (zeroed::<slipfit_monitor>(), zeroed::<slipfit_bank>());
    let (scene, limits, sample) = (scene(), zeroed::<slipfit_limits>(), zeroed::<slipfit_sample>());
    let mut sound = limits;
    let (mut said, mut found, mut spare) =
        (zeroed::<slipfit_prediction>(), zeroed::<slipfit_lookup>(), zeroed::<slipfit_spare>());
    let (mut report, mut estimate) = (zeroed::<slipfit_report>(), zeroed::<slipfit_estimate>());
    let (mut scrubber, mut rounds, record) = (zeroed::<slipfit_scrubber>(), 0, zeroed::<slipfit_record>());
    let both = slots(bytes, bytes, 8);
    let neither = slipfit_slots { first: ptr::null(), second: ptr::null(), ..both };
    let mut other_monitor = zeroed::<slipfit_monitor>();
    let (mut jam_watch, mut other_watch, mut jam) = (zeroed::<slipfit_jam_watch>(), zeroed::<slipfit_jam_watch>(), 0);
    let mut other_bank = zeroed::<slipfit_bank>();
    let (mut ahead, mut other_ahead) = (zeroed::<slipfit_ahead>(), zeroed::<slipfit_ahead>());
    let (mut observer, mut other_observer) = (zeroed::<slipfit_observer>(), zeroed::<slipfit_observer>());
    let (deadline, mut timing) = (zeroed::<slipfit_deadline>(), zeroed::<slipfit_timing>());
    let mut said_ahead = zeroed::<slipfit_ahead_prediction>();
    let (mut periods, mut force) = (0u32, 0.0f32);
    // SAFETY: what is neither null nor misaligned points at locals.
    unsafe {
        assert_eq!(slipfit_predictor_init(&mut predictor, &scene, 2.5), SLIPFIT_OK);
        assert_eq!(slipfit_observer_init(&mut observer, &scene, 1e-3, 1e-2), SLIPFIT_OK);
        assert_eq!(slipfit_ahead_init(&mut ahead, &regularised(), 2.5, &LIMITS, 0), SLIPFIT_OK);
        assert_eq!(slipfit_table_open(&mut table, bytes.as_ptr(), length, SLIPFIT_AXIS_TIME, 7), SLIPFIT_OK);
        assert_eq!(slipfit_bank_init(&mut bank, &table), SLIPFIT_OK);
        assert_eq!(slipfit_limits_for_noise(1e-3, 0.02, &mut sound), SLIPFIT_OK);
        assert_eq!(slipfit_monitor_init(&mut other_monitor, &table, 1.0, &sound), SLIPFIT_OK);
        assert_eq!(slipfit_jam_watch_init(&mut jam_watch, &sound), SLIPFIT_OK);
        assert_eq!(slipfit_scrubber_init(&mut scrubber, &table), SLIPFIT_OK);
        // Each call with one bad pointer.
        for (code, shift) in [(SLIPFIT_NULL, None), (SLIPFIT_MISALIGNED, Some(1))] {
            let bad = |pointer: *mut u8| shift.map_or(ptr::null_mut(), |by| pointer.wrapping_add(by));
            macro_rules! bad {
                ($place:expr) => {
                    bad(ptr::from_ref(&$place).cast_mut().cast()).cast()
                };
            }
            let answers = [
                slipfit_predictor_init(bad!(predictor), &scene, 2.5),
                slipfit_predictor_init(&mut predictor, bad!(scene), 2.5),
                slipfit_predictor_step(bad!(predictor)),
                slipfit_predictor_set_command(bad!(predictor), 0.1),
                slipfit_predictor_restart(bad!(predictor)),
                slipfit_predictor_read(bad!(predictor), &mut said),
                slipfit_predictor_read(&predictor, bad!(said)),
                slipfit_observer_init(bad!(observer), &scene, 1e-3, 1e-2),
                slipfit_observer_init(&mut other_observer, bad!(scene), 1e-3, 1e-2),
                slipfit_observer_step(bad!(observer), &mut predictor, 0.1, 0.1),
                slipfit_observer_step(&mut observer, bad!(predictor), 0.1, 0.1),
                slipfit_observer_missing(bad!(observer), &mut force),
                slipfit_observer_missing(&observer, bad!(force)),
                slipfit_observer_restart(bad!(observer)),
                slipfit_deadline_init(bad!(deadline), 1000),
                slipfit_deadline_begin(bad!(deadline), 0),
                slipfit_deadline_end(bad!(deadline), 0),
                slipfit_deadline_read(bad!(deadline), &mut timing),
                slipfit_deadline_read(&deadline, bad!(timing)),
                slipfit_ahead_init(bad!(ahead), &scene, 2.5, &LIMITS, 0),
                slipfit_ahead_init(&mut other_ahead, bad!(scene), 2.5, &LIMITS, 0),
                slipfit_ahead_init(&mut other_ahead, &scene, 2.5, bad!(LIMITS), 0),
                slipfit_ahead_step(bad!(ahead)),
                slipfit_ahead_read(bad!(ahead), &mut said_ahead),
                slipfit_ahead_read(&ahead, bad!(said_ahead)),
                slipfit_ahead_rest(bad!(ahead), 0),
                slipfit_ahead_plan(bad!(ahead), 0, 0.1),
                slipfit_ahead_follow(bad!(ahead), 0.1),
                slipfit_ahead_horizon(bad!(ahead), &mut periods),
                slipfit_ahead_horizon(&ahead, bad!(periods)),
                slipfit_ahead_forecast(bad!(ahead), 0, &mut force),
                slipfit_ahead_forecast(&ahead, 0, bad!(force)),
                slipfit_ahead_restart(bad!(ahead), &scene, 2.5),
                slipfit_ahead_restart(&mut ahead, bad!(scene), 2.5),
                slipfit_table_open(bad!(table), bytes.as_ptr(), length, SLIPFIT_AXIS_TIME, 7),
                slipfit_slots_open(bad!(table), &both, SLIPFIT_AXIS_TIME, 7, &mut spare),
                slipfit_slots_open(&mut table, bad!(both), SLIPFIT_AXIS_TIME, 7, &mut spare),
                slipfit_slots_open(&mut table, &both, SLIPFIT_AXIS_TIME, 7, bad!(spare)),
                slipfit_record_make(bad!(record), 8, 0),
                slipfit_table_look_up(bad!(table), 0.0, 0.0, &mut found),
                slipfit_table_look_up(&table, 0.0, 0.0, bad!(found)),
                slipfit_scrubber_init(bad!(scrubber), &table),
                slipfit_scrubber_init(&mut scrubber, bad!(table)),
                slipfit_scrubber_check(bad!(scrubber), 1, &mut rounds),
                slipfit_monitor_init(bad!(monitor), &table, 1.0, &limits),
                slipfit_monitor_init(&mut monitor, bad!(table), 1.0, bad!(limits)),
                slipfit_monitor_init(&mut monitor, &table, 1.0, bad!(limits)),
                slipfit_monitor_step(bad!(monitor), &sample, &mut report),
                slipfit_monitor_step(&mut monitor, bad!(sample), &mut report),
                slipfit_monitor_step(&mut monitor, &sample, bad!(report)),
                slipfit_limits_for_noise(1e-3, 0.02, bad!(limits)),
                slipfit_monitor_adapt(bad!(other_monitor), &estimate),
                slipfit_monitor_adapt(&mut other_monitor, bad!(estimate)),
                slipfit_monitor_restart(bad!(other_monitor)),
                slipfit_jam_watch_init(bad!(jam_watch), &sound),
                slipfit_jam_watch_init(&mut other_watch, bad!(sound)),
                slipfit_jam_watch_step(bad!(jam_watch), &sample, &mut jam),
                slipfit_jam_watch_step(&mut jam_watch, bad!(sample), &mut jam),
                slipfit_jam_watch_step(&mut jam_watch, &sample, bad!(jam)),
                slipfit_jam_watch_restart(bad!(jam_watch)),
                slipfit_bank_init(bad!(bank), &table),
                slipfit_bank_init(&mut other_bank, bad!(table)),
                slipfit_bank_add(bad!(bank), 0.0, 0.0),
                slipfit_bank_estimate(bad!(bank), &mut estimate),
                slipfit_bank_estimate(&bank, bad!(estimate)),
            ];
            for (i, answer) in answers.into_iter().enumerate() {
                assert_eq!(answer, code, "call {i}");
            }
        }
        for answer in [
            slipfit_table_open(&mut table, ptr::null(), length, SLIPFIT_AXIS_TIME, 7),
            slipfit_slots_open(&mut table, &neither, SLIPFIT_AXIS_TIME, 7, &mut spare),
        ] {
            assert_eq!(answer, SLIPFIT_NULL);
        }
    }
}
