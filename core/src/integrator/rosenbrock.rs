//! Rosenbrock methods: linearly implicit Runge–Kutta, one set of derivatives a step.
//!
//! Each stage is a linear solve with the same iteration matrix, so that nothing is iterated. The form is that of Hairer
//! and Wanner, *Solving Ordinary Differential Equations II* (IV.7), which needs no product with the Jacobian but the one that
//! eliminates the displacement. Derivatives at the start stand for those of the whole step, so that the error estimate
//! must choose the steps: where a contact closes or opens within a step it is worth little. Laws with internal
//! variables, such as exact friction, have no derivative that these methods could use.

use super::{Motion, MotionOf, Step, StepOf};
use crate::{SVector, Scalar, mechanism::Mechanism};

/// The most stages of a method.
const MOST_STAGES: usize = 6;

/// The coefficients of a method with as many stages as `STAGES` has.
///
/// The result is the start plus the sum of the stages weighted by [`RESULT`](Self::RESULT); the last stage is the difference
/// from the embedded method of one order less.
pub(super) trait Tableau {
    /// γ: the implicit part of the step.
    const GAMMA: f64;

    /// What each stage is made of.
    const STAGES: &'static [StageOf];

    /// mᵢ: weight of each stage in the result.
    const RESULT: &'static [f64];
}

/// The coefficients of one stage i.
pub(super) struct StageOf {
    /// aᵢⱼ for j < i: where the force is taken. `None` where it is the one of the stage before.
    pub force_at: Option<&'static [f64]>,
    /// αᵢ: when the force is taken, as a share of the step.
    pub time: f64,
    /// γᵢ: weight of the force's change with time.
    pub time_rate: f64,
    /// cᵢⱼ for j < i: what earlier stages add.
    pub coupling: &'static [f64],
}

/// A part of a step: displacement (m, rad) and change of velocity (m/s, rad/s).
#[derive(Clone, Copy)]
struct Part<S, const D: usize> {
    place: SVector<S, D>,
    velocity: SVector<S, D>,
}

impl<S: Scalar, const D: usize> Part<S, D> {
    /// The sum of `parts` weighted by `weights`, of which zeros cost nothing.
    #[inline(always)]
    fn weighted(parts: &[Self; MOST_STAGES], weights: &[f64]) -> Self {
        let mut sum = Self { place: SVector::zeros(), velocity: SVector::zeros() };
        for (part, weight) in parts.iter().zip(weights) {
            if *weight != 0.0 {
                let weight = S::from_f64(*weight);
                for k in 0..D {
                    sum.place[k] += part.place[k] * weight;
                    sum.velocity[k] += part.velocity[k] * weight;
                }
            }
        }
        sum
    }
}

/// One step of the method `T`; see [`Integrator::step`](super::Integrator::step).
#[inline(always)]
pub(super) fn step<T: Tableau, S: Scalar, M: Mechanism<S, D>, const D: usize>(
    mechanism: &M,
    t: S,
    h: S,
    motion: &MotionOf<S, M, D>,
) -> StepOf<S, M, D> {
    let start = mechanism.differentiated(t, &motion.pose, &motion.memory, &motion.velocity);
    let a = h * S::from_f64(T::GAMMA);
    let linearisation = mechanism.linearisation(&start.slopes, a);
    let per_step = S::one() / h;
    let mut parts = [Part { place: SVector::zeros(), velocity: SVector::zeros() }; MOST_STAGES];
    let (mut rate, mut force) = (motion.velocity, start.force);
    let mut last = parts[0];
    for (i, stage) in T::STAGES.iter().enumerate() {
        if let Some(weights) = stage.force_at {
            let at = Part::weighted(&parts, weights);
            let pose = mechanism.moved(&motion.pose, &at.place, S::one());
            let velocity = motion.velocity + at.velocity;
            let there = mechanism.forces(t + S::from_f64(stage.time) * h, &pose, &motion.memory, &velocity, h, None);
            force = mechanism.referred(&motion.pose, &pose, there);
            rate = mechanism.rate(&at.place, &velocity);
        }
        let before = Part::weighted(&parts, stage.coupling);
        let rate = rate + before.place * per_step;
        let changing = start.per_time * (S::from_f64(stage.time_rate) * h);
        let force = force + changing + mechanism.momentum(&motion.pose, &before.velocity) * per_step;
        // The equation of the place is solved for first.
        let velocity = mechanism.solve(&linearisation, &(force + mechanism.pushed(&start.slopes, &(rate * a))));
        last = Part { place: (velocity + rate) * a, velocity };
        if let Some(part) = parts.get_mut(i) {
            *part = last;
        }
    }
    let whole = Part::weighted(&parts, T::RESULT);
    let pose = mechanism.normalised(&mechanism.moved(&motion.pose, &whole.place, S::one()));
    Step {
        motion: Motion {
            pose,
            velocity: motion.velocity + whole.velocity,
            acceleration: whole.velocity * per_step,
            memory: motion.memory,
        },
        residual: S::zero(),
        error: mechanism.weighed(&motion.pose, &last.velocity),
        drift: mechanism.weighed(&motion.pose, &last.place),
    }
}
