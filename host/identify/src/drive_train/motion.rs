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
    /// Interval of these samples (s).
    pub step: f64,
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

/// Filters a `record` that has a motion.
pub fn filtered(record: &Record, options: &Options) -> Filtered {
    let rate = 1.0 / record.step;
    let cutoff = options.cutoff.unwrap_or((0.1 * rate).min(HIGHEST)).min(0.4 * rate);
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
    let force = record.force.as_ref().map(|force| clean(force));

    let second = LowPass::new(SECOND * cutoff / rate);
    let every = ((0.5 * rate / (2.0 * SECOND * cutoff)) as usize).max(1);
    // The ends of a filtered signal depend on how it is continued beyond.
    let margin = (second.settling() / 3).min(record.samples / 10);
    let rests = resting(&speed, record.step);
    let rests = second.both_ways(&rests);
    let moves: Vec<usize> =
        (margin..record.samples - margin).step_by(every).filter(|i| rests[*i].abs() < RESTS).collect();
    let at_samples = |signal: &[f64]| moves.iter().map(|i| signal[*i]).collect::<Vec<f64>>();
    let compared = |signal: &[f64]| {
        let smooth = second.both_ways(signal);
        Signal { value: at_samples(&smooth), rate: at_samples(&central(&smooth, record.step)) }
    };
    Filtered {
        acceleration: compared(&acceleration),
        speed: compared(&speed),
        forwards: compared(&forwards),
        speed_forwards: compared(&speed_forwards),
        force: force.map(|force| compared(&force).value),
        step: record.step * every as f64,
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
