//! The classical Runge–Kutta scheme: fourth order, explicit. A baseline: accurate on smooth motion, stable only while the
//! step resolves every contact and the stick band.

use super::{Integrator, Motion, MotionOf, Step, StepOf, refuse_sticking};
use crate::{SVector, Scalar, mechanism::Mechanism};

/// RK4.
#[derive(Clone, Copy, Debug)]
pub struct RungeKutta4;

impl Integrator for RungeKutta4 {
    const NAME: &'static str = "rk4";
    const ORDER: u32 = 4;
    const IMPLICIT: bool = false;

    #[inline(always)]
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
    ) -> StepOf<S, M, D> {
        refuse_sticking::<S, M, D>();
        let (half, third, sixth) = (S::from_f64(0.5), S::from_f64(1.0 / 3.0), S::from_f64(1.0 / 6.0));
        let acceleration = |t: S, pose: &M::Pose, velocity: &SVector<S, D>| {
            mechanism.velocity(pose, &mechanism.forces(t, pose, &motion.internal, velocity, h, None))
        };
        let (q1, v1) = (motion.pose, motion.velocity);
        let a1 = acceleration(t, &q1, &v1);
        // Each slope of the pose is kept as the pair of a pose and where a whole step along the slope leads.
        let p1 = mechanism.explicit_update(&q1, &v1, h);
        let (q2, v2) = (mechanism.shifted(&q1, &q1, &p1, half), v1 + a1 * (h * half));
        let a2 = acceleration(t + h * half, &q2, &v2);
        let p2 = mechanism.explicit_update(&q2, &v2, h);
        let (q3, v3) = (mechanism.shifted(&q1, &q2, &p2, half), v1 + a2 * (h * half));
        let a3 = acceleration(t + h * half, &q3, &v3);
        let p3 = mechanism.explicit_update(&q3, &v3, h);
        let (q4, v4) = (mechanism.shifted(&q1, &q3, &p3, S::one()), v1 + a3 * h);
        let a4 = acceleration(t + h, &q4, &v4);
        let p4 = mechanism.explicit_update(&q4, &v4, h);

        let velocity = v1 + (a1 + a4) * (h * sixth) + (a2 + a3) * (h * third);
        let mut pose = mechanism.shifted(&q1, &q1, &p1, sixth);
        for (from, to, weight) in [(&q2, &p2, third), (&q3, &p3, third), (&q4, &p4, sixth)] {
            pose = mechanism.shifted(&pose, from, to, weight);
        }
        let pose = mechanism.normalised(&pose);
        // The two slopes at the middle differ by a term of third order: an estimate on the safe side.
        let error = mechanism.weighed(&pose, &((a3 - a2) * (h * third)));
        let internal = mechanism.remembered(&pose, &motion.internal);
        let motion = Motion { pose, velocity, acceleration: a4, internal };
        Step { motion, residual: S::zero(), error, drift: error * h }
    }
}
