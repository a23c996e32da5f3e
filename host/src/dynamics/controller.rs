//! One unit as the controller computes it: steps of one length, by the scheme and in the numbers of the scene's controller.

use std::time::Instant as Clock;

use slipfit_core::{
    Scalar,
    integrator::Integrator,
    kernel::{Kernel, Report, StateOf},
    law::{Elastic, Friction},
    mechanism::Mechanism,
    pose::Pose,
    slide::{CONTACTS, Slide},
};

use super::{
    audit::Auditor,
    error_control::Effort,
    laws::{AnySlide, SlidingSlide, StickingSlide},
    out_of_line::OutOfLine,
    outcome::{Instant, Observer},
    scheme::{IntegratorVisitor, ScalarKind},
    simulate::{Run, Settings, SimulateError, Solved, Solver},
    tipping::Tipping,
    trajectory::Trajectory,
    trust::Watch,
};
use crate::{
    scene::{ControllerSpec, Scene},
    system::interrupt,
};

/// A speed (m/s) that no slide has: numbers grow without end from there on.
const RUNAWAY: f64 = 1e4;

/// Steps between two looks at whether somebody asked to stop.
const STEPS_PER_LOOK: u32 = 1024;

/// Runs the slide of `scene` with the given `gaps` (m) as `spec` has it.
///
/// # Errors
/// See [`SimulateError`].
pub fn run(
    scene: &Scene,
    gaps: &[f64; CONTACTS],
    settings: &Settings,
    spec: ControllerSpec,
) -> Result<Run, SimulateError> {
    started(scene, gaps, settings, spec, None)
}

/// The run of the scene's controller, or of the controller in `settings`, with an account of its energy.
///
/// # Errors
/// See [`SimulateError`].
pub fn audited(scene: &Scene, gaps: &[f64; CONTACTS], settings: &Settings) -> Result<Run, SimulateError> {
    let spec = match settings.solver {
        Solver::Controller(spec) => spec,
        Solver::Desk { .. } => scene.controller,
    };
    started(scene, gaps, settings, spec, Some(Auditor::new(spec.step)))
}

fn started(
    scene: &Scene,
    gaps: &[f64; CONTACTS],
    settings: &Settings,
    spec: ControllerSpec,
    auditor: Option<Auditor>,
) -> Result<Run, SimulateError> {
    let per_sample = (settings.every / spec.step).round();
    if !(per_sample >= 1.0 && (per_sample * spec.step - settings.every).abs() <= 1e-6 * settings.every) {
        return Err(SimulateError::Every { every: settings.every, step: spec.step });
    }
    let stepper = Stepper {
        settings,
        spec,
        observer: Observer::new(scene.drive, settings.run),
        auditor,
        watch: Watch::new(spec.step, scene.slide.mass, &scene.drive),
        per_sample: per_sample as u32,
        ramp_start: scene.drive.ramp_start,
    };
    match spec.scalar {
        ScalarKind::F32 => stepper.visit_any(AnySlide::<f32>::new(&scene.slide_data(gaps))?),
        ScalarKind::F64 => stepper.visit_any(AnySlide::<f64>::new(&scene.slide_data(gaps))?),
    }
}

struct Stepper<'a> {
    settings: &'a Settings,
    spec: ControllerSpec,
    observer: Observer,
    auditor: Option<Auditor>,
    watch: Watch,
    per_sample: u32,
    ramp_start: f64,
}

impl Stepper<'_> {
    fn visit_any<S: Scalar + PartialOrd + std::fmt::Display>(self, slide: AnySlide<S>) -> Result<Run, SimulateError> {
        let integrator = self.spec.integrator;
        match slide {
            AnySlide::Sliding(SlidingSlide::Usual(slide)) => integrator.visit(Started { stepper: self, slide }),
            AnySlide::Sliding(SlidingSlide::Chosen(slide)) => integrator.visit(Started { stepper: self, slide }),
            AnySlide::Sticking(StickingSlide::Usual(slide)) => {
                integrator.visit_implicit(Started { stepper: self, slide })
            }
            AnySlide::Sticking(StickingSlide::Chosen(slide)) => {
                integrator.visit_implicit(Started { stepper: self, slide })
            }
        }
    }
}

/// One step, in a function of its own: compiled once for each type, not into every loop around it.
#[inline(never)]
fn step_of<S: Scalar + PartialOrd, M: Mechanism<S, 6>, I: Integrator>(
    kernel: &Kernel<S, M, I>,
    state: &mut StateOf<S, M, 6>,
) -> Report<S> {
    kernel.step(state)
}

/// A stepper whose slide's type is known.
struct Started<'a, S, E, F> {
    stepper: Stepper<'a>,
    slide: Slide<S, E, F>,
}

impl<S, E, F> IntegratorVisitor for Started<'_, S, E, F>
where
    S: Scalar + PartialOrd + std::fmt::Display,
    E: Elastic<S>,
    F: Friction<S>,
{
    type Output = Result<Run, SimulateError>;

    fn visit<I: Integrator>(self) -> Self::Output {
        let Self {
            stepper: Stepper { settings, spec, mut observer, mut auditor, mut watch, per_sample, ramp_start },
            slide,
        } = self;
        let step = spec.step;
        let kernel = Kernel::<S, _, I>::new(OutOfLine::new(slide), S::from_f64(step))?;
        // The last step is the one that still ends within the run.
        let steps = (settings.run.duration / step * (1.0 + 1e-9)).floor() as u32;
        let mut state = kernel.at_rest(Pose::nominal());
        let mut trajectory = Trajectory::default();
        let mut worst_residual = 0.0f64;
        let mut tipping = Tipping::default();
        let start = Clock::now();
        loop {
            let t = f64::from(state.steps) * step;
            let vz = state.motion.velocity.z;
            let force = kernel.mechanism().mechanism().drive().force(kernel.time(state.steps), vz).to_f64();
            let r = state.motion.pose.displacement_w.map(S::to_f64);
            observer.observe(Instant { t, vz: vz.to_f64(), force, z: r.z });
            let gaps = kernel.mechanism().mechanism().gaps(&state.motion.pose).map(S::to_f64);
            if t >= ramp_start && tipping.begins(&gaps) {
                observer.tips(t, r.z);
            }
            if let Some(auditor) = &mut auditor {
                let slide = kernel.mechanism().mechanism();
                auditor.observe(slide.energy(&state.motion), slide.power(kernel.time(state.steps), &state.motion));
            }
            if state.steps.is_multiple_of(per_sample) {
                trajectory.push(t, [vz.to_f64(), r.x, r.y, r.z], force);
            }
            if state.steps >= steps || observer.is_at_end(r.z) {
                let integration = start.elapsed();
                let solved = Solved {
                    by: "controller",
                    integrator: I::NAME,
                    scalar: spec.scalar,
                    step_s: Some(step),
                    tolerance_n: None,
                    tolerance_m_per_s: None,
                    stick_band_m_per_s: None,
                    effort: Effort { accepted: state.steps, refused: 0 },
                    worst_residual,
                };
                let audit = auditor.map(|auditor| auditor.audit());
                return Ok(Run {
                    trajectory,
                    outcome: observer.outcome(),
                    solved,
                    audit,
                    trust: watch.trust(),
                    integration,
                });
            }
            if state.steps.is_multiple_of(STEPS_PER_LOOK) && interrupt::requested() {
                return Err(SimulateError::Interrupted);
            }
            let report = step_of(&kernel, &mut state);
            let residual = report.residual.to_f64();
            if !residual.is_finite() || state.motion.velocity.z.to_f64().abs() > RUNAWAY {
                return Err(SimulateError::NotFinite { time: t, step });
            }
            worst_residual = worst_residual.max(residual);
            let momentum = kernel.mechanism().weighed(&state.motion.pose, &state.motion.velocity);
            watch.observe(t, [residual, report.error.to_f64()], momentum.to_f64(), force);
        }
    }
}
