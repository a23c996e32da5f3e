//! One unit, stepped from rest.

use std::time::{Duration, Instant};

use slipfit_core::{
    ParameterError, SVector, Scalar,
    integrator::{Extrapolated, Integrator, Motion, Rodas3},
    kernel::Kernel,
    law::{Elastic, Friction},
    mechanism::Mechanism,
    menu::SlideVisitor,
    pose::Pose,
    slide::{CONTACTS, Slide},
};
use thiserror::Error;

use crate::{
    audit::{Audit, Auditor},
    controlled::{self, Sensitivity, Tolerance},
    interrupt,
    outcome::{Observer, Outcome, Trajectory},
    scene::{RunSpec, Scene},
    scheme::IntegratorVisitor,
    trust::{Trust, Watch},
};

/// The number type of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ScalarKind {
    /// Single precision, the controller's.
    F32,
    /// Double precision.
    #[default]
    F64,
}

impl ScalarKind {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

/// How to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Duration, step and scheme.
    pub run: RunSpec,
    /// Interval of the samples (s), a multiple of the step.
    pub every: f64,
    /// Number type.
    pub scalar: ScalarKind,
    /// Error control instead of fixed steps, in f64 whatever the number type: the error of force (N) a step may make.
    pub tolerance: Option<f64>,
}

impl Settings {
    /// Fixed steps as `run` has them, sampled every `every` (s).
    pub fn fixed(run: RunSpec, every: f64, scalar: ScalarKind) -> Self {
        Self { run, every, scalar, tolerance: None }
    }
}

/// A finished run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Samples.
    pub trajectory: Trajectory,
    /// Figures, from every step.
    pub outcome: Outcome,
    /// The energy account, if asked for.
    pub audit: Option<Audit>,
    /// What the run says about its step.
    pub trust: Trust,
    /// Wall time of the integration alone.
    pub integration: Duration,
}

/// Why a run did not finish.
#[derive(Debug, Error)]
pub enum SimulateError {
    /// A parameter is out of bounds.
    #[error("{0}")]
    Parameter(String),
    /// Samples do not fall on steps.
    #[error("samples every {every} s do not fall on steps of {step} s: --every has to be a multiple of the step")]
    Every {
        /// Interval of the samples (s).
        every: f64,
        /// Step (s).
        step: f64,
    },
    /// The motion left the range of the number type.
    #[error("the motion left the finite range at t = {time} s: take a smaller step than {step} s")]
    NotFinite {
        /// When (s).
        time: f64,
        /// Step (s).
        step: f64,
    },
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl<S: std::fmt::Display> From<ParameterError<S>> for SimulateError {
    fn from(error: ParameterError<S>) -> Self {
        Self::Parameter(error.to_string())
    }
}

/// Runs the slide of `scene` with the given `gaps` (m) from rest in its nominal pose.
///
/// # Errors
/// See [`SimulateError`].
pub fn simulate(scene: &Scene, gaps: &[f64; CONTACTS], settings: &Settings) -> Result<Run, SimulateError> {
    started(scene, gaps, settings, None)
}

/// The same run, with an account of its energy; fixed steps only.
///
/// # Errors
/// See [`SimulateError`].
pub fn audited(scene: &Scene, gaps: &[f64; CONTACTS], settings: &Settings) -> Result<Run, SimulateError> {
    started(scene, gaps, settings, Some(Auditor::new(settings.run.step)))
}

fn started(
    scene: &Scene,
    gaps: &[f64; CONTACTS],
    settings: &Settings,
    auditor: Option<Auditor>,
) -> Result<Run, SimulateError> {
    if let Some(force) = settings.tolerance {
        let controlled = Controlled { scene, settings, tolerance: Tolerance::of_force(force) };
        return Ok(scene.slide_data::<f64>(gaps).visit(controlled)?);
    }
    let per_sample = (settings.every / settings.run.step).round();
    if !(per_sample >= 1.0 && (per_sample * settings.run.step - settings.every).abs() <= 1e-6 * settings.every) {
        return Err(SimulateError::Every { every: settings.every, step: settings.run.step });
    }
    let stepper = Stepper {
        settings,
        observer: Observer::new(scene.drive, settings.run.duration),
        auditor,
        watch: Watch::new(settings.run.step, scene.slide.mass, &scene.drive),
        per_sample: per_sample as u32,
    };
    match settings.scalar {
        ScalarKind::F32 => scene.slide_data::<f32>(gaps).visit(stepper)?,
        ScalarKind::F64 => scene.slide_data::<f64>(gaps).visit(stepper)?,
    }
}

/// A run by error-controlled steps.
struct Controlled<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    tolerance: Tolerance,
}

/// Distance (s) at which an error-controlled run is looked at for its figures.
const LOOK: f64 = 1e-4;

impl SlideVisitor<f64> for Controlled<'_> {
    type Output = Run;

    fn visit<E: Elastic<f64>, F: Friction<f64>>(self, slide: Slide<f64, E, F>) -> Run {
        let Self { scene, settings, tolerance } = self;
        let duration = settings.run.duration;
        let sensitivity = Sensitivity { mass: scene.slide.mass, gain: scene.drive.gain };
        let rest = Motion {
            pose: Pose::nominal(),
            velocity: SVector::zeros(),
            acceleration: SVector::zeros(),
            memory: slide.fresh(),
        };
        let mut knots = Vec::new();
        let start = Instant::now();
        // A law that sticks remembers its force from step to step, which only a solved step can follow.
        let integrate =
            if F::STICKS { controlled::integrate::<Extrapolated<3, 3>, _> } else { controlled::integrate::<Rodas3, _> };
        let effort = integrate(&slide, rest, duration, sensitivity, tolerance, &mut knots);
        let integration = start.elapsed();

        let looks = (settings.every / LOOK - 1e-9).ceil().max(1.0);
        let between = settings.every / looks;
        let count = (duration / between * (1.0 + 1e-12)).floor() as usize;
        let time = |i: usize| (i as f64 * between).min(duration);
        let mut trajectory = Trajectory { worst_residual: effort.worst_residual, ..Trajectory::default() };
        let mut observer = Observer::new(scene.drive, duration);
        for (i, [vz, x, y, z]) in controlled::sampled(&knots, (0..=count).map(time)).into_iter().enumerate() {
            let t = time(i);
            let force = scene.drive.force(t, vz);
            observer.observe(t, vz, force);
            if i.is_multiple_of(looks as usize) {
                trajectory.t.push(t);
                trajectory.vz.push(vz);
                trajectory.force.push(force);
                trajectory.x.push(x);
                trajectory.y.push(y);
                trajectory.z.push(z);
            }
        }
        let last = knots.last().map_or(0.0, |knot| knot.values[0]);
        // Error control has bounded what a watch looks for.
        let outcome = observer.outcome(duration, last);
        Run { trajectory, outcome, trust: Trust::default(), audit: None, integration }
    }
}

struct Stepper<'a> {
    settings: &'a Settings,
    observer: Observer,
    auditor: Option<Auditor>,
    watch: Watch,
    per_sample: u32,
}

impl<S: Scalar + PartialOrd + std::fmt::Display> SlideVisitor<S> for Stepper<'_> {
    type Output = Result<Run, SimulateError>;

    fn visit<E: Elastic<S>, F: Friction<S>>(self, slide: Slide<S, E, F>) -> Self::Output {
        self.settings.run.integrator.visit(Started { stepper: self, slide })
    }
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
        let Self { stepper: Stepper { settings, mut observer, mut auditor, mut watch, per_sample }, slide } = self;
        let RunSpec { duration, step, .. } = settings.run;
        let kernel = Kernel::<S, _, I>::new(slide, S::from_f64(step))?;
        let steps = (duration / step).round() as u32;
        let mut state = kernel.at_rest(Pose::nominal());
        let mut trajectory = Trajectory::default();
        let start = Instant::now();
        loop {
            let t = f64::from(state.steps) * step;
            let vz = state.motion.velocity.z;
            let force = kernel.mechanism().drive().force(kernel.time(state.steps), vz).to_f64();
            observer.observe(t, vz.to_f64(), force);
            if let Some(auditor) = &mut auditor {
                let slide = kernel.mechanism();
                auditor.observe(slide.energy(&state.motion), slide.power(kernel.time(state.steps), &state.motion));
            }
            if state.steps.is_multiple_of(per_sample) {
                let r = state.motion.pose.displacement_w;
                trajectory.t.push(t);
                trajectory.vz.push(vz.to_f64());
                trajectory.force.push(force);
                trajectory.x.push(r.x.to_f64());
                trajectory.y.push(r.y.to_f64());
                trajectory.z.push(r.z.to_f64());
            }
            if state.steps == steps {
                let integration = start.elapsed();
                let audit = auditor.map(|auditor| auditor.audit());
                return Ok(Run {
                    trajectory,
                    outcome: observer.outcome(t, vz.to_f64()),
                    trust: watch.trust(),
                    audit,
                    integration,
                });
            }
            if state.steps.is_multiple_of(1024) && interrupt::requested() {
                return Err(SimulateError::Interrupted);
            }
            let report = kernel.step(&mut state);
            let residual = report.residual.to_f64();
            if !residual.is_finite() {
                return Err(SimulateError::NotFinite { time: t, step });
            }
            trajectory.worst_residual = trajectory.worst_residual.max(residual);
            let slide = kernel.mechanism();
            let momentum = slide.impulse(&slide.momentum(&state.motion.velocity));
            watch.observe(t, [residual, report.error.to_f64()], momentum.to_f64(), force);
        }
    }
}
