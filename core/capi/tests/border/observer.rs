//! The observer.

use slipfit_capi::*;
use slipfit_problems::arcs;

use super::{common::zeroed, scene};

/// Corrections have the core's bits, and leave a predictor that goes on without them.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
#[cfg(not(feature = "exact"))]
fn it_corrects_as_the_core_does() {
    use slipfit_core::{
        drive::Commandable as _,
        integrator::ImplicitEuler,
        kernel::Kernel,
        observer::{Noise, Observer},
        pose::Pose,
    };
    let scene = scene();
    let mut kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(super::ahead::slide(&scene, 2.5), scene.step).unwrap();
    let mut state = kernel.at_rest(Pose::nominal());
    // What the drive can push with, and the weight.
    let most = scene.drive_gain * scene.drive_speed + 9.81 * scene.mass;
    let noise = Noise { speed: 1e-3, force: 1e-2 };
    let mut observer = Observer::new(scene.drive_gain, scene.mass, scene.step, noise, most).unwrap();
    let (mut c, mut predictor) = (zeroed::<slipfit_observer>(), zeroed::<slipfit_predictor>());
    let (mut said, mut missing) = (zeroed::<slipfit_prediction>(), 0.0f32);
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        assert_eq!(slipfit_predictor_init(&mut predictor, &scene, 2.5), SLIPFIT_OK);
        assert_eq!(slipfit_observer_init(&mut c, &scene, noise.speed, noise.force), SLIPFIT_OK);
        for period in 0..3000 {
            let command = arcs(0.1, period, 1200);
            // A unit that lags behind, whose sensor fails once a while.
            let measured = if period % 50 == 7 { f32::NAN } else { 0.9 * command + 1e-3 * (period % 3) as f32 };
            kernel.mechanism_mut().drive_mut().set_command(observer.command(command));
            let _ = kernel.step(&mut state);
            state.motion.velocity.z += observer.correct(state.motion.velocity.z, measured);
            assert_eq!(slipfit_observer_step(&mut c, &mut predictor, command, measured), SLIPFIT_OK);
            assert_eq!(slipfit_predictor_read(&predictor, &mut said), SLIPFIT_OK);
            assert_eq!(slipfit_observer_missing(&c, &mut missing), SLIPFIT_OK);
            assert_eq!((said.velocity, missing), (state.motion.velocity.z, observer.missing()), "{period}");
            assert_eq!(said.force, scene.drive_gain * (command - said.velocity), "{period}");
        }
        for wrong in [f32::NAN, f32::NEG_INFINITY, 1001.0] {
            assert_eq!(slipfit_observer_step(&mut c, &mut predictor, wrong, 0.1), SLIPFIT_PARAMETER);
        }
        let command = arcs(0.1, 3000, 1200);
        kernel.mechanism_mut().drive_mut().set_command(command);
        let _ = kernel.step(&mut state);
        assert_eq!(slipfit_predictor_set_command(&mut predictor, command), SLIPFIT_OK);
        assert_eq!(slipfit_predictor_step(&mut predictor), SLIPFIT_OK);
        assert_eq!(slipfit_predictor_read(&predictor, &mut said), SLIPFIT_OK);
        assert_eq!(said.velocity, state.motion.velocity.z);
        assert_eq!(slipfit_observer_restart(&mut c), SLIPFIT_OK);
        assert_eq!(slipfit_observer_missing(&c, &mut missing), SLIPFIT_OK);
        assert_eq!(missing, 0.0);
    }
}

#[test]
fn what_is_out_of_bounds_is_refused() {
    let (mut c, mut predictor) = (zeroed::<slipfit_observer>(), zeroed::<slipfit_predictor>());
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        assert_eq!(slipfit_observer_step(&mut c, &mut predictor, 0.1, 0.1), SLIPFIT_NOT_MADE);
        for (speed, force) in [(0.0, 1e-2), (-1.0, 1e-2), (f32::NAN, 1e-2), (1e-3, -1.0), (1e-3, f32::INFINITY)] {
            assert_eq!(slipfit_observer_init(&mut c, &scene(), speed, force), SLIPFIT_PARAMETER, "{speed} {force}");
            assert_eq!(slipfit_observer_restart(&mut c), SLIPFIT_NOT_MADE);
        }
        assert_eq!(slipfit_observer_init(&mut c, &scene(), 1e-3, 1e-2), SLIPFIT_OK);
        assert_eq!(slipfit_observer_step(&mut c, &mut predictor, 0.1, 0.1), SLIPFIT_NOT_MADE);
    }
}
