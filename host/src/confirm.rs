//! A second look: what a run with half the step says of a run.

use slipfit_core::slide::CONTACTS;

use crate::{
    outcome::Verdict,
    scene::Scene,
    simulate::{Run, ScalarKind, Settings, SimulateError, simulate},
};

/// `run`, made by `settings`, held against a run with half the step in double precision: its verdict is undecided where the
/// two disagree, and its trust takes in how far their forces part. Without a verdict, and where its steps leave no doubt,
/// there is no second run; error control needs none.
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
    if settings.tolerance.is_some() || !(decided || run.trust.leaves_doubt()) {
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
