//! What one simulated unit did.

use serde::Serialize;
use slipfit_core::table::MotionVerdict;
pub use slipfit_desk::settled::{BREAKAWAY_SPEED, SETTLED_WINDOW, settled};

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
