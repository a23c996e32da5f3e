//! RODAS (Hairer and Wanner, *Solving Ordinary Differential Equations II*, table IV.7): fourth order, one set of
//! derivatives and five more forces a step.
//!
//! A step takes half again as long as RODAS3's. To an error of 0.1 % of the drive force both need the same time; below,
//! the higher order wins, and twice as much at 0.001 %.

use super::{
    Integrator, MotionOf, StepOf,
    rosenbrock::{StageOf, Tableau, step},
};
use crate::{Scalar, mechanism::Mechanism};

/// Fourth order, linearly implicit, L-stable.
#[derive(Clone, Copy, Debug)]
pub struct Rodas4;

/// What the last two stages and the result share.
const LAST: [f64; 4] = [1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950];

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
            coupling: &[7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160],
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
        step::<Self, S, M, D>(mechanism, t, h, motion)
    }
}
