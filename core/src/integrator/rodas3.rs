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

#[cfg(test)]
mod tests {
    use super::{Part, Rodas3, Start};
    use crate::{
        SVector, Scalar, Vector3,
        drive::Drive,
        law::{Impact, Power, Regularised},
        mechanism::Mechanism,
        pose::{Orientation, Pose},
        slide::{Body, NO_INTERNAL, PINS, box_inertia},
    };

    /// Numbers from −1 to 1, some of them near 0.
    struct Dice(u64);

    impl Dice {
        fn roll<S: Scalar>(&mut self) -> S {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let x = (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
            S::from_f64(x * x * x)
        }

        /// 10 to the power of a number between two.
        fn size<S: Scalar>(&mut self, [least, most]: [f64; 2]) -> S {
            let share = 0.5 + 0.5 * self.roll::<f64>();
            S::from_f64(libm::pow(10.0, least + (most - least) * share))
        }

        fn vector<S: Scalar>(&mut self, size: S) -> Vector3<S> {
            Vector3::new(self.roll::<S>() * size, self.roll::<S>() * size, self.roll::<S>() * size)
        }
    }

    /// Steps of slides of any stiffness, deep in their contacts and however fast: how many were finite at the end of Euler's stage, of which
    /// each must be at the end of the attempt, too.
    fn finite<S: Scalar + PartialOrd>() -> usize {
        let (mut dice, mut count) = (Dice(7), 0);
        for _ in 0..4000 {
            let (reach, mass): (S, S) = (dice.size([-3.0, 0.0]), dice.size([-5.0, 2.0]));
            let body = Body {
                mass,
                inertia_b: box_inertia(mass, [reach; 3]),
                gravity_w: dice.vector(S::from_f64(10.0)),
                pins_w: [(); PINS].map(|()| dice.vector(reach)),
                gaps: [(); 4 * PINS].map(|()| dice.size([-6.0, -2.0])),
            };
            let spring = Power::new(dice.size([2.0, 11.0]), S::from_f64(2.5 + 1.5 * dice.roll::<f64>())).unwrap();
            let contact = Impact::new(spring, dice.size([-1.0, 4.0]), dice.size([-6.0, -3.0])).unwrap();
            let friction = Regularised::new(dice.size([-2.0, 0.5]), dice.size([-6.0, -2.0])).unwrap();
            let (gain, speed) = (dice.size([-1.0, 6.0]), dice.roll());
            let drive = Drive { gain, ramp_start: S::zero(), ramp_end: S::one(), speed, point_b: dice.vector(reach) };
            let slide = body.slide(contact, friction, drive).unwrap();

            let (far, fast) = (dice.size([-6.0, 0.0]), dice.size([-3.0, 4.0]));
            let Vector3 { data, .. } = dice.vector::<S>(fast);
            let [[x, y, z]] = data.0;
            let spin = dice.vector(fast / reach);
            let orientation = Orientation { w: S::one(), v: dice.vector(far) };
            let pose = Pose { displacement_w: dice.vector(far), orientation }.normalised();
            let velocity = SVector::from([x, y, z, spin.x, spin.y, spin.z]);
            let from = (&pose, &velocity, &NO_INTERNAL);
            let h = dice.size([-7.0, -1.0]);

            let (start, here) = Start::new(&slide, S::zero(), h, from, 0.5);
            let stage = start.stage(&here, None, 0.5);
            let euler = start.end(&stage.times(S::one()), &stage);
            let found = Rodas3::attempt(&slide, S::zero(), h, from, Some(S::one()), &mut [Part::zero(); 2]);
            let is_finite = |probe: S, change: &SVector<S, 6>| (probe + change.sum() * S::zero()).is_zero();
            if is_finite(slide.finiteness_probe(&euler.pose), &euler.change) {
                count += 1;
                assert!(is_finite(slide.finiteness_probe(&found.pose), &found.change), "{pose:?} {velocity:?} {h:?}");
                assert_eq!((found.pose, found.change), (euler.pose, euler.change));
            }
        }
        count
    }

    /// The later stages of a forced step start from where Euler's ended, so that they are bounded with it, and count 0 times.
    #[test]
    fn half_a_step_by_euler_is_finite_wherever_its_one_stage_is() {
        for count in [finite::<f32>(), finite::<f64>()] {
            assert!(count > 3900, "{count}");
        }
    }
}
