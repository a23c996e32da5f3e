//! A controller's steps, all of one length.

use std::ops::ControlFlow;

use slipfit_core::{
    integrator::{Integrator, Motion},
    kernel::{Kernel, State as KernelState},
};

use super::RunError;
use crate::{
    dynamics::{
        error_control::{Accelerations, Effort},
        scheme::IntegratorVisitor,
    },
    system::interrupt,
};

/// Steps of one length.
pub struct FixedSteps<M, P, R, F, const D: usize> {
    /// What moves.
    pub desk: M,
    /// From where.
    pub start: Motion<f64, P, R, D>,
    /// How long (s).
    pub duration: f64,
    /// Length of a step (s).
    pub step: f64,
    /// Is told of the start and of every step, and says whether to go on.
    pub keep: F,
}

impl<M, F, const D: usize> IntegratorVisitor for FixedSteps<M, M::Pose, M::Internal, F, D>
where
    M: slipfit_core::mechanism::Mechanism<f64, D>,
    F: FnMut(f64, &Motion<f64, M::Pose, M::Internal, D>, Option<Accelerations<D>>) -> ControlFlow<()>,
{
    type Output = Result<Effort, RunError>;

    fn visit<I: Integrator>(mut self) -> Self::Output {
        let kernel = Kernel::<f64, M, I>::new(self.desk, self.step)?;
        let mut state = KernelState { steps: 0, motion: self.start };
        let _ = (self.keep)(0.0, &state.motion, None);
        let mut accepted = 0;
        while kernel.time(state.steps) < self.duration * (1.0 - 1e-12) {
            let report = kernel.step(&mut state);
            let time = kernel.time(state.steps);
            if !report.residual.is_finite() {
                return Err(RunError::NotFinite { time, step: self.step });
            }
            if interrupt::requested() {
                return Err(RunError::Interrupted);
            }
            accepted += 1;
            if (self.keep)(time, &state.motion, None).is_break() {
                break;
            }
        }
        Ok(Effort { accepted, refused: 0 })
    }
}
