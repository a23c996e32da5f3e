//! The predictor.

use proptest::prelude::*;
use slipfit_capi::*;
use slipfit_problems::arcs;

use super::{
    NUMBERS, SPECIAL,
    ahead::{LIMITS, ahead_stays_finite},
    changed,
    common::zeroed,
    regularised, scene,
};

/// Makes and steps a predictor: refused, or finite for ever.
fn stays_finite(scene: &slipfit_scene, n: f32) -> Result<(), TestCaseError> {
    let mut predictor = zeroed::<slipfit_predictor>();
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        let made = slipfit_predictor_init(&mut predictor, scene, n);
        prop_assert!([SLIPFIT_OK, SLIPFIT_PARAMETER, SLIPFIT_LAW, SLIPFIT_STEP].contains(&made), "{made}");
        for _ in 0..20 {
            let set = slipfit_predictor_set_command(&mut predictor, n);
            let is_speed = n.is_finite() && n.abs() <= 1000.0;
            prop_assert_eq!(set == SLIPFIT_OK, made == SLIPFIT_OK && is_speed, "{}", set);
            let stepped = slipfit_predictor_step(&mut predictor);
            if made == SLIPFIT_OK {
                prop_assert!([SLIPFIT_OK, SLIPFIT_NOT_FINITE].contains(&stepped), "{stepped}");
            } else {
                prop_assert_eq!(stepped, SLIPFIT_NOT_MADE);
            }
        }
        let mut said = zeroed::<slipfit_prediction>();
        if slipfit_predictor_read(&predictor, &mut said) == SLIPFIT_OK {
            prop_assert!(said.time.is_finite() && said.velocity.is_finite() && !said.residual.is_nan(), "{said:?}");
        }
    }
    Ok(())
}

#[test]
fn special_numbers_in_every_place_of_a_scene() {
    stays_finite(&scene(), 2.5).unwrap();
    // An interpreter has no time to try every one.
    let (places, specials) = if cfg!(miri) { (40, 1) } else { (1, SPECIAL.len()) };
    for place in (0..NUMBERS).step_by(places) {
        for special in SPECIAL.into_iter().take(specials) {
            stays_finite(&changed(scene(), &[(place, special.to_bits())]), 2.5).unwrap();
            ahead_stays_finite(&changed(regularised(), &[(place, special.to_bits())]), 2.5, &LIMITS).unwrap();
        }
    }
    for n in SPECIAL.into_iter().take(specials) {
        stays_finite(&scene(), n).unwrap();
    }
}

#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn what_cannot_be_stepped_is_refused() {
    let mut predictor = zeroed::<slipfit_predictor>();
    // SAFETY: every pointer is to a local of its type.
    let mut made = |scene: &slipfit_scene, n| unsafe { slipfit_predictor_init(&mut predictor, scene, n) };
    for n in [-3.0, 0.0, 2.5, 5.0, 8.0] {
        assert_eq!(made(&scene(), n), SLIPFIT_OK, "{n}");
    }
    // What such a unit lets go of, compressed by 10 mm and more, steps of 1 ms do not follow; steps of 0.1 ms do for a while.
    let loose =
        |factor: f32| slipfit_scene { gap_deviations: scene().gap_deviations.map(|gap| factor * gap), ..scene() };
    for factor in [100.0, 400.0, 2e3] {
        assert_eq!(made(&loose(factor), 5.0), SLIPFIT_STEP, "{factor}");
    }
    assert_eq!(made(&slipfit_scene { step: 1e-4, ..loose(100.0) }, 5.0), SLIPFIT_OK);
    // No production makes units of such levels.
    for n in [-1e6, -1000.0, -50.0, -20.1, 20.1, 50.0, 1e6] {
        assert_eq!(made(&scene(), n), SLIPFIT_PARAMETER, "{n}");
    }
    // No step is so great that it is not noticed that it is too great.
    for step in [0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9, 1.0] {
        assert_eq!(made(&slipfit_scene { step, ..scene() }, 2.5), SLIPFIT_STEP, "{step}");
    }
    for step in [0.0, -1e-3, 1.1, 1e30, f32::NAN, f32::INFINITY] {
        assert_eq!(made(&slipfit_scene { step, ..scene() }, 2.5), SLIPFIT_PARAMETER, "{step}");
    }
    for step in [1e-4, 5e-4, 1e-3, 2e-3] {
        assert_eq!(made(&slipfit_scene { step, ..scene() }, 2.5), SLIPFIT_OK, "{step}");
    }
    for scheme in [0, 2, u32::MAX] {
        assert_eq!(made(&slipfit_scene { scheme, ..scene() }, 2.5), SLIPFIT_LAW);
    }
    let mut negative = scene();
    negative.gap_deviations[7] = -1e-9;
    assert_eq!(made(&negative, 2.5), SLIPFIT_PARAMETER);
}

/// The command of each period: there and back, a jump, a rest, there and back.
fn command(period: u32) -> f32 {
    match period {
        0..600 => arcs(0.1, period, 1200),
        600..700 => -0.05,
        700..900 => 0.0,
        _ => arcs(0.08, period, 310),
    }
}

/// Any command has the kernel's bits, also across a copy of the predictor's memory, and from rest again.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
#[cfg(not(feature = "exact"))]
fn a_command_that_is_set_is_the_kernels() {
    use slipfit_core::{drive::Commandable, integrator::ImplicitEuler, kernel::Kernel, pose::Pose};
    let mut kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(super::ahead::slide(&scene(), 2.5), scene().step).unwrap();
    let (mut c, mut said) = (zeroed::<slipfit_predictor>(), zeroed::<slipfit_prediction>());
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        assert_eq!(slipfit_predictor_init(&mut c, &scene(), 2.5), SLIPFIT_OK);
        for from_rest in 0..2 {
            let mut state = kernel.at_rest(Pose::nominal());
            for period in 0..2000 {
                kernel.mechanism_mut().drive_mut().set_command(command(period));
                let report = kernel.step(&mut state);
                assert_eq!(slipfit_predictor_set_command(&mut c, command(period)), SLIPFIT_OK);
                if period == 1000 {
                    let saved = c;
                    for _ in 0..5 {
                        assert_eq!(slipfit_predictor_step(&mut c), SLIPFIT_OK);
                    }
                    c = saved;
                }
                assert_eq!(slipfit_predictor_step(&mut c), SLIPFIT_OK);
                assert_eq!(slipfit_predictor_read(&c, &mut said), SLIPFIT_OK);
                let (time, velocity) = (kernel.time(state.steps), state.motion.velocity.z);
                let expected = slipfit_prediction {
                    time,
                    force: kernel.mechanism().drive().force(time, velocity),
                    velocity,
                    position: state.motion.pose.displacement_w.z,
                    residual: report.residual,
                };
                assert_eq!(said, expected, "{from_rest} {period}");
                // At the end of the rest.
                assert!(period != 899 || velocity.abs() < 1e-5, "{velocity}");
            }
            for wrong in [f32::NAN, f32::NEG_INFINITY, 1001.0] {
                assert_eq!(slipfit_predictor_set_command(&mut c, wrong), SLIPFIT_PARAMETER);
            }
            assert_eq!(slipfit_predictor_restart(&mut c), SLIPFIT_OK);
            assert_eq!(slipfit_predictor_read(&c, &mut said), SLIPFIT_OK);
            assert_eq!((said.time, said.velocity, said.position, said.residual), (0.0, 0.0, 0.0, 0.0));
        }
    }
}

proptest! {
    #![proptest_config(super::cases())]

    #[test]
    fn any_scene_is_refused_or_stays_finite(
        changes in prop::collection::vec((0..NUMBERS, any::<u32>()), 0..6),
        n in any::<f32>(),
    ) {
        stays_finite(&changed(scene(), &changes), n)?;
        ahead_stays_finite(&changed(regularised(), &changes), n, &LIMITS)?;
    }
}
