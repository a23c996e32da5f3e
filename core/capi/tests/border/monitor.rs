//! The monitor's limits, and what a monitor takes a unit for.

use std::ptr;

use slipfit_capi::*;
use slipfit_core::{
    monitor::{Estimate, Limits, Monitor},
    table::{AxisKind, Table},
};

use super::{
    SPECIAL,
    common::zeroed,
    table::{table, table_over},
};

/// Limits for noise of 20 mN in samples of 1 kHz.
fn limits() -> slipfit_limits {
    let mut limits = zeroed::<slipfit_limits>();
    // SAFETY: the pointer is to a local of its type.
    assert_eq!(unsafe { slipfit_limits_for_noise(1e-3, 0.02, &mut limits) }, SLIPFIT_OK);
    limits
}

#[test]
fn limits_for_noise_are_those_of_rust() {
    let Limits { period, blind, force_most, hold, smoothing, band, margin, rise } = Limits::for_noise(1e-3, 0.02);
    let expected = slipfit_limits { period, blind, force_most, hold, smoothing, band, margin, rise };
    assert_eq!(limits(), expected);
}

#[test]
fn limits_that_no_monitor_takes_are_refused_and_not_written() {
    let before = limits();
    let for_noise = |period: f32, noise: f32| {
        let mut limits = before;
        // SAFETY: the pointer is to a local of its type.
        let status = unsafe { slipfit_limits_for_noise(period, noise, &mut limits) };
        (status, limits)
    };
    for (period, noise) in [(1e-6, 0.0), (0.5, 0.02), (1e-3, 1e9)] {
        assert_eq!(for_noise(period, noise).0, SLIPFIT_OK, "{period} {noise}");
    }
    for (period, noise) in [(9e-7, 0.02), (0.51, 0.02), (-1e-3, 0.02), (1e-3, -1e-6), (1e-3, 2e9)] {
        assert_eq!(for_noise(period, noise), (SLIPFIT_PARAMETER, before), "{period} {noise}");
    }
    let bytes: &'static [u8] = table().leak();
    let (mut table, mut monitor) = (zeroed::<slipfit_table>(), zeroed::<slipfit_monitor>());
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let opened = slipfit_table_open(&mut table, bytes.as_ptr(), bytes.len() as u32, SLIPFIT_AXIS_TIME, 7);
        assert_eq!(opened, SLIPFIT_OK);
        for period in SPECIAL {
            for noise in SPECIAL {
                let (status, limits) = for_noise(period, noise);
                // What is not refused here, a monitor takes.
                if status == SLIPFIT_OK {
                    assert_eq!(slipfit_monitor_init(&mut monitor, &table, 1.0, &limits), SLIPFIT_OK);
                } else {
                    assert_eq!((status, limits), (SLIPFIT_PARAMETER, before), "{period} {noise}");
                }
            }
        }
    }
}

#[test]
fn a_monitor_adapts_as_in_rust_and_restarts() {
    // The last of its levels jams.
    let bytes: &'static [u8] = table_over(&[(AxisKind::Level, 4, 1.0), (AxisKind::Time, 4, 0.1)]).leak();
    let (mut table, mut monitor, mut report) =
        (zeroed::<slipfit_table>(), zeroed::<slipfit_monitor>(), zeroed::<slipfit_report>());
    let limits = limits();
    let mut rust = Monitor::new(Table::open(bytes).unwrap(), 1.0, Limits::for_noise(1e-3, 0.02)).unwrap();
    let estimate = |level, deviation| slipfit_estimate { level, deviation, low: 0.0, high: 2.0, residual: 0.0 };
    let good = estimate(1.25, 0.1);
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        assert_eq!(slipfit_monitor_adapt(&mut monitor, &good), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_monitor_restart(&mut monitor), SLIPFIT_NOT_MADE);
        let opened = slipfit_table_open(&mut table, bytes.as_ptr(), bytes.len() as u32, SLIPFIT_AXIS_TIME, 7);
        assert_eq!(opened, SLIPFIT_OK);
        assert_eq!(slipfit_monitor_init(&mut monitor, &table, 1.0, &limits), SLIPFIT_OK);
        // The table counts its values up, by 8 N from level to level.
        let sample = slipfit_sample { time: 0.1, force: 10.0, speed: 0.1, command: 0.1 };
        let mut step = |monitor: &mut slipfit_monitor| {
            assert_eq!(slipfit_monitor_step(monitor, &sample, &mut report), SLIPFIT_OK);
            report
        };
        let first = step(&mut monitor);
        assert_eq!(first.expected, 10.0);
        for (level, deviation, taken) in [
            (1.6, 0.1, false),
            (0.4, 0.1, false),
            (1.1, 0.6, false),
            (1.1, f32::INFINITY, false),
            (f32::NAN, 0.1, false),
            (1.1, f32::NAN, false),
            (1.1, -1.0, false),
            (1.1, -f32::MIN_POSITIVE, false),
            (1.5, 0.1, true),
            // The band is about the level that the monitor was made for.
            (1.75, 0.1, false),
        ] {
            let estimate = estimate(level, deviation);
            let status = slipfit_monitor_adapt(&mut monitor, &estimate);
            assert_eq!(status, if taken { SLIPFIT_OK } else { SLIPFIT_MONITOR_BAND }, "{level} {deviation}");
            let in_rust = Estimate { level, deviation, interval: [0.0, 2.0], residual: 0.0 };
            assert_eq!(rust.adapt(&in_rust), taken, "{level} {deviation}");
        }
        // Half a level on.
        assert_eq!((rust.level(), step(&mut monitor).expected), (1.5, 14.0));
        assert_eq!(slipfit_monitor_adapt(&mut monitor, ptr::null()), SLIPFIT_NULL);
        // Forgets what it has seen, not what it takes the unit for.
        assert_eq!(slipfit_monitor_adapt(&mut monitor, &estimate(1.0, 0.1)), SLIPFIT_OK);
        assert!(step(&mut monitor) != first);
        assert_eq!(slipfit_monitor_restart(&mut monitor), SLIPFIT_OK);
        assert_eq!(step(&mut monitor), first);
        // Between the last level that runs and the one that jams there is no unit.
        for (n, made) in [(2.0, SLIPFIT_OK), (2.5, SLIPFIT_MONITOR_MIXED), (3.0, SLIPFIT_OK), (3.5, SLIPFIT_PARAMETER)]
        {
            assert_eq!(slipfit_monitor_init(&mut monitor, &table, n, &limits), made, "{n}");
        }
    }
}

#[test]
fn a_dead_sensor_and_the_tables_end_are_no_data() {
    let bytes: &'static [u8] = table().leak();
    let (mut table, mut monitor, mut report) =
        (zeroed::<slipfit_table>(), zeroed::<slipfit_monitor>(), zeroed::<slipfit_report>());
    let good = slipfit_sample { time: 0.1, force: 2.0, speed: 0.1, command: 0.1 };
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let opened = slipfit_table_open(&mut table, bytes.as_ptr(), bytes.len() as u32, SLIPFIT_AXIS_TIME, 7);
        assert_eq!(opened, SLIPFIT_OK);
        for sample in [
            slipfit_sample { time: f32::NAN, ..good },
            slipfit_sample { time: 0.31, ..good },
            slipfit_sample { force: f32::NAN, ..good },
            slipfit_sample { speed: f32::NAN, ..good },
            slipfit_sample { command: f32::NAN, ..good },
        ] {
            assert_eq!(slipfit_monitor_init(&mut monitor, &table, 0.0, &limits()), SLIPFIT_OK);
            for i in 0..1099 {
                assert_eq!(slipfit_monitor_step(&mut monitor, &sample, &mut report), SLIPFIT_OK);
                // Ten periods, give or take rounding of their sum.
                assert!(i == 10 || (report.verdict == SLIPFIT_NO_DATA) == (i > 10), "{i} {sample:?} {report:?}");
            }
            assert_eq!(slipfit_monitor_step(&mut monitor, &good, &mut report), SLIPFIT_OK);
            assert_eq!(report.verdict, SLIPFIT_FREE, "{sample:?}");
        }
    }
}
