//! Prediction ahead of the clock: error-controlled steps in constant work a period.

use slipfit_core::{
    ahead::{Ahead, Limits, MOST_EARLY, Prediction, State},
    law::Regularised,
    menu::FrictionData,
    pose::Pose,
};

use crate::{
    border::{Made, Storage, Zeroed, input, make_in_place, object, object_mut, output},
    scene::{Unit, slipfit_scene},
    status::{Refusal, SLIPFIT_BEHIND, SLIPFIT_LAW, SLIPFIT_PARAMETER, slipfit_status, status},
};

/// Motions that are kept.
const KEPT: usize = 256;

/// The most periods by which the clock of a prediction may start before the unit's release.
pub const SLIPFIT_AHEAD_EARLY_MOST: u32 = 1000;
const _: () = assert!(SLIPFIT_AHEAD_EARLY_MOST == MOST_EARLY);

/// What prediction ahead of the clock is held to.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_ahead_limits {
    /// Time from one step to the next (s).
    pub period: f32,
    /// Error of the drive's force (N) that is aimed at.
    pub tolerance: f32,
    /// The lead over the clock that is not exceeded (s), 4 to 1000 periods.
    pub lead: f32,
    /// The lag behind the clock (s) at which steps are forced, whatever their error, 4 to 1000 periods.
    pub lag: f32,
}

/// What a prediction ahead of the clock says after a step.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_ahead_prediction {
    /// The time (s) that force and velocity hold for: the clock's, or an earlier one where the prediction is behind.
    pub time: f32,
    /// Force of the drive (N).
    pub force: f32,
    /// Velocity along the drive (m/s).
    pub velocity: f32,
    /// How far beyond the clock the motion is known (s); negative where the prediction is behind.
    pub lead: f32,
    /// The tolerance (N) that the step was held to; infinite for a forced one.
    pub tolerance: f32,
    /// Sum of the estimated errors (N) of all steps as far as they exceed the tolerance of the limits; without forced steps.
    pub excess: f32,
    /// Steps forced so far: their error is not known.
    pub forced: u32,
}

/// Memory of a prediction ahead of the clock; opaque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_ahead {
    words: [u32; 3684],
}

type RegularisedUnit = Unit<Regularised<f32>>;

pub(crate) struct Predicted {
    ahead: Ahead<f32, RegularisedUnit>,
    state: State<f32, Pose<f32>, 6, KEPT>,
    said: Prediction<f32>,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_ahead {
    type Object = Predicted;
    const MARK: u32 = 0x534c_4131;
}

// SAFETY: all of it are numbers.
unsafe impl Zeroed for slipfit_ahead {}

/// Numbers of four bytes and no pointers: as large on the target as here, and no larger than needed.
const _: () = assert!(size_of::<slipfit_ahead>() == size_of::<Made<Predicted>>());

/// Makes `ahead` that of a unit. One copy in the code serves init and restart; in place, for less stack.
#[inline(never)]
fn put(
    ahead: &mut Ahead<f32, RegularisedUnit>,
    scene: &slipfit_scene,
    n: f32,
    limits: Limits<f32>,
) -> Result<(), Refusal> {
    let slide = scene.slide(n, |data| match data {
        FrictionData::Regularised { coefficient, stick_band } => Ok(Regularised::new(coefficient, stick_band)?),
        _ => Err(Refusal(SLIPFIT_LAW)),
    })?;
    *ahead = Ahead::new(slide, limits)?;
    Ok(())
}

impl Predicted {
    /// Whether its values are those of the present instant.
    fn is_current(&self) -> Result<(), Refusal> {
        if self.said.lead < 0.0 { Err(Refusal(SLIPFIT_BEHIND)) } else { Ok(()) }
    }
}

/// Makes a prediction ahead of the clock in `*storage` for a unit of tolerance level `n` (-20 to 20) of `*scene`, at rest until its release at
/// time 0. Its clock starts `early` periods before, SLIPFIT_AHEAD_EARLY_MOST at most, in which it takes a lead. The scene's scheme
/// and step do not matter. Its friction must be regularised, also in a library that is built for exact friction: instead of
/// that take a stick band of 10 to 30 µm/s, or SLIPFIT_LAW is the answer.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_init(
    storage: *mut slipfit_ahead,
    scene: *const slipfit_scene,
    n: f32,
    limits: *const slipfit_ahead_limits,
    early: u32,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make_in_place(storage, |predicted: &mut Predicted| {
            let slipfit_ahead_limits { period, tolerance, lead, lag } = *input(limits)?;
            if early > SLIPFIT_AHEAD_EARLY_MOST {
                return Err(Refusal(SLIPFIT_PARAMETER));
            }
            let Predicted { ahead, state, said } = predicted;
            put(ahead, input(scene)?, n, Limits { period, tolerance, lead, lag })?;
            ahead.put_at_rest(state, Pose::nominal(), early);
            let lead = early as f32 * period;
            let force = ahead.mechanism().drive().force(-lead, 0.0);
            *said = Prediction { time: -lead, speed: 0.0, force, lead, tolerance, excess: 0.0, forced: 0 };
            Ok(())
        })
    })
}

/// One period, in the same instructions whatever the motion does: the clock goes on by it, and one step is attempted.
/// SLIPFIT_BEHIND if the motion is not known at the new instant.
///
/// # Safety
/// As for slipfit_ahead_init; the memory has been written before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_step(storage: *mut slipfit_ahead) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let predicted = unsafe { object_mut(storage)? };
        predicted.said = predicted.ahead.step(&mut predicted.state);
        predicted.is_current()
    })
}

/// What the prediction says now. SLIPFIT_BEHIND if that holds for an earlier time than the clock's, which `*prediction` then
/// says.
///
/// # Safety
/// As for slipfit_ahead_step; nobody else uses `*prediction` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_read(
    storage: *const slipfit_ahead,
    prediction: *mut slipfit_ahead_prediction,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(prediction, || {
            let Prediction { time, speed: velocity, force, lead, tolerance, excess, forced } = object(storage)?.said;
            Ok(slipfit_ahead_prediction { time, force, velocity, lead, tolerance, excess, forced })
        })?;
        object(storage)?.is_current()
    })
}

/// Goes on from the motion at the present instant as a unit of tolerance level `n` of `*scene`: for when the command or what is
/// known of the unit changes. The clock runs on, and the scene's ramp counts from the same time 0. Where the prediction is
/// behind, it goes on from the last motion known. It keeps its limits, and if it is refused everything else too.
///
/// # Safety
/// As for slipfit_ahead_step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_restart(
    storage: *mut slipfit_ahead,
    scene: *const slipfit_scene,
    n: f32,
) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let (predicted, scene) = unsafe { (object_mut(storage)?, input(scene)?) };
        let limits = *predicted.ahead.limits();
        put(&mut predicted.ahead, scene, n, limits)?;
        predicted.ahead.restart(&mut predicted.state);
        Ok(())
    })
}
