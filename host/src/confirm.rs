//! A second look: what a run with half the step says of a run.

use slipfit_core::slide::CONTACTS;

use crate::{
    outcome::Verdict,
    scene::Scene,
    simulate::{Run, ScalarKind, Settings, SimulateError, simulate},
};

/// A step (s) above which a second run is always made: it costs little, and errors of single steps do not tell how far the
/// slide strays over thousands of them.
const COARSE: f64 = 100e-6;

/// `run`, made by `settings`, held against a run with half the step in double precision: its verdict is undecided where the
/// two disagree, and its trust takes in how far their forces part. A run in double precision without a verdict whose steps
/// are fine and leave no doubt needs no second run, nor does error control.
///
/// # Errors
/// See [`SimulateError`]; a second run that leaves the finite range is as far off as can be.
pub fn confirmed(
    scene: &Scene,
    gaps: &[f64; CONTACTS],
    settings: &Settings,
    mut run: Run,
) -> Result<Run, SimulateError> {
    let decided = run.outcome.verdict != Verdict::Undecided;
    // Steps do not see what single precision has rounded away.
    let single = settings.scalar == ScalarKind::F32;
    let coarse = settings.run.step > COARSE;
    if settings.tolerance.is_some() || !(single || coarse || decided || run.trust.leaves_doubt()) {
        return Ok(run);
    }
    let mut half = Settings { scalar: ScalarKind::F64, ..*settings };
    half.run.step /= 2.0;
    let (verdict, difference) = match simulate(scene, gaps, &half) {
        Ok(half) => {
            (half.outcome.verdict, run.trajectory.greatest_difference(&half.trajectory, scene.drive.ramp_start))
        }
        Err(SimulateError::NotFinite { .. }) => (Verdict::Undecided, f64::MAX),
        Err(other) => return Err(other),
    };
    if verdict != run.outcome.verdict {
        run.outcome.verdict = Verdict::Undecided;
    }
    run.trust = run.trust.compared(difference, settings.run.step);
    Ok(run)
}
