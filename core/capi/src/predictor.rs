//! The predictor: a unit's kernel and its state.

use slipfit_core::{
    integrator::ImplicitEuler,
    kernel::{Kernel, Report, StateOf},
    law::{Impact, ThreeHalves},
    menu::{ContactData, FrictionData, NormalType},
    pose::Pose,
    scene::SceneData,
    slide::Slide,
};

use crate::{
    border::{Storage, input, make, object, object_mut, output},
    status::{Refusal, SLIPFIT_LAW, SLIPFIT_NOT_FINITE, SLIPFIT_STEP, slipfit_status, status},
};

#[cfg(feature = "exact")]
type Friction = slipfit_core::law::Exact<f32>;
#[cfg(not(feature = "exact"))]
type Friction = slipfit_core::law::Regularised<f32>;

type Unit = Slide<f32, ThreeHalves<f32>, Friction>;

/// A scene: a slide over the production, SI units, as `slipfit kernel SCENE -o scene.h` writes it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_scene {
    /// SLIPFIT_SCHEME_IMPLICIT_EULER.
    pub scheme: u32,
    /// Step (s).
    pub step: f32,
    /// Mass (kg).
    pub mass: f32,
    /// Principal moments of inertia about the centre of mass (kg·m²).
    pub inertia: [f32; 3],
    /// Gravity (m/s²).
    pub gravity: [f32; 3],
    /// Positions of the pins from the centre of mass (m): x, y, z of each.
    pub pins: [[f32; 3]; 4],
    /// Means of the gaps (m): left, right, rail, wall of each pin; 1e6 for none.
    pub gap_means: [f32; 16],
    /// Standard deviations of the gaps (m), not negative.
    pub gap_deviations: [f32; 16],
    /// Contact stiffness (N/m^e).
    pub stiffness: f32,
    /// Contact exponent e; the library is built for 1.5.
    pub exponent: f32,
    /// Contact damping (N·s/m).
    pub damping: f32,
    /// Depth of full damping (m).
    pub depth: f32,
    /// SLIPFIT_FRICTION_REGULARISED or SLIPFIT_FRICTION_EXACT; the library is built for one of the two.
    pub friction_law: u32,
    /// Coefficient of friction.
    pub friction_coefficient: f32,
    /// Stick band of smoothed friction (m/s); ignored by exact friction.
    pub friction_stick_band: f32,
    /// Gain of the drive (N·s/m).
    pub drive_gain: f32,
    /// Start and end of the drive's ramp (s).
    pub drive_ramp: [f32; 2],
    /// Commanded speed at the end of the ramp (m/s).
    pub drive_speed: f32,
    /// Where the drive pushes, from the centre of mass (m).
    pub drive_point: [f32; 3],
}

/// Implicit Euler with four Newton passes.
pub const SLIPFIT_SCHEME_IMPLICIT_EULER: u32 = 1;

/// Smoothed Coulomb friction.
pub const SLIPFIT_FRICTION_REGULARISED: u32 = 1;
/// Coulomb friction with true stick.
pub const SLIPFIT_FRICTION_EXACT: u32 = 2;

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
    /// Imbalance of momentum (N·s) that the step left; infinite if it was not finite.
    pub residual: f32,
}

#[derive(Clone, Copy)]
pub(crate) struct Predictor {
    kernel: Kernel<f32, Unit, ImplicitEuler<4>>,
    state: StateOf<f32, Unit, 6>,
    report: Report<f32>,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_predictor {
    type Object = Predictor;
    const MARK: u32 = 0x534c_5031;
}

impl slipfit_scene {
    fn data(&self) -> Result<SceneData<f32>, Refusal> {
        let coefficient = self.friction_coefficient;
        Ok(SceneData {
            mass: self.mass,
            inertia_b: self.inertia,
            gravity_w: self.gravity,
            pins_w: self.pins,
            gap_means: self.gap_means,
            gap_deviations: self.gap_deviations,
            contact: ContactData {
                stiffness: self.stiffness,
                exponent: self.exponent,
                damping: self.damping,
                depth: self.depth,
            },
            friction: match self.friction_law {
                SLIPFIT_FRICTION_REGULARISED => {
                    FrictionData::Regularised { coefficient, stick_band: self.friction_stick_band }
                }
                SLIPFIT_FRICTION_EXACT => FrictionData::Exact { coefficient },
                _ => return Err(Refusal(SLIPFIT_LAW)),
            },
            drive_gain: self.drive_gain,
            drive_ramp: self.drive_ramp,
            drive_speed: self.drive_speed,
            drive_point_b: self.drive_point,
        })
    }
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

/// Periods of the scene's step over which a predictor is tried before it is made: as long as the release of stored compression
/// takes in steps of 1 ms.
const TRIAL: u32 = 50;

/// By how much of the greatest force half the step may change the drive's force in the trial.
const TRIAL_ERROR: f32 = 0.1;

impl Predictor {
    fn new(slide: Unit, step: f32) -> Result<Self, Refusal> {
        let kernel = Kernel::new(slide, step)?;
        let report = Report { residual: 0.0, error: 0.0 };
        Ok(Self { state: kernel.at_rest(Pose::nominal()), kernel, report })
    }

    /// One step; whether the motion could be moved. One copy in the code serves the trial too.
    #[inline(never)]
    fn advance(&mut self) -> bool {
        self.report = self.kernel.step(&mut self.state);
        self.report.residual.is_finite()
    }

    /// Force of the drive (N).
    fn force(&self) -> f32 {
        self.kernel.mechanism().drive().force(self.kernel.time(self.state.steps), self.state.motion.velocity.z)
    }

    /// Whether the step follows the first instants, in which a tight unit lets go of what it is compressed by: as well as half
    /// the step.
    fn holds(mut self, mut fine: Self, greatest: f32) -> bool {
        (0..TRIAL).all(|_| {
            let moved = self.advance() & fine.advance() & fine.advance();
            moved && (self.force() - fine.force()).abs() <= TRIAL_ERROR * greatest
        })
    }
}

fn predictor(scene: &slipfit_scene, n: f32) -> Result<Predictor, Refusal> {
    let unit = scene.data()?.at(n)?;
    if scene.scheme != SLIPFIT_SCHEME_IMPLICIT_EULER || unit.contact.normal_type() != NormalType::ThreeHalves {
        return Err(Refusal(SLIPFIT_LAW));
    }
    let ContactData { stiffness, damping, depth, .. } = unit.contact;
    let contact = Impact::new(ThreeHalves::new(stiffness)?, damping, depth)?;
    let slide = Slide::new(unit.body, contact, friction(unit.friction)?, unit.drive)?;
    let made = Predictor::new(slide, scene.step)?;
    let fine = Predictor::new(slide, 0.5 * scene.step)?;
    // What the drive can push with, and the weight.
    let [x, y, z] = scene.gravity.map(|part| part * scene.mass);
    let greatest = (scene.drive_gain * scene.drive_speed).abs() + x.abs() + y.abs() + z.abs();
    if made.holds(fine, greatest) { Ok(made) } else { Err(Refusal(SLIPFIT_STEP)) }
}

/// Makes a predictor in `*predictor` for a unit of tolerance level `n` of `*scene`, at rest at time 0. It is tried over its
/// first 50 steps, which takes as long as 150: SLIPFIT_STEP if half the step would change the drive's force by more than a
/// tenth of its greatest, or the motion cannot be moved.
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
            let predictor = object(storage)?;
            let Predictor { kernel, state, report } = predictor;
            let (time, velocity) = (kernel.time(state.steps), state.motion.velocity.z);
            Ok(slipfit_prediction { time, force: predictor.force(), velocity, residual: report.residual })
        })
    })
}
