//! A mechanism at the desk: bodies on joints, with elements chosen at run time.
//!
//! One type for each dimension; that they are settled here keeps their steps from being compiled by whoever moves them.

use std::ops::ControlFlow;

use slipfit_core::{
    SVector,
    integrator::{Integrator, Motion, MotionOf, Rodas4},
    kernel::{Kernel, State},
    mechanism::Mechanism,
    pose::Pose,
    system::{
        Bodies, Reduced, System, ThroughJoints,
        planar::PlanarTree,
        spatial::{FreeBodies, tree::SpatialTree},
    },
};
use slipfit_system::interrupt;

use crate::{
    closing::Gaps,
    element::{AngularSpeeds as _, HasContacts as _, PlanarElement, SpatialElement},
    error_control::{Accelerations, Effort, Stopped, Watched, integrate},
    out_of_line::OutOfLine,
    scheme::{IntegratorKind, IntegratorVisitor},
    side_by_side::SideBySide,
};

/// Most bodies of a mechanism in space.
pub const MOST_BODIES: usize = 3;

/// Bodies in a plane with `D` coordinates.
pub type PlanarPlant<'a, const D: usize> = OutOfLine<System<PlanarTree<f64, D>, &'a [PlanarElement<D>]>>;

/// `N` bodies in space with `D` = 6·N coordinates, all of whose joints have play.
pub type FreePlant<'a, const N: usize, const D: usize> =
    OutOfLine<System<FreeBodies<f64, N, D>, &'a [SpatialElement]>, SideBySide<N, D>>;

/// Bodies in space on ideal joints.
pub type JointedBodies<const D: usize> = SpatialTree<f64, MOST_BODIES, { 6 * MOST_BODIES }, D>;

/// The same with what acts on them.
pub type JointedPlant<'a, const D: usize> =
    OutOfLine<System<JointedBodies<D>, ThroughJoints<&'a [SpatialElement], { 6 * MOST_BODIES }>>>;

/// Sees the time (s) and the motion at the start and at the end of every step, with the step's accelerations and the least gap (m) of a
/// contact there where they are known, and says whether to go on.
pub type See<'a, P, const D: usize> =
    &'a mut dyn FnMut(f64, &Motion<f64, P, (), D>, Option<Accelerations<D>>, Option<f64>) -> ControlFlow<()>;

/// What a step may err by.
#[derive(Clone, Copy)]
pub struct Allowed<'a> {
    /// The error that a step makes, of which 1 is allowed; given what the step reports and its length (s).
    pub error: &'a dyn Fn(Reported, f64) -> f64,
    /// How deep (m) a contact may be that a step passes over.
    pub depth: f64,
    /// Ascending times (s) at which what is commanded bends: no step passes over one.
    pub bends: &'a [f64],
}

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
        allowed: Allowed,
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

/// At the start of a run of `plant`.
fn motion<M: Mechanism<f64, D>, const D: usize>(
    plant: &M,
    (pose, velocity): (M::Pose, SVector<f64, D>),
) -> MotionOf<f64, M, D> {
    Motion { pose, velocity, acceleration: SVector::zeros(), internal: plant.fresh() }
}

/// A motion without what laws remember.
fn visible<P: Copy, R, const D: usize>(motion: &Motion<f64, P, R, D>) -> Motion<f64, P, (), D> {
    let Motion { pose, velocity, acceleration, .. } = *motion;
    Motion { pose, velocity, acceleration, internal: () }
}

/// What [`integrate`] has to know of contacts.
trait Watch<P, const D: usize> {
    /// Fills in the contacts at a `pose` and a `velocity`.
    fn watch(&self, pose: &P, velocity: &SVector<f64, D>, gaps: &mut Gaps);
}

impl<const D: usize> Watch<[[f64; 2]; D], D> for PlanarPlant<'_, D> {
    fn watch(&self, pose: &[[f64; 2]; D], velocity: &SVector<f64, D>, gaps: &mut Gaps) {
        let bodies = self.mechanism().bodies();
        let placed = bodies.placed(pose, velocity);
        gaps.clear(bodies.max_angular_speed(&placed));
        let mut add = |contact| gaps.add(contact);
        self.mechanism().elements().iter().for_each(|one| one.approach((bodies, &placed), &mut add));
    }
}

impl<const N: usize, const D: usize> Watch<[Pose<f64>; N], D> for FreePlant<'_, N, D> {
    fn watch(&self, pose: &[Pose<f64>; N], velocity: &SVector<f64, D>, gaps: &mut Gaps) {
        self.contacts().watch(self.mechanism(), pose, velocity, gaps);
    }
}

impl<const D: usize> Watch<[[f64; 2]; D], D> for JointedPlant<'_, D> {
    fn watch(&self, pose: &[[f64; 2]; D], velocity: &SVector<f64, D>, gaps: &mut Gaps) {
        let bodies = self.mechanism().bodies();
        let placed = bodies.placed(pose, velocity);
        let (free, placed) = bodies.free(&placed);
        gaps.clear(free.max_angular_speed(placed));
        let mut add = |contact| gaps.add(contact);
        self.mechanism().elements().0.iter().for_each(|one| one.approach((free, placed), &mut add));
    }
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
                allowed: Allowed,
                see: See<Self::Pose, $dimension>,
            ) -> Result<Effort, Stopped> {
                integrate::<Rodas4, Self, $dimension>(
                    self,
                    motion(self, start),
                    duration,
                    |step, length| {
                        let reported = Reported { residual: step.residual, error: step.error, drift: step.drift };
                        (allowed.error)(reported, length)
                    },
                    Watched {
                        gaps: |motion: &MotionOf<f64, Self, $dimension>, gaps: &mut Gaps| {
                            self.watch(&motion.pose, &motion.velocity, gaps);
                        },
                        depth: allowed.depth,
                        bends: allowed.bends,
                    },
                    |t, motion, accelerations, gaps| see(t, &visible(motion), accelerations, Some(gaps.least())),
                )
            }

            fn by_controller(
                self,
                start: (Self::Pose, SVector<f64, $dimension>),
                duration: f64,
                (scheme, step): (IntegratorKind, f64),
                see: See<Self::Pose, $dimension>,
            ) -> Result<Effort, Stopped> {
                let start = motion(&self, start);
                scheme.visit_implicit(FixedSteps { plant: self, start, duration, step, see })
            }
        }
    )* };
}

plants! {
    PlanarPlant<'_, 3>, 3;
    PlanarPlant<'_, 6>, 6;
    FreePlant<'_, 1, 6>, 6;
    FreePlant<'_, 2, 12>, 12;
    FreePlant<'_, 3, 18>, 18;
    JointedPlant<'_, 8>, 8;
    JointedPlant<'_, 14>, 14;
}

/// Steps of one length.
struct FixedSteps<'a, M: Mechanism<f64, D>, const D: usize> {
    plant: M,
    start: MotionOf<f64, M, D>,
    duration: f64,
    step: f64,
    see: See<'a, M::Pose, D>,
}

impl<M: Mechanism<f64, D>, const D: usize> IntegratorVisitor for FixedSteps<'_, M, D> {
    type Output = Result<Effort, Stopped>;

    fn visit<I: Integrator>(self) -> Self::Output {
        let Self { plant, start, duration, step, see } = self;
        let kernel = Kernel::<f64, M, I>::new(plant, step)?;
        let mut state = State { steps: 0, motion: start };
        let _ = see(0.0, &visible(&state.motion), None, None);
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
            if see(time, &visible(&state.motion), None, None).is_break() {
                break;
            }
        }
        Ok(Effort { accepted, refused: 0 })
    }
}
