//! What is compared: solvers, each with one knob from quick to precise.

use std::time::Duration;

use serde::Serialize;
use slipfit_core::menu::FrictionData;
use slipfit_tolerance::number::three_digits;

use crate::{
    dynamics::{
        scheme::IntegratorKind,
        simulate::{Run, ScalarKind, Settings, SimulateError, simulate},
    },
    mechanism::{ByDrive, Mechanism, MechanismRun, RunError, controller_run, run},
    setup::{ControllerSpec, RunSpec, Scene},
};

/// Interval of the samples that are compared (s).
pub const EVERY: f64 = 1e-3;
/// Steps of all fixed-step schemes (s).
const STEPS: [f64; 8] = [1e-3, 500e-6, 250e-6, 200e-6, 100e-6, 50e-6, 25e-6, 10e-6];
/// Further steps of the explicit ones (s), which are cheap and stable only when they resolve the stick band.
const FINER: [f64; 4] = [5e-6, 2e-6, 1e-6, 0.5e-6];
/// Tolerances of the error-controlled solver of a slide (N).
const TOLERANCES: [f64; 8] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6];
/// The same of a mechanism, as shares of its own speed.
const SHARES: [f64; 6] = [1e-4, 3e-5, 1e-5, 1e-6, 1e-7, 1e-8];

/// A stretch of motion to be simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Problem {
    /// Its name.
    pub name: &'static str,
    /// Simulated time (s).
    pub duration: f64,
}

/// What a solver's setting is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Knob {
    /// The step (s).
    StepS,
    /// The error of force that a step may make (N).
    ForceN,
    /// The error of speed that a step may make, as a share of the mechanism's own speed.
    Share,
}

impl Knob {
    /// A setting as people read it.
    pub fn typeset(self, setting: f64) -> String {
        match self {
            Self::StepS => format!("{} µs", three_digits(setting * 1e6)),
            Self::ForceN => format!("{} mN", three_digits(setting * 1e3)),
            Self::Share => format!("{setting:e}"),
        }
    }
}

/// A drive's force or torque every millisecond, and how long the integration took.
pub struct Timed {
    /// Force (N) or torque (N·m).
    pub force: Vec<f64>,
    /// Time of the integration alone.
    pub integration: Duration,
}

impl From<Run> for Timed {
    fn from(run: Run) -> Self {
        Self { force: run.trajectory.force, integration: run.integration }
    }
}

type Work<'a> = dyn Fn(f64, ScalarKind) -> Result<Timed, SimulateError> + 'a;

/// A way to simulate a unit.
pub struct Solver<'a> {
    /// Its name.
    pub name: &'static str,
    /// What its settings are.
    pub knob: Knob,
    /// The settings to be tried, from quick to precise.
    pub settings: Vec<f64>,
    /// The number types that it knows.
    pub scalars: &'static [ScalarKind],
    work: Box<Work<'a>>,
}

impl Solver<'_> {
    /// Simulates the unit at a `setting`.
    ///
    /// # Errors
    /// See [`SimulateError`].
    pub fn run(&self, setting: f64, scalar: ScalarKind) -> Result<Timed, SimulateError> {
        (self.work)(setting, scalar)
    }
}

/// Every solver that can do the friction law of `scene`, for the unit with these `gaps` (m).
pub fn solvers<'a>(scene: &'a Scene, gaps: &'a [f64], problem: Problem) -> Vec<Solver<'a>> {
    let exact = matches!(scene.friction, FrictionData::Exact { .. });
    let duration = problem.duration;
    let fixed = |kind: IntegratorKind| Solver {
        name: kind.name(),
        knob: Knob::StepS,
        settings: STEPS.iter().chain(if kind.is_implicit() { &[][..] } else { &FINER }).copied().collect(),
        scalars: &ScalarKind::ALL,
        work: Box::new(move |step, scalar| {
            let controller = ControllerSpec { step, integrator: kind, scalar };
            Ok(run_of(scene, gaps, duration, Settings::desk(scene, EVERY).by(controller))?.into())
        }),
    };
    let able = |kind: &IntegratorKind| kind.is_implicit() || !exact;
    let error_controlled = Solver {
        name: DESK,
        knob: Knob::ForceN,
        settings: TOLERANCES.to_vec(),
        scalars: &[ScalarKind::F64],
        work: Box::new(move |tolerance, _| {
            Ok(run_of(scene, gaps, duration, Settings::desk(scene, EVERY).to(tolerance))?.into())
        }),
    };
    IntegratorKind::ALL.into_iter().filter(able).map(fixed).chain([error_controlled]).collect()
}

/// What the error-controlled solver is called beside the schemes of a controller.
const DESK: &str = "desk";

/// Every solver of a mechanism, for the unit with these `gaps` (m): the implicit schemes of its controller, and the desk's.
pub fn solvers_of<'a>(driven: &'a ByDrive<'a>, gaps: &'a [f64]) -> Vec<Solver<'a>> {
    let timed = |run: Result<MechanismRun, RunError>| {
        let mut run = run?;
        Ok(Timed { force: run.trajectories.swap_remove(driven.index()).force, integration: run.integration })
    };
    let fixed = |kind: IntegratorKind| Solver {
        name: kind.name(),
        knob: Knob::StepS,
        settings: STEPS.to_vec(),
        scalars: &[ScalarKind::F64],
        work: Box::new(move |step, scalar| {
            let controller = ControllerSpec { step, integrator: kind, scalar };
            timed(controller_run(&Mechanism { controller, ..whole(driven) }, gaps, EVERY))
        }),
    };
    let error_controlled = Solver {
        name: DESK,
        knob: Knob::Share,
        settings: SHARES.to_vec(),
        scalars: &[ScalarKind::F64],
        work: Box::new(move |share, _| timed(run(&to(&whole(driven), share), gaps, EVERY))),
    };
    let implicit = IntegratorKind::ALL.into_iter().filter(|kind| kind.is_implicit());
    implicit.map(fixed).chain([error_controlled]).collect()
}

/// The mechanism, which runs for its whole duration.
pub fn whole(driven: &ByDrive) -> Mechanism {
    let mechanism = driven.mechanism();
    Mechanism { run: RunSpec { stroke: None, ..mechanism.run }, ..mechanism.clone() }
}

/// The `mechanism` with another error of a step of the desk.
pub fn to(mechanism: &Mechanism, error: f64) -> Mechanism {
    Mechanism { run: RunSpec { error, ..mechanism.run }, ..mechanism.clone() }
}

/// `duration` (s) of `scene` as `solver` computes it, whatever its stroke.
pub fn run_of(scene: &Scene, gaps: &[f64], duration: f64, settings: Settings) -> Result<Run, SimulateError> {
    let run = RunSpec { duration, stroke: None, ..scene.run };
    simulate(scene, gaps, &Settings { run, every: EVERY, ..settings })
}
