//! Prediction ahead of the clock.

use proptest::prelude::*;
use slipfit_capi::*;
use slipfit_core::{
    ahead::{Ahead, Limits, Prediction, State},
    drive::SetpointDrive,
    menu::FrictionData,
    pose::Pose,
};
use slipfit_problems::{
    arcs,
    cd_rom::{self, CdRomSlide},
};

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
            match step {
                5 => prop_assert_eq!(slipfit_ahead_follow(&mut ahead, 0.02), SLIPFIT_OK),
                10 => prop_assert_eq!(slipfit_ahead_restart(&mut ahead, scene, n), SLIPFIT_OK),
                15 => prop_assert_eq!(slipfit_ahead_rest(&mut ahead, 3), SLIPFIT_OK),
                _ => {}
            }
        }
    }
    Ok(())
}

/// What prediction ahead of the clock is held to here.
pub const LIMITS: slipfit_ahead_limits =
    slipfit_ahead_limits { period: 1e-3, tolerance: 7e-5, lead: 0.2, lag: 0.2, attempts: 1 };

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

/// The slide of a unit of `scene`.
pub fn slide(scene: &slipfit_scene, n: f32) -> CdRomSlide<f32> {
    let mut data = cd_rom::data(0.0f32);
    data.friction = FrictionData::Regularised { coefficient: 0.3, stick_band: scene.friction_stick_band };
    data.drive.speed = scene.drive_speed;
    for (gap, deviation) in data.body.gaps.iter_mut().zip(scene.gap_deviations) {
        *gap -= n * deviation;
    }
    cd_rom::from_data(&data)
}

/// Whether `c` says of a period what Rust says.
unsafe fn assert_is_rusts(c: &slipfit_ahead, status: slipfit_status, rust: Prediction<f32>, period: usize) {
    let mut said = zeroed::<slipfit_ahead_prediction>();
    assert_eq!(status, if rust.lead < 0.0 { SLIPFIT_BEHIND } else { SLIPFIT_OK });
    // SAFETY: both are there.
    assert_eq!(unsafe { slipfit_ahead_read(c, &mut said) }, status);
    let slipfit_ahead_prediction { time, force, velocity, position, deviation, lead, tolerance, excess, forced } = said;
    let in_c = Prediction { time, force, speed: velocity, position, deviation, lead, tolerance, excess, forced };
    assert_eq!(in_c, rust, "{period}");
    let clock = (period as f32 - 69.0) * 1e-3;
    assert_eq!(time, if status == SLIPFIT_OK { clock } else { clock + lead });
}

/// The same bits as in Rust, through a change of the unit, a planned command and one that is followed, and across a copy.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn a_prediction_ahead_of_the_clock_is_rusts() {
    let (first, second) = (regularised(), slipfit_scene { drive_speed: 0.05, ..regularised() });
    let slipfit_ahead_limits { period, tolerance, lead, lag, .. } = LIMITS;
    let limits = Limits { period, tolerance, lead, lag, attempts: 2 };
    let (one, other) = (slide(&first, 2.5), slide(&second, 2.0));
    let made =
        |of: &CdRomSlide<f32>| Ahead::new(of.driven_by(SetpointDrive::new(of.drive().gain)).unwrap(), limits).unwrap();
    let (mut ahead, mut ramp) = (made(&one), *one.drive());
    let mut state: State<f32, _, 6, 256> = ahead.at_rest(Pose::nominal(), 70, |t| ramp.command(t));
    let horizon = ahead.horizon(&state);
    let command = |period: usize| arcs(0.05, period as u32, 628);
    let (mut c, mut said) = (zeroed::<slipfit_ahead>(), zeroed::<slipfit_ahead_prediction>());
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        let limits = slipfit_ahead_limits { attempts: 2, ..LIMITS };
        assert_eq!(slipfit_ahead_init(&mut c, &first, 2.5, &limits, 70), SLIPFIT_OK);
        assert_eq!(slipfit_ahead_read(&c, &mut said), SLIPFIT_OK);
        assert_eq!((said.time, said.force, said.velocity, said.lead), (-0.07, 0.0, 0.0, 0.07));
        let mut periods = 0;
        assert_eq!(slipfit_ahead_horizon(&c, &mut periods), SLIPFIT_OK);
        assert_eq!(periods, horizon);
        for period in 0..1800 {
            match period {
                400 => {
                    assert_eq!(slipfit_ahead_restart(&mut c, &second, 2.0), SLIPFIT_OK);
                    (ahead, ramp) = (made(&other), *other.drive());
                    ahead.restart(&mut state);
                    ahead.plan_all(&mut state, |t| ramp.command(t));
                }
                // A copy is all of it.
                1000 => {
                    let copy = c;
                    assert_eq!(slipfit_ahead_rest(&mut c, 3), SLIPFIT_OK);
                    c = copy;
                }
                _ => {}
            }
            match period {
                0..800 => {
                    let speed = ramp.command(ahead.time(&state, horizon + 1));
                    assert!(ahead.plan(&mut state, horizon, speed));
                }
                800..1300 => {
                    assert!(ahead.plan(&mut state, horizon, command(period)));
                    assert_eq!(slipfit_ahead_plan(&mut c, horizon, command(period)), SLIPFIT_OK);
                }
                _ => {
                    ahead.follow(&mut state, command(period));
                    assert_eq!(slipfit_ahead_follow(&mut c, command(period)), SLIPFIT_OK);
                }
            }
            let rust = ahead.step(&mut state);
            let status = slipfit_ahead_step(&mut c);
            assert_is_rusts(&c, status, rust, period);
            for after in [0, 7, 20] {
                let mut force = 0.0;
                let found = slipfit_ahead_forecast(&c, after, &mut force);
                let forecast = ahead.forecast(&state, after);
                assert_eq!((found == SLIPFIT_OK).then_some(force), forecast, "{period}");
            }
        }
        // What is predicted already and what is beyond the horizon.
        assert_eq!(slipfit_ahead_plan(&mut c, 0, 0.0), SLIPFIT_LATE);
        assert_eq!(slipfit_ahead_plan(&mut c, horizon + 1, 0.0), SLIPFIT_PARAMETER);
        let mut force = 0.0;
        assert_eq!(slipfit_ahead_forecast(&c, 1000, &mut force), SLIPFIT_BEHIND);
        for wrong in [f32::NAN, f32::INFINITY, 1001.0] {
            assert_eq!(slipfit_ahead_plan(&mut c, horizon, wrong), SLIPFIT_PARAMETER);
            assert_eq!(slipfit_ahead_follow(&mut c, wrong), SLIPFIT_PARAMETER);
        }
        // Nothing has changed by what was refused.
        ahead.follow(&mut state, 0.01);
        assert_eq!(slipfit_ahead_follow(&mut c, 0.01), SLIPFIT_OK);
        let (rust, status) = (ahead.step(&mut state), slipfit_ahead_step(&mut c));
        assert_is_rusts(&c, status, rust, 1800);
        // At rest again it is as new.
        let mut new = zeroed::<slipfit_ahead>();
        assert_eq!(slipfit_ahead_rest(&mut c, 1001), SLIPFIT_PARAMETER);
        assert_eq!(slipfit_ahead_rest(&mut c, 50), SLIPFIT_OK);
        assert_eq!(slipfit_ahead_init(&mut new, &second, 2.0, &limits, 50), SLIPFIT_OK);
        for _ in 0..300 {
            assert_eq!(slipfit_ahead_step(&mut c), slipfit_ahead_step(&mut new));
            let mut same = said;
            assert_eq!(slipfit_ahead_read(&c, &mut said), slipfit_ahead_read(&new, &mut same));
            assert_eq!(said, same);
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
            (&regularised(), 2.5, slipfit_ahead_limits { attempts: 0, ..LIMITS }, 70, SLIPFIT_PARAMETER),
            (&regularised(), 2.5, slipfit_ahead_limits { attempts: u32::MAX, ..LIMITS }, 70, SLIPFIT_PARAMETER),
        ] {
            assert_eq!(slipfit_ahead_init(&mut ahead, &regularised(), 2.5, &LIMITS, 1000), SLIPFIT_OK);
            assert_eq!(slipfit_ahead_init(&mut ahead, scene, n, &limits, early), status);
            assert_eq!(slipfit_ahead_step(&mut ahead), SLIPFIT_NOT_MADE);
            assert_eq!(slipfit_ahead_read(&ahead, &mut said), SLIPFIT_NOT_MADE);
            assert_eq!(slipfit_ahead_restart(&mut ahead, &regularised(), 2.5), SLIPFIT_NOT_MADE);
            assert_eq!(slipfit_ahead_rest(&mut ahead, 3), SLIPFIT_NOT_MADE);
            assert_eq!(slipfit_ahead_plan(&mut ahead, 3, 0.1), SLIPFIT_NOT_MADE);
            assert_eq!(slipfit_ahead_follow(&mut ahead, 0.1), SLIPFIT_NOT_MADE);
            let (mut periods, mut force) = (0, 0.0);
            assert_eq!(slipfit_ahead_horizon(&ahead, &mut periods), SLIPFIT_NOT_MADE);
            assert_eq!(slipfit_ahead_forecast(&ahead, 3, &mut force), SLIPFIT_NOT_MADE);
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
