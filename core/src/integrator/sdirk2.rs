//! SDIRK2: second order, L-stable, two stages with γ = 1 − √½ (Alexander 1977).

use super::{Integrator, Motion, stage};
use crate::{Scalar, mechanism::Mechanism};

/// SDIRK2 with `PASSES` Newton passes a stage.
#[derive(Clone, Copy, Debug)]
pub struct Sdirk2<const PASSES: usize>;

impl<const PASSES: usize> Integrator for Sdirk2<PASSES> {
    const NAME: &'static str = "sdirk2";

    #[inline(always)]
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &Motion<S, M::Pose, D>,
    ) -> (Motion<S, M::Pose, D>, S) {
        let gamma = 1.0 - core::f64::consts::FRAC_1_SQRT_2;
        let a = h * S::from_f64(gamma);
        let (first, residual_1) = stage::<S, M, D, PASSES>(mechanism, t + a, a, motion, motion.velocity);
        // Base of the second stage: the first stage's slope over (1 − γ)·h.
        let weight = S::from_f64((1.0 - gamma) / gamma);
        let base = Motion {
            pose: mechanism.extrapolated(&motion.pose, &first.pose, weight),
            velocity: motion.velocity + (first.velocity - motion.velocity) * weight,
        };
        let (second, residual_2) = stage::<S, M, D, PASSES>(mechanism, t + h, a, &base, first.velocity);
        let end = Motion { pose: mechanism.normalised(&second.pose), velocity: second.velocity };
        (end, residual_1.max_of(residual_2))
    }
}
