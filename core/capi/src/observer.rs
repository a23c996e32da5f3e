//! The observer: a predictor that a measured speed corrects.

use slipfit_core::{
    drive::{Commandable, checked_command},
    observer::{Noise, Observer},
};

use crate::{
    border::{Storage, input, make, object, object_mut, output},
    predictor::slipfit_predictor,
    scene::slipfit_scene,
    status::{Refusal, SLIPFIT_NOT_FINITE, slipfit_status, status},
};

/// Memory of an observer; opaque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_observer {
    words: [u64; 4],
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_observer {
    type Object = Observer<f32>;
    const MARK: u32 = 0x534c_4f31;
}

/// Makes an observer in `*storage` for predictors of `*scene`: the standard deviations of a measured speed, `speed_noise` (m/s), and of
/// what the force that the model lacks changes by in a step, `force_noise` (N). That force stays within the greatest that drive and
/// weight have.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_observer_init(
    storage: *mut slipfit_observer,
    scene: *const slipfit_scene,
    speed_noise: f32,
    force_noise: f32,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make(storage, || {
            let scene = input(scene)?;
            let noise = Noise { speed: speed_noise, force: force_noise };
            Ok(Observer::new(scene.drive_gain, scene.mass, scene.step, noise, scene.greatest_force())?)
        })
    })
}

/// Moves `*predictor` by one step under the commanded speed `command` (m/s, within 1000 either way), corrected by the speed that was
/// `measured` (m/s) at the end of the step; NAN if none was. Its force is then the real drive's, of the corrected speed.
/// SLIPFIT_NOT_FINITE if the motion could not be moved and was held.
///
/// # Safety
/// As for slipfit_observer_init; the memory of both has been written before; nobody else uses `*predictor` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_observer_step(
    storage: *mut slipfit_observer,
    predictor: *mut slipfit_predictor,
    command: f32,
    measured: f32,
) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let (observer, predictor) = unsafe { (object_mut(storage)?, object_mut(predictor)?) };
        let command = checked_command(command)?;
        predictor.kernel.mechanism_mut().drive_mut().set_command(observer.command(command));
        let moved = predictor.advance();
        let speed = &mut predictor.state.motion.velocity.z;
        *speed += observer.correct(*speed, measured);
        predictor.kernel.mechanism_mut().drive_mut().set_command(command);
        predictor.force = predictor.force();
        if moved { Ok(()) } else { Err(Refusal(SLIPFIT_NOT_FINITE)) }
    })
}

/// Sets `*force` to the force (N) along the drive that the model lacks: negative where the unit is harder to move than the model's.
///
/// # Safety
/// As for slipfit_observer_step; nobody else uses `*force` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_observer_missing(storage: *const slipfit_observer, force: *mut f32) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { output(force, || Ok(object(storage)?.missing())) })
}

/// The model lacks nothing again: for another unit.
///
/// # Safety
/// As for slipfit_observer_step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_observer_restart(storage: *mut slipfit_observer) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        unsafe { object_mut(storage)? }.restart();
        Ok(())
    })
}
