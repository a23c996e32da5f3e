//! The watch for jams without a table.

use std::ptr;

use slipfit_capi::*;
use slipfit_core::monitor::{JamWatch, Limits, Sample, Verdict};

use super::{SPECIAL, common::zeroed};

/// Limits for samples of 1 kHz: blind until 10 ms, jams held for 3.5 ms.
const LIMITS: Limits = Limits {
    period: 1e-3,
    blind: 0.01,
    force_most: 3.0,
    hold: 0.0035,
    smoothing: 0.0,
    band: 0.0,
    margin: 0.0,
    rise: 0.0,
};

fn limits() -> slipfit_limits {
    let Limits { period, blind, force_most, hold, smoothing, band, margin, rise } = LIMITS;
    slipfit_limits { period, blind, force_most, hold, smoothing, band, margin, rise }
}

/// A watch, made.
fn made() -> slipfit_jam_watch {
    let mut watch = zeroed::<slipfit_jam_watch>();
    // SAFETY: the pointers are to locals of their types.
    assert_eq!(unsafe { slipfit_jam_watch_init(&mut watch, &limits()) }, SLIPFIT_OK);
    watch
}

/// The verdict on the sample.
fn verdict(watch: &mut slipfit_jam_watch, sample: &slipfit_sample) -> u32 {
    let mut verdict = 9;
    // SAFETY: the pointers are to locals of their types.
    assert_eq!(unsafe { slipfit_jam_watch_step(watch, sample, &mut verdict) }, SLIPFIT_OK);
    assert!([SLIPFIT_BLIND, SLIPFIT_FREE, SLIPFIT_JAM, SLIPFIT_NO_DATA].contains(&verdict), "{verdict}");
    verdict
}

/// Whether there is a jam at the sample.
fn step(watch: &mut slipfit_jam_watch, sample: &slipfit_sample) -> bool {
    verdict(watch, sample) == SLIPFIT_JAM
}

#[test]
fn a_jam_is_reported_when_it_has_lasted_and_forgotten_with_the_motion() {
    let at = |i: u32, force, speed| slipfit_sample { time: i as f32 * 1e-3, force, speed, command: 0.1 };
    // A drive whose force nobody measures moves for 20 ms and then stands.
    let stands = |i: u32| at(i, 0.0, if i < 20 { 0.1 } else { 0.0 });
    let mut watch = made();
    assert_eq!((0..100).position(|i| step(&mut watch, &stands(i))), Some(23));
    // SAFETY: the pointer is to a local of its type.
    assert_eq!(unsafe { slipfit_jam_watch_restart(&mut watch) }, SLIPFIT_OK);
    assert_eq!((20..100).position(|i| step(&mut watch, &stands(i))), None);
    // One that pushes against its limit of force, blind or not.
    assert_eq!((0..100).position(|i| step(&mut watch, &at(i, -3.1, 0.1))), Some(3));
}

#[test]
fn a_dead_sensor_is_no_data() {
    let good = slipfit_sample { time: 0.5, force: 1.0, speed: 0.1, command: 0.1 };
    for sample in [
        slipfit_sample { time: f32::NAN, ..good },
        slipfit_sample { force: f32::NAN, ..good },
        slipfit_sample { speed: f32::NAN, ..good },
        slipfit_sample { command: f32::NAN, ..good },
    ] {
        let mut watch = made();
        let verdicts: Vec<u32> = (0..1099).map(|_| verdict(&mut watch, &sample)).collect();
        assert!(verdicts[..3].iter().all(|verdict| [SLIPFIT_BLIND, SLIPFIT_FREE].contains(verdict)), "{sample:?}");
        assert!(verdicts[3..].iter().all(|verdict| *verdict == SLIPFIT_NO_DATA), "{sample:?}");
        assert_eq!(verdict(&mut watch, &good), SLIPFIT_FREE);
    }
}

#[test]
fn every_sample_is_judged_as_in_rust() {
    let (mut watch, mut rust) = (made(), JamWatch::default());
    let mut jams = 0;
    for time in SPECIAL {
        for speed in SPECIAL {
            for command in SPECIAL {
                for force in SPECIAL {
                    let expected = rust.step(&LIMITS, &Sample { time, force, speed, command });
                    let found = verdict(&mut watch, &slipfit_sample { time, force, speed, command });
                    // In the order in which Rust has them.
                    assert_eq!(found, expected as u32);
                    jams += u32::from(expected == Verdict::Jam);
                }
            }
        }
    }
    assert!(jams > 0);
}

#[test]
fn what_is_not_made_or_out_of_bounds_is_refused() {
    let (mut watch, mut jam, sample) = (zeroed::<slipfit_jam_watch>(), 2, zeroed::<slipfit_sample>());
    let numbers = size_of::<slipfit_limits>() / size_of::<f32>();
    // SAFETY: every pointer is to a local of its type, and every field of the limits is a number.
    unsafe {
        assert_eq!(slipfit_jam_watch_restart(&mut watch), SLIPFIT_NOT_MADE);
        for place in 0..numbers {
            let mut bad = limits();
            ptr::from_mut(&mut bad).cast::<f32>().add(place).write(-1.0);
            watch = made();
            assert_eq!(slipfit_jam_watch_init(&mut watch, &bad), SLIPFIT_PARAMETER, "{place}");
            assert_eq!(slipfit_jam_watch_step(&mut watch, &sample, &mut jam), SLIPFIT_NOT_MADE, "{place}");
        }
    }
    assert_eq!(jam, 2);
}
