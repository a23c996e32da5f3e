//! A mechanism at the desk: bodies on joints, with elements chosen at run time.
//!
//! One type for each dimension; that they are settled here keeps their steps from being compiled by whoever moves them.

use std::ops::ControlFlow;

use slipfit_core::{
    SVector,
    integrator::{Integrator, Motion, Rodas4},
    kernel::{Kernel, State},
    mechanism::Mechanism,
    system::{
        Bodies, System, ThroughJoints,
        planar::PlanarTree,
        spatial::{FreeBodies, tree::SpatialTree},
    },
};

use crate::{
    element::{PlanarElement, SpatialElement},
    error_control::{Accelerations, Effort, Stopped, integrate},
    interrupt,
    out_of_line::OutOfLine,
    scheme::{IntegratorKind, IntegratorVisitor},
    side_by_side::SideBySide,
    wide::Wide,
};

/// Most bodies of a mechanism in space.
pub const MOST_BODIES: usize = 3;

/// Bodies in a plane with `D` coordinates.
pub type PlanarPlant<'a, const D: usize> = OutOfLine<System<PlanarTree<f64, D>, &'a [PlanarElement<D>]>, Wide>;

/// `N` bodies in space with `D` = 6·N coordinates, all of whose joints have play.
pub type FreePlant<'a, const N: usize, const D: usize> =
    OutOfLine<System<FreeBodies<f64, N, D>, &'a [SpatialElement]>, SideBySide<N, D>>;

/// Bodies in space on ideal joints.
pub type JointedBodies<const D: usize> = SpatialTree<f64, MOST_BODIES, { 6 * MOST_BODIES }, D>;

/// The same with what acts on them.
pub type JointedPlant<'a, const D: usize> =
    OutOfLine<System<JointedBodies<D>, ThroughJoints<&'a [SpatialElement], { 6 * MOST_BODIES }>>, Wide>;

/// Sees the time (s) and the motion at the start and at the end of every step, with the step's accelerations where they are known,
/// and says whether to go on.
pub type See<'a, P, const D: usize> =
    &'a mut dyn FnMut(f64, &Motion<f64, P, (), D>, Option<Accelerations<D>>) -> ControlFlow<()>;

/// The error that a step makes, of which 1 is allowed; given what the step reports (see [`Reported`]) and its length (s).
pub type Allowed<'a> = &'a dyn Fn(Reported, f64) -> f64;

/// What a step says about itself.
#[derive(Clone, Copy, Debug)]
pub struct Reported {
    /// Imbalance of momentum (N·s) that Newton's passes left.
    pub residual: f64,
    /// Estimate of the momentum's error (N·s).
    pub error: f64,
    /// Estimate of the error of place (N·s²), weighted with the masses.
    pub drift: f64,
}

/// A mechanism with `D` coordinates.
pub trait Plant<const D: usize> {
    /// Where its bodies are.
    type Pose: Copy;

    /// The least mass (kg) that moves.
    fn least_mass(&self) -> f64;

    /// Moves it from `start` over `duration` (s) by error-controlled steps.
    ///
    /// # Errors
    /// See [`Stopped`].
    fn by_desk(
        &self,
        start: (Self::Pose, SVector<f64, D>),
        duration: f64,
        error: Allowed,
        see: See<Self::Pose, D>,
    ) -> Result<Effort, Stopped>;

    /// Moves it by steps of the length `step` (s). Of the schemes only implicit ones are known; implicit Euler is used in place of
    /// the others.
    ///
    /// # Errors
    /// See [`Stopped`].
    fn by_controller(
        self,
        start: (Self::Pose, SVector<f64, D>),
        duration: f64,
        scheme: (IntegratorKind, f64),
        see: See<Self::Pose, D>,
    ) -> Result<Effort, Stopped>;
}

/// At the start of a run.
fn motion<P, const D: usize>((pose, velocity): (P, SVector<f64, D>)) -> Motion<f64, P, (), D> {
    Motion { pose, velocity, acceleration: SVector::zeros(), internal: () }
}

macro_rules! plants {
    ($($plant:ty, $dimension:literal;)*) => { $(
        impl Plant<$dimension> for $plant {
            type Pose = <Self as Mechanism<f64, $dimension>>::Pose;

            fn least_mass(&self) -> f64 {
                self.mechanism().bodies().least_mass()
            }

            fn by_desk(
                &self,
                start: (Self::Pose, SVector<f64, $dimension>),
                duration: f64,
                error: Allowed,
                see: See<Self::Pose, $dimension>,
            ) -> Result<Effort, Stopped> {
                integrate::<Rodas4, Self, $dimension>(
                    self,
                    motion(start),
                    duration,
                    |step, length| {
                        let reported = Reported { residual: step.residual, error: step.error, drift: step.drift };
                        error(reported, length)
                    },
                    see,
                )
            }

            fn by_controller(
                self,
                start: (Self::Pose, SVector<f64, $dimension>),
                duration: f64,
                (scheme, step): (IntegratorKind, f64),
                see: See<Self::Pose, $dimension>,
            ) -> Result<Effort, Stopped> {
                scheme.visit_implicit(FixedSteps { plant: self, start: motion(start), duration, step, see })
            }
        }
    )* };
}

plants! {
    PlanarPlant<'_, 1>, 1;
    PlanarPlant<'_, 2>, 2;
    PlanarPlant<'_, 3>, 3;
    PlanarPlant<'_, 4>, 4;
    PlanarPlant<'_, 5>, 5;
    PlanarPlant<'_, 6>, 6;
    FreePlant<'_, 1, 6>, 6;
    FreePlant<'_, 2, 12>, 12;
    FreePlant<'_, 3, 18>, 18;
    JointedPlant<'_, 8>, 8;
    JointedPlant<'_, 14>, 14;
}

/// Steps of one length.
struct FixedSteps<'a, M, P, const D: usize> {
    plant: M,
    start: Motion<f64, P, (), D>,
    duration: f64,
    step: f64,
    see: See<'a, P, D>,
}

impl<M, const D: usize> IntegratorVisitor for FixedSteps<'_, M, M::Pose, D>
where
    M: Mechanism<f64, D, Internal = ()>,
{
    type Output = Result<Effort, Stopped>;

    fn visit<I: Integrator>(self) -> Self::Output {
        let Self { plant, start, duration, step, see } = self;
        let kernel = Kernel::<f64, M, I>::new(plant, step)?;
        let mut state = State { steps: 0, motion: start };
        let _ = see(0.0, &state.motion, None);
        let mut accepted = 0;
        while kernel.time(state.steps) < duration * (1.0 - 1e-12) {
            let report = kernel.step(&mut state);
            let time = kernel.time(state.steps);
            if !report.residual.is_finite() {
                return Err(Stopped::NotFinite { time, step });
            }
            if interrupt::requested() {
                return Err(Stopped::Interrupted);
            }
            accepted += 1;
            if see(time, &state.motion, None).is_break() {
                break;
            }
        }
        Ok(Effort { accepted, refused: 0 })
    }
}
