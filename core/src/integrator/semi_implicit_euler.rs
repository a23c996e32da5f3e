//! Semi-implicit Euler: first order, explicit in the forces. A baseline: one evaluation a step and one for the error
//! estimate, stable only while the step resolves every contact and the stick band.

use super::{Integrator, Motion, MotionOf, Step, StepOf, refuse_sticking};
use crate::{Scalar, mechanism::Mechanism};

/// Velocities from the forces at the step's start, poses from the new velocities.
#[derive(Clone, Copy, Debug)]
pub struct SemiImplicitEuler;

impl Integrator for SemiImplicitEuler {
    const NAME: &'static str = "semi-implicit-euler";
    const ORDER: u32 = 1;
    const IMPLICIT: bool = false;

    #[inline(always)]
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
    ) -> StepOf<S, M, D> {
        refuse_sticking::<S, M, D>();
        let start = mechanism.forces(t, &motion.pose, &motion.internal, &motion.velocity, h, None);
        let velocity = motion.velocity + mechanism.velocity(&motion.pose, &(start * h));
        let pose = mechanism.normalised(&mechanism.implicit_update(&motion.pose, &velocity, h));
        let end = mechanism.forces(t + h, &pose, &motion.internal, &velocity, h, None);
        // Half the change of the force over the step is what the first order leaves out.
        let error = mechanism.impulse(&((end - start) * (h * S::from_f64(0.5))));
        let internal = mechanism.remembered(&pose, &motion.internal);
        let motion = Motion { pose, velocity, acceleration: mechanism.velocity(&pose, &end), internal };
        Step { motion, residual: S::zero(), error, drift: error * h }
    }
}
