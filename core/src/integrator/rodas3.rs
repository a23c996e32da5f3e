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
        *at = at.plus(&third.only_if(rest), one);
        let [before, at] = black_box(&mut *sums);
        *before = start.stage(&start.evaluated(at, 1.0), Some(before), 0.0);
        let [fourth, at] = black_box(sums);
        start.end(&at.plus(&fourth.only_if(rest), one), fourth)
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

#[cfg(test)]
mod tests {
    use super::{Part, Rodas3};
    use crate::{
        drive::Push,
        law::{Impact, Linear, Pad},
        system::on_axis,
    };

    /// A push (N) that ends in a force that is not finite, at 1 ms.
    #[derive(Clone, Copy, Debug)]
    struct Breaks(f64);

    impl Push<f64> for Breaks {
        fn force(&self, t: f64, speed: f64) -> f64 {
            if t < 1e-3 { 2.0 * (0.1 - speed) } else { self.0 }
        }

        fn force_rate(&self, _: f64) -> f64 {
            0.0
        }

        fn gain(&self) -> f64 {
            2.0
        }

        fn checked(self) -> Result<Self, crate::ParameterError<f64>> {
            Ok(self)
        }
    }

    #[test]
    fn half_a_step_by_euler_does_not_depend_on_the_later_stages() {
        let (mass, h) = (0.1, 2e-3);
        for end in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e300, 0.0] {
            let contact = Impact::new(Linear::new(100.0).unwrap(), 0.0, 1.0).unwrap();
            let body = on_axis(mass, 0.0, Pad::new(1.0).unwrap(), contact, Breaks(end)).unwrap();
            let internal = crate::mechanism::Mechanism::fresh(&body);
            let from = (&0.25, &crate::SVector::from([0.05]), &internal);
            let attempt = |euler| Rodas3::attempt(&body, 0.0, h, from, Some(euler), &mut [Part::zero(); 2]);
            let euler = attempt(1.0);
            // m·(v − v₀) = a·2·(0.1 − v) with a = h/2.
            let after = (mass * 0.05 + 0.5 * h * 2.0 * 0.1) / (mass + 0.5 * h * 2.0);
            assert!(libm::fabs(0.05 + euler.change.x - after) < 1e-15, "{end}: {}", euler.change.x);
            assert!(libm::fabs(euler.pose - (0.25 + 0.5 * h * after)) < 1e-15, "{end}: {}", euler.pose);
            // The whole step says that it is worth nothing.
            assert_eq!(attempt(0.0).change.x.is_finite(), end.is_finite(), "{end}");
        }
    }
}
