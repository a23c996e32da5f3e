//! Prediction ahead of the clock: error-controlled steps in constant work a period.

use slipfit_core::{
    ahead::{Ahead, Limits, MOST_ATTEMPTS, MOST_EARLY, Prediction, State},
    drive::{Drive, SetpointDrive, checked_command},
    law::{Regularised, ThreeHalves},
    menu::FrictionData,
    pose::Pose,
    slide::Slide,
};

use crate::{
    border::{Made, Storage, Zeroed, input, make_in_place, object, object_mut, output},
    scene::slipfit_scene,
    status::{Refusal, SLIPFIT_BEHIND, SLIPFIT_LATE, SLIPFIT_LAW, SLIPFIT_PARAMETER, slipfit_status, status},
};

/// Motions that are kept.
const KEPT: usize = 256;

/// The most periods by which the clock of a prediction may start before the unit's release.
pub const SLIPFIT_AHEAD_EARLY_MOST: u32 = 1000;
const _: () = assert!(SLIPFIT_AHEAD_EARLY_MOST == MOST_EARLY);

/// The most attempts at a step in a period.
pub const SLIPFIT_AHEAD_ATTEMPTS_MOST: u32 = 16;
const _: () = assert!(SLIPFIT_AHEAD_ATTEMPTS_MOST == MOST_ATTEMPTS);

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
    /// Attempts at a step in each period, 1 to SLIPFIT_AHEAD_ATTEMPTS_MOST: 1 for strokes, 2 for planned commands that reverse,
    /// 3 or 4 for commands that are followed.
    pub attempts: u32,
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
    /// How far the slide is along the drive (m), from where it was at rest.
    pub position: f32,
    /// Of a followed command: the commanded speed (m/s) minus the extrapolated one by which this instant was predicted. 0
    /// where it had not been predicted before, where the prediction is behind, and for other commands.
    pub deviation: f32,
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
    words: [u32; 4231],
}

type SetpointUnit = Slide<f32, ThreeHalves<f32>, Regularised<f32>, [f32; 4], SetpointDrive<f32>>;

pub(crate) struct Predicted {
    ahead: Ahead<f32, SetpointUnit>,
    state: State<f32, Pose<f32>, 6, KEPT>,
    said: Prediction<f32>,
    /// The scene's command.
    ramp: Drive<f32>,
    /// 1 where the caller has set the command, 0 where it is the scene's ramp.
    is_commanded: u32,
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

/// Makes `ahead` that of a unit, and `ramp` its scene's command. One copy in the code serves init and restart; in place, for less stack.
#[inline(never)]
fn put(
    (ahead, ramp): (&mut Ahead<f32, SetpointUnit>, &mut Drive<f32>),
    scene: &slipfit_scene,
    n: f32,
    limits: Limits<f32>,
) -> Result<(), Refusal> {
    let slide = scene.slide(n, |data| match data {
        FrictionData::Regularised { coefficient, stick_band } => Ok(Regularised::new(coefficient, stick_band)?),
        _ => Err(Refusal(SLIPFIT_LAW)),
    })?;
    *ahead = Ahead::new(slide.driven_by(SetpointDrive::new(slide.drive().gain))?, limits)?;
    *ramp = *slide.drive();
    Ok(())
}

impl Predicted {
    /// Whether its values are those of the present instant.
    fn is_current(&self) -> Result<(), Refusal> {
        if self.said.lead < 0.0 { Err(Refusal(SLIPFIT_BEHIND)) } else { Ok(()) }
    }

    /// One period.
    fn advance(&mut self) {
        let Self { ahead, state, said, ramp, is_commanded } = self;
        if *is_commanded == 0 {
            let horizon = ahead.horizon(state);
            let speed = ramp.command(ahead.time(state, horizon + 1));
            ahead.plan(state, horizon, speed);
        }
        *said = ahead.step(state);
    }

    /// At rest until it is released, after `early` periods. One copy in the code.
    #[inline(never)]
    fn rest(&mut self, early: u32) -> Result<(), Refusal> {
        if early > SLIPFIT_AHEAD_EARLY_MOST {
            return Err(Refusal(SLIPFIT_PARAMETER));
        }
        let Self { ahead, state, said, ramp, is_commanded } = self;
        ahead.put_at_rest(state, Pose::nominal(), early, |time| ramp.command(time));
        let Limits { period, tolerance, .. } = *ahead.limits();
        let lead = early as f32 * period;
        *said = Prediction {
            time: -lead,
            speed: 0.0,
            position: 0.0,
            force: ramp.force(-lead, 0.0),
            deviation: 0.0,
            lead,
            tolerance,
            excess: 0.0,
            forced: 0,
        };
        *is_commanded = 0;
        Ok(())
    }
}

/// Makes a prediction ahead of the clock in `*storage` for a unit of tolerance level `n` (-20 to 20) of `*scene`, at rest until its release at
/// time 0. Its clock starts `early` periods before, SLIPFIT_AHEAD_EARLY_MOST at most, in which it takes a lead. Its command is the
/// scene's ramp until slipfit_ahead_plan or slipfit_ahead_follow sets another. The scene's scheme and step do not matter. Its
/// friction must be regularised, also in a library that is built for exact friction: instead of that take a stick band of 10 to 30 µm/s,
/// or SLIPFIT_LAW is the answer.
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
            let slipfit_ahead_limits { period, tolerance, lead, lag, attempts } = *input(limits)?;
            let limits = Limits { period, tolerance, lead, lag, attempts };
            put((&mut predicted.ahead, &mut predicted.ramp), input(scene)?, n, limits)?;
            predicted.rest(early)
        })
    })
}

/// The unit is at rest again until its release at time 0, `early` periods from now, with the scene's ramp as its command.
///
/// # Safety
/// As for slipfit_ahead_step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_rest(storage: *mut slipfit_ahead, early: u32) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { object_mut(storage)? }.rest(early))
}

/// Writes to `*periods` how many periods after the end of the coming one a command may be planned: the horizon.
///
/// # Safety
/// As for slipfit_ahead_read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_horizon(storage: *const slipfit_ahead, periods: *mut u32) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(periods, || {
            let Predicted { ahead, state, .. } = object(storage)?;
            Ok(ahead.horizon(state))
        })
    })
}

/// The commanded `speed` (m/s, within 1000 either way) so many `periods` after the end of the coming one, of a command that is known in
/// advance, in place of the scene's ramp. After slipfit_ahead_init, _rest and _restart plan all periods from 0 to the horizon, then the
/// horizon once a period before each step. The first one then holds up to the horizon, until the next ones are set. SLIPFIT_PARAMETER beyond
/// the horizon; SLIPFIT_LATE if the motion is already predicted for that instant: slipfit_ahead_restart takes that back.
///
/// # Safety
/// As for slipfit_ahead_step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_plan(storage: *mut slipfit_ahead, periods: u32, speed: f32) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let Predicted { ahead, state, is_commanded, .. } = unsafe { object_mut(storage)? };
        let speed = checked_command(speed)?;
        if periods > ahead.horizon(state) {
            return Err(Refusal(SLIPFIT_PARAMETER));
        }
        if !ahead.plan(state, periods, speed) {
            return Err(Refusal(SLIPFIT_LATE));
        }
        *is_commanded = 1;
        Ok(())
    })
}

/// The commanded `speed` (m/s, within 1000 either way) at the end of the coming period, of a command that is not known in advance, in
/// place of the scene's ramp; once a period, before slipfit_ahead_step. It is extrapolated to the horizon by a parabola through the last eight
/// periods; at first and after slipfit_ahead_restart as constant, until eight periods are known.
///
/// # Safety
/// As for slipfit_ahead_step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_follow(storage: *mut slipfit_ahead, speed: f32) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let Predicted { ahead, state, is_commanded, .. } = unsafe { object_mut(storage)? };
        ahead.follow(state, checked_command(speed)?);
        *is_commanded = 1;
        Ok(())
    })
}

/// One period, in the same instructions whatever the motion does: the clock goes on by it, and steps are attempted.
/// SLIPFIT_BEHIND if the motion is not known at the new instant.
///
/// # Safety
/// As for slipfit_ahead_init; the memory has been written before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_step(storage: *mut slipfit_ahead) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let predicted = unsafe { object_mut(storage)? };
        predicted.advance();
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
            let said = object(storage)?.said;
            let Prediction { time, speed: velocity, position, force, deviation, lead, tolerance, excess, forced } =
                said;
            Ok(slipfit_ahead_prediction { time, force, velocity, position, deviation, lead, tolerance, excess, forced })
        })?;
        object(storage)?.is_current()
    })
}

/// Writes to `*force` (N) what the drive gives so many `periods` after the present instant. SLIPFIT_BEHIND if that is beyond the lead.
///
/// # Safety
/// As for slipfit_ahead_read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_ahead_forecast(
    storage: *const slipfit_ahead,
    periods: u32,
    force: *mut f32,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(force, || {
            let Predicted { ahead, state, .. } = object(storage)?;
            ahead.forecast(state, periods).ok_or(Refusal(SLIPFIT_BEHIND))
        })
    })
}

/// Goes on from the motion at the present instant as a unit of tolerance level `n` of `*scene`: for when the command or what is
/// known of the unit changes. The clock runs on, and the scene's ramp counts from the same time 0; a command that was set stays
/// until it is set again, from the coming period on. Where the prediction is behind, it goes on from the last motion known. It keeps its limits, and
/// if it is refused everything else too.
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
        let Predicted { ahead, state, ramp, is_commanded, .. } = predicted;
        let limits = *ahead.limits();
        put((ahead, ramp), scene, n, limits)?;
        ahead.restart(state);
        if *is_commanded == 0 {
            ahead.plan_all(state, |time| ramp.command(time));
        }
        Ok(())
    })
}
