//! What a controller calls: a mechanism, a scheme and a step size, made once; a state, stepped for ever.

use core::marker::PhantomData;

use crate::{
    ParameterError, SVector, Scalar,
    error::bounded,
    integrator::{Integrator, Motion},
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
pub struct State<S, P, const D: usize> {
    /// Steps taken; time is this count times the step.
    pub steps: u32,
    /// Pose and velocities.
    pub motion: Motion<S, P, D>,
}

/// What a step says about itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Report<S> {
    /// Imbalance of momentum (N·s) that the last Newton pass found; what the step keeps of it is smaller.
    /// Infinite if the step left the finite range: then the motion was held as it was.
    pub residual: S,
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
    pub fn at_rest<const D: usize>(&self, pose: M::Pose) -> State<S, M::Pose, D>
    where
        M: Mechanism<S, D>,
    {
        State { steps: 0, motion: Motion { pose, velocity: SVector::zeros() } }
    }

    /// Moves `state` by one step. The count of steps stops at its greatest value, after which time stands still.
    #[inline]
    pub fn step<const D: usize>(&self, state: &mut State<S, M::Pose, D>) -> Report<S>
    where
        M: Mechanism<S, D>,
    {
        let t = self.time(state.steps);
        let (next, residual) = I::step(&self.mechanism, t, self.step, &state.motion);
        let zero = S::zero();
        let nought = next.velocity.iter().fold(self.mechanism.nought(&next.pose), |sum, v| sum + *v * zero);
        let finite = S::one() + nought;
        let was = state.motion;
        state.steps = state.steps.saturating_add(1);
        state.motion = Motion {
            pose: self.mechanism.selected(finite, &next.pose, &was.pose),
            velocity: next.velocity.zip_map(&was.velocity, |new, old| finite.select_gt(zero, new, old)),
        };
        Report { residual: finite.select_gt(zero, residual, S::one() / zero) }
    }
}
