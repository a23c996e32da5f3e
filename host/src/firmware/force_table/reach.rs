//! How far units come along the axis of positions, and why there are no runs that a table over it can be made of.

use slipfit_tolerance::number::ten_digits;
use thiserror::Error;

use super::SUBSAMPLES;
use crate::dynamics::{driven::DriveKind, outcome::Verdict};

/// Distance of the table's positions (m), unless its region of flash has too little room.
pub const STEP: f64 = 0.25e-3;

/// Distance (m) of the samples of a run.
pub const SAMPLE: f64 = STEP / SUBSAMPLES as f64;

/// Distance of the table's angles (rad), a quarter of a degree, unless its region of flash has too little room.
pub const TURN_STEP: f64 = std::f64::consts::PI / 720.0;

/// Distance (rad) of the samples of a run.
pub const TURN_SAMPLE: f64 = TURN_STEP / SUBSAMPLES as f64;

/// The longest stroke (m).
const STROKE_MOST: f64 = 1.0;

/// The longest turn (rad), ten times around.
const TURN_MOST: f64 = 20.0 * std::f64::consts::PI;

/// The most runs of a table.
pub(super) const RUNS_MOST: usize = 200_000;

/// How far a unit comes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Reach {
    /// Tolerance level.
    pub n: f64,
    /// Commanded speed (m/s).
    pub speed: f64,
    /// Farthest position (m).
    pub z: f64,
    /// Whether it moves when the run ends.
    pub verdict: Verdict,
}

/// Seconds in ms as they were typed.
fn ms(seconds: f64) -> String {
    ten_digits(seconds * 1e3)
}

impl DriveKind {
    pub(super) fn step(self) -> f64 {
        self.choose(STEP, TURN_STEP)
    }

    pub(super) fn sample(self) -> f64 {
        self.choose(SAMPLE, TURN_SAMPLE)
    }

    pub(super) fn most(self) -> f64 {
        self.choose(STROKE_MOST, TURN_MOST)
    }

    /// Travel as it was typed.
    fn typed(self, travel: f64) -> String {
        format!("{} {}", ten_digits(self.travel(travel)), self.travel_unit())
    }

    /// A speed as it was typed.
    fn typed_speed(self, speed: f64) -> String {
        format!("{} {}", ten_digits(self.speed(speed)), self.speed_unit())
    }
}

/// Why there are no runs that a table over position can be made of.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PositionError {
    /// The drive may come by a position more than once.
    #[error("a drive that is commanded segments may come by a position several times: make its table over time")]
    Segments,
    /// The drive does not come to its speed.
    #[error(
        "the run of {} ms ends before the drive's ramp does, at {} ms: a table over position takes a stroke, \
         so state a run.stroke or a longer run.duration",
        ms(*duration),
        ms(*ramp_end)
    )]
    Ramp {
        /// Duration of the run (s).
        duration: f64,
        /// End of the ramp (s).
        ramp_end: f64,
    },
    /// No unit comes to the end of the axis.
    #[error(
        "no unit comes {} far: in {} ms the farthest, at n = {} and {}, comes {:.3} {}; \
         take a longer run.duration, other levels or a faster drive",
        kind.typed(*asked), ms(*duration), farthest.n, kind.typed_speed(farthest.speed), kind.travel(farthest.z),
        kind.travel_unit()
    )]
    TooFar {
        /// What the drive gives.
        kind: DriveKind,
        /// Where the axis is to end (m).
        asked: f64,
        /// Who comes farthest.
        farthest: Reach,
        /// Duration of the run (s).
        duration: f64,
    },
    /// A stroke (m, rad) that no axis can have.
    #[error("the stroke is {}, allowed is {} to {}", kind.typed(*stroke), kind.typed(kind.step()), kind.typed(kind.most()))]
    Stroke {
        /// What the drive gives.
        kind: DriveKind,
        /// The stroke.
        stroke: f64,
    },
    /// More runs than anyone waits for.
    #[error("levels and speeds, with those half way between, make {0} runs, allowed are at most {RUNS_MOST}")]
    TooMany(usize),
    /// Speeds in both directions, or none at all.
    #[error(
        "speeds from {} to {}: all have to be positive, or all negative",
        kind.typed_speed(*first),
        kind.typed_speed(*last)
    )]
    Direction {
        /// What the drive gives.
        kind: DriveKind,
        /// First speed (m/s).
        first: f64,
        /// Last speed (m/s).
        last: f64,
    },
}
