//! The slide as a controller computes it: steps of one length, by any scheme and in either number type.

use std::ops::ControlFlow;

use slipfit_core::{
    Scalar, Vector3,
    integrator::Integrator,
    kernel::{Kernel, Report as StepReport, StateOf},
    law::{Elastic, Friction},
    mechanism::Mechanism,
    menu::SlideData,
    pose::Pose,
    slide::{CONTACTS, Energy, Power, Slide},
};
use slipfit_system::interrupt;

use crate::{
    error_control::Stopped,
    laws::{AnySlide, SlidingSlide, StickingSlide},
    out_of_line::OutOfLine,
    scheme::{IntegratorKind, IntegratorVisitor, ScalarKind},
};

/// A speed (m/s) that no slide has: numbers grow without end from there on.
const RUNAWAY: f64 = 1e4;

/// Steps between two looks at whether somebody asked to stop.
const STEPS_PER_LOOK: u32 = 1024;

/// How a controller computes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// Scheme.
    pub integrator: IntegratorKind,
    /// Number type.
    pub scalar: ScalarKind,
    /// Length of a step (s).
    pub step: f64,
}

/// The slide at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct At {
    /// Steps until now.
    pub steps: u32,
    /// Velocity along the frame's z (m/s).
    pub vz: f64,
    /// Drive force along the frame's z (N).
    pub force: f64,
    /// Displacement of the centre of mass in the frame (m).
    pub displacement_w: Vector3<f64>,
    /// Gaps of the contacts (m).
    pub gaps: [f64; CONTACTS],
    /// Its energy and powers, if the witness [accounts](Witness::accounts) for them.
    pub energy: Option<(Energy<f64>, Power<f64>)>,
}

/// What a step says about itself.
#[derive(Clone, Copy, Debug)]
pub struct Report {
    /// Imbalance of momentum (N·s) that Newton's passes left.
    pub residual: f64,
    /// Estimate of the momentum's error (N·s).
    pub error: f64,
    /// Momentum that the step led to (N·s), angular components over a length of the slide.
    pub momentum: f64,
}

/// Sees a run.
pub trait Witness {
    /// Whether it wants energy and powers.
    fn accounts(&self) -> bool;

    /// Sees the slide at the start of a step and says whether to go on.
    fn at(&mut self, at: &At) -> ControlFlow<()>;

    /// Sees what the step says that began there.
    fn stepped(&mut self, from: &At, report: Report);
}

/// Moves the slide that `data` describes from rest in its nominal pose by the steps of a `controller`, until the `witness` breaks.
///
/// # Errors
/// See [`Stopped`].
pub fn by_controller(data: &SlideData<f64>, controller: Controller, witness: &mut dyn Witness) -> Result<(), Stopped> {
    let run = Run { controller, witness };
    match controller.scalar {
        ScalarKind::F32 => run.of_any(AnySlide::<f32>::new(&data.cast(|x| x as f32))?),
        ScalarKind::F64 => run.of_any(AnySlide::<f64>::new(data)?),
    }
}

/// A run whose slide's type is to be known.
struct Run<'a> {
    controller: Controller,
    witness: &'a mut dyn Witness,
}

impl Run<'_> {
    fn of_any<S: Scalar + PartialOrd + std::fmt::Display>(self, slide: AnySlide<S>) -> Result<(), Stopped> {
        let integrator = self.controller.integrator;
        match slide {
            AnySlide::Sliding(SlidingSlide::Usual(slide)) => integrator.visit(Started { run: self, slide }),
            AnySlide::Sliding(SlidingSlide::Chosen(slide)) => integrator.visit(Started { run: self, slide }),
            AnySlide::Sticking(StickingSlide::Usual(slide)) => integrator.visit_implicit(Started { run: self, slide }),
            AnySlide::Sticking(StickingSlide::Chosen(slide)) => integrator.visit_implicit(Started { run: self, slide }),
        }
    }
}

/// One step, in a function of its own: compiled once for each type, not into every loop around it.
#[inline(never)]
fn step_of<S: Scalar + PartialOrd, M: Mechanism<S, 6>, I: Integrator>(
    kernel: &Kernel<S, M, I>,
    state: &mut StateOf<S, M, 6>,
) -> StepReport<S> {
    kernel.step(state)
}

/// A run whose slide's type is known.
struct Started<'a, S, E, F> {
    run: Run<'a>,
    slide: Slide<S, E, F>,
}

impl<S, E, F> IntegratorVisitor for Started<'_, S, E, F>
where
    S: Scalar + PartialOrd + std::fmt::Display,
    E: Elastic<S>,
    F: Friction<S>,
{
    type Output = Result<(), Stopped>;

    fn visit<I: Integrator>(self) -> Self::Output {
        let Self { run: Run { controller, witness }, slide } = self;
        let step = controller.step;
        let kernel = Kernel::<S, _, I>::new(OutOfLine::new(slide), S::from_f64(step))?;
        let mut state = kernel.at_rest(Pose::nominal());
        loop {
            let (slide, motion) = (kernel.mechanism().mechanism(), &state.motion);
            let (vz, time) = (motion.velocity.z, kernel.time(state.steps));
            let energy = witness.accounts().then(|| {
                let (Energy { kinetic, gravity, elastic }, power) = (slide.energy(motion), slide.power(time, motion));
                let [kinetic, gravity, elastic] = [kinetic, gravity, elastic].map(S::to_f64);
                let [drive, damping, friction] = [power.drive, power.damping, power.friction].map(S::to_f64);
                (Energy { kinetic, gravity, elastic }, Power { drive, damping, friction })
            });
            let at = At {
                steps: state.steps,
                vz: vz.to_f64(),
                force: slide.drive().force(time, vz).to_f64(),
                displacement_w: motion.pose.displacement_w.map(S::to_f64),
                gaps: slide.gaps(&motion.pose).map(S::to_f64),
                energy,
            };
            if witness.at(&at).is_break() {
                return Ok(());
            }
            if state.steps.is_multiple_of(STEPS_PER_LOOK) && interrupt::requested() {
                return Err(Stopped::Interrupted);
            }
            let report = step_of(&kernel, &mut state);
            let residual = report.residual.to_f64();
            if !residual.is_finite() || state.motion.velocity.z.to_f64().abs() > RUNAWAY {
                return Err(Stopped::NotFinite { time: f64::from(at.steps) * step, step });
            }
            let momentum = kernel.mechanism().weighed(&state.motion.pose, &state.motion.velocity).to_f64();
            witness.stepped(&at, Report { residual, error: report.error.to_f64(), momentum });
        }
    }
}
