//! Communication points and the kernel's own steps.

/// How far (in steps) a communication point may lie before an instant of the kernel and still be taken for it: importers
/// sum their steps, and sums are rounded.
const SLACK: f64 = 1e-3;

/// How many steps of the length `step` (s) have ended when `elapsed` (s) has passed since the start: the motion is that of the
/// last instant of the kernel at or before the communication point. `None` if that is no time.
pub fn steps_until(elapsed: f64, step: f64) -> Option<u64> {
    let steps = (elapsed / step + SLACK).floor();
    // Beyond, not every count is a number of its own.
    (0.0..9e15).contains(&steps).then_some(steps as u64)
}

#[cfg(test)]
mod tests {
    use super::steps_until;

    #[test]
    fn multiples_are_hit_however_they_were_summed() {
        for step in [1e-3, 1e-4, 2.5e-4, 1.0 / 3.0] {
            let mut summed = 0.0;
            for k in 0..100_000u64 {
                assert_eq!(steps_until(k as f64 * step, step), Some(k), "{k} of {step}");
                assert_eq!(steps_until(summed, step), Some(k), "{k} of {step}, summed");
                summed += step;
            }
        }
    }

    #[test]
    fn between_instants_the_last_one_holds() {
        for (elapsed, steps) in [(0.0, 0), (0.4e-3, 0), (0.99e-3, 0), (1.6e-3, 1), (2.4e-3, 2)] {
            assert_eq!(steps_until(elapsed, 1e-3), Some(steps), "{elapsed}");
        }
        for bad in [-1e-3, f64::NAN, f64::INFINITY, 1e300] {
            assert_eq!(steps_until(bad, 1e-3), None, "{bad}");
        }
    }
}
