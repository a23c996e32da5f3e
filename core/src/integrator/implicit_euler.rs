//! Implicit Euler: first order, L-stable, the most forgiving.

use super::{Integrator, Motion, stage};
use crate::{Scalar, mechanism::Mechanism};

/// Implicit Euler with `PASSES` Newton passes.
#[derive(Clone, Copy, Debug)]
pub struct ImplicitEuler<const PASSES: usize>;

impl<const PASSES: usize> Integrator for ImplicitEuler<PASSES> {
    const NAME: &'static str = "implicit-euler";

    #[inline(always)]
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &Motion<S, M::Pose, D>,
    ) -> (Motion<S, M::Pose, D>, S) {
        let (end, residual) = stage::<S, M, D, PASSES>(mechanism, t + h, h, motion, motion.velocity);
        (Motion { pose: mechanism.normalised(&end.pose), velocity: end.velocity }, residual)
    }
}
