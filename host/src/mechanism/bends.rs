//! Times at which steps of the desk end, because what acts changes there.

use super::Mechanism;

/// Difference (s) of two times that is rounding.
const SAME_TIME: f64 = 1e-10;

/// Longest step (s) under a prescribed motion, and fewest steps of a run: the force is known at the ends of steps.
const LONGEST: f64 = 1e-3;
const LEAST_STEPS: f64 = 500.0;

/// The times (s) within the run of `mechanism`, ascending, at which a command bends, a controller samples, or the force of a prescribed
/// motion has to be known.
pub fn bends(mechanism: &Mechanism) -> Vec<f64> {
    let duration = mechanism.run.duration;
    let every = |period: f64| (0..).map(move |k| f64::from(k) * period).take_while(move |t| *t < duration);
    let mut bends: Vec<f64> = mechanism.drives.iter().flat_map(|named| named.setpoint().bends()).collect();
    let sampling = mechanism.drives.iter().filter_map(|named| named.sampling.as_ref());
    bends.extend(sampling.flat_map(|sampling| every(sampling.period)));
    if mechanism.drives.iter().any(|named| named.is_prescribed) {
        bends.extend(every(LONGEST.min(duration / LEAST_STEPS)));
    }
    bends.sort_by(f64::total_cmp);
    // Times that differ by rounding would make a step of their difference.
    bends.dedup_by(|later, earlier| *later - *earlier < SAME_TIME);
    bends.retain(|bend| duration - bend > SAME_TIME);
    bends
}
