//! RODAS3 (Sandu et al., Atmospheric Environment 31, 1997): third order, one set of derivatives and two more forces a step.

use core::hint::black_box;

use super::{
    Integrator, MotionOf, StepOf,
    rosenbrock::{End, From, Part, Start},
};
use crate::{Scalar, mechanism::Mechanism};

/// Third order, linearly implicit, L-stable.
#[derive(Clone, Copy, Debug)]
pub struct Rodas3;

/// What the next stage adds of earlier ones, and where its force is taken.
pub(crate) type Sums<S, const D: usize> = [Part<S, D>; 2];

impl Rodas3 {
    /// A step `h` (s) of `mechanism` at time `t` (s); where `euler` > 0 half of it by linearly implicit Euler, which the first
    /// stage alone is, so that it stays bounded where the whole step would not. The error is that of the whole step either way.
    ///
    /// Written out: a loop over coefficients would keep every stage alive, and in images some of the coefficients as doubles.
    /// The compiler is kept from looking into the sums: it would hold them on the stack a second time, and put a stage off until
    /// after the forces of the next, which need much of the stack themselves. That would take 160 bytes more on a Cortex-M4F.
    #[inline(always)]
    pub(crate) fn attempt<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        from: From<'_, S, M, D>,
        euler: Option<S>,
        sums: &mut Sums<S, D>,
    ) -> End<S, M::Pose, D> {
        let one = S::one();
        // Weights, because a choice of vectors becomes a branch.
        let rest = euler.map_or(one, |euler| euler.select_gt(S::zero(), S::zero(), one));
        let (start, here) = Start::new(mechanism, t, h, from, 0.5);
        let first = start.stage(&here, None, 0.5);
        let second = start.stage(&here, Some(&first.times(S::from_f64(4.0))), 1.5);
        *sums = [first.plus(&second, -one), first.times(one + rest)];
        let [before, at] = black_box(&mut *sums);
        let third = start.stage(&start.evaluated(at, 1.0), Some(before), 0.0);
        *before = before.plus(&third, S::from_f64(-8.0 / 3.0));
        *at = at.plus(&third, rest);
        let [before, at] = black_box(&mut *sums);
        *before = start.stage(&start.evaluated(at, 1.0), Some(before), 0.0);
        let [fourth, at] = black_box(sums);
        start.end(&at.plus(fourth, rest), fourth)
    }
}

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
        let from = (&motion.pose, &motion.velocity, &motion.internal);
        Self::attempt(mechanism, t, h, from, None, &mut [Part::zero(); 2]).step(mechanism, motion, h)
    }
}
