//! What moves under one drive, whether a slide on pins or a mechanism: what sweeps, tables and reports are about.

use slipfit_core::drive::Drive;

use super::{level::Level, run::SimulateError, setpoint::Setpoint};
use crate::setup::{LevelRange, RunSpec};

/// What a drive gives: a force along an axis, or a torque about one. Forces (N), speeds (m/s) and travel (m) of the one
/// are torques (N·m), angular velocities (rad/s) and angles (rad) of the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DriveKind {
    /// A force.
    #[default]
    Pushes,
    /// A torque.
    Turns,
}

impl DriveKind {
    /// What it gives.
    pub fn effort(self) -> &'static str {
        self.choose("force", "torque")
    }

    /// The unit of what it gives.
    pub fn effort_unit(self) -> &'static str {
        self.choose("N", "N·m")
    }

    /// The unit in which speeds are shown.
    pub fn speed_unit(self) -> &'static str {
        self.choose("mm/s", "rad/s")
    }

    /// A speed in the unit in which it is shown.
    pub fn speed(self, speed: f64) -> f64 {
        self.choose(1e3, 1.0) * speed
    }

    /// The unit in which travel is shown.
    pub fn travel_unit(self) -> &'static str {
        self.choose("mm", "°")
    }

    /// Travel in the unit in which it is shown.
    pub fn travel(self, travel: f64) -> f64 {
        self.choose(1e3, 180.0 / std::f64::consts::PI) * travel
    }

    /// One of two.
    pub fn choose<T>(self, pushes: T, turns: T) -> T {
        match self {
            Self::Pushes => pushes,
            Self::Turns => turns,
        }
    }
}

/// How a unit is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Commanded speed (m/s, rad/s).
    pub speed: f64,
    /// Duration and stroke.
    pub run: RunSpec,
    /// Interval (s) of the samples.
    pub every: f64,
}

/// What moves under one drive.
pub trait Driven: Sync {
    /// Title, for plots and reports.
    fn title(&self) -> &str;

    /// What the drive gives.
    fn kind(&self) -> DriveKind;

    /// The drive.
    fn drive(&self) -> &Drive<f64>;

    /// What it is commanded.
    fn setpoint(&self) -> Setpoint {
        (*self.drive()).into()
    }

    /// Whether it is commanded segments, which may reverse, instead of a ramp to one speed.
    fn has_segments(&self) -> bool {
        false
    }

    /// Duration, stroke and error.
    fn run(&self) -> RunSpec;

    /// Tolerance levels.
    fn levels(&self) -> &LevelRange;

    /// Names of the gaps, in the order of [`Level::classes`].
    fn gap_names(&self) -> Vec<String>;

    /// What flash tables and kernels are stamped with: the physics of every unit. How the desk and the controller compute is
    /// no part of it, because a table holds for whatever predicts the same scene.
    fn hash(&self) -> u64;

    /// The desk's run of the unit of level `n`, its verdict and trust by a run at a tenth of the tolerance.
    ///
    /// # Errors
    /// See [`SimulateError`].
    fn level(&self, n: f64, motion: Motion) -> Result<Level, SimulateError>;

    /// As the scene has it, sampled every `every` (s).
    fn motion(&self, every: f64) -> Motion {
        Motion { speed: self.drive().speed, run: self.run(), every }
    }

    /// What the drive gives at most (N, N·m): standing still, at the command's full speed.
    fn greatest_force(&self) -> f64 {
        (self.drive().gain * self.drive().speed).abs()
    }

    /// The time (s) after which a run of the whole stroke is over: the ramp, then the stroke at the commanded speed. What runs
    /// at half of that speed or slower does not come to its end. `None` where no stroke is stated or nothing is commanded.
    fn stroke_duration(&self) -> Option<f64> {
        let Drive { ramp_end, speed, .. } = self.drive();
        self.run().stroke.filter(|_| *speed != 0.0).map(|stroke| ramp_end.max(0.0) + stroke / speed.abs())
    }
}
