//! One unit, moved from rest: by the desk, which knows its error, or as the controller computes it.

use super::{controller, desk};
use crate::setup::Scene;

pub use super::{
    run::{Run, SimulateError, Solved},
    scheme::ScalarKind,
    settings::{Settings, Solver},
};

/// Runs the slide of `scene` with the given `gaps` (m) from rest in its nominal pose.
///
/// # Errors
/// See [`SimulateError`].
pub fn simulate(scene: &Scene, gaps: &[f64], settings: &Settings) -> Result<Run, SimulateError> {
    match settings.solver {
        Solver::Desk { tolerance } => desk::run(scene, gaps, settings, tolerance),
        Solver::Controller(spec) => controller::run(scene, gaps, settings, spec),
    }
}
