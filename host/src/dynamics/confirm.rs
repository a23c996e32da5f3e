//! A second look: what a better run says of a run.

use slipfit_core::slide::CONTACTS;

use super::{
    outcome::{Outcome, Verdict},
    run::{Run, SimulateError},
    settings::{Settings, Solver},
    simulate::simulate,
    tolerance::tolerance,
    trust::Trust,
};
use crate::setup::Scene;

/// How much finer than the desk's run the one is that it is held against.
const FINER: f64 = 0.1;

/// How many shorter steps of a controller are tried.
const TRIES: usize = 4;

/// The shortest step (s) that is tried: with shorter ones a stroke takes seconds.
const SHORTEST_TRIED: f64 = 5e-6;

/// `run`, made by `settings`, held against a better one: a run of the desk against one at a tenth of its tolerance, a run of
/// the controller against the desk's. Its verdict is undecided where the two disagree, and its trust takes in how far their
/// forces part.
///
/// # Errors
/// See [`SimulateError`].
pub fn confirmed(scene: &Scene, gaps: &[f64], settings: &Settings, run: Run) -> Result<Run, SimulateError> {
    let tolerance = match settings.solver {
        Solver::Desk { tolerance } => FINER * tolerance,
        Solver::Controller(_) => tolerance(scene),
    };
    Ok(against(&simulate(scene, gaps, &settings.to(tolerance))?, scene, settings, run))
}

/// What is known of a controller's run at the levels `n`, its `trust` so far: where its step is too long, shorter ones are
/// tried, so that the one advised does.
///
/// # Errors
/// See [`SimulateError`].
pub fn with_step_tried(scene: &Scene, n: &[f64; CONTACTS], trust: Trust) -> Result<Trust, SimulateError> {
    let mut shorter = scene.clone();
    let (mut next, mut shortest) = (trust.better_step, trust.better_step);
    for _ in 0..TRIES {
        let Some(step) = next.filter(|step| *step >= SHORTEST_TRIED) else { break };
        shorter.controller.step = step;
        let settings = Settings::controller(&shorter, (1e-3 / step).round().max(1.0) * step);
        let gaps = settings.gaps(&shorter, n);
        let run = simulate(&shorter, &gaps, &settings).and_then(|run| confirmed(&shorter, &gaps, &settings, run));
        next = match run {
            Ok(run) if run.trust.is_sound() => return Ok(trust.tried(step)),
            Ok(run) => run.trust.better_step,
            Err(SimulateError::Interrupted) => return Err(SimulateError::Interrupted),
            Err(_) => None,
        };
        shortest = next.or(shortest);
    }
    Ok(trust.advised(shortest))
}

/// `run`, made by `settings`, held against the `better` one, which is sampled at the same times.
pub fn against(better: &Run, scene: &Scene, settings: &Settings, mut run: Run) -> Run {
    let agrees = match settings.solver {
        Solver::Desk { .. } => {
            figures_agree(&run.outcome, &better.outcome, [scene.drive.command(better.outcome.end.t), LEAST_TRAVEL])
        }
        // How far its figures are off is said beside its verdict.
        Solver::Controller(_) => run.outcome.verdict == better.outcome.verdict,
    };
    if !agrees {
        run.outcome.verdict = Verdict::Undecided;
    }
    let difference = run.trajectory.greatest_difference(&better.trajectory, scene.drive.ramp_start);
    let step = match settings.solver {
        Solver::Desk { .. } => None,
        Solver::Controller(spec) => Some(spec.step),
    };
    run.trust = run.trust.compared(difference, step);
    run
}

/// A difference of figures, as a share, from which a verdict is in doubt.
const DOUBTFUL: f64 = 0.01;

/// Whether two runs agree in verdict and figures: in peak, final speed and travel, each to 1 %. A final speed counts by the `command`
/// (m/s, rad/s) at the end where that is greater, a travel by what is `some` (m, rad) likewise.
pub fn figures_agree(one: &Outcome, better: &Outcome, [command, some]: [f64; 2]) -> bool {
    let within = |one: f64, better: f64, whole: f64| (one - better).abs() <= DOUBTFUL * whole.abs();
    let peaks = match (one.peak_force, better.peak_force) {
        (Some(one), Some(better)) => within(one, better, better),
        (one, better) => one.is_none() && better.is_none(),
    };
    let speed = command.abs().max(better.final_velocity.abs());
    let [travel, better_travel] = [one.end.z, better.end.z];
    // The figures of a runaway grow until it is stopped.
    let run_away = [one, better].iter().all(|outcome| outcome.runs_away(command));
    let figures = peaks
        && within(one.final_velocity, better.final_velocity, speed)
        && within(travel, better_travel, better_travel.abs().max(some));
    one.verdict == better.verdict && (run_away || figures)
}

/// Travel (m, rad) that counts as some.
pub const LEAST_TRAVEL: f64 = 1e-5;

#[cfg(test)]
mod tests {
    use slipfit_core::slide::CONTACTS;

    use super::confirmed;
    use crate::dynamics::{
        driven::Driven,
        example,
        outcome::Verdict,
        simulate::{Settings, simulate},
    };

    #[test]
    fn a_controller_is_held_against_the_desk_and_the_desk_against_a_finer_run() {
        let scene = example::cd_rom();
        let gaps = scene.gaps_at(&[2.5; CONTACTS]);
        let difference = |settings: Settings| {
            let run = simulate(&scene, &gaps, &settings).unwrap();
            confirmed(&scene, &gaps, &settings, run).unwrap().trust.difference.unwrap()
        };
        let desk = difference(Settings::desk(&scene, 1e-3));
        let controller = difference(Settings::controller(&scene, 1e-3));
        assert!(desk < 1e-4 && (1e-3..1e-2).contains(&controller), "{desk} {controller}");
    }

    #[test]
    fn a_verdict_that_a_finer_run_does_not_share_is_none() {
        let mut scene = example::cd_rom();
        scene.run.duration = scene.stroke_duration().unwrap();
        let gaps = scene.gaps_at(&[2.5; CONTACTS]);
        // So coarse that it does not see the slide run.
        let settings = Settings::desk(&scene, 1e-3);
        let fine = confirmed(&scene, &gaps, &settings, simulate(&scene, &gaps, &settings).unwrap()).unwrap();
        assert_eq!(fine.outcome.verdict, Verdict::Runs);
        let mut wrong = fine.clone();
        wrong.outcome.verdict = Verdict::Jammed;
        let judged = super::against(&fine, &scene, &settings, wrong);
        assert_eq!(judged.outcome.verdict, Verdict::Undecided);
    }
}
