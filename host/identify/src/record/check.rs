//! Whether times are those of samples at equal intervals.

use super::RecordProblem;
use crate::signal::spikes::median;

/// The fewest samples that a fit is made of.
pub const LEAST: usize = 20;
/// An interval beyond which samples are missing, of the usual one.
const GAP: f64 = 1.5;
/// Distance of a sample from the grid of equal intervals that rounded times may have, in intervals.
const OFF: f64 = 0.5;

/// The interval (s) of the samples at these `times` (s).
///
/// # Errors
/// What is wrong, and at which sample.
pub fn interval(times: &[f64]) -> Result<f64, (usize, RecordProblem)> {
    let n = times.len();
    for (i, pair) in times.windows(2).enumerate() {
        if pair[1] <= pair[0] {
            return Err((i + 1, RecordProblem::NotIncreasing { time: pair[1], before: pair[0] }));
        }
    }
    if n < LEAST {
        return Err((n - 1, RecordProblem::Few { found: n, least: LEAST }));
    }
    let usual = median(&mut times.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>());
    for (i, pair) in times.windows(2).enumerate() {
        if pair[1] - pair[0] > GAP * usual {
            return Err((i + 1, RecordProblem::Gap { before: pair[0], time: pair[1], step: usual }));
        }
    }
    let step = (times[n - 1] - times[0]) / (n - 1) as f64;
    for (i, time) in times.iter().enumerate() {
        let off = time - (times[0] + step * i as f64);
        if off.abs() > OFF * step {
            return Err((i, RecordProblem::Uneven { time: *time, off, step }));
        }
    }
    Ok(step)
}
