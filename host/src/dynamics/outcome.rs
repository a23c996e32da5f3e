//! What one simulated unit did.

use serde::Serialize;
use slipfit_core::table::MotionVerdict;
use slipfit_desk::settled::extremes;
pub use slipfit_desk::settled::{BREAKAWAY_SPEED, SETTLED_WINDOW, settled};

use super::setpoint::Setpoint;
use crate::setup::RunSpec;

/// Share of the commanded speed from which a unit runs.
pub const RUNS: f64 = 0.5;

/// Share of the commanded speed below which it is jammed.
pub const JAMMED: f64 = 0.01;

/// Share of the commanded speed beyond which a unit overruns it.
pub const OVERRUNS: f64 = 1.5;

/// Whether the unit does its job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// 50 % to 150 % of the commanded speed at the end.
    Runs,
    /// 1 % to 50 %.
    Crawls,
    /// Below 1 %.
    Jammed,
    /// Above 150 %, or against the command at more than half of its speed.
    Overruns,
    /// The run ends before the ramp does, nothing is commanded, or a finer run says otherwise.
    Undecided,
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Runs => "runs",
            Self::Crawls => "crawls",
            Self::Jammed => "jammed",
            Self::Overruns => "overruns",
            Self::Undecided => "undecided",
        })
    }
}

impl Verdict {
    /// Whether the unit does not do its job. Without a verdict nobody knows.
    pub fn is_malfunction(self) -> bool {
        matches!(self, Self::Crawls | Self::Jammed | Self::Overruns)
    }

    /// Of a unit that moves with `share` of its command at the end; none if it had no command, or it was not `over`.
    pub fn of(share: f64, over: bool) -> Self {
        if !over || share.is_nan() {
            Self::Undecided
        } else if !(-RUNS..=OVERRUNS).contains(&share) {
            Self::Overruns
        } else if share >= RUNS {
            Self::Runs
        } else if share >= JAMMED {
            Self::Crawls
        } else {
            Self::Jammed
        }
    }
}

impl Outcome {
    /// Whether its drive has run away from the `command` (m/s, rad/s).
    pub fn runs_away(&self, command: f64) -> bool {
        has_run_away(self.final_velocity, command)
    }
}

impl From<Verdict> for MotionVerdict {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Runs => Self::Runs,
            Verdict::Crawls => Self::Crawls,
            Verdict::Jammed => Self::Jammed,
            // A table has no motion to offer for it.
            Verdict::Overruns | Verdict::Undecided => Self::Undecided,
        }
    }
}

/// When and where something happens on the way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Moment {
    /// Time (s).
    pub t: f64,
    /// Travel (m) along the drive's direction.
    pub z: f64,
}

/// Figures of one unit. Speeds, forces and travel count along the commanded direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Breakaway time (s): the last upward crossing of 0.2 mm/s after the ramp's start; `None` if there is none.
    pub breakaway: Option<f64>,
    /// Magnitude of the greatest force, driving or braking, from the ramp's start on (N); `None` if the run ends before.
    pub peak_force: Option<f64>,
    /// Mean force over the last 20 ms (N), if it varies by less than 1 %.
    pub settled_force: Option<f64>,
    /// Velocity at the end (m/s).
    pub final_velocity: f64,
    /// The end of the run: at the stroke's end, or when its time is over.
    pub end: Moment,
    /// Whether the run came to the end of the stroke; `None` where the scene states no stroke.
    pub stroke_reached: Option<bool>,
    /// Least and greatest velocity (m/s) over the last 20 ms, if a limit between two verdicts lies between them: the verdict is
    /// then that of the last instant, and another a moment before.
    pub swings: Option<[f64; 2]>,
    /// From where on the unit is slower than half of the command, if it is so at the end and was faster before.
    pub slows: Option<Moment>,
    /// From where on it is slower than 1 % of the command, likewise.
    pub stops: Option<Moment>,
    /// Where the slide tips: the first wall below a pin that meets its pin after the ramp's start, having been free until then.
    pub tips: Option<Moment>,
    /// Speed as a share of the command where the verdict is made; NaN without a command.
    #[serde(skip)]
    pub share: f64,
    /// The verdict, at the end; of a command with several stretches of constant speed, at the end of each: the first that is not run.
    pub verdict: Verdict,
}

/// An instant of a run. Velocity, force and travel along the frame's z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Time (s).
    pub t: f64,
    /// Velocity (m/s).
    pub vz: f64,
    /// Drive force (N).
    pub force: f64,
    /// Displacement (m).
    pub z: f64,
}

/// Watches a run instant by instant and keeps its figures, not the run.
#[derive(Clone, Debug)]
pub struct Observer {
    setpoint: Setpoint,
    /// Ends of stretches of constant speed that are still to come, the last first.
    holds: Vec<f64>,
    /// The share of the command at the end of the first such stretch in which the unit did not run, or else of the last one.
    held: Option<f64>,
    /// From when on it was slow where it first did not run at the end of such a stretch.
    failed: Option<[Option<Moment>; 2]>,
    run: RunSpec,
    last: Option<Instant>,
    breakaway: Option<f64>,
    peak: Option<f64>,
    /// Below which the unit was seen last: half of the command, and 1 % of it.
    below: [Below; 2],
    tips: Option<Moment>,
    /// The last [`SETTLED_WINDOW`].
    window: std::collections::VecDeque<Instant>,
}

/// Whether a unit is slower than a share of its command, and since when.
#[derive(Clone, Copy, Debug, Default)]
struct Below {
    was_above: bool,
    since: Option<Moment>,
}

impl Below {
    fn observe(&mut self, is_below: bool, at: Moment) {
        if !is_below {
            *self = Self { was_above: true, since: None };
        } else if self.was_above && self.since.is_none() {
            self.since = Some(at);
        }
    }
}

impl Observer {
    /// For a `run` under a drive that is commanded `setpoint`.
    pub fn new(setpoint: impl Into<Setpoint>, run: RunSpec) -> Self {
        let setpoint = setpoint.into();
        let mut holds = setpoint.holds();
        holds.reverse();
        let below = [Below::default(); 2];
        let window = std::collections::VecDeque::new();
        Self {
            setpoint,
            holds,
            held: None,
            failed: None,
            run,
            last: None,
            breakaway: None,
            peak: None,
            below,
            tips: None,
            window,
        }
    }

    /// 1 or −1: the direction of the command. Speeds, forces and travel count along it.
    fn along(&self) -> f64 {
        self.setpoint.along()
    }

    /// Whether a slide displaced by `z` (m) has come to the end of the stroke.
    pub fn is_at_end(&self, z: f64) -> bool {
        self.run.stroke.is_some_and(|stroke| z * self.along() >= stroke)
    }

    /// Takes note of an instant. Times ascend.
    pub fn observe(&mut self, at: Instant) {
        let along = self.along();
        let now = Instant { vz: at.vz * along, force: at.force * along, z: at.z * along, ..at };
        let Instant { t, vz, force, z } = now;
        self.hold(&now);
        if t >= self.setpoint.start() {
            if let Some(before) = self.last
                && before.t >= self.setpoint.start()
                && before.vz < BREAKAWAY_SPEED
                && vz >= BREAKAWAY_SPEED
            {
                self.breakaway = Some(before.t + (t - before.t) * (BREAKAWAY_SPEED - before.vz) / (vz - before.vz));
            }
            self.peak = Some(self.peak.map_or(force.abs(), |peak| peak.max(force.abs())));
            let command = self.setpoint.at(t) * along;
            // Backwards where that is commanded.
            let (vz, command) = if command < 0.0 { (-vz, -command) } else { (vz, command) };
            for (below, share) in self.below.iter_mut().zip([RUNS, JAMMED]) {
                // A release burst is no motion.
                let is_below = vz < (share * command).max(BREAKAWAY_SPEED);
                below.observe(is_below, Moment { t, z });
            }
        }
        self.last = Some(now);
        self.window.push_back(now);
        // A hair early, so that rounding of the time cannot cost the first sample of the window.
        while self.window.front().is_some_and(|first| first.t < t - SETTLED_WINDOW * (1.0 + 1e-9)) {
            self.window.pop_front();
        }
    }

    /// Takes note of the share of the command at the end of a stretch of constant speed, where `now` is there.
    fn hold(&mut self, now: &Instant) {
        while let Some(end) = self.holds.last().copied().filter(|end| now.t >= end * (1.0 - 1e-12)) {
            self.holds.pop();
            let at = match self.last {
                Some(last) if now.t > end => last,
                _ => *now,
            };
            let share = at.vz / (self.setpoint.at(end * (1.0 - 1e-9)) * self.along());
            if self.failed.is_none() && Verdict::of(share, true) != Verdict::Runs {
                self.failed = Some(self.below.map(|below| below.since));
            }
            self.held = Some(self.held.map_or(share, |held| first_failure(held, share)));
        }
    }

    /// Takes note that the slide tips at time `t` (s), displaced by `z` (m). The first time counts.
    pub fn tips(&mut self, t: f64, z: f64) {
        let z = z * self.along();
        self.tips.get_or_insert(Moment { t, z });
    }

    /// The figures of the run, which ended with the last instant observed.
    pub fn outcome(&self) -> Outcome {
        let Instant { t, vz, z, .. } = self.last.unwrap_or(Instant { t: 0.0, vz: 0.0, force: 0.0, z: 0.0 });
        let is_at_end = self.run.stroke.map(|stroke| z >= stroke);
        let command = self.setpoint.settled_at(t) * self.along();
        // At the stroke's end what the command is by then counts.
        let over = t >= self.setpoint.end() || is_at_end == Some(true) || self.failed.is_some();
        let at_end = (command != 0.0).then_some(vz / command);
        let share = [self.held, at_end].into_iter().flatten().reduce(first_failure);
        let verdict = share.map_or(Verdict::Undecided, |share| Verdict::of(share, over));
        let share = share.unwrap_or(f64::NAN);
        let swings = extremes(self.window.iter().map(|at| at.vz))
            .filter(|_| verdict != Verdict::Undecided && command != 0.0)
            .filter(|speeds| between_verdicts(speeds.map(|speed| speed / command)));
        let at_end = self.below.map(|below| below.since.filter(|_| over && command != 0.0));
        let [slows, stops] = self.failed.unwrap_or(at_end);
        Outcome {
            breakaway: self.breakaway,
            peak_force: self.peak,
            settled_force: settled(self.window.iter().map(|at| (at.t, at.force))),
            final_velocity: vz,
            end: Moment { t, z },
            stroke_reached: is_at_end,
            swings,
            slows,
            stops,
            tips: self.tips,
            share,
            verdict,
        }
    }
}

/// The `first` of two shares of a command if the unit does not run with it, else the `second`.
fn first_failure(first: f64, second: f64) -> f64 {
    if Verdict::of(first, true) == Verdict::Runs { second } else { first }
}

/// Speed, as a share of the command, beyond which a drive has run away.
const RUN_AWAY: f64 = 100.0;

/// Whether a `speed` (m/s, rad/s) is that of a drive which has run away from its `command`.
pub fn has_run_away(speed: f64, command: f64) -> bool {
    command != 0.0 && speed.abs() > RUN_AWAY * command.abs()
}

/// Whether a limit between two verdicts lies between the least and the greatest of these speeds, as shares of the command.
pub fn between_verdicts([least, greatest]: [f64; 2]) -> bool {
    [OVERRUNS, RUNS, JAMMED, -RUNS].iter().any(|limit| least < *limit && *limit <= greatest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipfit_core::{Vector3, drive::Drive};

    fn run(duration: f64, stroke: Option<f64>) -> RunSpec {
        RunSpec { duration, stroke, error: 1e-6 }
    }

    /// The outcome of a slide with this `speed` over time, seen every `every` (s).
    fn observe(speed: impl Fn(f64) -> f64, duration: f64, every: f64) -> Outcome {
        let drive = Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() };
        let mut observer = Observer::new(drive, run(duration, None));
        let steps = (duration / every).round() as u32;
        let mut z = 0.0;
        for k in 0..=steps {
            let t = f64::from(k) * every;
            z += speed(t) * every;
            observer.observe(Instant { t, vz: speed(t), force: drive.force(t, speed(t)), z });
        }
        observer.outcome()
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
        let outcome = observe(speed, 1.5, 1e-4);
        assert!((outcome.breakaway.unwrap() - 0.704).abs() < 1e-9, "{outcome:?}");
        assert_eq!(observe(|_| 0.0, 1.5, 1e-4).breakaway, None);
    }

    #[test]
    fn verdicts_follow_the_share_of_the_commanded_speed() {
        let all = [
            (0.15, Verdict::Runs),
            (0.05, Verdict::Runs),
            (0.049, Verdict::Crawls),
            (0.001, Verdict::Crawls),
            (-0.049, Verdict::Jammed),
            (-0.051, Verdict::Overruns),
            (0.151, Verdict::Overruns),
            (-2468.0, Verdict::Overruns),
            (f64::INFINITY, Verdict::Overruns),
        ];
        for (v, verdict) in all {
            let found = Verdict::of(v / 0.1, true);
            assert_eq!(found, verdict, "{v}");
            assert_eq!(found.is_malfunction(), verdict != Verdict::Runs);
            if v.is_finite() {
                assert_eq!(observe(|_| v, 1.5, 1e-4).verdict, verdict);
            }
        }
        assert_eq!(observe(|_| 0.000_99, 1.0, 1e-4).verdict, Verdict::Jammed);
        assert_eq!(observe(|_| 0.1, 0.999, 1e-4).verdict, Verdict::Undecided);
    }

    #[test]
    fn settles_only_if_steady_however_often_it_is_seen() {
        for every in [1e-4, 3e-3, 7e-3] {
            let steady = observe(|_| 0.0, 1.5, every);
            assert!((steady.settled_force.unwrap() - 4.0).abs() < 1e-9, "{every}: {steady:?}");
            assert_eq!(steady.peak_force, Some(4.0));
            assert_eq!(observe(|t| 0.01 * t, 0.5, every).settled_force, None);
        }
        assert_eq!(observe(|_| 0.0, 0.04, 1e-4).peak_force, None);
    }

    #[test]
    fn tells_where_a_unit_slows_and_stops() {
        // At full speed until 1.2 s, then ever slower, and still from 1.4 s on.
        let speed = |t: f64| match t {
            t if t < 1.0 => 0.1 * t,
            t if t < 1.2 => 0.1,
            t if t < 1.4 => 0.1 * (1.4 - t) / 0.2,
            _ => 0.0,
        };
        let Outcome { slows, stops, verdict, end, .. } = observe(speed, 1.5, 1e-4);
        let (slows, stops) = (slows.unwrap(), stops.unwrap());
        assert!((slows.t - 1.3).abs() < 2e-4 && (slows.z - 0.0775).abs() < 1e-4, "{slows:?}");
        // 0.2 mm/s is the least speed that counts as motion, 1 % of the command is more.
        assert!((stops.t - 1.398).abs() < 2e-4 && (stops.z - 0.08).abs() < 1e-4, "{stops:?}");
        assert_eq!(verdict, Verdict::Jammed);
        assert!((end.z - 0.08).abs() < 1e-4);
        // What never moved does not stop anywhere, and what recovers does not either.
        assert_eq!(observe(|_| 0.0, 1.5, 1e-4).stops, None);
        let recovers = observe(|t| if (1.1..1.2).contains(&t) { 0.0 } else { 0.1 }, 1.5, 1e-4);
        assert_eq!((recovers.slows, recovers.stops), (None, None));
    }

    #[test]
    fn tells_where_the_verdict_is_that_of_a_moment() {
        // Shaken at 30 Hz about a mean speed, by so much to either side.
        let shaken = |mean: f64, by: f64| {
            observe(move |t| mean + by * libm::sin(2.0 * core::f64::consts::PI * 30.0 * t), 1.5, 1e-4)
        };
        let [least, greatest] = shaken(0.05, 0.03).swings.unwrap();
        assert!(least < 0.03 && greatest > 0.06, "{least} {greatest}");
        // Where all of it runs, or crawls, nothing is said.
        assert_eq!(shaken(0.09, 0.03).swings, None);
        assert_eq!(shaken(0.02, 0.01).swings, None);
        assert_eq!(observe(|_| 0.0, 1.5, 1e-4).swings, None);
        // Nor of what was over before the last 20 ms.
        assert_eq!(observe(|t| if t < 1.45 { 0.02 } else { 0.1 }, 1.5, 1e-4).swings, None);
    }

    #[test]
    fn the_stroke_ends_the_run_in_either_direction() {
        for direction in [1.0, -1.0] {
            let speed = 0.1 * direction;
            let drive = Drive { gain: 40.0, ramp_start: 0.0, ramp_end: 0.1, speed, point_b: Vector3::zeros() };
            let mut observer = Observer::new(drive, run(1.0, Some(0.02)));
            assert!(!observer.is_at_end(0.019 * direction) && observer.is_at_end(0.0201 * direction));
            observer.observe(Instant { t: 0.2, vz: speed, force: 0.0, z: 0.02 * direction });
            let outcome = observer.outcome();
            assert_eq!((outcome.stroke_reached, outcome.verdict), (Some(true), Verdict::Runs));
            assert!((outcome.end.z - 0.02).abs() < 1e-15);
        }
    }
}
