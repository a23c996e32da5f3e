//! Fixed-step schemes, one a file. Each solves its implicit stages with a fixed number of Newton passes.

mod implicit_euler;
mod sdirk2;

pub use implicit_euler::ImplicitEuler;
pub use sdirk2::Sdirk2;

use crate::{SVector, Scalar, mechanism::Mechanism};

/// Where the bodies are and how fast they move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<S, P, const D: usize> {
    /// Pose.
    pub pose: P,
    /// Generalised velocities.
    pub velocity: SVector<S, D>,
}

/// A fixed-step scheme.
pub trait Integrator: Copy {
    /// Name on the command line.
    const NAME: &'static str;

    /// The motion a step `h` (s) after `motion`, which holds at time `t` (s), and the residual (N·s): the imbalance of
    /// momentum that the last Newton pass of any stage found, before it corrected it.
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &Motion<S, M::Pose, D>,
    ) -> (Motion<S, M::Pose, D>, S);
}

/// One implicit stage: the motion Q = Q₀ + a·Q̇, V = V₀ + a·M⁻¹·force(t, Q, V) from `base` = (Q₀, V₀), after `PASSES`
/// Newton passes that start at `guess`, and the residual (N·s).
#[inline(always)]
fn stage<S: Scalar, M: Mechanism<S, D>, const D: usize, const PASSES: usize>(
    mechanism: &M,
    t: S,
    a: S,
    base: &Motion<S, M::Pose, D>,
    guess: SVector<S, D>,
) -> (Motion<S, M::Pose, D>, S) {
    let mut velocity = guess;
    let mut residual = S::zero();
    for _ in 0..PASSES {
        let pose = mechanism.advanced(&base.pose, &velocity, a);
        let (force, linearisation) = mechanism.linearised(t, &pose, &velocity, a);
        let imbalance = mechanism.momentum(&(velocity - base.velocity)) - force * a;
        residual = mechanism.impulse(&imbalance);
        velocity -= mechanism.solve(&linearisation, &imbalance);
    }
    (Motion { pose: mechanism.advanced(&base.pose, &velocity, a), velocity }, residual)
}
