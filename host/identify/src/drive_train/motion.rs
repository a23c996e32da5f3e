//! The motion of a record, filtered without a shift of phase and differentiated, beside the force through the same filter.

use crate::{
    record::Record,
    signal::{butterworth::LowPass, difference::central, spikes},
};

/// How a record is filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Cut-off frequency (Hz) of the motion's filter; `None` for a tenth of the sampling frequency, at most 100 Hz.
    pub cutoff: Option<f64>,
}

/// A quantity at the samples that are compared, and its derivative by time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signal {
    /// The quantity (SI).
    pub value: Vec<f64>,
    /// Its derivative (SI).
    pub rate: Vec<f64>,
}

/// The motion and the force of a record, at the samples that are compared. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Filtered {
    /// Acceleration (m/s²).
    pub acceleration: Signal,
    /// Speed (m/s).
    pub speed: Signal,
    /// 1 while the drive moves forwards, 0 while it moves backwards.
    pub forwards: Signal,
    /// Speed (m/s) forwards, 0 while it moves backwards.
    pub speed_forwards: Signal,
    /// Force (N); `None` where none was measured.
    pub force: Option<Vec<f64>>,
    /// Times of these samples (s).
    pub times: Vec<f64>,
    /// Cut-off frequency (Hz) of the motion's filter.
    pub cutoff: f64,
    /// Single wrong samples that were replaced.
    pub spikes: usize,
}

/// Highest cut-off frequency (Hz) that is chosen, where a record is sampled fast.
const HIGHEST: f64 = 100.0;
/// Share of the cut-off frequency at which the force and what it is compared with are filtered once more.
const SECOND: f64 = 0.5;

/// Share of the greatest speed below which the drive rests, if it stays there for so long (s). A reversal is not a rest.
const REST: (f64, f64) = (0.01, 0.05);
/// Share of rest, through the second filter, from which on a sample is not compared.
const RESTS: f64 = 0.05;

/// The speed of a record, filtered without a shift of phase, its force, and the samples at which forces are compared.
#[derive(Clone, Debug)]
pub struct Smoothed {
    /// Speed (m/s) at every sample.
    pub speed: Vec<f64>,
    /// Force (N) at every sample; `None` where none was measured.
    pub force: Option<Vec<f64>>,
    /// Which samples are compared.
    pub compared: ComparedSamples,
    /// Cut-off frequency (Hz) of the motion's filter.
    pub cutoff: f64,
    /// Single wrong samples that were replaced.
    pub spikes: usize,
}

/// The samples of a record that are compared, after a second filter: neither its ends nor where the drive rests.
#[derive(Clone, Debug)]
pub struct ComparedSamples {
    filter: LowPass,
    chosen: Vec<usize>,
}

impl ComparedSamples {
    /// What is compared of a `signal` with a value at every sample of the record.
    pub fn of(&self, signal: &[f64]) -> Vec<f64> {
        self.chosen(&self.filter.both_ways(signal))
    }

    /// When (s) they were taken of their `record`.
    pub fn times(&self, record: &Record) -> Vec<f64> {
        self.chosen.iter().map(|i| record.start + record.step * *i as f64).collect()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.chosen.len()
    }

    fn chosen(&self, signal: &[f64]) -> Vec<f64> {
        self.chosen.iter().map(|i| signal[*i]).collect()
    }
}

/// Filters the motion of a `record` that has one, by a filter of this cut-off frequency (Hz); `None` as in [`Options`].
pub fn smoothed(record: &Record, cutoff: Option<f64>) -> Smoothed {
    let rate = 1.0 / record.step;
    let cutoff = cutoff.unwrap_or((0.1 * rate).min(HIGHEST)).min(0.4 * rate);
    let first = LowPass::new(cutoff / rate);
    let mut spikes = 0;
    let mut clean = |signal: &[f64]| {
        let mut signal = signal.to_vec();
        spikes += spikes::remove(&mut signal);
        signal
    };
    let speed = match (&record.speed, &record.position) {
        (Some(speed), None) => first.both_ways(&clean(speed)),
        (_, Some(position)) => central(&first.both_ways(&clean(position)), record.step),
        (None, None) => vec![0.0; record.samples],
    };
    let force = record.force.as_ref().map(|force| clean(force));
    let filter = LowPass::new(SECOND * cutoff / rate);
    let every = ((0.5 * rate / (2.0 * SECOND * cutoff)) as usize).max(1);
    // The ends of a filtered signal depend on how it is continued beyond.
    let margin = (filter.settling() / 3).min(record.samples / 10);
    let rests = filter.both_ways(&resting(&speed, record.step));
    let chosen = (margin..record.samples - margin).step_by(every).filter(|i| rests[*i].abs() < RESTS).collect();
    Smoothed { speed, force, compared: ComparedSamples { filter, chosen }, cutoff, spikes }
}

/// Filters a `record` that has a motion.
pub fn filtered(record: &Record, options: &Options) -> Filtered {
    let Smoothed { speed, force, compared, cutoff, spikes } = smoothed(record, options.cutoff);
    let acceleration = central(&speed, record.step);
    let forwards: Vec<f64> = speed
        .iter()
        .map(|speed| {
            if *speed > 0.0 {
                1.0
            } else if *speed < 0.0 {
                0.0
            } else {
                0.5
            }
        })
        .collect();
    let speed_forwards: Vec<f64> = speed.iter().map(|speed| speed.max(0.0)).collect();
    let signal = |signal: &[f64]| {
        let smooth = compared.filter.both_ways(signal);
        Signal { value: compared.chosen(&smooth), rate: compared.chosen(&central(&smooth, record.step)) }
    };
    Filtered {
        acceleration: signal(&acceleration),
        speed: signal(&speed),
        forwards: signal(&forwards),
        speed_forwards: signal(&speed_forwards),
        force: force.map(|force| compared.of(&force)),
        times: compared.times(record),
        cutoff,
        spikes,
    }
}

/// 1 where the drive rests, else 0: friction at rest is any force up to its greatest.
fn resting(speed: &[f64], step: f64) -> Vec<f64> {
    let (share, duration) = REST;
    let fastest = speed.iter().fold(0.0f64, |most, speed| most.max(speed.abs()));
    let mut rests = vec![0.0; speed.len()];
    let mut start = 0;
    for i in 0..=speed.len() {
        if i == speed.len() || speed[i].abs() >= share * fastest {
            if (i - start) as f64 * step >= duration {
                rests[start..i].fill(1.0);
            }
            start = i + 1;
        }
    }
    rests
}
