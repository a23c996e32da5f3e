//! What a drive gives between the ends of steps.
//!
//! A P-drive multiplies the error of a speed by its gain. Within a step shorter than some of the drive's time constants (mass over gain)
//! the speed is known well enough for that. In a longer one the drive follows its load without delay, and a polynomial of the speed,
//! good to its last digits, would still show forces that never act. There the force is interpolated itself: it is known at the ends
//! of steps, which the scheme damps, and is monotone between two of them. A controller that samples holds its effort between samples.

/// A drive's force (N) or torque (N·m) over a run.
pub struct Effort {
    /// Ends of steps (s), ascending; of a controller that samples, its samples.
    times: Vec<f64>,
    /// The effort there.
    values: Vec<f64>,
    /// Longest step (s) within which the effort follows from the speed.
    longest: f64,
    /// How the effort is known between the times.
    between: Between,
}

/// How an effort is known between two times.
#[derive(Clone, Copy, PartialEq)]
enum Between {
    /// By the speed.
    BySpeed,
    /// By the speed where steps are short, and by the efforts at the ends of longer ones.
    Monotone,
    /// It is held.
    Held,
}

/// Time constants of the drive in the longest step within which its effort follows from the speed.
const TIME_CONSTANTS: f64 = 30.0;

impl Effort {
    /// With these `values` at the ends of steps, at ascending `times` (s), of a drive with this `time_constant` (s).
    pub fn new(times: Vec<f64>, values: Vec<f64>, time_constant: f64) -> Self {
        let longest = TIME_CONSTANTS * time_constant;
        let any_longer = times.windows(2).any(|ends| ends[1] - ends[0] > longest);
        let between = if any_longer { Between::Monotone } else { Between::BySpeed };
        Self { times, values, longest, between }
    }

    /// Of a controller that took these `samples`: when (s), ascending, and the effort (N, N·m) that it holds from then on.
    pub fn held(samples: &[[f64; 2]]) -> Self {
        let [times, values] = [0, 1].map(|i| samples.iter().map(|sample| sample[i]).collect());
        Self { times, values, longest: 0.0, between: Between::Held }
    }

    /// What is held up to time `t` (s), if a sample is taken there; `None` of an effort that is not held.
    pub fn held_before(&self, t: f64) -> Option<f64> {
        let after = self.times.partition_point(|time| *time <= t);
        let is_sample = self.between == Between::Held && after > 1 && self.times[after - 1] == t;
        is_sample.then(|| self.values[after - 2])
    }

    /// The effort at time `t` (s), where that of the interpolated speed is `by_speed`.
    pub fn at(&self, t: f64, by_speed: f64) -> f64 {
        match self.between {
            // That of most runs: no search for the step around `t`.
            Between::BySpeed => by_speed,
            Between::Monotone => self.before(self.times.partition_point(|knot| *knot < t), t, by_speed),
            Between::Held => {
                let after = self.times.partition_point(|time| *time <= t);
                after.checked_sub(1).map_or(by_speed, |last| self.values[last])
            }
        }
    }

    /// The same at the end of a step, where the speed is known.
    pub fn at_knot(&self, t: f64, by_speed: f64) -> f64 {
        if self.between == Between::Held { self.at(t, by_speed) } else { by_speed }
    }

    /// The same in the step that ends at `knot`.
    pub fn before(&self, knot: usize, t: f64, by_speed: f64) -> f64 {
        if self.between == Between::Held {
            return self.at(t, by_speed);
        }
        match knot.checked_sub(1) {
            Some(i) if knot < self.times.len() && self.length(i) > self.longest => self.monotone(i, t),
            _ => by_speed,
        }
    }

    fn length(&self, i: usize) -> f64 {
        self.times[i + 1] - self.times[i]
    }

    /// The slope (per s) between the ends `i` and `i + 1`; none outside of the run.
    fn chord(&self, i: Option<usize>) -> Option<f64> {
        let i = i.filter(|i| i + 1 < self.times.len())?;
        Some((self.values[i + 1] - self.values[i]) / self.length(i))
    }

    /// The slope (per s) at the end `i`: the harmonic mean of those on both sides where they agree in sign (Fritsch and Butland, SIAM J.
    /// Sci. Stat. Comput. 5, 1984), which keeps the curve monotone.
    fn slope(&self, i: usize) -> f64 {
        match (self.chord(i.checked_sub(1)), self.chord(Some(i))) {
            (Some(before), Some(after)) if before * after > 0.0 => {
                let [first, second] = [self.length(i - 1), self.length(i)];
                let weights = [first + 2.0 * second, 2.0 * first + second];
                (weights[0] + weights[1]) / (weights[0] / before + weights[1] / after)
            }
            (Some(_), Some(_)) => 0.0,
            (one, other) => one.or(other).unwrap_or(0.0),
        }
    }

    /// The monotone cubic between the ends `i` and `i + 1` at time `t` (s).
    fn monotone(&self, i: usize, t: f64) -> f64 {
        let length = self.length(i);
        let s = (t - self.times[i]) / length;
        let rest = 1.0 - s;
        self.values[i] * rest * rest * (1.0 + 2.0 * s)
            + self.values[i + 1] * s * s * (3.0 - 2.0 * s)
            + length * s * rest * (self.slope(i) * rest - self.slope(i + 1) * s)
    }
}

#[cfg(test)]
mod tests {
    use super::Effort;

    /// Over steps of 0.1 s.
    fn effort(values: &[f64], time_constant: f64) -> Effort {
        let times = (0..values.len()).map(|k| k as f64 * 0.1).collect();
        Effort::new(times, values.to_vec(), time_constant)
    }

    #[test]
    fn a_stiff_drive_gives_nothing_beyond_the_ends_of_steps() {
        let values = [0.0, 1.0, 1.0, -3.0, 0.5, 0.4, 0.4];
        let effort = effort(&values, 1e-4);
        for k in 0..=600 {
            let t = f64::from(k) * 1e-3;
            let i = ((k / 100) as usize).min(5);
            let (least, most) = (values[i].min(values[i + 1]), values[i].max(values[i + 1]));
            let found = effort.at(t, 100.0);
            assert!(k == 0 || (least - 1e-12..=most + 1e-12).contains(&found), "{t}: {found}");
        }
    }

    #[test]
    fn it_errs_by_the_third_power_of_the_step_where_it_is_monotone() {
        let worst = |count: usize| {
            let times: Vec<f64> = (0..=count).map(|k| k as f64 / count as f64).collect();
            let values = times.iter().map(|t| libm::exp(*t)).collect();
            let effort = Effort::new(times, values, 0.0);
            (100..900)
                .map(|k| f64::from(k) * 1e-3)
                .fold(0.0f64, |most, t| most.max((effort.at(t, 0.0) - libm::exp(t)).abs()))
        };
        let order = libm::log2(worst(16) / worst(32));
        assert!(order > 2.8 && worst(32) < 1e-5, "{order} {}", worst(32));
    }

    #[test]
    fn a_soft_drive_gives_what_its_speed_says() {
        assert_eq!(effort(&[0.0, 1.0, 2.0], 1.0).at(0.05, 7.0), 7.0);
    }
}
