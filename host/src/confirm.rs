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

#[cfg(test)]
mod tests {
    use slipfit_core::slide::CONTACTS;

    use super::{COARSE, confirmed};
    use crate::{
        scene::{CD_ROM_SLIDE, Scene},
        simulate::{ScalarKind, Settings, simulate},
    };

    #[test]
    fn a_coarse_step_is_always_held_against_half_of_it() {
        let mut scene = Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).unwrap();
        let gaps = scene.gaps_at(&[0.0; CONTACTS]);
        let mut difference = |step: f64| {
            scene.run.step = step;
            let settings = Settings::fixed(scene.run, 1e-3, ScalarKind::F64);
            confirmed(&scene, &gaps, &settings, simulate(&scene, &gaps, &settings).unwrap()).unwrap().trust.difference
        };
        // The opening at n = 0 comes to no verdict, and its steps leave no doubt.
        assert_eq!(difference(COARSE / 2.0), None);
        assert!(difference(2.0 * COARSE).is_some_and(|difference| difference < 5e-3));
    }
}
