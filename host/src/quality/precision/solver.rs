//! What is compared: solvers, each with one knob from quick to precise.

use serde::Serialize;
use slipfit_core::{menu::FrictionData, slide::CONTACTS};

use super::{EVERY, run_of};
use crate::{
    dynamics::{
        scheme::IntegratorKind,
        simulate::{Run, ScalarKind, Settings, SimulateError},
    },
    scene::{ControllerSpec, Scene},
    show::number::three_digits,
};

/// Steps of all fixed-step schemes (s).
const STEPS: [f64; 8] = [1e-3, 500e-6, 250e-6, 200e-6, 100e-6, 50e-6, 25e-6, 10e-6];
/// Further steps of the explicit ones (s), which are cheap and stable only when they resolve the stick band.
const FINER: [f64; 4] = [5e-6, 2e-6, 1e-6, 0.5e-6];

/// What a solver's setting is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Knob {
    /// The step (s).
    StepS,
    /// The error of force that a step may make (N).
    ForceN,
}

impl Knob {
    /// A setting as people read it.
    pub fn typeset(self, setting: f64) -> String {
        match self {
            Self::StepS => format!("{} µs", three_digits(setting * 1e6)),
            Self::ForceN => format!("{} mN", three_digits(setting * 1e3)),
        }
    }
}

/// Tolerances of the error-controlled solver (N).
const TOLERANCES: [f64; 8] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6];

type Work = dyn Fn(&Scene, &[f64; CONTACTS], f64, f64, ScalarKind) -> Result<Run, SimulateError>;

/// A way to simulate a scene.
pub struct Solver {
    /// Its name.
    pub name: &'static str,
    /// What its settings are.
    pub knob: Knob,
    /// The settings to be tried, from quick to precise.
    pub settings: Vec<f64>,
    work: Box<Work>,
}

impl Solver {
    fn fixed_step(kind: IntegratorKind) -> Self {
        let finer = if kind.is_implicit() { &[][..] } else { &FINER };
        Self {
            name: kind.name(),
            knob: Knob::StepS,
            settings: STEPS.iter().chain(finer).copied().collect(),
            work: Box::new(move |scene, gaps, duration, step, scalar| {
                let controller = ControllerSpec { step, integrator: kind, scalar };
                run_of(scene, gaps, duration, Settings::desk(scene, EVERY).by(controller))
            }),
        }
    }

    fn error_controlled() -> Self {
        Self {
            name: "error-controlled",
            knob: Knob::ForceN,
            settings: TOLERANCES.to_vec(),
            work: Box::new(|scene, gaps, duration, tolerance, _| {
                run_of(scene, gaps, duration, Settings::desk(scene, EVERY).to(tolerance))
            }),
        }
    }

    /// Whether it computes in `scalar`; error control is double precision only.
    pub fn does(&self, scalar: ScalarKind) -> bool {
        self.knob == Knob::StepS || scalar == ScalarKind::F64
    }

    /// Simulates `duration` (s) of `scene` with `gaps` (m), sampled every millisecond.
    ///
    /// # Errors
    /// See [`SimulateError`].
    pub fn run(
        &self,
        scene: &Scene,
        gaps: &[f64; CONTACTS],
        duration: f64,
        setting: f64,
        scalar: ScalarKind,
    ) -> Result<Run, SimulateError> {
        (self.work)(scene, gaps, duration, setting, scalar)
    }
}

/// Every solver that can do the friction law of `scene`.
pub fn solvers(scene: &Scene) -> Vec<Solver> {
    let exact = matches!(scene.friction, FrictionData::Exact { .. });
    let able = |kind: &IntegratorKind| kind.is_implicit() || !exact;
    let fixed = IntegratorKind::ALL.into_iter().filter(able).map(Solver::fixed_step);
    fixed.chain([Solver::error_controlled()]).collect()
}
