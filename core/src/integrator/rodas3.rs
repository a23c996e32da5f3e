//! RODAS3 (Sandu et al., Atmospheric Environment 31, 1997): third order, one set of derivatives and two more forces a step.

use super::{
    Integrator, MotionOf, StepOf,
    rosenbrock::{StageOf, Tableau, step},
};
use crate::{Scalar, mechanism::Mechanism};

/// Third order, linearly implicit, L-stable.
#[derive(Clone, Copy, Debug)]
pub struct Rodas3;

impl Tableau for Rodas3 {
    const GAMMA: f64 = 0.5;

    const STAGES: &'static [StageOf] = &[
        StageOf { force_at: None, time: 0.0, time_rate: 0.5, coupling: &[] },
        StageOf { force_at: None, time: 0.0, time_rate: 1.5, coupling: &[4.0] },
        StageOf { force_at: Some(&[2.0, 0.0]), time: 1.0, time_rate: 0.0, coupling: &[1.0, -1.0] },
        StageOf { force_at: Some(&[2.0, 0.0, 1.0]), time: 1.0, time_rate: 0.0, coupling: &[1.0, -1.0, -8.0 / 3.0] },
    ];

    const RESULT: &'static [f64] = &[2.0, 0.0, 1.0, 1.0];
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
        step::<Self, S, M, D>(mechanism, t, h, motion)
    }
}
