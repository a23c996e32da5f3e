//! How a unit is to be run, and by whom.

use slipfit_core::slide::CONTACTS;

use super::{scheme::ScalarKind, tolerance::tolerance};
use crate::setup::{ControllerSpec, RunSpec, Scene};

/// Who computes a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solver {
    /// The desk, by error-controlled steps in double precision: the error of force (N) that a step may make.
    Desk {
        /// Error of the drive force (N).
        tolerance: f64,
    },
    /// The controller, by steps of one length.
    Controller(ControllerSpec),
}

/// How to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Duration and stroke.
    pub run: RunSpec,
    /// Interval of the samples (s).
    pub every: f64,
    /// Who computes.
    pub solver: Solver,
}

impl Settings {
    /// The desk's, for `scene`, sampled every `every` (s).
    pub fn desk(scene: &Scene, every: f64) -> Self {
        Self { run: scene.run, every, solver: Solver::Desk { tolerance: tolerance(scene) } }
    }

    /// The controller's, for `scene`, sampled every `every` (s), a multiple of its step.
    pub fn controller(scene: &Scene, every: f64) -> Self {
        Self { run: scene.run, every, solver: Solver::Controller(scene.controller) }
    }

    /// All sixteen gaps (m) of `scene` at the tolerance levels `n`, as whoever computes has them: firmware computes eq. 9 in
    /// single precision, and so does its stand-in here.
    pub fn gaps(&self, scene: &Scene, n: &[f64; CONTACTS]) -> [f64; CONTACTS] {
        match self.solver {
            Solver::Controller(ControllerSpec { scalar: ScalarKind::F32, .. }) => {
                scene.gaps_in::<f32>(n).map(f64::from)
            }
            Solver::Controller(_) | Solver::Desk { .. } => scene.gaps_at(n),
        }
    }

    /// The same by `controller`.
    pub fn by(self, controller: ControllerSpec) -> Self {
        Self { solver: Solver::Controller(controller), ..self }
    }

    /// The same by the desk to an error of force of `tolerance` (N).
    pub fn to(self, tolerance: f64) -> Self {
        Self { solver: Solver::Desk { tolerance }, ..self }
    }
}
