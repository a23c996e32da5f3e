//! The C entry points, in any order, with any numbers, on objects made and not made: a status, never a crash.
#![no_main]
#![allow(unsafe_code, reason = "calls the library as C does")]

use std::ptr;

use libfuzzer_sys::fuzz_target;
use slipfit_capi::*;
use slipfit_core::table::layout;

#[path = "../../../core/capi/tests/common/mod.rs"]
mod common;

use common::{scene, zeroed};

/// Puts `bits` into one of the words of a value that is plain numbers.
fn change<T: Copy>(value: &mut T, place: u32, bits: u32) {
    let words = size_of::<T>() / size_of::<u32>();
    // SAFETY: all bits will do for plain numbers, and the place is one of its words.
    unsafe { ptr::from_mut(value).cast::<u32>().add(place as usize % words).write(bits) };
}

/// The checksum and the fixed fields that a table of this length has to have.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let length = bytes.len();
    if length >= layout::HEADER_SIZE + layout::CHECKSUM_SIZE {
        bytes[..4].copy_from_slice(&layout::MAGIC);
        bytes[layout::VERSION_AT..][..2].copy_from_slice(&layout::VERSION.to_le_bytes());
        bytes[layout::SCENE_HASH_AT..][..8].fill(0);
        bytes[layout::LENGTH_AT..][..4].copy_from_slice(&(length as u32).to_le_bytes());
        let body = length - layout::CHECKSUM_SIZE;
        let checksum = layout::checksum(&bytes[..body]);
        bytes[body..].copy_from_slice(&checksum.to_le_bytes());
    }
    bytes
}

fuzz_target!(|input: (Vec<u8>, Vec<(u8, f32, f32)>)| {
    let (bytes, calls) = input;
    let bytes = sealed(bytes);
    let (mut predictor, mut table) = (zeroed::<slipfit_predictor>(), zeroed::<slipfit_table>());
    let (mut monitor, mut bank) = (zeroed::<slipfit_monitor>(), zeroed::<slipfit_bank>());
    let (mut said, mut found, mut spare) =
        (zeroed::<slipfit_prediction>(), zeroed::<slipfit_lookup>(), zeroed::<slipfit_spare>());
    let (mut scrubber, mut rounds) = (zeroed::<slipfit_scrubber>(), 0);
    let (mut jam_watch, mut verdict) = (zeroed::<slipfit_jam_watch>(), 0);
    let (mut report, mut estimate) = (zeroed::<slipfit_report>(), zeroed::<slipfit_estimate>());
    let (mut integers, mut integer) = (zeroed::<slipfit_integers>(), zeroed::<slipfit_integer_lookup>());
    let (mut ahead, mut force) = (Box::new(zeroed::<slipfit_ahead>()), 0.0);
    let ahead = &mut *ahead;
    let (mut observer, mut deadline) = (zeroed::<slipfit_observer>(), zeroed::<slipfit_deadline>());
    let (length, half) = (bytes.len() as u32, bytes.len() / 2);
    let (mut scene, mut limits) = (scene(SLIPFIT_FRICTION_REGULARISED), zeroed::<slipfit_limits>());
    limits.period = 1e-3;
    limits.force_most = 3.0;
    // SAFETY: every pointer is to a local of its type, or null; the bytes outlive the table.
    unsafe {
        for (call, x, y) in calls {
            let sample = slipfit_sample { time: x, force: y, speed: y, command: x };
            let status = match call % 36 {
                0 => slipfit_predictor_init(&mut predictor, &scene, x),
                1 => slipfit_predictor_step(&mut predictor),
                2 => slipfit_predictor_read(&predictor, &mut said),
                3 => slipfit_table_open(&mut table, bytes.as_ptr(), length, SLIPFIT_AXIS_TIME, 0),
                4 => {
                    let second = bytes.as_ptr().add(half);
                    let slots =
                        slipfit_slots { first: bytes.as_ptr(), second, length: half as u32, word: x.to_bits() % 40 };
                    slipfit_slots_open(&mut table, &slots, SLIPFIT_AXIS_TIME, 0, &mut spare)
                }
                5 => slipfit_table_look_up(&table, x, y, &mut found),
                6 if y > 0.0 => slipfit_scrubber_init(&mut scrubber, &table),
                6 => slipfit_scrubber_check(&mut scrubber, x.to_bits(), &mut rounds),
                7 => slipfit_monitor_init(&mut monitor, &table, x, &limits),
                8 => slipfit_monitor_step(&mut monitor, &sample, &mut report),
                9 => slipfit_bank_init(&mut bank, &table),
                10 => slipfit_bank_add(&mut bank, x, y),
                11 => slipfit_bank_estimate(&bank, &mut estimate),
                12 => {
                    change(&mut scene, x.to_bits(), y.to_bits());
                    SLIPFIT_OK
                }
                13 => {
                    change(&mut limits, x.to_bits(), y.to_bits());
                    SLIPFIT_OK
                }
                14 => slipfit_predictor_init(ptr::null_mut(), &scene, x),
                15 => slipfit_limits_for_noise(x, y, &mut limits),
                16 => slipfit_monitor_adapt(&mut monitor, &estimate),
                17 => slipfit_monitor_restart(&mut monitor),
                18 => slipfit_jam_watch_init(&mut jam_watch, &limits),
                19 => slipfit_jam_watch_step(&mut jam_watch, &sample, &mut verdict),
                20 => slipfit_jam_watch_restart(&mut jam_watch),
                21 => slipfit_predictor_set_command(&mut predictor, x),
                22 => slipfit_predictor_restart(&mut predictor),
                23 => slipfit_integers_init(&mut integers, &table, x, y),
                24 => slipfit_integers_look_up(&integers, x.to_bits().cast_signed(), &mut integer),
                25 => {
                    let limits = slipfit_ahead_limits {
                        period: 1e-3,
                        tolerance: 1e-4,
                        lead: x,
                        lag: y,
                        attempts: x.to_bits() % 3,
                    };
                    slipfit_ahead_init(ahead, &scene, x, &limits, y.to_bits() % 2000)
                }
                26 => slipfit_ahead_step(ahead),
                27 => slipfit_ahead_plan(ahead, y.to_bits(), x),
                28 => slipfit_ahead_follow(ahead, x),
                29 => slipfit_ahead_forecast(ahead, x.to_bits(), &mut force),
                30 => slipfit_observer_init(&mut observer, &scene, x, y),
                31 => slipfit_observer_step(&mut observer, &mut predictor, x, y),
                32 => slipfit_deadline_init(&mut deadline, x.to_bits()),
                33 => slipfit_deadline_begin(&mut deadline, x.to_bits()),
                34 => slipfit_deadline_end(&mut deadline, y.to_bits()),
                _ => slipfit_table_look_up(&table, x, y, ptr::null_mut()),
            };
            assert!((SLIPFIT_OK..=SLIPFIT_MONITOR_BAND).contains(&status));
        }
    }
});
