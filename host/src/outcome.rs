//! What one simulated unit did.

use serde::Serialize;
use slipfit_core::drive::Drive;

/// Speed (m/s) whose last upward crossing is the breakaway. Bursts of released compression stay below it.
pub const BREAKAWAY_SPEED: f64 = 0.2e-3;

/// Length (s) of the end of a run over which a force must be steady to count as settled.
pub const SETTLED_WINDOW: f64 = 0.020;

/// A run sampled at equal intervals, SI units. All vectors have the same length.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Trajectory {
    /// Time (s), from 0 on.
    pub t: Vec<f64>,
    /// Velocity of the centre of mass along z (m/s).
    pub vz: Vec<f64>,
    /// Drive force (N).
    pub force: Vec<f64>,
    /// Displacement of the centre of mass across (m).
    pub x: Vec<f64>,
    /// Displacement of the centre of mass up (m).
    pub y: Vec<f64>,
    /// Displacement of the centre of mass along z (m).
    pub z: Vec<f64>,
    /// The greatest residual of any step (N·s).
    pub worst_residual: f64,
}

impl Trajectory {
    /// The greatest difference of the drive force from the time `from` (s) on, over the greatest force of `other`, which is
    /// sampled at the same times.
    pub fn greatest_difference(&self, other: &Self, from: f64) -> f64 {
        let peak = other.force.iter().fold(f64::MIN_POSITIVE, |most, force| most.max(force.abs()));
        let late = self.t.iter().zip(self.force.iter().zip(&other.force)).filter(|(t, _)| **t >= from - 1e-9);
        late.fold(0.0f64, |most, (_, (force, other))| most.max((force - other).abs())) / peak
    }
}

/// Whether the unit does its job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// At least half of the commanded speed at the end.
    Runs,
    /// 1 % to 50 %.
    Crawls,
    /// Below 1 %.
    Jammed,
    /// The run ends before the ramp does, nothing is commanded, or a run at half the step says otherwise.
    Undecided,
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Runs => "runs",
            Self::Crawls => "crawls",
            Self::Jammed => "jammed",
            Self::Undecided => "undecided",
        })
    }
}

/// Figures of one unit. Speeds and forces count along the commanded direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Breakaway time (s): the last upward crossing of 0.2 mm/s after the ramp's start; `None` if there is none.
    pub breakaway: Option<f64>,
    /// Greatest force from the ramp's start on (N); `None` if the run ends before.
    pub peak_force: Option<f64>,
    /// Mean force over the last 20 ms (N), if it varies by less than 1 %.
    pub settled_force: Option<f64>,
    /// Velocity at the end (m/s).
    pub final_velocity: f64,
    /// The verdict.
    pub verdict: Verdict,
}

/// Watches a run step by step and keeps its figures, not the run.
#[derive(Clone, Debug)]
pub struct Observer {
    drive: Drive<f64>,
    window_start: f64,
    last: Option<(f64, f64)>,
    breakaway: Option<f64>,
    peak: Option<f64>,
    window: Option<Window>,
}

#[derive(Clone, Copy, Debug)]
struct Window {
    least: f64,
    greatest: f64,
    sum: f64,
    count: f64,
}

impl Observer {
    /// For a run of `duration` (s) under `drive`.
    pub fn new(drive: Drive<f64>, duration: f64) -> Self {
        // A hair early, so that rounding of the time cannot cost the first sample of the window.
        let window_start = duration - SETTLED_WINDOW * (1.0 + 1e-9);
        Self { drive, window_start, last: None, breakaway: None, peak: None, window: None }
    }

    /// 1 or −1: the direction of the command. Speeds and forces count along it.
    fn along(&self) -> f64 {
        if self.drive.speed < 0.0 { -1.0 } else { 1.0 }
    }

    /// Takes note of the time `t` (s), the velocity `vz` (m/s) and the drive force (N). Times ascend.
    pub fn observe(&mut self, t: f64, vz: f64, force: f64) {
        let (vz, force) = (vz * self.along(), force * self.along());
        if t >= self.drive.ramp_start {
            if let Some((before, speed)) = self.last
                && speed < BREAKAWAY_SPEED
                && vz >= BREAKAWAY_SPEED
            {
                self.breakaway = Some(before + (t - before) * (BREAKAWAY_SPEED - speed) / (vz - speed));
            }
            self.last = Some((t, vz));
            self.peak = Some(self.peak.map_or(force, |peak| peak.max(force)));
        }
        if t >= self.window_start {
            let so_far = self.window.unwrap_or(Window { least: force, greatest: force, sum: 0.0, count: 0.0 });
            self.window = Some(Window {
                least: so_far.least.min(force),
                greatest: so_far.greatest.max(force),
                sum: so_far.sum + force,
                count: so_far.count + 1.0,
            });
        }
    }

    /// The figures of a run that ended at `t` (s) with `vz` (m/s).
    pub fn outcome(&self, t: f64, vz: f64) -> Outcome {
        let settled_force = self.window.and_then(|window| {
            let mean = window.sum / window.count;
            (window.greatest - window.least < 0.01 * mean.abs()).then_some(mean)
        });
        let (vz, command) = (vz * self.along(), self.drive.speed.abs());
        let share = vz / command;
        let verdict = if t < self.drive.ramp_end || command == 0.0 {
            Verdict::Undecided
        } else if share >= 0.5 {
            Verdict::Runs
        } else if share >= 0.01 {
            Verdict::Crawls
        } else {
            Verdict::Jammed
        };
        Outcome { breakaway: self.breakaway, peak_force: self.peak, settled_force, final_velocity: vz, verdict }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipfit_core::Vector3;

    fn observe(speed: impl Fn(f64) -> f64, duration: f64) -> Outcome {
        let drive = Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() };
        let mut observer = Observer::new(drive, duration);
        let steps = (duration * 1e4).round() as u32;
        for k in 0..=steps {
            let t = f64::from(k) * 1e-4;
            observer.observe(t, speed(t), drive.force(t, speed(t)));
        }
        observer.outcome(duration, speed(duration))
    }

    #[test]
    fn breakaway_is_the_last_upward_crossing_after_the_ramp_starts() {
        // A burst before the ramp, one after it, and the real start at 0.7 s.
        let speed = |t: f64| match t {
            t if (0.001..0.002).contains(&t) => 1e-3,
            t if (0.1..0.11).contains(&t) => 3e-4,
            t if t > 0.7 => 0.05 * (t - 0.7),
            _ => 0.0,
        };
        let outcome = observe(speed, 1.5);
        assert!((outcome.breakaway.unwrap() - 0.704).abs() < 1e-9, "{outcome:?}");
        assert_eq!(observe(|_| 0.0, 1.5).breakaway, None);
    }

    #[test]
    fn verdicts_follow_the_share_of_the_commanded_speed() {
        for (v, verdict) in [(0.05, Verdict::Runs), (0.049, Verdict::Crawls), (0.001, Verdict::Crawls)] {
            assert_eq!(observe(|_| v, 1.5).verdict, verdict);
        }
        assert_eq!(observe(|_| 0.000_99, 1.0).verdict, Verdict::Jammed);
        assert_eq!(observe(|_| 0.1, 0.999).verdict, Verdict::Undecided);
    }

    #[test]
    fn settles_only_if_steady() {
        let steady = observe(|_| 0.0, 1.5);
        assert!((steady.settled_force.unwrap() - 4.0).abs() < 1e-9);
        assert_eq!(steady.peak_force, Some(4.0));
        assert_eq!(observe(|t| 0.01 * t, 0.5).settled_force, None);
        assert_eq!(observe(|_| 0.0, 0.04).peak_force, None);
    }
}
