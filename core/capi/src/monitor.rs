//! The monitor, and the bank that estimates a unit's tolerance level.

use slipfit_core::{
    monitor::{BankError, Estimate, LevelBank, Limits, Monitor, Sample, Verdict, Watch},
    table::AnyNodes,
};

use crate::{
    border::{Storage, input, make, object, object_mut, output},
    status::{Refusal, SLIPFIT_BANK_LEVELS, SLIPFIT_BANK_SAMPLES, SLIPFIT_MONITOR_BAND, slipfit_status, status},
    table::slipfit_table,
};

/// Levels that a bank has room for.
pub const SLIPFIT_BANK_LEVELS_MOST: u32 = 96;

/// Too early to say.
pub const SLIPFIT_BLIND: u32 = 0;
/// As the table has it.
pub const SLIPFIT_FREE: u32 = 1;
/// More force in the direction of the command than the table's for this unit's level, or rising away from it.
pub const SLIPFIT_TIGHT: u32 = 2;
/// Standing still against the command, or at the limit of force.
pub const SLIPFIT_JAM: u32 = 3;
/// For the time `hold` of the limits no sample was of use: a number was missing, as of a dead sensor, or the table has no force
/// then.
pub const SLIPFIT_NO_DATA: u32 = 4;

/// The motion has come to the end of a table of a production, beyond which nothing is watched.
pub const SLIPFIT_ENDED: u32 = 5;

/// As C has it.
pub(crate) fn code(verdict: Verdict) -> u32 {
    match verdict {
        Verdict::Blind => SLIPFIT_BLIND,
        Verdict::Free => SLIPFIT_FREE,
        Verdict::Tight => SLIPFIT_TIGHT,
        Verdict::Jam => SLIPFIT_JAM,
        Verdict::NoData => SLIPFIT_NO_DATA,
        Verdict::Ended => SLIPFIT_ENDED,
    }
}

/// Where free ends, and when a jam is one.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_limits {
    /// Time from one sample to the next (s).
    pub period: f32,
    /// Until this time (s) of the motion only the force limit counts.
    pub blind: f32,
    /// A force (N) beyond which it is a jam, either sign.
    pub force_most: f32,
    /// How long (s) a jam's sign has to last before it is reported, and how long no sample has to be of use before there is no data.
    pub hold: f32,
    /// Time constant (s) over which force is averaged.
    pub smoothing: f32,
    /// By how many levels a unit may be tighter than it is taken for. By fewer where the table ends, or where its units end
    /// differently from this one.
    pub band: f32,
    /// What the averaged force (N) may differ from the table's beyond that band.
    pub margin: f32,
    /// How fast (N/s) the averaged force may rise away from the table's.
    pub rise: f32,
}

/// What the drive measures once a period. Of what it cannot measure, a force is given as 0 and a speed as the command, which say
/// nothing. What it fails to measure is NAN.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_sample {
    /// Time since the motion's start (s).
    pub time: f32,
    /// The drive's force (N).
    pub force: f32,
    /// The speed along the drive (m/s).
    pub speed: f32,
    /// The commanded speed (m/s).
    pub command: f32,
}

/// What a monitor says of a sample.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_report {
    /// SLIPFIT_BLIND, SLIPFIT_FREE, SLIPFIT_TIGHT, SLIPFIT_JAM or SLIPFIT_NO_DATA.
    pub verdict: u32,
    /// The force (N) that the table has for this unit now.
    pub expected: f32,
    /// By how much (N) the averaged force may exceed it.
    pub band: f32,
    /// By how much (N) it does, in the direction of the command.
    pub excess: f32,
    /// How fast (N/s) that rises.
    pub rise: f32,
}

/// A tolerance level and how well it is known.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_estimate {
    /// The level that fits best.
    pub level: f32,
    /// Its standard error; infinite if any level of the table would do.
    pub deviation: f32,
    /// Ends of the interval of 95 % confidence.
    pub low: f32,
    /// See `low`.
    pub high: f32,
    /// Standard deviation (N) of the force from the table's at that level.
    pub residual: f32,
}

/// Memory of a monitor; opaque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_monitor {
    words: [u64; 48],
}

/// Memory of a bank; opaque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_bank {
    words: [u64; 240],
}

#[derive(Clone, Copy)]
pub(crate) struct Watching {
    monitor: Monitor<'static, AnyNodes<'static>>,
    watch: Watch,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_monitor {
    type Object = Watching;
    const MARK: u32 = 0x534c_4d31;
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_bank {
    type Object = LevelBank<'static, AnyNodes<'static>, { SLIPFIT_BANK_LEVELS_MOST as usize }>;
    const MARK: u32 = 0x534c_4231;
}

impl From<slipfit_limits> for Limits {
    fn from(limits: slipfit_limits) -> Self {
        let slipfit_limits { period, blind, force_most, hold, smoothing, band, margin, rise } = limits;
        Self { period, blind, force_most, hold, smoothing, band, margin, rise }
    }
}

impl From<slipfit_sample> for Sample {
    fn from(sample: slipfit_sample) -> Self {
        let slipfit_sample { time, force, speed, command } = sample;
        Self { time, force, speed, command }
    }
}

impl From<BankError> for Refusal {
    fn from(error: BankError) -> Self {
        match error {
            BankError::Table(error) => error.into(),
            BankError::Levels { .. } => Self(SLIPFIT_BANK_LEVELS),
        }
    }
}

/// Limits for samples a `period` (s) apart with white noise of standard deviation `noise` (N) on the force: averages over 20
/// periods, five standard deviations of what the average leaves of the noise, jams held for ten periods, a band of half a
/// level, no blind time and no force limit. SLIPFIT_PARAMETER if no monitor takes them: the period must be 1 µs to 0.5 s, the
/// noise not negative.
///
/// # Safety
/// If `limits` is neither null nor misaligned, memory for them is there, and nobody else uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_limits_for_noise(
    period: f32,
    noise: f32,
    limits: *mut slipfit_limits,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(limits, || {
            let Limits { period, blind, force_most, hold, smoothing, band, margin, rise } =
                Limits::for_noise(period, noise).checked()?;
            Ok(slipfit_limits { period, blind, force_most, hold, smoothing, band, margin, rise })
        })
    })
}

/// Makes a monitor in `*storage` of a unit of tolerance level `n`, by an open table over time. The first motion starts with
/// it, others with slipfit_monitor_restart. SLIPFIT_MONITOR_MIXED if a lookup at that level would be mixed.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; the table has been written before; nobody
/// else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_monitor_init(
    storage: *mut slipfit_monitor,
    table: *const slipfit_table,
    n: f32,
    limits: *const slipfit_limits,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make(storage, || {
            let limits = (*input(limits)?).into();
            Ok(Watching { monitor: Monitor::new(*object(table)?, n, limits)?, watch: Watch::default() })
        })
    })
}

/// What a sample says, after those before it.
///
/// # Safety
/// As for slipfit_monitor_init; nobody else uses `*report` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_monitor_step(
    storage: *mut slipfit_monitor,
    sample: *const slipfit_sample,
    report: *mut slipfit_report,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(report, || {
            let sample = (*input(sample)?).into();
            let Watching { monitor, watch } = object_mut(storage)?;
            let report = monitor.step(watch, &sample);
            Ok(slipfit_report {
                verdict: code(report.verdict),
                expected: report.tightness.expected,
                band: report.tightness.band,
                excess: report.tightness.excess,
                rise: report.tightness.rise,
            })
        })
    })
}

/// Takes the unit for the level that `*estimate` says from now on. SLIPFIT_MONITOR_BAND, and the level stays, if the estimate is
/// of no unit of the table, further than the band of the limits from the `n` of slipfit_monitor_init, or its standard error
/// negative or greater than that band. The band does not move along: a unit that leaves it, at once or motion by motion, is tight.
///
/// # Safety
/// As for slipfit_monitor_init; the monitor has been written before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_monitor_adapt(
    storage: *mut slipfit_monitor,
    estimate: *const slipfit_estimate,
) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let (watching, estimate) = unsafe { (object_mut(storage)?, input(estimate)?) };
        let slipfit_estimate { level, deviation, low, high, residual } = *estimate;
        let estimate = Estimate { level, deviation, interval: [low, high], residual };
        if watching.monitor.adapt(&estimate) { Ok(()) } else { Err(Refusal(SLIPFIT_MONITOR_BAND)) }
    })
}

/// Starts another motion: forgets all samples, and keeps the limits and the level that the unit is taken for.
///
/// # Safety
/// As for slipfit_monitor_adapt.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_monitor_restart(storage: *mut slipfit_monitor) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        unsafe { object_mut(storage)? }.watch = Watch::default();
        Ok(())
    })
}

/// Makes an empty bank in `*storage` for an open table over time, which it goes by until it is made anew.
///
/// # Safety
/// As for slipfit_monitor_init.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_bank_init(storage: *mut slipfit_bank, table: *const slipfit_table) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { make(storage, || Ok(LevelBank::new(*object(table)?)?)) })
}

/// Adds the force (N) measured at the time `t` (s) of a motion.
///
/// # Safety
/// As for slipfit_monitor_init; the bank has been written before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_bank_add(storage: *mut slipfit_bank, t: f32, force: f32) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        unsafe { object_mut(storage)? }.add(t, force);
        Ok(())
    })
}

/// The tolerance level that fits best.
///
/// # Safety
/// As for slipfit_bank_add; nobody else uses `*estimate` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_bank_estimate(
    storage: *const slipfit_bank,
    estimate: *mut slipfit_estimate,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(estimate, || {
            let found = object(storage)?.estimate().ok_or(Refusal(SLIPFIT_BANK_SAMPLES))?;
            let [low, high] = found.interval;
            let Estimate { level, deviation, residual, .. } = found;
            Ok(slipfit_estimate { level, deviation, low, high, residual })
        })
    })
}
