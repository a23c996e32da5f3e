//! The desk: one unit by error-controlled steps, the truth that a controller is held against.

use std::{ops::ControlFlow, time::Instant as Clock};

use slipfit_core::{
    SVector,
    integrator::{Integrator, Rodas4},
    pose::Pose,
    slide::CONTACTS,
};
use slipfit_desk::slide::by_desk;

use super::{
    effort::Effort,
    error_control::{Knot, Tolerance, sampled},
    looks::{Place, end, looks, samples},
    observer::{Instant, Observer},
    run::{Run, SimulateError, Solved},
    scheme::ScalarKind,
    settings::Settings,
    tipping::Tipping,
    tolerance::STICK_BAND,
    trajectory::Trajectory,
    trust::Trust,
};
use crate::setup::Scene;

pub use super::tolerance::{stick_band, tolerance, tolerance_of};

/// Steps of most units: what is kept of them is not moved while it grows.
const USUAL_STEPS: usize = 1024;

/// Sees the time (s), the velocity along z (m/s), the pose and the gaps (m) at the end of every step.
pub type See<'a> = &'a mut dyn FnMut(f64, f64, &Pose<f64>, &[f64; CONTACTS]);

/// Runs the slide of `scene` with the given `gaps` (m), each step held to an error of force of `tolerance` (N).
///
/// # Errors
/// See [`SimulateError`].
pub fn run(scene: &Scene, gaps: &[f64], settings: &Settings, tolerance: f64) -> Result<Run, SimulateError> {
    seen(scene, gaps, settings, tolerance, None)
}

/// The same, with somebody who sees where the slide is.
///
/// # Errors
/// See [`SimulateError`].
pub fn seen(
    scene: &Scene,
    gaps: &[f64],
    settings: &Settings,
    tolerance: f64,
    mut see: Option<See>,
) -> Result<Run, SimulateError> {
    let stick_band = stick_band(scene, tolerance);
    let mut observer = Observer::new(scene.drive, settings.run);
    let mut tipping = Tipping::default();
    let mut knots: Vec<Knot<[f64; 4]>> = Vec::with_capacity(USUAL_STEPS);
    let mut before = SVector::zeros();
    let rates = |velocity: &SVector<f64, 6>, by: &SVector<f64, 6>| [by.z, velocity.x, velocity.y, velocity.z];
    let start = Clock::now();
    let (data, band) = (scene.slide_data::<f64>(gaps), stick_band.unwrap_or(STICK_BAND[1]));
    let (duration, allowed) = (settings.run.duration, Tolerance::of_force(tolerance));
    let effort = by_desk(&data, band, duration, allowed, &mut |t, motion, gaps, accelerations| {
        let (r, after) = (motion.pose.displacement_w, motion.velocity);
        let rates = accelerations.map(|[from, to]| [rates(&before, &from), rates(&after, &to)]);
        before = after;
        knots.push(Knot { t, values: [after.z, r.x, r.y, r.z], rates });
        if let Some(see) = &mut see {
            see(t, after.z, &motion.pose, gaps);
        }
        if t >= scene.drive.ramp_start && tipping.begins(gaps) {
            observer.tips(t, r.z);
        }
        if observer.is_at_end(r.z) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    let integration = start.elapsed();

    let end = end(&knots, |values| observer.is_at_end(values[3]));
    let times = knots.iter().map(|knot| knot.t).collect();
    let at_knots = knots.iter().map(|knot| scene.drive.force(knot.t, knot.values[0])).collect();
    let given = Effort::new(times, at_knots, scene.slide.mass / scene.drive.gain);
    let force = |t: f64, vz: f64| given.at(t, scene.drive.force(t, vz));
    looks(&knots, end, |t, [vz, _, _, z], place| {
        let by_speed = scene.drive.force(t, vz);
        let force = if let Place::Before(knot) = place { given.before(knot, t, by_speed) } else { by_speed };
        observer.observe(Instant { t, vz, force, z });
    });
    let mut trajectory = Trajectory::default();
    let times = samples(end, settings.every);
    for (t, values) in times.clone().zip(sampled(&knots, times)) {
        trajectory.push(t, values, force(t, values[0]));
    }
    let solved = Solved {
        by: "desk",
        integrator: Rodas4::NAME,
        scalar: ScalarKind::F64,
        step_s: None,
        tolerance_n: Some(tolerance),
        tolerance_m_per_s: None,
        stick_band_m_per_s: stick_band,
        effort,
        worst_residual: 0.0,
    };
    let outcome = observer.outcome();
    Ok(Run { trajectory, outcome, solved, trust: Trust::default(), audit: None, integration })
}

#[cfg(test)]
mod tests {
    use slipfit_core::{menu::FrictionData, slide::CONTACTS};

    use super::tolerance;
    use crate::dynamics::{
        example,
        outcome::Verdict,
        simulate::{Settings, simulate},
    };

    #[test]
    fn the_stroke_ends_a_run_and_its_verdict_does_not_change_with_a_longer_one() {
        let mut scene = example::cd_rom();
        let gaps = scene.gaps_at(&[2.5; CONTACTS]);
        let mut outcome = |duration: f64| {
            scene.run.duration = duration;
            simulate(&scene, &gaps, &Settings::desk(&scene, 1e-3)).unwrap()
        };
        let [run, longer] = [1.8, 3.0].map(&mut outcome);
        assert_eq!(run, crate::dynamics::simulate::Run { integration: run.integration, ..longer });
        let stroke = scene.run.stroke.unwrap();
        assert_eq!((run.outcome.stroke_reached, run.outcome.verdict), (Some(true), Verdict::Runs));
        assert!((run.outcome.end.z - stroke).abs() < 1e-9, "{:?}", run.outcome);
        assert!(run.trajectory.z.iter().all(|z| *z <= stroke));
        assert!(run.outcome.end.t - run.trajectory.t.last().unwrap() < 1e-3);
    }

    #[test]
    fn figures_do_not_depend_on_how_often_a_run_is_sampled() {
        let mut scene = example::cd_rom();
        scene.run.duration = 1.5;
        let gaps = scene.gaps_at(&[4.0; CONTACTS]);
        let outcome = |every: f64| simulate(&scene, &gaps, &Settings::desk(&scene, every)).unwrap().outcome;
        assert_eq!(outcome(1e-3), outcome(0.1));
    }

    #[test]
    fn nothing_commanded_is_held_to_a_share_of_the_weight() {
        let mut scene = example::cd_rom();
        assert!((tolerance(&scene) - 1.2e-6).abs() < 1e-18);
        scene.drive.speed = 0.0;
        assert!((tolerance(&scene) - 0.0818 * 9.81 * 3e-7).abs() < 1e-18);
    }

    #[test]
    fn a_narrow_stick_band_is_resolved() {
        let mut scene = example::cd_rom();
        scene.friction = FrictionData::Regularised { coefficient: 0.3, stick_band: 1e-7 };
        assert!((tolerance(&scene) - 40.0 * 1e-7 / 4.0).abs() < 1e-18);
    }

    /// A slide held by friction alone: at rest for exact friction. The desk's creeps, by less than its stick band.
    #[test]
    fn what_exact_friction_holds_creeps_by_less_than_the_stick_band() {
        let mut scene = example::cd_rom();
        scene.friction = FrictionData::Exact { coefficient: 0.3 };
        scene.drive.speed = 0.002;
        scene.run.duration = 1.5;
        let gaps = scene.gaps_at(&[0.0; CONTACTS]).map(|gap| gap.max(1e-5));
        let run = simulate(&scene, &gaps, &Settings::desk(&scene, 1e-3)).unwrap();
        let band = run.solved.stick_band_m_per_s.unwrap();
        let creep = run.trajectory.vz.last().unwrap();
        assert!(creep.abs() < band && band < 1e-8, "{creep} {band}");
    }
}
