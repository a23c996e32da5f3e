//! The predictor: a unit's kernel and its state.

use slipfit_core::{
    drive::{Commandable, checked_command},
    integrator::ImplicitEuler,
    kernel::{Kernel, Report, StateOf},
    menu::FrictionData,
    pose::Pose,
};

use crate::{
    border::{Storage, input, make, object, object_mut, output},
    scene::{SLIPFIT_SCHEME_IMPLICIT_EULER, Unit, slipfit_scene},
    status::{Refusal, SLIPFIT_LAW, SLIPFIT_NOT_FINITE, SLIPFIT_STEP, slipfit_status, status},
};

#[cfg(feature = "exact")]
type Friction = slipfit_core::law::Exact<f32>;
#[cfg(not(feature = "exact"))]
type Friction = slipfit_core::law::Regularised<f32>;

/// Memory of a predictor; opaque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_predictor {
    words: [u64; 128],
}

/// What a predictor says after a step.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_prediction {
    /// Time (s).
    pub time: f32,
    /// Force of the drive (N).
    pub force: f32,
    /// Velocity along the drive (m/s).
    pub velocity: f32,
    /// How far the slide is along the drive (m), from where it was at rest.
    pub position: f32,
    /// Imbalance of momentum (N·s) that the step left; infinite if it was not finite.
    pub residual: f32,
}

#[derive(Clone, Copy)]
pub(crate) struct Predictor {
    pub(crate) kernel: Kernel<f32, Unit<Friction>, ImplicitEuler<4>>,
    pub(crate) state: StateOf<f32, Unit<Friction>, 6>,
    report: Report<f32>,
    /// Force of the drive (N) at the end of the last step: another command counts from the next one on.
    pub(crate) force: f32,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_predictor {
    type Object = Predictor;
    const MARK: u32 = 0x534c_5031;
}

fn friction(data: FrictionData<f32>) -> Result<Friction, Refusal> {
    match data {
        #[cfg(feature = "exact")]
        FrictionData::Exact { coefficient } => Ok(Friction::new(coefficient)?),
        #[cfg(not(feature = "exact"))]
        FrictionData::Regularised { coefficient, stick_band } => Ok(Friction::new(coefficient, stick_band)?),
        _ => Err(Refusal(SLIPFIT_LAW)),
    }
}

/// Steps over which a predictor is tried before it is made: as long as the release of stored compression takes in steps of 1 ms.
const TRIAL: u32 = 50;

/// The greatest step (s) that is compared with half of it alone. Greater ones may agree with each other because either misses all of
/// the release, so that their halves are tried too, down to this.
const TRIAL_STEP: f32 = 1e-3;

/// By how much of the greatest force half the step may change the drive's force in the trial.
const TRIAL_ERROR: f32 = 0.1;

/// What a predictor says of steps before the first.
const NO_STEP: Report<f32> = Report { residual: 0.0, error: 0.0 };

impl Predictor {
    fn new(slide: Unit<Friction>, step: f32) -> Result<Self, Refusal> {
        let kernel = Kernel::new(slide, step)?;
        let mut made = Self { state: kernel.at_rest(Pose::nominal()), kernel, report: NO_STEP, force: 0.0 };
        made.force = made.force();
        Ok(made)
    }

    /// One step; whether the motion could be moved. One copy in the code serves the trial too.
    #[inline(never)]
    pub(crate) fn advance(&mut self) -> bool {
        self.report = self.kernel.step(&mut self.state);
        self.force = self.force();
        self.report.residual.is_finite()
    }

    /// Force of the drive (N) now.
    pub(crate) fn force(&self) -> f32 {
        self.kernel.mechanism().drive().force(self.kernel.time(self.state.steps), self.state.motion.velocity.z)
    }

    /// Whether the step follows the first instants, in which a tight unit lets go of what it is compressed by: as well as half
    /// the step.
    fn holds(mut self, mut fine: Self, greatest: f32) -> bool {
        (0..TRIAL).all(|_| {
            let moved = self.advance() & fine.advance() & fine.advance();
            moved && (self.force - fine.force).abs() <= TRIAL_ERROR * greatest
        })
    }
}

fn predictor(scene: &slipfit_scene, n: f32) -> Result<Predictor, Refusal> {
    if scene.scheme != SLIPFIT_SCHEME_IMPLICIT_EULER {
        return Err(Refusal(SLIPFIT_LAW));
    }
    let slide = scene.slide(n, friction)?;
    // A step out of bounds is refused before its halves are tried, of which there are ten at most.
    Kernel::<f32, _, ImplicitEuler<4>>::new(slide, scene.step)?;
    let greatest = scene.greatest_force();
    let mut step = scene.step;
    while step > TRIAL_STEP {
        step *= 0.5;
    }
    // Powers of two are exact, so that the last step is the scene's.
    loop {
        let made = Predictor::new(slide, step)?;
        if !made.holds(Predictor::new(slide, 0.5 * step)?, greatest) {
            return Err(Refusal(SLIPFIT_STEP));
        }
        if step >= scene.step {
            return Ok(made);
        }
        step *= 2.0;
    }
}

/// Makes a predictor in `*predictor` for a unit of tolerance level `n` (-20 to 20) of `*scene`, at rest at time 0. It is tried over
/// its first 50 steps, which takes as long as 150: SLIPFIT_STEP if half the step would change the drive's force by more than a
/// tenth of the greatest, gain times speed plus the weight, or the motion cannot be moved. A step above 1 ms is halved down to
/// that, and each of the halves tried so.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*predictor` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_predictor_init(
    storage: *mut slipfit_predictor,
    scene: *const slipfit_scene,
    n: f32,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { make(storage, || predictor(input(scene)?, n)) })
}

/// Moves the predictor by one step; SLIPFIT_NOT_FINITE if the motion could not be moved and was held.
///
/// # Safety
/// As for slipfit_predictor_init; the memory has been written before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_predictor_step(storage: *mut slipfit_predictor) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let moved = unsafe { object_mut(storage)? }.advance();
        if moved { Ok(()) } else { Err(Refusal(SLIPFIT_NOT_FINITE)) }
    })
}

/// From the coming step on the commanded speed is `speed` (m/s, within 1000 either way), in place of the scene's ramp, until another one
/// is set: any motion, reversals and stops too, once a period.
///
/// # Safety
/// As for slipfit_predictor_step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_predictor_set_command(storage: *mut slipfit_predictor, speed: f32) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let predictor = unsafe { object_mut(storage)? };
        predictor.kernel.mechanism_mut().drive_mut().set_command(checked_command(speed)?);
        Ok(())
    })
}

/// The unit is at rest at time 0 again, without the trial that making it takes. Its command is the scene's ramp, or what was set last.
///
/// # Safety
/// As for slipfit_predictor_step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_predictor_restart(storage: *mut slipfit_predictor) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let predictor = unsafe { object_mut(storage)? };
        predictor.state = predictor.kernel.at_rest(Pose::nominal());
        (predictor.report, predictor.force) = (NO_STEP, predictor.force());
        Ok(())
    })
}

/// What the predictor says now.
///
/// # Safety
/// As for slipfit_predictor_step; nobody else uses `*prediction` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_predictor_read(
    storage: *const slipfit_predictor,
    prediction: *mut slipfit_prediction,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(prediction, || {
            let Predictor { kernel, state, report, force } = object(storage)?;
            let (time, velocity) = (kernel.time(state.steps), state.motion.velocity.z);
            let position = state.motion.pose.displacement_w.z;
            Ok(slipfit_prediction { time, force: *force, velocity, position, residual: report.residual })
        })
    })
}
