//! SDIRK2: second order, L-stable, two stages with γ = 1 − √½ (Alexander 1977).

use super::{Integrator, Motion, MotionOf, NO_CHORD, Stage, Step, StepOf, shifted, stage};
use crate::{Scalar, mechanism::Mechanism};

/// SDIRK2 with `PASSES` Newton passes a stage.
#[derive(Clone, Copy, Debug)]
pub struct Sdirk2<const PASSES: usize>;

impl<const PASSES: usize> Integrator for Sdirk2<PASSES> {
    const NAME: &'static str = "sdirk2";
    const ORDER: u32 = 2;
    const IMPLICIT: bool = true;

    #[inline(always)]
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
    ) -> StepOf<S, M, D> {
        let gamma = 1.0 - core::f64::consts::FRAC_1_SQRT_2;
        let a = h * S::from_f64(gamma);
        let Stage { motion: first, residual: residual_1, .. } =
            stage::<S, M, D, PASSES, NO_CHORD>(mechanism, t + a, a, motion, motion.velocity);
        // Base of the second stage: the first stage's slope over (1 − γ)·h.
        let base = shifted(mechanism, motion, motion, &first, S::from_f64((1.0 - gamma) / gamma));
        let Stage { motion: second, residual: residual_2, .. } =
            stage::<S, M, D, PASSES, NO_CHORD>(mechanism, t + h, a, &base, first.velocity);
        // Against the first-order solution that takes the first stage's slope for the whole step.
        let difference = (second.velocity - base.velocity) - (first.velocity - motion.velocity);
        let error = mechanism.weighed(&second.pose, &difference);
        let pose = mechanism.normalised(&second.pose);
        Step { motion: Motion { pose, ..second }, residual: residual_1.max_of(residual_2), error, drift: error * h }
    }
}
