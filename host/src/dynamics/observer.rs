//! Watching a run for its figures.

use std::collections::VecDeque;

use slipfit_desk::settled::{BREAKAWAY_SPEED, SETTLED_WINDOW, extremes, settled};

use super::{
    outcome::{JAMMED, Moment, Outcome, RUNS, Verdict, between_verdicts},
    setpoint::Setpoint,
};
use crate::setup::RunSpec;

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
    window: VecDeque<Instant>,
    /// From when (s) on that may be.
    window_from: f64,
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
        let window = VecDeque::new();
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
            window_from: f64::NEG_INFINITY,
        }
    }

    /// The same observer of a run that is known to end at `end` (s).
    #[must_use]
    pub fn until(self, end: f64) -> Self {
        Self { window_from: end - SETTLED_WINDOW * (1.0 + 1e-9), ..self }
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
        if t < self.window_from {
            return;
        }
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
