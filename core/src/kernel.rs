//! What a controller calls: a mechanism, a scheme and a step size, made once; a state, stepped for ever.

use core::marker::PhantomData;

use crate::{
    ParameterError, SVector, Scalar,
    error::bounded,
    integrator::{Integrator, Motion, Step},
    mechanism::Mechanism,
};

/// Everything about a run that does not change. Stepping it cannot fail and takes the same instructions for every
/// state.
#[derive(Clone, Copy, Debug)]
pub struct Kernel<S, M, I> {
    mechanism: M,
    step: S,
    integrator: PhantomData<I>,
}

/// Everything that changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<S, P, R, const D: usize> {
    /// Steps taken; time is this count times the step.
    pub steps: u32,
    /// Pose, velocities and memory.
    pub motion: Motion<S, P, R, D>,
}

/// The state of mechanism `M`.
pub type StateOf<S, M, const D: usize> = State<S, <M as Mechanism<S, D>>::Pose, <M as Mechanism<S, D>>::Memory, D>;

/// What a step says about itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Report<S> {
    /// Imbalance of momentum (N·s) that the Newton passes left in the worst stage.
    /// Infinite if it left the finite range, never NaN. If the motion left it, the motion was held as it was.
    pub residual: S,
    /// Estimate of the momentum's error (N·s) made in this step; infinite likewise.
    pub error: S,
}

impl<S: Scalar + PartialOrd, M, I: Integrator> Kernel<S, M, I> {
    /// A kernel that moves `mechanism` by `step` (s) at a time.
    ///
    /// # Errors
    /// If the step is outside 1e-9…1 s or not finite.
    pub fn new(mechanism: M, step: S) -> Result<Self, ParameterError<S>> {
        Ok(Self { mechanism, step: bounded("run.step", step, [1e-9, 1.0])?, integrator: PhantomData })
    }
}

impl<S: Scalar, M, I: Integrator> Kernel<S, M, I> {
    /// The mechanism.
    pub fn mechanism(&self) -> &M {
        &self.mechanism
    }

    /// The time (s) after `steps` steps.
    #[inline(always)]
    pub fn time(&self, steps: u32) -> S {
        S::from_count(steps) * self.step
    }

    /// At rest in `pose` at time 0.
    pub fn at_rest<const D: usize>(&self, pose: M::Pose) -> StateOf<S, M, D>
    where
        M: Mechanism<S, D>,
    {
        State {
            steps: 0,
            motion: Motion {
                pose,
                velocity: SVector::zeros(),
                acceleration: SVector::zeros(),
                memory: self.mechanism.fresh(),
            },
        }
    }

    /// Moves `state` by one step. The count of steps stops at its greatest value, after which time stands still.
    #[inline]
    pub fn step<const D: usize>(&self, state: &mut StateOf<S, M, D>) -> Report<S>
    where
        M: Mechanism<S, D>,
    {
        let Step { motion: next, residual, error, .. } =
            I::step(&self.mechanism, self.time(state.steps), self.step, &state.motion);
        let zero = S::zero();
        let rates = next.velocity + next.acceleration;
        let nought = rates.iter().fold(self.mechanism.nought(&next.pose), |sum, v| sum + *v) * zero;
        let finite = S::one() + nought;
        state.steps = state.steps.saturating_add(1);
        let motion = &mut state.motion;
        self.mechanism.adopt(finite, (&next.pose, &next.memory), (&mut motion.pose, &mut motion.memory));
        let either = |new: S, old| new.or_old(finite, old);
        motion.velocity = next.velocity.zip_map(&motion.velocity, either);
        motion.acceleration = next.acceleration.zip_map(&motion.acceleration, either);
        let or_infinite = |x: S| (finite + x * zero).select_gt(zero, x, S::one() / zero);
        Report { residual: or_infinite(residual), error: or_infinite(error) }
    }
}
