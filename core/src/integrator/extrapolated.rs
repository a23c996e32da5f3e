//! Extrapolated implicit Euler: order by order from steps cut into 1, 2, 3, … parts (Deuflhard 1985).
//!
//! Every part is a whole implicit Euler step, so that the scheme keeps its forgiveness of stiffness and friction; the
//! extrapolation takes out the errors of first, second, … order. The last two columns differ by the error of the one
//! before, which is an error estimate without further work. With one Newton pass a part this is the extrapolated linearly
//! implicit Euler scheme.

use super::{Integrator, Motion, MotionOf, NO_CHORD, Step, StepOf, shifted, stage};
use crate::{Scalar, mechanism::Mechanism};

/// `COLUMNS` columns (at least 2), `PASSES` Newton passes a part.
#[derive(Clone, Copy, Debug)]
pub struct Extrapolated<const COLUMNS: usize, const PASSES: usize>;

impl<const COLUMNS: usize, const PASSES: usize> Integrator for Extrapolated<COLUMNS, PASSES> {
    const NAME: &'static str = "extrapolated";
    const ORDER: u32 = COLUMNS as u32;
    const IMPLICIT: bool = true;

    #[inline(always)]
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
    ) -> StepOf<S, M, D> {
        // The last row so far of the tableau of Aitken and Neville, first column first.
        let mut row = [*motion; COLUMNS];
        let mut residual = S::zero();
        let mut error = S::zero();
        for parts in 1..=COLUMNS as u32 {
            let a = h / S::from_count(parts);
            let mut end = *motion;
            for part in 1..=parts {
                let at =
                    stage::<S, M, D, PASSES, NO_CHORD>(mechanism, t + a * S::from_count(part), a, &end, end.velocity);
                end = at.motion;
                residual = at.residual.max_of(residual);
            }
            for (column, above) in (1..parts).zip(row.iter_mut()) {
                // Rows of parts n and n − k cancel the k-th error term with the weight 1/(n/(n − k) − 1) = (n − k)/k.
                let weight = S::from_count(parts - column) / S::from_count(column);
                let better = shifted(mechanism, &end, above, &end, weight);
                error = mechanism.weighed(&better.pose, &(better.velocity - end.velocity));
                *above = end;
                end = better;
            }
            if let Some(last) = row.get_mut(parts as usize - 1) {
                *last = end;
            }
        }
        let end = row[COLUMNS - 1];
        let pose = mechanism.normalised(&end.pose);
        Step { motion: Motion { pose, ..end }, residual, error, drift: error * h }
    }
}
