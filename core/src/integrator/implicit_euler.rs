//! Implicit Euler: first order, L-stable, the most forgiving and the cheapest of the implicit schemes.

use super::{Integrator, Motion, MotionOf, Step, StepOf, stage};
use crate::{Scalar, mechanism::Mechanism};

/// Implicit Euler with `PASSES` Newton passes; with one pass it is the linearly implicit scheme.
#[derive(Clone, Copy, Debug)]
pub struct ImplicitEuler<const PASSES: usize>;

impl<const PASSES: usize> Integrator for ImplicitEuler<PASSES> {
    const NAME: &'static str = if PASSES == 1 { "linearly-implicit-euler" } else { "implicit-euler" };
    const ORDER: u32 = 1;
    const IMPLICIT: bool = true;

    #[inline(always)]
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
    ) -> StepOf<S, M, D> {
        let (start, _) = mechanism.forces(t, &motion.pose, &motion.memory, &motion.velocity, h);
        let end = stage::<S, M, D, PASSES>(mechanism, t + h, h, motion, motion.velocity);
        // Half the change of the force over the step is what the first order leaves out; the linearisation takes the stiff
        // part out of it again, which the scheme damps and does not follow.
        let rate = S::one() / h;
        let change = mechanism.momentum(&(end.motion.velocity - motion.velocity)) * rate - start;
        let left_out = mechanism.solve(&end.linearisation, &(change * S::from_f64(0.5)));
        let error = mechanism.impulse(&mechanism.momentum(&left_out));
        let pose = mechanism.normalised(&end.motion.pose);
        Step { motion: Motion { pose, ..end.motion }, residual: end.residual, error, drift: error * h }
    }
}
