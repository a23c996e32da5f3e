//! RODAS (Hairer and Wanner, *Solving Ordinary Differential Equations II*, table IV.7; between the ends of a step as in the
//! authors' program of that name): fourth order, one set of derivatives and five more forces a step.
//!
//! A step takes some 1.6 times as long as one of RODAS3, and fewer are needed the tighter the tolerance is.

use super::{
    Dense, Integrator, MotionOf, StepOf,
    rosenbrock::{StageOf, Tableau, step},
};
use crate::{
    SVector, Scalar,
    mechanism::{Differentiated, Mechanism},
};

/// Fourth order, linearly implicit, L-stable.
#[derive(Clone, Copy, Debug)]
pub struct Rodas4;

/// What the last two stages and the result share.
const LAST: [f64; 4] = [1.221224509226641, 6.019134481288629, 12.53708332932087, -0.687886036105895];

impl Tableau for Rodas4 {
    const GAMMA: f64 = 0.25;

    const STAGES: &'static [StageOf] = &[
        StageOf { force_at: None, time: 0.0, time_rate: 0.25, coupling: &[] },
        StageOf { force_at: Some(&[1.544]), time: 0.386, time_rate: -0.1043, coupling: &[-5.6688] },
        StageOf {
            force_at: Some(&[0.9466785280815826, 0.2557011698983284]),
            time: 0.21,
            time_rate: 0.1035,
            coupling: &[-2.430093356833875, -0.2063599157091915],
        },
        StageOf {
            force_at: Some(&[3.314825187068521, 2.896124015972201, 0.9986419139977817]),
            time: 0.63,
            time_rate: -0.036_200_000_000_000_23,
            coupling: &[-0.1073529058151375, -9.594562251023355, -20.47028614809616],
        },
        StageOf {
            force_at: Some(&LAST),
            time: 1.0,
            time_rate: 0.0,
            coupling: &[7.496443313967647, -10.24680431464352, -33.99990352819905, 11.7089089320616],
        },
        StageOf {
            force_at: Some(&[LAST[0], LAST[1], LAST[2], LAST[3], 1.0]),
            time: 1.0,
            time_rate: 0.0,
            coupling: &[
                8.083246795921522,
                -7.981132988064893,
                -31.52159432874371,
                16.31930543123136,
                -6.058818238834054,
            ],
        },
    ];

    const RESULT: &'static [f64] = &[LAST[0], LAST[1], LAST[2], LAST[3], 1.0, 1.0];

    const BENDS: [&'static [f64]; 2] = [
        &[10.12623508344586, -7.487995877610167, -34.80091861555747, -7.992771707568823, 1.025137723295662],
        &[-0.6762803392801253, 6.087714651680015, 16.43084320892478, 24.76722511418386, -6.594389125716872],
    ];
}

impl Integrator for Rodas4 {
    const NAME: &'static str = "rodas4";
    const ORDER: u32 = 4;
    const IMPLICIT: bool = false;

    #[inline(always)]
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
    ) -> StepOf<S, M, D> {
        let differentiated = mechanism.differentiated(t, &motion.pose, &motion.internal, &motion.velocity);
        step::<Self, S, M, D>(mechanism, [t, h], motion, differentiated).0
    }
}

impl Dense for Rodas4 {
    #[inline(always)]
    fn dense_step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
        differentiated: &Differentiated<S, M::Jacobians, D>,
    ) -> (StepOf<S, M, D>, [SVector<S, D>; 2]) {
        step::<Self, S, M, D>(mechanism, [t, h], motion, *differentiated)
    }
}

#[cfg(test)]
mod tests {
    use super::Rodas4;
    use crate::{
        integrator::{Dense, Integrator, Rodas3},
        kernel::Kernel,
        law::{Impact, Linear, Slot},
        mechanism::Mechanism as _,
        system::on_axis,
    };

    /// How far from the closed form a mass between two springs is that falls from their middle, after 0.1 s in steps of `h` (s).
    fn error<I: Integrator>(h: f64) -> f64 {
        let (mass, stiffness) = (0.1, 100.0);
        let law = Impact::new(Linear::new(stiffness / 2.0).unwrap(), 0.0, 1.0).unwrap();
        let held = Slot::new(-1.0, -1.0).unwrap();
        let body = on_axis(mass, -9.81, held, law, ()).unwrap();
        let kernel = Kernel::<f64, _, I>::new(body, h).unwrap();
        let mut state = kernel.at_rest(0.0);
        while state.steps < (0.1 / h + 0.5) as u32 {
            let _ = kernel.step(&mut state);
        }
        let swing = -9.81 * mass / stiffness;
        libm::fabs(state.motion.pose - swing * (1.0 - libm::cos(0.1 * libm::sqrt(stiffness / mass))))
    }

    /// How far the velocity in the middle of one step `h` (s) is from that of the same body in closed form.
    fn error_within(h: f64) -> f64 {
        let (mass, stiffness) = (0.1, 100.0);
        let law = Impact::new(Linear::new(stiffness / 2.0).unwrap(), 0.0, 1.0).unwrap();
        let held = Slot::new(-1.0, -1.0).unwrap();
        let body = on_axis(mass, -9.81, held, law, ()).unwrap();
        let rest = Kernel::<f64, _, Rodas4>::new(body, h).unwrap().at_rest(0.0).motion;
        let differentiated = body.differentiated(0.0, &rest.pose, &rest.internal, &rest.velocity);
        let (step, [from, to]) = Rodas4::dense_step(&body, 0.0, h, &rest, &differentiated);
        // The cubic with these slopes, in its middle.
        let middle = 0.5 * step.motion.velocity[0] + 0.125 * h * (from[0] - to[0]);
        let frequency = libm::sqrt(stiffness / mass);
        libm::fabs(middle + 9.81 / frequency * libm::sin(frequency * 0.5 * h))
    }

    #[test]
    fn within_a_step_the_error_falls_with_the_fourth_power() {
        let order = libm::log2(error_within(2e-3) / error_within(1e-3));
        assert!((3.8..5.2).contains(&order), "{order}");
    }

    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
    fn errors_fall_with_the_order() {
        let order = |coarse: f64, fine: f64| libm::log2(coarse / fine);
        let four = order(error::<Rodas4>(5e-4), error::<Rodas4>(2.5e-4));
        let three = order(error::<Rodas3>(2e-3), error::<Rodas3>(1e-3));
        assert!((3.8..4.3).contains(&four) && (2.8..3.3).contains(&three), "{four} {three}");
        assert!(error::<Rodas4>(1e-3) < 1e-8);
    }
}
