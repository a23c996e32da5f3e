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
    /// Steps taken; time is this count times the step, see [`Kernel::time`].
    pub steps: u32,
    /// Pose, velocities and internal variables.
    pub motion: Motion<S, P, R, D>,
}

/// The state of mechanism `M`.
pub type StateOf<S, M, const D: usize> = State<S, <M as Mechanism<S, D>>::Pose, <M as Mechanism<S, D>>::Internal, D>;

/// What a step says about itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use = "it says whether the motion was moved or held"]
pub struct Report<S> {
    /// Imbalance of momentum (N·s) that the Newton passes left in the worst stage.
    /// Infinite if it, or the motion, left the finite range, never NaN; then, and only then, the motion was held as it was.
    pub residual: S,
    /// Estimate of the momentum's error (N·s) made in this step; infinite if it left the finite range, never NaN.
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

    /// The mechanism, whose drive may be given another command: see [`Commandable`](crate::drive::Commandable).
    pub fn mechanism_mut(&mut self) -> &mut M {
        &mut self.mechanism
    }

    /// The time (s) after `steps` steps, to the last place of `S`. In f32 a count is exact up to 2²⁴, 4.7 h at 1 kHz; beyond,
    /// time goes on in treads of 2, 4 and more steps, and a ramp that is still under way then goes up such a stair. A ramp
    /// that is over needs no time: the motion has the same bits then at any count.
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
                internal: self.mechanism.fresh(),
            },
        }
    }

    /// Moves `state` by one step. The count of steps stops at its greatest value, after which time stands still.
    ///
    /// Friction that sticks needs an implicit scheme; with another one this does not compile:
    /// ```compile_fail
    /// use slipfit_core::{integrator::SemiImplicitEuler, kernel::Kernel, law::Exact, pose::Pose, slide::Slide};
    ///
    /// fn slides<E: slipfit_core::law::Elastic<f32>>(slide: Slide<f32, E, Exact<f32>>) {
    ///     let kernel = Kernel::<f32, _, SemiImplicitEuler>::new(slide, 1e-3).unwrap();
    ///     let report = kernel.step::<6>(&mut kernel.at_rest(Pose::nominal()));
    /// }
    /// # use slipfit_core::law::Linear;
    /// # let _: fn(Slide<f32, Linear<f32>, Exact<f32>>) = slides;
    /// ```
    /// With implicit Euler it does:
    /// ```
    /// use slipfit_core::{integrator::ImplicitEuler, kernel::Kernel, law::Exact, pose::Pose, slide::Slide};
    ///
    /// fn slides<E: slipfit_core::law::Elastic<f32>>(slide: Slide<f32, E, Exact<f32>>) {
    ///     let kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(slide, 1e-3).unwrap();
    ///     let report = kernel.step::<6>(&mut kernel.at_rest(Pose::nominal()));
    ///     assert!(report.residual.is_finite());
    /// }
    /// # use slipfit_core::law::Linear;
    /// # let _: fn(Slide<f32, Linear<f32>, Exact<f32>>) = slides;
    /// ```
    #[inline]
    pub fn step<const D: usize>(&self, state: &mut StateOf<S, M, D>) -> Report<S>
    where
        M: Mechanism<S, D>,
    {
        const { assert!(I::IMPLICIT || !M::STICKS, "friction that sticks needs an implicit scheme") };
        let Step { motion: next, residual, error, .. } =
            I::step(&self.mechanism, self.time(state.steps), self.step, &state.motion);
        let zero = S::zero();
        let rates = next.velocity + next.acceleration;
        // Where every pass was taken back the motion is finite, but not a solution.
        let finiteness_probe = rates.data.0[0]
            .iter()
            .fold(self.mechanism.finiteness_probe(&next.pose) + residual * zero, |sum, v| sum + *v)
            * zero;
        let finite = S::one() + finiteness_probe;
        state.steps = state.steps.saturating_add(1);
        let motion = &mut state.motion;
        self.mechanism.accept(finite, (&next.pose, &next.internal), (&mut motion.pose, &mut motion.internal));
        let either = |new: S, old| new.or_old(finite, old);
        motion.velocity = next.velocity.zip_map(&motion.velocity, either);
        motion.acceleration = next.acceleration.zip_map(&motion.acceleration, either);
        let or_infinite = |x: S| (finite + x * zero).select_gt(zero, x, S::one() / zero);
        Report { residual: or_infinite(residual), error: or_infinite(error) }
    }
}

#[cfg(test)]
mod tests {
    use super::Kernel;
    use crate::{
        Vector3,
        drive::Drive,
        integrator::ImplicitEuler,
        law::{Impact, Pad, ThreeHalves},
        system::{AxisBody, on_axis},
    };

    type Driven = AxisBody<f32, ThreeHalves<f32>, Pad<f32>, Drive<f32>>;

    /// A body of 0.1 kg that is driven along an axis, towards a pad 1 mm ahead.
    fn kernel() -> Kernel<f32, Driven, ImplicitEuler<4>> {
        let contact = Impact::new(ThreeHalves::new(3e6).unwrap(), 1000.0, 1e-4).unwrap();
        let drive = Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: -0.1, point_b: Vector3::zeros() };
        let body = on_axis(0.1, 0.0, Pad::new(1e-3).unwrap(), contact, drive).unwrap();
        Kernel::new(body, 1e-3).unwrap()
    }

    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
    fn a_ramp_that_is_over_needs_no_time() {
        let kernel = kernel();
        let after = |steps: u32| {
            let mut state = kernel.at_rest::<1>(0.0);
            state.steps = steps;
            core::array::from_fn::<_, 100, _>(|_| (kernel.step(&mut state), state.motion))
        };
        let expected = after(1000);
        for steps in [1 << 20, (1 << 24) - 50, (1 << 24) + 1, 1 << 30, u32::MAX - 50, u32::MAX] {
            assert_eq!(after(steps), expected, "{steps}");
        }
        // Where a count is not exact any more, time still never goes back.
        let times = ((1 << 24) - 9..(1 << 24) + 9).map(|steps| kernel.time(steps));
        assert!(times.is_sorted());
    }

    #[test]
    fn a_motion_is_held_where_the_residual_is_infinite_and_only_there() {
        let kernel = kernel();
        let mut held = 0;
        for exponent in 0..38 {
            let mut state = kernel.at_rest::<1>(0.0);
            state.motion.velocity.x = -libm::powf(10.0, exponent as f32);
            for _ in 0..4 {
                let before = state.motion;
                let report = kernel.step(&mut state);
                assert_eq!(report.residual == f32::INFINITY, state.motion == before, "1e{exponent} {report:?}");
                held += u32::from(state.motion == before);
            }
        }
        assert!(held > 0);
    }
}
