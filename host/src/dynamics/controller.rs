//! One unit as the controller computes it: steps of one length, by the scheme and in the numbers of the scene's controller.

use std::{ops::ControlFlow, time::Instant as Clock};

use slipfit_desk::slide::{At, Controller, Report, Witness, by_controller};

use super::{
    audit::Auditor,
    error_control::Effort,
    observer::{Instant, Observer},
    run::{Run, SimulateError, Solved},
    settings::{Settings, Solver},
    tipping::Tipping,
    trajectory::Trajectory,
    trust::Watch,
};
use crate::setup::{ControllerSpec, Scene};

/// Runs the slide of `scene` with the given `gaps` (m) as `spec` has it.
///
/// # Errors
/// See [`SimulateError`].
pub fn run(scene: &Scene, gaps: &[f64], settings: &Settings, spec: ControllerSpec) -> Result<Run, SimulateError> {
    started(scene, gaps, settings, spec, None)
}

/// The run of the scene's controller, or of the controller in `settings`, with an account of its energy.
///
/// # Errors
/// See [`SimulateError`].
pub fn audited(scene: &Scene, gaps: &[f64], settings: &Settings) -> Result<Run, SimulateError> {
    let spec = match settings.solver {
        Solver::Controller(spec) => spec,
        Solver::Desk { .. } => scene.controller,
    };
    started(scene, gaps, settings, spec, Some(Auditor::new(spec.step)))
}

fn started(
    scene: &Scene,
    gaps: &[f64],
    settings: &Settings,
    spec: ControllerSpec,
    auditor: Option<Auditor>,
) -> Result<Run, SimulateError> {
    let per_sample = (settings.every / spec.step).round();
    if !(per_sample >= 1.0 && (per_sample * spec.step - settings.every).abs() <= 1e-6 * settings.every) {
        return Err(SimulateError::Every { every: settings.every, step: spec.step });
    }
    let ControllerSpec { step, integrator, scalar } = spec;
    let mut stepper = Stepper {
        step,
        per_sample: per_sample as u32,
        // The last step is the one that still ends within the run.
        steps: (settings.run.duration / step * (1.0 + 1e-9)).floor() as u32,
        ramp_start: scene.drive.ramp_start,
        observer: Observer::new(scene.drive, settings.run),
        auditor,
        watch: Watch::new(step, scene.slide.mass, &scene.drive),
        tipping: Tipping::default(),
        trajectory: Trajectory::default(),
        worst_residual: 0.0,
        made: 0,
    };
    let start = Clock::now();
    by_controller(&scene.slide_data(gaps), Controller { integrator, scalar, step }, &mut stepper)?;
    let integration = start.elapsed();
    let Stepper { observer, auditor, watch, trajectory, worst_residual, made, .. } = stepper;
    let solved = Solved {
        by: "controller",
        integrator: integrator.name(),
        scalar,
        step_s: Some(step),
        tolerance_n: None,
        tolerance_m_per_s: None,
        stick_band_m_per_s: None,
        effort: Effort { accepted: made, refused: 0 },
        worst_residual,
    };
    let audit = auditor.map(|auditor| auditor.audit());
    Ok(Run { trajectory, outcome: observer.outcome(), solved, audit, trust: watch.trust(), integration })
}

/// Keeps what is wanted of a run.
struct Stepper {
    step: f64,
    per_sample: u32,
    /// Steps of the whole run.
    steps: u32,
    ramp_start: f64,
    observer: Observer,
    auditor: Option<Auditor>,
    watch: Watch,
    tipping: Tipping,
    trajectory: Trajectory,
    worst_residual: f64,
    /// Steps that were made.
    made: u32,
}

impl Witness for Stepper {
    fn accounts(&self) -> bool {
        self.auditor.is_some()
    }

    fn at(&mut self, at: &At) -> ControlFlow<()> {
        let t = f64::from(at.steps) * self.step;
        let At { vz, force, displacement_w: r, .. } = *at;
        self.observer.observe(Instant { t, vz, force, z: r.z });
        if t >= self.ramp_start && self.tipping.begins(&at.gaps) {
            self.observer.tips(t, r.z);
        }
        if let (Some(auditor), Some((energy, power))) = (&mut self.auditor, at.energy) {
            auditor.observe(energy, power);
        }
        if at.steps.is_multiple_of(self.per_sample) {
            self.trajectory.push(t, [vz, r.x, r.y, r.z], force);
        }
        self.made = at.steps;
        let is_over = at.steps >= self.steps || self.observer.is_at_end(r.z);
        if is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn stepped(&mut self, from: &At, report: Report) {
        self.worst_residual = self.worst_residual.max(report.residual);
        let t = f64::from(from.steps) * self.step;
        self.watch.observe(t, [report.residual, report.error], report.momentum, from.force);
    }
}
