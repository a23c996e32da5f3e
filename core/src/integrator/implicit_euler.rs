//! Implicit Euler: first order, L-stable, the most forgiving and the cheapest of the implicit schemes.

use super::{Integrator, Motion, MotionOf, Step, StepOf, stage};
use crate::{Scalar, mechanism::Mechanism};

/// The third pass is a chord: it takes the iteration matrix of the second, for half the cost.
///
/// It errs about as little as four full passes. A chord before or after errs more, and so does any in an extrapolated scheme
/// (the guide's notes on steps of one length have the figures).
const CHORD: usize = 2;

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
        let end = stage::<S, M, D, PASSES, CHORD>(mechanism, t + h, h, motion, motion.velocity);
        // Half the change of the force from the last step's end is what the first order leaves out; the iteration matrix takes
        // the stiff part out of it again, which the scheme damps and does not follow.
        let change = mechanism.momentum(&end.motion.pose, &(end.motion.acceleration - motion.acceleration));
        let left_out = mechanism.solve(&end.iteration_matrix, &(change * S::from_f64(0.5)));
        let error = mechanism.weighed(&end.motion.pose, &left_out);
        let pose = mechanism.normalised(&end.motion.pose);
        Step { motion: Motion { pose, ..end.motion }, residual: end.residual, error, drift: error * h }
    }
}
