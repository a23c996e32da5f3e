//! What is to be computed, and how.

use slipfit_desk::scheme::{IntegratorKind, ScalarKind};

/// What is simulated, and how well the desk has to know it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSpec {
    /// The longest simulated time (s).
    pub duration: f64,
    /// Travel (m) along the drive's direction at which a run ends; `None` where the scene states none.
    pub stroke: Option<f64>,
    /// Error of the drive force that a step of the desk may make, as a share of the drive's greatest force.
    pub error: f64,
}

/// How the controller computes: steps of one length by one scheme in one number type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerSpec {
    /// Step (s).
    pub step: f64,
    /// Scheme.
    pub integrator: IntegratorKind,
    /// Number type.
    pub scalar: ScalarKind,
}

/// Equidistant tolerance levels: `first`, `first + step`, …, up to `last`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelRange {
    /// First level.
    pub first: f64,
    /// Distance between levels, positive.
    pub step: f64,
    /// How many, at least 1.
    pub count: usize,
}

impl LevelRange {
    /// The `i`-th level.
    pub fn level(&self, i: usize) -> f64 {
        self.first + self.step * i as f64
    }

    /// All levels.
    pub fn levels(&self) -> Vec<f64> {
        (0..self.count).map(|i| self.level(i)).collect()
    }
}

/// The largest gap and the deepest interference (m) that a kernel is made for.
pub const GAP_MOST: f64 = 0.1;
