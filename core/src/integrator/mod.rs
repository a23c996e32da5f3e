//! Fixed-step schemes, one a file.
//!
//! Implicit schemes solve their stages with a fixed number of Newton passes and then look at what the last pass left.
//! Which one to take, by error against run time, is what `slipfit precision` shows.

mod extrapolated;
mod implicit_euler;
mod rodas3;
mod rodas4;
mod rosenbrock;
mod runge_kutta_4;
mod sdirk2;
mod semi_implicit_euler;

pub use extrapolated::Extrapolated;
pub use implicit_euler::ImplicitEuler;
pub use rodas3::Rodas3;
pub(crate) use rodas3::Sums;
pub use rodas4::Rodas4;
pub(crate) use rosenbrock::Part;
pub use runge_kutta_4::RungeKutta4;
pub use sdirk2::Sdirk2;
pub use semi_implicit_euler::SemiImplicitEuler;

use crate::{
    SVector, Scalar,
    mechanism::{Differentiated, Mechanism},
};

/// Where the bodies are, how fast they move, and the internal variables of their force laws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<S, P, R, const D: usize> {
    /// Pose.
    pub pose: P,
    /// Generalised velocities.
    pub velocity: SVector<S, D>,
    /// Accelerations (m/s², rad/s²) that the last step ended with as far as its scheme knows, zero before the first: what
    /// the next step's change of force is told from.
    pub acceleration: SVector<S, D>,
    /// Internal variables of the force laws.
    pub internal: R,
}

/// A motion of mechanism `M`.
pub type MotionOf<S, M, const D: usize> = Motion<S, <M as Mechanism<S, D>>::Pose, <M as Mechanism<S, D>>::Internal, D>;

/// What a step leads to, and how well.
#[derive(Clone, Copy, Debug)]
#[must_use = "the motion at the step's end is in it"]
pub struct Step<S, P, R, const D: usize> {
    /// The motion at the step's end.
    pub motion: Motion<S, P, R, D>,
    /// Imbalance of momentum (N·s) that the passes left in the worst stage; 0 for explicit schemes.
    pub residual: S,
    /// Estimate of the momentum's error (N·s) made in this step.
    pub error: S,
    /// Estimate of the error (N·s²) of the place made in this step, weighted with the masses as momentum is.
    pub drift: S,
}

/// A step of mechanism `M`.
pub type StepOf<S, M, const D: usize> = Step<S, <M as Mechanism<S, D>>::Pose, <M as Mechanism<S, D>>::Internal, D>;

/// A fixed-step scheme.
pub trait Integrator: Copy {
    /// Name in scene files and on the command line.
    const NAME: &'static str;

    /// Order of convergence on smooth motion.
    const ORDER: u32;

    /// Whether forces are solved for at the end of a step. Friction that sticks needs that: with another scheme it does not compile,
    /// neither by a kernel nor by the scheme's own functions.
    /// ```compile_fail
    /// use slipfit_core::{integrator::*, law::{Exact, Linear}, mechanism::Mechanism, slide::Slide};
    ///
    /// type Sticks = Slide<f64, Linear<f64>, Exact<f64>>;
    /// let step = <Rodas4 as Integrator>::step::<f64, Sticks, 6>;
    /// ```
    /// ```compile_fail
    /// # use slipfit_core::{integrator::*, law::{Exact, Linear}, mechanism::Mechanism, slide::Slide};
    /// # type Sticks = Slide<f64, Linear<f64>, Exact<f64>>;
    /// let step = <Rodas4 as Dense>::dense_step::<f64, Sticks, 6>;
    /// ```
    /// ```compile_fail
    /// # use slipfit_core::{integrator::*, law::{Exact, Linear}, mechanism::Mechanism, slide::Slide};
    /// # type Sticks = Slide<f64, Linear<f64>, Exact<f64>>;
    /// let step = <Rodas3 as Integrator>::step::<f64, Sticks, 6>;
    /// ```
    /// ```compile_fail
    /// # use slipfit_core::{integrator::*, law::{Exact, Linear}, mechanism::Mechanism, slide::Slide};
    /// # type Sticks = Slide<f64, Linear<f64>, Exact<f64>>;
    /// let step = <RungeKutta4 as Integrator>::step::<f64, Sticks, 6>;
    /// ```
    /// ```compile_fail
    /// # use slipfit_core::{integrator::*, law::{Exact, Linear}, mechanism::Mechanism, slide::Slide};
    /// # type Sticks = Slide<f64, Linear<f64>, Exact<f64>>;
    /// let step = <SemiImplicitEuler as Integrator>::step::<f64, Sticks, 6>;
    /// ```
    /// These do:
    /// ```
    /// # use slipfit_core::{integrator::*, law::{Exact, Linear, Regularised}, mechanism::Mechanism, slide::Slide};
    /// # type Sticks = Slide<f64, Linear<f64>, Exact<f64>>;
    /// type Slides = Slide<f64, Linear<f64>, Regularised<f64>>;
    /// let step = <ImplicitEuler<4> as Integrator>::step::<f64, Sticks, 6>;
    /// let step = <Rodas4 as Dense>::dense_step::<f64, Slides, 6>;
    /// let steps = [<Rodas3 as Integrator>::step::<f64, Slides, 6>, <SemiImplicitEuler as Integrator>::step::<f64, Slides, 6>];
    /// ```
    const IMPLICIT: bool;

    /// The motion a step `h` (s) after `motion`, which holds at time `t` (s).
    fn step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
    ) -> StepOf<S, M, D>;
}

/// Refuses, at compile time, mechanisms that stick: for schemes that are not [`Integrator::IMPLICIT`].
#[inline(always)]
fn refuse_sticking<S: Scalar, M: Mechanism<S, D>, const D: usize>() {
    const { assert!(!M::STICKS, "friction that sticks needs an implicit scheme") }
}

/// A scheme that is also known within its steps.
pub trait Dense: Integrator {
    /// [`Integrator::step`], with the accelerations (m/s², rad/s²) at its start and at its end. Velocities within the step are
    /// cubics with these slopes; on smooth motion their error falls with `h`⁴. The forces and derivatives at `motion` are given,
    /// so that a step that is refused and tried again with another length does not take them anew.
    ///
    /// They are no accelerations of the motion itself, which turn a velocity's last digits into large numbers where a contact is
    /// stiff: vibrations that the step damps are damped in them.
    fn dense_step<S: Scalar, M: Mechanism<S, D>, const D: usize>(
        mechanism: &M,
        t: S,
        h: S,
        motion: &MotionOf<S, M, D>,
        differentiated: &Differentiated<S, M::Jacobians, D>,
    ) -> (StepOf<S, M, D>, [SVector<S, D>; 2]);
}

/// An implicit stage, solved.
struct Stage<S, P, R, L, const D: usize> {
    motion: Motion<S, P, R, D>,
    /// Imbalance of momentum (N·s) that the passes left.
    residual: S,
    /// Iteration matrix of the last pass.
    iteration_matrix: L,
}

type StageOf<S, M, const D: usize> = Stage<
    S,
    <M as Mechanism<S, D>>::Pose,
    <M as Mechanism<S, D>>::Internal,
    <M as Mechanism<S, D>>::IterationMatrix,
    D,
>;

/// How much of friction's tangent a Newton pass takes; the rest is the secant.
///
/// The tangent is flat where the body slides, so that an iterate that comes from there overshoots the stick band into
/// sliding the other way, and passes are lost to and fro. The secant never overshoots but creeps. A second pass by the
/// secant ends such a cycle, and the tenth of the secant in the other passes keeps them from starting one.
#[inline(always)]
fn tangent_share<S: Scalar>(full_pass: usize) -> S {
    S::from_f64(if full_pass == 1 { 0.0 } else { 0.9 })
}

/// An iterate that leaves more than this times the least imbalance so far, or one that is not finite, is taken back, and
/// [`SHORTER`] of its update tried instead.
///
/// Full updates may run away where a stick band is narrow and contacts are stiff. 1 and 1.2 forbid passes that friction
/// needs on its way; 4 and 10 let some scenes of the stability map run away.
const WORSE: f64 = 2.0;

/// See [`WORSE`].
const SHORTER: f64 = 0.25;

/// For [`stage`]: no pass is a chord.
const NO_CHORD: usize = usize::MAX;

/// The motion Q = Q₀ + a·Q̇, V = V₀ + a·M⁻¹·force(t, Q, V) from `base` = (Q₀, V₀), after `PASSES` Newton passes that
/// start at the velocity `guess`. The pass `CHORD`, not the first, takes the iteration matrix of the one before.
#[inline(always)]
fn stage<S: Scalar, M: Mechanism<S, D>, const D: usize, const PASSES: usize, const CHORD: usize>(
    mechanism: &M,
    t: S,
    a: S,
    base: &MotionOf<S, M, D>,
    guess: SVector<S, D>,
) -> StageOf<S, M, D> {
    let (rate, zero) = (S::one() / a, S::zero());
    let mut velocity = guess;
    let (mut kept, mut update) = (base.velocity, SVector::zeros());
    let mut least = S::one() / zero;
    let (mut iteration_matrix, mut internal) = (M::IterationMatrix::default(), base.internal);
    let mut full_passes = 0;
    let mut pass = 0;
    // Kept from the compiler, which would repeat the body of a small mechanism for every pass.
    let passes = core::hint::black_box(PASSES);
    let (size, better) = loop {
        // So that parameters are read where they are used: before the loop they would all be copied to the stack. Those of a
        // body on one axis fit into registers.
        let (mechanism, base) = if D > 1 { core::hint::black_box((mechanism, base)) } else { (mechanism, base) };
        let pose = mechanism.implicit_update(&base.pose, &velocity, a);
        let force = if pass == CHORD || pass == passes {
            // Internal variables of an iterate that is only worse hold as well: the next step brings the friction force back into the
            // cone.
            mechanism.forces(t, &pose, &base.internal, &velocity, a, Some(&mut internal))
        } else {
            let share = tangent_share(full_passes);
            let at = mechanism.balance(t, &pose, &base.internal, &velocity, a, share);
            full_passes += 1;
            iteration_matrix = at.iteration_matrix;
            at.force
        };
        let change = velocity - base.velocity;
        let imbalance = mechanism.momentum(&pose, &change) * rate - force;
        let size = mechanism.impulse(&imbalance);
        if pass == passes {
            break (size, S::from_f64(WORSE) * least - size + size * zero);
        }
        let next = mechanism.solve(&iteration_matrix, &imbalance);
        let finiteness_probe = next.data.0[0].iter().fold(size, |sum, x| sum + *x) * zero;
        let better = S::from_f64(WORSE) * least - size + finiteness_probe;
        let shortened = better.select_gt(zero, S::one(), S::from_f64(SHORTER));
        // Weights, because a choice of vectors becomes a copy that takes longer for one than for the other.
        let taken = better.select_gt(zero, S::one(), zero);
        kept = velocity * taken + kept * (S::one() - taken);
        update = next.zip_map(&update, |new, old| better.select_gt(zero, new, old)) * shortened;
        least = better.select_gt(zero, least.select_gt(size, size, least), least);
        velocity = mechanism.settled(&(kept - update), a);
        pass += 1;
    };
    let velocity = velocity.zip_map(&kept, |new, old| better.select_gt(zero, new, old));
    let pose = mechanism.implicit_update(&base.pose, &velocity, a);
    let acceleration = (velocity - base.velocity) * rate;
    let residual = a * better.select_gt(zero, size, S::from_f64(WORSE) * least);
    Stage { motion: Motion { pose, velocity, acceleration, internal }, residual, iteration_matrix }
}

/// `base + weight·(to − from)`.
#[inline(always)]
fn shifted<S: Scalar, M: Mechanism<S, D>, const D: usize>(
    mechanism: &M,
    base: &MotionOf<S, M, D>,
    from: &MotionOf<S, M, D>,
    to: &MotionOf<S, M, D>,
    weight: S,
) -> MotionOf<S, M, D> {
    Motion {
        pose: mechanism.shifted(&base.pose, &from.pose, &to.pose, weight),
        velocity: base.velocity + (to.velocity - from.velocity) * weight,
        acceleration: base.acceleration + (to.acceleration - from.acceleration) * weight,
        internal: mechanism.internal_shifted(&base.internal, &from.internal, &to.internal, weight),
    }
}
