//! What one simulated unit did.

use serde::Serialize;

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
    /// The greatest residual of any step (N·s).
    pub worst_residual: f64,
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
    /// The run ends before the ramp does, or a run at half the step says otherwise.
    Undecided,
}

/// Figures of one unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Breakaway time (s): the last upward crossing of 0.2 mm/s after the ramp's start; `None` if there is none.
    pub breakaway: Option<f64>,
    /// Greatest force from the ramp's start on (N).
    pub peak_force: f64,
    /// Mean force over the last 20 ms (N), if it varies by less than 1 %.
    pub settled_force: Option<f64>,
    /// Velocity at the end (m/s).
    pub final_velocity: f64,
    /// The verdict.
    pub verdict: Verdict,
}
