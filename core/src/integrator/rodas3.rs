//! RODAS3: a Rosenbrock method of third order (Sandu et al. 1997), one linearisation and three forces a step.
//!
//! Each of its four stages is a linear solve with the same matrix; the last two forces are evaluated at the end of the
//! step, and the last stage is the error of the embedded second-order method. It takes the derivatives at the start for
//! those of the whole step, so that its error estimate must choose the steps: where a contact closes or lets go within a
//! step it is worth nothing. Laws with a memory, such as exact friction, have no derivative that it could use.

use super::{Integrator, Motion, MotionOf, Step, StepOf};
use crate::{SVector, Scalar, mechanism::Mechanism};

/// Third order, linearly implicit, L-stable.
#[derive(Clone, Copy, Debug)]
pub struct Rodas3;

impl Integrator for Rodas3 {
    const NAME: &'static str = "rodas3";
    const ORDER: u32 = 3;
    const IMPLICIT: bool = false;

    #[inline(always)]
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
    ) -> StepOf<S, M, D> {
        let (half, two) = (S::from_f64(0.5), S::from_f64(2.0));
        let start = mechanism.differentiated(t, &motion.pose, &motion.memory, &motion.velocity);
        let a = h * half;
        let linearisation = mechanism.linearisation(&start.slopes, a);
        // Rates at a place and the force there, with what earlier stages add to both: the stage's own part of place and
        // velocity. The equation of the place is solved for first.
        let stage = |rate: SVector<S, D>, force: SVector<S, D>| {
            let velocity = mechanism.solve(&linearisation, &(force + mechanism.pushed(&start.slopes, &(rate * a))));
            Part { place: (velocity + rate) * a, velocity }
        };
        let end = t + h;
        let forces = |at: &Part<S, D>| {
            let pose = mechanism.moved(&motion.pose, &at.place, S::one());
            let velocity = motion.velocity + at.velocity;
            let force = mechanism.forces(end, &pose, &motion.memory, &velocity, h, None);
            (mechanism.rate(&at.place, &velocity), force)
        };
        let per_step = S::one() / h;
        let inertia = |part: &Part<S, D>| mechanism.momentum(&part.velocity);

        let first = stage(motion.velocity, start.force + start.per_time * a);
        let four = per_step * S::from_f64(4.0);
        let second = stage(
            motion.velocity + first.place * four,
            start.force + start.per_time * (a + h) + inertia(&first) * four,
        );
        let at_third = first.times(two);
        let (rate, force) = forces(&at_third);
        let left = first.minus(&second);
        let third = stage(rate + left.place * per_step, force + inertia(&left) * per_step);
        let at_fourth = at_third.plus(&third);
        let (rate, force) = forces(&at_fourth);
        let left = left.minus(&third.times(S::from_f64(8.0 / 3.0)));
        let fourth = stage(rate + left.place * per_step, force + inertia(&left) * per_step);
        let moved = at_fourth.plus(&fourth);

        let pose = mechanism.normalised(&mechanism.moved(&motion.pose, &moved.place, S::one()));
        Step {
            motion: Motion {
                pose,
                velocity: motion.velocity + moved.velocity,
                acceleration: moved.velocity * per_step,
                memory: motion.memory,
            },
            residual: S::zero(),
            error: mechanism.impulse(&inertia(&fourth)),
            drift: mechanism.impulse(&mechanism.momentum(&fourth.place)),
        }
    }
}

/// A part of a step: displacement (m, rad) and change of velocity (m/s, rad/s).
struct Part<S, const D: usize> {
    place: SVector<S, D>,
    velocity: SVector<S, D>,
}

impl<S: Scalar, const D: usize> Part<S, D> {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Self { place: self.place + other.place, velocity: self.velocity + other.velocity }
    }

    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        Self { place: self.place - other.place, velocity: self.velocity - other.velocity }
    }

    #[inline(always)]
    fn times(&self, factor: S) -> Self {
        Self { place: self.place * factor, velocity: self.velocity * factor }
    }
}
