//! Prediction ahead of the clock.

use proptest::prelude::*;
use slipfit_capi::*;
use slipfit_core::{
    ahead::{Ahead, Limits, Prediction, State},
    menu::FrictionData,
    pose::Pose,
};
use slipfit_problems::cd_rom::{self, CdRomSlide};

use super::{SPECIAL, common::zeroed, regularised};

/// A prediction ahead of the clock of `scene`, which is one with regularised friction wherever its law was not changed.
pub fn ahead_stays_finite(scene: &slipfit_scene, n: f32, limits: &slipfit_ahead_limits) -> Result<(), TestCaseError> {
    let mut ahead = zeroed::<slipfit_ahead>();
    let mut said = zeroed::<slipfit_ahead_prediction>();
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        let made = slipfit_ahead_init(&mut ahead, scene, n, limits, 5);
        prop_assert!([SLIPFIT_OK, SLIPFIT_PARAMETER, SLIPFIT_LAW].contains(&made), "{made}");
        for step in 0..20 {
            let stepped = slipfit_ahead_step(&mut ahead);
            if made != SLIPFIT_OK {
                prop_assert_eq!(stepped, SLIPFIT_NOT_MADE);
                continue;
            }
            prop_assert_eq!(slipfit_ahead_read(&ahead, &mut said), stepped);
            prop_assert_eq!(stepped, if said.lead < 0.0 { SLIPFIT_BEHIND } else { SLIPFIT_OK });
            prop_assert!(said.time.is_finite() && said.velocity.is_finite() && said.lead.is_finite(), "{said:?}");
            if step == 10 {
                prop_assert_eq!(slipfit_ahead_restart(&mut ahead, scene, n), SLIPFIT_OK);
            }
        }
    }
    Ok(())
}

/// What prediction ahead of the clock is held to here.
pub const LIMITS: slipfit_ahead_limits = slipfit_ahead_limits { period: 1e-3, tolerance: 7e-5, lead: 0.2, lag: 0.2 };

#[test]
fn special_numbers_ahead_of_the_clock() {
    ahead_stays_finite(&regularised(), 2.5, &LIMITS).unwrap();
    let specials = if cfg!(miri) { 1 } else { SPECIAL.len() };
    for special in SPECIAL.into_iter().take(specials) {
        for limits in [
            slipfit_ahead_limits { period: special, ..LIMITS },
            slipfit_ahead_limits { tolerance: special, ..LIMITS },
            slipfit_ahead_limits { lead: special, ..LIMITS },
            slipfit_ahead_limits { lag: special, ..LIMITS },
        ] {
            ahead_stays_finite(&regularised(), 2.5, &limits).unwrap();
        }
    }
}

/// The same bits as in Rust, through a change of the unit and the command.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn a_prediction_ahead_of_the_clock_is_rusts() {
    let slide = |scene: &slipfit_scene, n: f32| -> CdRomSlide<f32> {
        let mut data = cd_rom::data(0.0f32);
        data.friction = FrictionData::Regularised { coefficient: 0.3, stick_band: scene.friction_stick_band };
        data.drive.speed = scene.drive_speed;
        for (gap, deviation) in data.body.gaps.iter_mut().zip(scene.gap_deviations) {
            *gap -= n * deviation;
        }
        cd_rom::from_data(&data)
    };
    let (first, second) = (regularised(), slipfit_scene { drive_speed: 0.05, ..regularised() });
    let slipfit_ahead_limits { period, tolerance, lead, lag } = LIMITS;
    let limits = Limits { period, tolerance, lead, lag };
    let mut ahead = Ahead::new(slide(&first, 2.5), limits).unwrap();
    let mut state: State<f32, _, 6, 256> = ahead.at_rest(Pose::nominal(), 70);
    let (mut c, mut said) = (zeroed::<slipfit_ahead>(), zeroed::<slipfit_ahead_prediction>());
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        assert_eq!(slipfit_ahead_init(&mut c, &first, 2.5, &LIMITS, 70), SLIPFIT_OK);
        assert_eq!(slipfit_ahead_read(&c, &mut said), SLIPFIT_OK);
        assert_eq!((said.time, said.force, said.velocity, said.lead), (-0.07, 0.0, 0.0, 0.07));
        for period in 0..900 {
            if period == 400 {
                assert_eq!(slipfit_ahead_restart(&mut c, &second, 2.0), SLIPFIT_OK);
                ahead = Ahead::new(slide(&second, 2.0), limits).unwrap();
                ahead.restart(&mut state);
            }
            let rust = ahead.step(&mut state);
            let status = slipfit_ahead_step(&mut c);
            assert_eq!(status, if rust.lead < 0.0 { SLIPFIT_BEHIND } else { SLIPFIT_OK });
            assert_eq!(slipfit_ahead_read(&c, &mut said), status);
            let slipfit_ahead_prediction { time, force, velocity, lead, tolerance, excess, forced } = said;
            let in_c = Prediction { time, force, speed: velocity, lead, tolerance, excess, forced };
            assert_eq!(in_c, rust, "{period}");
            let clock = (period as f32 - 69.0) * 1e-3;
            assert_eq!(time, if status == SLIPFIT_OK { clock } else { clock + lead });
        }
    }
}

#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn what_is_behind_the_clock_says_so() {
    // Too stiff for one attempt a period.
    let hard = slipfit_scene { stiffness: 3e7, friction_stick_band: 1e-5, ..regularised() };
    let limits = slipfit_ahead_limits { lag: 0.004, ..LIMITS };
    let (mut ahead, mut said) = (zeroed::<slipfit_ahead>(), zeroed::<slipfit_ahead_prediction>());
    let mut behind = 0;
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        assert_eq!(slipfit_ahead_init(&mut ahead, &hard, 2.5, &limits, 0), SLIPFIT_OK);
        for period in 1..300 {
            let status = slipfit_ahead_step(&mut ahead);
            assert_eq!(slipfit_ahead_read(&ahead, &mut said), status);
            let lag = period as f32 * 1e-3 - said.time;
            if status == SLIPFIT_BEHIND {
                behind += 1;
                assert!(lag > 0.0 && (lag + said.lead).abs() < 1e-6 && lag < 0.006, "{period} {said:?}");
            } else {
                assert!(status == SLIPFIT_OK && lag == 0.0, "{period} {said:?}");
            }
        }
    }
    assert!(behind > 50 && said.forced > 10, "{behind} {said:?}");
}

/// What cannot be made leaves nothing to step; what cannot be restarted goes on as it was.
#[test]
fn what_cannot_be_predicted_ahead_is_refused() {
    let (mut ahead, mut other) = (zeroed::<slipfit_ahead>(), zeroed::<slipfit_ahead>());
    let (mut said, mut same) = (zeroed::<slipfit_ahead_prediction>(), zeroed::<slipfit_ahead_prediction>());
    let exact = slipfit_scene { friction_law: SLIPFIT_FRICTION_EXACT, ..regularised() };
    let heavy = slipfit_scene { mass: f32::NAN, ..regularised() };
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        for (scene, n, limits, early, status) in [
            (&exact, 2.5, LIMITS, 70, SLIPFIT_LAW),
            (&heavy, 2.5, LIMITS, 70, SLIPFIT_PARAMETER),
            (&regularised(), 1e6, LIMITS, 70, SLIPFIT_PARAMETER),
            (&regularised(), 2.5, slipfit_ahead_limits { lead: 1e-3, ..LIMITS }, 70, SLIPFIT_PARAMETER),
            (&regularised(), 2.5, LIMITS, SLIPFIT_AHEAD_EARLY_MOST + 1, SLIPFIT_PARAMETER),
        ] {
            assert_eq!(slipfit_ahead_init(&mut ahead, &regularised(), 2.5, &LIMITS, 1000), SLIPFIT_OK);
            assert_eq!(slipfit_ahead_init(&mut ahead, scene, n, &limits, early), status);
            assert_eq!(slipfit_ahead_step(&mut ahead), SLIPFIT_NOT_MADE);
            assert_eq!(slipfit_ahead_read(&ahead, &mut said), SLIPFIT_NOT_MADE);
            assert_eq!(slipfit_ahead_restart(&mut ahead, &regularised(), 2.5), SLIPFIT_NOT_MADE);
        }
        for both in [&mut ahead, &mut other] {
            assert_eq!(slipfit_ahead_init(both, &regularised(), 2.5, &LIMITS, 0), SLIPFIT_OK);
        }
        for _ in 0..if cfg!(miri) { 3 } else { 50 } {
            assert_eq!(slipfit_ahead_restart(&mut ahead, &exact, 2.5), SLIPFIT_LAW);
            assert_eq!(slipfit_ahead_restart(&mut ahead, &heavy, 2.5), SLIPFIT_PARAMETER);
            assert_eq!(slipfit_ahead_step(&mut ahead), slipfit_ahead_step(&mut other));
            assert_eq!(slipfit_ahead_read(&ahead, &mut said), slipfit_ahead_read(&other, &mut same));
            assert_eq!(said, same);
        }
    }
}
