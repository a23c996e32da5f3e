//! Rosenbrock methods: linearly implicit Runge–Kutta, one set of derivatives a step.
//!
//! Each stage is a linear solve with the same iteration matrix, so that nothing is iterated. The form is that of Hairer
//! and Wanner, *Solving Ordinary Differential Equations II* (IV.7), which needs no product with the Jacobian but the one that
//! eliminates the displacement. Derivatives at the start stand for those of the whole step, so that the error estimate
//! must choose the steps: where a contact closes or opens within a step it is worth little. Laws whose forces change their
//! internal variables, such as exact friction, have no derivative that these methods could use.

use super::{Motion, MotionOf, Step, StepOf, refuse_sticking};
use crate::{
    SVector, Scalar,
    mechanism::{Differentiated, Mechanism},
};

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

    /// Weights of the stages in b₀ and b₁: at the share s of the step the change is s·(whole + (1 − s)·(b₀ + s·b₁)).
    const BENDS: [&'static [f64]; 2];
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part<S, const D: usize> {
    place: SVector<S, D>,
    velocity: SVector<S, D>,
}

impl<S: Scalar, const D: usize> Part<S, D> {
    /// No displacement and no change.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { place: SVector::zeros(), velocity: SVector::zeros() }
    }

    /// `self` times `weight`.
    #[inline(always)]
    pub fn times(&self, weight: S) -> Self {
        Self { place: self.place * weight, velocity: self.velocity * weight }
    }

    /// `self` + `weight`·`other`.
    #[inline(always)]
    pub fn plus(&self, other: &Self, weight: S) -> Self {
        let Self { place, velocity } = other;
        Self { place: self.place + place * weight, velocity: self.velocity + velocity * weight }
    }

    /// The sum of `parts` weighted by `weights`, of which zeros cost nothing.
    #[inline(always)]
    fn weighted(parts: &[Self; MOST_STAGES], weights: &[f64]) -> Self {
        let mut sum = Self::zero();
        for (part, weight) in parts.iter().zip(weights) {
            if *weight != 0.0 {
                sum = sum.plus(part, S::from_f64(*weight));
            }
        }
        sum
    }
}

/// The force at a stage, and how its place changes there.
#[derive(Clone, Copy)]
pub(super) struct Evaluation<S, const D: usize> {
    force: SVector<S, D>,
    rate: SVector<S, D>,
}

/// Where a step starts: pose, velocity, internal variables.
pub(super) type From<'a, S, M, const D: usize> =
    (&'a <M as Mechanism<S, D>>::Pose, &'a SVector<S, D>, &'a <M as Mechanism<S, D>>::Internal);

/// A step at its start: what all of its stages share.
pub(super) struct Start<'a, S: Scalar, M: Mechanism<S, D>, const D: usize> {
    mechanism: &'a M,
    from: From<'a, S, M, D>,
    t: S,
    h: S,
    /// Implicit part of the step (s).
    a: S,
    per_step: S,
    per_time: SVector<S, D>,
    jacobians: M::Jacobians,
    iteration_matrix: M::IterationMatrix,
}

/// Where a step ends, and how far the embedded method's end is from there.
pub(crate) struct End<S, P, const D: usize> {
    pub pose: P,
    /// Change of the velocities.
    pub change: SVector<S, D>,
    /// See [`Step::error`].
    pub error: S,
    /// See [`Step::drift`].
    pub drift: S,
}

impl<'a, S: Scalar, M: Mechanism<S, D>, const D: usize> Start<'a, S, M, D> {
    /// The start of a step `h` (s) with the implicit part `gamma`·`h`, and the force there.
    #[inline(always)]
    pub fn new(mechanism: &'a M, t: S, h: S, from: From<'a, S, M, D>, gamma: f64) -> (Self, Evaluation<S, D>) {
        let (pose, velocity, internal) = from;
        Self::of(mechanism, [t, h], from, gamma, mechanism.differentiated(t, pose, internal, velocity))
    }

    /// [`new`](Self::new) with the forces and derivatives there given.
    #[inline(always)]
    pub fn of(
        mechanism: &'a M,
        [t, h]: [S; 2],
        from: From<'a, S, M, D>,
        gamma: f64,
        differentiated: Differentiated<S, M::Jacobians, D>,
    ) -> (Self, Evaluation<S, D>) {
        refuse_sticking::<S, M, D>();
        let (_, velocity, _) = from;
        let Differentiated { force, per_time, jacobians } = differentiated;
        let a = h * S::from_f64(gamma);
        let iteration_matrix = mechanism.iteration_matrix(&jacobians, velocity, a);
        let start = Self { mechanism, from, t, h, a, per_step: S::one() / h, per_time, jacobians, iteration_matrix };
        (start, Evaluation { force, rate: *velocity })
    }

    /// The force `at` a part of the step, at `time`, a share of it.
    #[inline(always)]
    pub fn evaluated(&self, at: &Part<S, D>, time: f64) -> Evaluation<S, D> {
        let Self { mechanism, from: (start, velocity, internal), .. } = *self;
        let pose = mechanism.explicit_update(start, &at.place, S::one());
        let velocity = velocity + at.velocity;
        let t = self.t + S::from_f64(time) * self.h;
        let force = mechanism.forces_by(&self.jacobians, t, &pose, internal, &velocity, self.h);
        Evaluation { force, rate: mechanism.rate(&at.place, &velocity) }
    }

    /// The stage with the evaluation `here`, with what earlier stages add `before` and the weight `time_rate` of the force's
    /// change with time.
    #[inline(always)]
    pub fn stage(&self, here: &Evaluation<S, D>, before: Option<&Part<S, D>>, time_rate: f64) -> Part<S, D> {
        let Self { mechanism, a, per_step, .. } = *self;
        let Evaluation { mut force, mut rate } = *here;
        if time_rate != 0.0 {
            force += self.per_time * (S::from_f64(time_rate) * self.h);
        }
        if let Some(before) = before {
            rate += before.place * per_step;
            force += mechanism.momentum_by(&self.jacobians, self.from.0, &before.velocity) * per_step;
        }
        // The equation of the place is solved for first.
        let displaced = |rate: &SVector<S, D>| mechanism.displacement(self.from.1, rate, a);
        let velocity =
            mechanism.solve(&self.iteration_matrix, &(force + mechanism.pushed(&self.jacobians, &displaced(&rate))));
        Part { place: displaced(&(velocity + rate)), velocity }
    }

    /// The end of the step, which is the `whole` of its parts; `last` is the difference from the embedded method.
    #[inline(always)]
    pub fn end(&self, whole: &Part<S, D>, last: &Part<S, D>) -> End<S, M::Pose, D> {
        let Self { mechanism, from: (start, ..), .. } = *self;
        End {
            pose: mechanism.normalised(&mechanism.explicit_update(start, &whole.place, S::one())),
            change: whole.velocity,
            error: mechanism.weighed(start, &last.velocity),
            drift: mechanism.weighed(start, &last.place),
        }
    }
}

impl<S: Scalar, P, const D: usize> End<S, P, D> {
    /// The step `h` (s) of `mechanism` that led here from `motion`.
    #[inline(always)]
    pub fn step<M: Mechanism<S, D, Pose = P>>(
        self,
        mechanism: &M,
        motion: &MotionOf<S, M, D>,
        h: S,
    ) -> StepOf<S, M, D> {
        Step {
            motion: Motion {
                velocity: motion.velocity + self.change,
                acceleration: self.change * (S::one() / h),
                internal: mechanism.remembered(&self.pose, &motion.internal),
                pose: self.pose,
            },
            residual: S::zero(),
            error: self.error,
            drift: self.drift,
        }
    }
}

/// One step of the method `T`, with the accelerations at its start and end; see [`Dense`](super::Dense).
#[inline(always)]
pub(super) fn step<T: Tableau, S: Scalar, M: Mechanism<S, D>, const D: usize>(
    mechanism: &M,
    [t, h]: [S; 2],
    motion: &MotionOf<S, M, D>,
    differentiated: Differentiated<S, M::Jacobians, D>,
) -> (StepOf<S, M, D>, [SVector<S, D>; 2]) {
    let from = (&motion.pose, &motion.velocity, &motion.internal);
    let (start, mut here) = Start::of(mechanism, [t, h], from, T::GAMMA, differentiated);
    let mut parts = [Part::zero(); MOST_STAGES];
    let mut last = Part::zero();
    for (i, stage) in T::STAGES.iter().enumerate() {
        if let Some(weights) = stage.force_at {
            here = start.evaluated(&Part::weighted(&parts, weights), stage.time);
        }
        let before = Part::weighted(&parts, stage.coupling);
        last = start.stage(&here, Some(&before), stage.time_rate);
        if let Some(part) = parts.get_mut(i) {
            *part = last;
        }
    }
    let whole = Part::weighted(&parts, T::RESULT);
    let [first, second] = T::BENDS.map(|weights| Part::weighted(&parts, weights).velocity);
    let slopes = [whole.velocity + first, whole.velocity - first - second];
    (start.end(&whole, &last).step(mechanism, motion, h), slopes.map(|slope| slope * start.per_step))
}
