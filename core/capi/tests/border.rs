//! Whatever C passes is answered by a status, and whatever a function writes is finite.
#![allow(unsafe_code, reason = "calls the library as C does")]

mod common;

use std::ptr;

use common::zeroed;
use proptest::prelude::*;
use slipfit_capi::*;
use slipfit_core::{
    ahead::{Ahead, Limits, Prediction, State},
    menu::FrictionData,
    pose::Pose,
    table::{AxisKind, MotionVerdict, Table, layout, motions, verdict_bytes},
};
use slipfit_problems::cd_rom::{self, CdRomSlide};

/// What floating point has that a careless program trips over.
const SPECIAL: [f32; 14] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    1e30,
    -1e30,
    0.0,
    -0.0,
    f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    1e-40,
    1.0,
];

/// Floats of a scene.
const NUMBERS: usize = size_of::<slipfit_scene>() / size_of::<f32>();

fn scene() -> slipfit_scene {
    common::scene(if cfg!(feature = "exact") { SLIPFIT_FRICTION_EXACT } else { SLIPFIT_FRICTION_REGULARISED })
}

/// The scene with the bits of some of its numbers changed, its laws' numbers too.
fn changed(mut scene: slipfit_scene, changes: &[(usize, u32)]) -> slipfit_scene {
    for (place, bits) in changes {
        // SAFETY: every field is a word of four bytes, for which every value will do.
        unsafe { ptr::from_mut(&mut scene).cast::<u32>().add(place % NUMBERS).write(*bits) };
    }
    scene
}

/// Makes and steps a predictor: refused, or finite for ever.
fn stays_finite(scene: &slipfit_scene, n: f32) -> Result<(), TestCaseError> {
    let mut predictor = zeroed::<slipfit_predictor>();
    // SAFETY: every pointer is to a local of its type.
    unsafe {
        let made = slipfit_predictor_init(&mut predictor, scene, n);
        prop_assert!([SLIPFIT_OK, SLIPFIT_PARAMETER, SLIPFIT_LAW, SLIPFIT_STEP].contains(&made), "{made}");
        for _ in 0..20 {
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

/// A prediction ahead of the clock of `scene`, which is one with regularised friction wherever its law was not changed.
fn ahead_stays_finite(scene: &slipfit_scene, n: f32, limits: &slipfit_ahead_limits) -> Result<(), TestCaseError> {
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
const LIMITS: slipfit_ahead_limits = slipfit_ahead_limits { period: 1e-3, tolerance: 7e-5, lead: 0.2, lag: 0.2 };

fn regularised() -> slipfit_scene {
    common::scene(SLIPFIT_FRICTION_REGULARISED)
}

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
    for n in [500.0, 2e3, 1e4] {
        assert_eq!(made(&scene(), n), SLIPFIT_STEP, "{n}");
    }
    assert_eq!(made(&slipfit_scene { step: 1e-4, ..scene() }, 500.0), SLIPFIT_OK);
    assert_eq!(made(&scene(), 1e6), SLIPFIT_PARAMETER);
    for scheme in [0, 2, u32::MAX] {
        assert_eq!(made(&slipfit_scene { scheme, ..scene() }, 2.5), SLIPFIT_LAW);
    }
    let mut negative = scene();
    negative.gap_deviations[7] = -1e-9;
    assert_eq!(made(&negative, 2.5), SLIPFIT_PARAMETER);
}

/// A table in f32 whose values count up: along each axis its nodes and their distance, from 0 on.
fn table_over(axes: &[(AxisKind, u32, f32)]) -> Vec<u8> {
    let nodes: u32 = axes.iter().map(|(_, count, _)| count).product();
    let mut bytes = Vec::from(*b"SLFT");
    bytes.extend([3, 0, axes.len() as u8, 1]);
    bytes.extend(7u64.to_le_bytes());
    let motions = motions(axes.iter().map(|(_, count, _)| *count as usize)).unwrap();
    let length = layout::HEADER_SIZE + (nodes as usize + 1) * 8 + motions.next_multiple_of(4) + layout::CHECKSUM_SIZE;
    bytes.extend((length as u32).to_le_bytes());
    for (kind, count, step) in axes {
        bytes.extend([*kind as u8, 0, 0, 0]);
        bytes.extend(count.to_le_bytes());
        bytes.extend([0.0, *step].map(f32::to_le_bytes).concat());
    }
    bytes.resize(layout::CHANNELS_AT, 0);
    bytes.extend([1.0f32, 0.0, 0.0, 1.0, 0.0, 0.0].map(f32::to_le_bytes).concat());
    bytes.extend((0..2 * nodes).flat_map(|i| (i as f32).to_le_bytes()));
    bytes.extend([0; 8]);
    // The last motion jams, the others run.
    let mut verdicts = vec![MotionVerdict::Runs; motions];
    verdicts[motions - 1] = MotionVerdict::Jammed;
    bytes.extend(verdict_bytes(&verdicts, axes.get(2).map_or(1, |(_, count, _)| *count as usize)));
    bytes.resize(length - layout::CHECKSUM_SIZE, 0);
    sealed(bytes)
}

/// A table over 3 levels and 4 instants.
fn table() -> Vec<u8> {
    table_over(&[(AxisKind::Level, 3, 1.0), (AxisKind::Time, 4, 0.1)])
}

/// The table with its checksum at the end.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(layout::checksum(&bytes).to_le_bytes());
    bytes
}

/// Two slots, as long as the first.
fn slots(first: &'static [u8], second: &'static [u8], word: u32) -> slipfit_slots {
    slipfit_slots { first: first.as_ptr(), second: second.as_ptr(), length: first.len() as u32, word }
}

/// Everything that takes a table, with every number.
fn uses_of_a_table(bytes: &'static [u8], numbers: &[f32]) -> Result<slipfit_status, TestCaseError> {
    let mut table = zeroed::<slipfit_table>();
    let (mut monitor, mut bank) = (zeroed::<slipfit_monitor>(), zeroed::<slipfit_bank>());
    let (mut found, mut report, mut estimate) =
        (zeroed::<slipfit_lookup>(), zeroed::<slipfit_report>(), zeroed::<slipfit_estimate>());
    let (mut scrubber, mut rounds) = (zeroed::<slipfit_scrubber>(), 0);
    let at = |i: usize| numbers[i % numbers.len()];
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let opened = slipfit_table_open(&mut table, bytes.as_ptr(), bytes.len() as u32, SLIPFIT_AXIS_TIME, 7);
        let expected = if opened == SLIPFIT_OK { SLIPFIT_OK } else { SLIPFIT_NOT_MADE };
        for (i, n) in numbers.iter().enumerate() {
            prop_assert_eq!(slipfit_table_look_up(&table, *n, at(i + 1), &mut found), expected);
            prop_assert!(
                found.force.is_finite() && found.velocity.is_finite() && found.clamped.max(found.mixed) <= 1,
                "{found:?}"
            );
            let _ = slipfit_scrubber_init(&mut scrubber, &table);
            let _ = slipfit_scrubber_check(&mut scrubber, n.to_bits(), &mut rounds);
            let limits = slipfit_limits {
                period: at(i + 1),
                blind: at(i + 2),
                force_most: at(i + 3),
                hold: at(i + 4),
                smoothing: at(i + 5),
                band: at(i + 6),
                margin: at(i + 7),
                rise: at(i + 8),
            };
            let _ = slipfit_monitor_init(&mut monitor, &table, *n, &limits);
            let sample = slipfit_sample { time: *n, force: at(i + 1), speed: at(i + 2), command: at(i + 3) };
            if slipfit_monitor_step(&mut monitor, &sample, &mut report) == SLIPFIT_OK {
                prop_assert!(report.verdict <= SLIPFIT_JAM && report.expected.is_finite(), "{report:?}");
            }
            let _ = slipfit_bank_init(&mut bank, &table);
            for k in 0..40 {
                let _ = slipfit_bank_add(&mut bank, at(i + k), at(i * k));
            }
            if slipfit_bank_estimate(&bank, &mut estimate) == SLIPFIT_OK {
                let slipfit_estimate { low, level, high, .. } = estimate;
                prop_assert!(low <= level && level <= high && low.is_finite() && high.is_finite(), "{estimate:?}");
            }
        }
        Ok(opened)
    }
}

#[test]
fn special_numbers_in_every_call_with_a_table() {
    assert_eq!(uses_of_a_table(table().leak(), &SPECIAL).unwrap(), SLIPFIT_OK);
    // Within the table's grid too.
    assert_eq!(uses_of_a_table(table().leak(), &[0.1, 0.25, 1e-3, f32::NAN, 0.3, -0.0, 1e-45]).unwrap(), SLIPFIT_OK);
}

#[test]
fn every_short_length_is_refused() {
    let whole: &'static [u8] = table().leak();
    assert!(Table::<2>::open(whole).is_ok());
    for length in (0..whole.len()).step_by(if cfg!(miri) { 19 } else { 1 }) {
        let status = uses_of_a_table(&whole[..length], &[0.5]).unwrap();
        assert!([SLIPFIT_TABLE_TRUNCATED, SLIPFIT_TABLE_MAGIC].contains(&status), "{length}: {status}");
    }
}

#[test]
fn a_table_over_position_is_no_table_over_time() {
    assert_eq!([SLIPFIT_AXIS_TIME, SLIPFIT_AXIS_POSITION], [AxisKind::Time as u32, AxisKind::Position as u32]);
    let mut bytes = table_over(&[(AxisKind::Level, 3, 1.0), (AxisKind::Position, 4, 0.1)]);
    bytes.resize(bytes.len() + 8, 0xff);
    let bytes: &'static [u8] = bytes.leak();
    let length = bytes.len() as u32;
    let (mut table, mut found, mut spare) =
        (zeroed::<slipfit_table>(), zeroed::<slipfit_lookup>(), zeroed::<slipfit_spare>());
    let (mut monitor, mut bank, limits) =
        (zeroed::<slipfit_monitor>(), zeroed::<slipfit_bank>(), zeroed::<slipfit_limits>());
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let mut open = |over| {
            let opened = slipfit_table_open(&mut table, bytes.as_ptr(), length, over, 7);
            assert_eq!(slipfit_slots_open(&mut table, &slots(bytes, bytes, 1), over, 7, &mut spare), opened, "{over}");
            opened
        };
        assert_eq!(open(SLIPFIT_AXIS_TIME), SLIPFIT_TABLE_KIND);
        for none in [0, 1, 4, 5, u32::MAX] {
            assert_eq!(open(none), SLIPFIT_PARAMETER);
        }
        assert_eq!(open(SLIPFIT_AXIS_POSITION), SLIPFIT_OK);
        assert_eq!(slipfit_table_look_up(&table, 1.0, 0.1, &mut found), SLIPFIT_OK);
        assert_eq!(found, slipfit_lookup { force: 10.0, velocity: 11.0, clamped: 0, mixed: 0 });
        assert_eq!(slipfit_table_look_up(&table, 1.5, 0.1, &mut found), SLIPFIT_OK);
        assert_eq!(found, slipfit_lookup { force: 14.0, velocity: 15.0, clamped: 0, mixed: 1 });
        // What works on time does not take it.
        assert_eq!(slipfit_monitor_init(&mut monitor, &table, 1.0, &limits), SLIPFIT_TABLE_KIND);
        assert_eq!(slipfit_bank_init(&mut bank, &table), SLIPFIT_TABLE_KIND);
    }
}

#[test]
fn a_table_over_three_axes() {
    let axes = [(AxisKind::Level, 3, 1.0), (AxisKind::Position, 4, 0.1), (AxisKind::Velocity, 2, 0.05)];
    let bytes: &'static [u8] = table_over(&axes).leak();
    let length = bytes.len() as u32;
    let (mut plane, mut table) = (zeroed::<slipfit_table>(), zeroed::<slipfit_table3>());
    let (mut found, mut scrubber, mut rounds) = (zeroed::<slipfit_lookup>(), zeroed::<slipfit_scrubber>(), 0);
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let refused = slipfit_table_open(&mut plane, bytes.as_ptr(), length, SLIPFIT_AXIS_POSITION, 7);
        assert_eq!(refused, SLIPFIT_TABLE_AXES);
        assert_eq!(slipfit_table3_look_up(&table, 1.0, 0.1, 0.05, &mut found), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_scrubber_init3(&mut scrubber, &table), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_table3_open(&mut table, bytes.as_ptr(), length, 8), SLIPFIT_TABLE_SCENE);
        assert_eq!(slipfit_table3_open(&mut table, ptr::null(), length, 7), SLIPFIT_NULL);
        assert_eq!(slipfit_table3_open(&mut table, bytes.as_ptr(), length - 1, 7), SLIPFIT_TABLE_TRUNCATED);
        assert_eq!(slipfit_table3_open(&mut table, bytes.as_ptr(), length, 7), SLIPFIT_OK);
        assert_eq!(slipfit_table3_look_up(&table, 1.0, 0.1, 0.05, &mut found), SLIPFIT_OK);
        assert_eq!(found, slipfit_lookup { force: 22.0, velocity: 23.0, clamped: 0, mixed: 0 });
        assert_eq!(slipfit_table3_look_up(&table, 2.0, 0.1, 0.025, &mut found), SLIPFIT_OK);
        assert_eq!(found.mixed, 1);
        for special in SPECIAL {
            assert_eq!(slipfit_table3_look_up(&table, special, special, special, &mut found), SLIPFIT_OK);
            assert!(found.force.is_finite() && found.velocity.is_finite());
        }
        assert_eq!(slipfit_scrubber_init3(&mut scrubber, &table), SLIPFIT_OK);
        for _ in 0..4 {
            assert_eq!(slipfit_scrubber_check(&mut scrubber, length / 2, &mut rounds), SLIPFIT_OK);
        }
        assert_eq!(rounds, 2);
        let other = table_over(&[(AxisKind::Level, 3, 1.0), (AxisKind::Time, 4, 0.1), (AxisKind::Velocity, 2, 0.05)]);
        let other: &'static [u8] = other.leak();
        assert_eq!(slipfit_table3_open(&mut table, other.as_ptr(), length, 7), SLIPFIT_TABLE_KIND);
    }
}

#[test]
fn null_and_misaligned_pointers_are_refused() {
    let bytes: &'static [u8] = table().leak();
    let length = bytes.len() as u32;
    let (mut predictor, mut table) = (zeroed::<slipfit_predictor>(), zeroed::<slipfit_table>());
    let (mut monitor, mut bank) = (zeroed::<slipfit_monitor>(), zeroed::<slipfit_bank>());
    let (scene, limits, sample) = (scene(), zeroed::<slipfit_limits>(), zeroed::<slipfit_sample>());
    let (mut said, mut found, mut spare) =
        (zeroed::<slipfit_prediction>(), zeroed::<slipfit_lookup>(), zeroed::<slipfit_spare>());
    let (mut report, mut estimate) = (zeroed::<slipfit_report>(), zeroed::<slipfit_estimate>());
    let (mut scrubber, mut rounds, record) = (zeroed::<slipfit_scrubber>(), 0, zeroed::<slipfit_record>());
    let both = slots(bytes, bytes, 8);
    let neither = slipfit_slots { first: ptr::null(), second: ptr::null(), ..both };
    let mut other_bank = zeroed::<slipfit_bank>();
    let (mut ahead, mut other_ahead) = (zeroed::<slipfit_ahead>(), zeroed::<slipfit_ahead>());
    let mut said_ahead = zeroed::<slipfit_ahead_prediction>();
    // SAFETY: what is neither null nor misaligned points at locals.
    unsafe {
        assert_eq!(slipfit_predictor_init(&mut predictor, &scene, 2.5), SLIPFIT_OK);
        assert_eq!(slipfit_ahead_init(&mut ahead, &regularised(), 2.5, &LIMITS, 0), SLIPFIT_OK);
        assert_eq!(slipfit_table_open(&mut table, bytes.as_ptr(), length, SLIPFIT_AXIS_TIME, 7), SLIPFIT_OK);
        assert_eq!(slipfit_bank_init(&mut bank, &table), SLIPFIT_OK);
        assert_eq!(slipfit_scrubber_init(&mut scrubber, &table), SLIPFIT_OK);
        // Each call with one bad pointer.
        for (code, shift) in [(SLIPFIT_NULL, None), (SLIPFIT_MISALIGNED, Some(1))] {
            let bad = |pointer: *mut u8| shift.map_or(ptr::null_mut(), |by| pointer.wrapping_add(by));
            macro_rules! bad {
                ($place:expr) => {
                    bad(ptr::from_ref(&$place).cast_mut().cast()).cast()
                };
            }
            let answers = [
                slipfit_predictor_init(bad!(predictor), &scene, 2.5),
                slipfit_predictor_init(&mut predictor, bad!(scene), 2.5),
                slipfit_predictor_step(bad!(predictor)),
                slipfit_predictor_read(bad!(predictor), &mut said),
                slipfit_predictor_read(&predictor, bad!(said)),
                slipfit_ahead_init(bad!(ahead), &scene, 2.5, &LIMITS, 0),
                slipfit_ahead_init(&mut other_ahead, bad!(scene), 2.5, &LIMITS, 0),
                slipfit_ahead_init(&mut other_ahead, &scene, 2.5, bad!(LIMITS), 0),
                slipfit_ahead_step(bad!(ahead)),
                slipfit_ahead_read(bad!(ahead), &mut said_ahead),
                slipfit_ahead_read(&ahead, bad!(said_ahead)),
                slipfit_ahead_restart(bad!(ahead), &scene, 2.5),
                slipfit_ahead_restart(&mut ahead, bad!(scene), 2.5),
                slipfit_table_open(bad!(table), bytes.as_ptr(), length, SLIPFIT_AXIS_TIME, 7),
                slipfit_slots_open(bad!(table), &both, SLIPFIT_AXIS_TIME, 7, &mut spare),
                slipfit_slots_open(&mut table, bad!(both), SLIPFIT_AXIS_TIME, 7, &mut spare),
                slipfit_slots_open(&mut table, &both, SLIPFIT_AXIS_TIME, 7, bad!(spare)),
                slipfit_record_make(bad!(record), 8, 0),
                slipfit_table_look_up(bad!(table), 0.0, 0.0, &mut found),
                slipfit_table_look_up(&table, 0.0, 0.0, bad!(found)),
                slipfit_scrubber_init(bad!(scrubber), &table),
                slipfit_scrubber_init(&mut scrubber, bad!(table)),
                slipfit_scrubber_check(bad!(scrubber), 1, &mut rounds),
                slipfit_monitor_init(bad!(monitor), &table, 1.0, &limits),
                slipfit_monitor_init(&mut monitor, bad!(table), 1.0, bad!(limits)),
                slipfit_monitor_init(&mut monitor, &table, 1.0, bad!(limits)),
                slipfit_monitor_step(bad!(monitor), &sample, &mut report),
                slipfit_monitor_step(&mut monitor, bad!(sample), &mut report),
                slipfit_monitor_step(&mut monitor, &sample, bad!(report)),
                slipfit_bank_init(bad!(bank), &table),
                slipfit_bank_init(&mut other_bank, bad!(table)),
                slipfit_bank_add(bad!(bank), 0.0, 0.0),
                slipfit_bank_estimate(bad!(bank), &mut estimate),
                slipfit_bank_estimate(&bank, bad!(estimate)),
            ];
            for (i, answer) in answers.into_iter().enumerate() {
                assert_eq!(answer, code, "call {i}");
            }
        }
        for answer in [
            slipfit_table_open(&mut table, ptr::null(), length, SLIPFIT_AXIS_TIME, 7),
            slipfit_slots_open(&mut table, &neither, SLIPFIT_AXIS_TIME, 7, &mut spare),
        ] {
            assert_eq!(answer, SLIPFIT_NULL);
        }
    }
}

/// An update as C does it, on flash of every programming word.
#[test]
fn an_update_of_two_slots() {
    let axes = [(AxisKind::Level, 3, 1.0), (AxisKind::Time, 4, 0.1)];
    for word in [1, 2, 4, 8, 16, 32] {
        let old = table_over(&axes);
        let length = old.len().next_multiple_of(32) + 64;
        let (mut first, mut second) = (vec![0xff; length], vec![0xff; length]);
        first[..old.len()].copy_from_slice(&old);
        let (mut table, mut spare) = (zeroed::<slipfit_table>(), zeroed::<slipfit_spare>());
        let (mut record, mut found) = (zeroed::<slipfit_record>(), zeroed::<slipfit_lookup>());
        // SAFETY: every pointer is to a local of its type, and the bytes outlive the table.
        unsafe {
            let mut open = |first: &[u8], second: &[u8]| {
                let slots =
                    slipfit_slots { first: first.as_ptr(), second: second.as_ptr(), length: length as u32, word };
                assert_eq!(slipfit_slots_open(&mut table, &slots, SLIPFIT_AXIS_TIME, 7, &mut spare), SLIPFIT_OK);
                assert_eq!(slipfit_table_look_up(&table, 0.0, 0.0, &mut found), SLIPFIT_OK);
                (found.force, spare)
            };
            let room = length as u32 - word.max(8);
            assert_eq!(open(&first, &second), (0.0, slipfit_spare { slot: 1, sequence: 0, room }));
            second[..old.len()].copy_from_slice(&old);
            second[layout::HEADER_SIZE..][..4].copy_from_slice(&5.0f32.to_le_bytes());
            let checksum = layout::checksum(&second[..old.len() - 4]).to_le_bytes();
            second[old.len() - 4..old.len()].copy_from_slice(&checksum);
            assert_eq!(open(&first, &second).0, 0.0);
            assert_eq!(slipfit_record_make(&mut record, word, 0), SLIPFIT_OK);
            assert_eq!(record.size, word.max(8));
            second[length - record.size as usize..].copy_from_slice(&record.bytes[..record.size as usize]);
            assert_eq!(open(&first, &second), (5.0, slipfit_spare { slot: 0, sequence: 1, room }));
            // A slot that cannot be read: the other one counts.
            let slots = slipfit_slots { first: first.as_ptr(), second: ptr::null(), length: length as u32, word };
            assert_eq!(slipfit_slots_open(&mut table, &slots, SLIPFIT_AXIS_TIME, 7, &mut spare), SLIPFIT_OK);
            assert_eq!(spare, slipfit_spare { slot: 1, sequence: 0, room });
        }
    }
}

#[test]
fn slots_that_do_not_open_leave_nothing_open_and_say_nothing() {
    let bytes: &'static [u8] = table().leak();
    let (mut table, mut found) = (zeroed::<slipfit_table>(), zeroed::<slipfit_lookup>());
    let untouched = slipfit_spare { slot: 77, sequence: 78, room: 79 };
    let both = slots(bytes, bytes, 8);
    let erased: &'static [u8] = &[0xff; 400];
    let null = ptr::null();
    for (slots, over, hash, status) in [
        // Table and record do not fit.
        (both, SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_SLOT),
        (slots(erased, erased, 8), SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_MAGIC),
        (both, SLIPFIT_AXIS_POSITION, 7, SLIPFIT_TABLE_KIND),
        (both, 0, 7, SLIPFIT_PARAMETER),
        (both, SLIPFIT_AXIS_TIME, 8, SLIPFIT_TABLE_SCENE),
        (slipfit_slots { word: 0, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_PARAMETER),
        (slipfit_slots { word: 24, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_PARAMETER),
        (slipfit_slots { word: 64, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_PARAMETER),
        (slipfit_slots { length: 10, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_TRUNCATED),
        (slipfit_slots { first: null, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_SLOT),
        (slipfit_slots { second: null, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_SLOT),
        (slipfit_slots { first: null, second: null, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_NULL),
    ] {
        // SAFETY: every pointer is to a local of its type, and the bytes stay.
        unsafe {
            let opened = slipfit_table_open(&mut table, bytes.as_ptr(), bytes.len() as u32, SLIPFIT_AXIS_TIME, 7);
            assert_eq!(opened, SLIPFIT_OK);
            let mut spare = untouched;
            assert_eq!(slipfit_slots_open(&mut table, &slots, over, hash, &mut spare), status);
            assert_eq!(spare, untouched);
            assert_eq!(slipfit_table_look_up(&table, 0.0, 0.0, &mut found), SLIPFIT_NOT_MADE);
            // Nor if what it says has nowhere to go.
            let _ = slipfit_table_open(&mut table, bytes.as_ptr(), bytes.len() as u32, SLIPFIT_AXIS_TIME, 7);
            assert_eq!(slipfit_slots_open(&mut table, &slots, over, hash, ptr::null_mut()), SLIPFIT_NULL);
            assert_eq!(slipfit_table_look_up(&table, 0.0, 0.0, &mut found), SLIPFIT_NOT_MADE);
        }
    }
}

/// The check is an object of its own: the table is only read, while an interrupt looks it up as well as by the check itself.
#[test]
fn a_scrubber_finds_what_changes_and_counts_its_rounds() {
    let mut bytes = table();
    let length = bytes.len();
    let (mut table, mut scrubber, mut rounds) = (zeroed::<slipfit_table>(), zeroed::<slipfit_scrubber>(), 41u32);
    let pointer = bytes.as_mut_ptr();
    // SAFETY: every pointer is to a local of its type, and the bytes outlive the table; only a raw pointer changes them, while
    // no call is under way.
    unsafe {
        assert_eq!(slipfit_table_open(&mut table, pointer, length as u32, SLIPFIT_AXIS_TIME, 7), SLIPFIT_OK);
        assert_eq!(slipfit_scrubber_check(&mut scrubber, 1, &mut rounds), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_scrubber_init(&mut scrubber, &table), SLIPFIT_OK);
        let mut found = zeroed::<slipfit_lookup>();
        let mut round = |most: u32| {
            let before = rounds;
            loop {
                assert_eq!(slipfit_table_look_up(&table, 1.0, 0.1, &mut found), SLIPFIT_OK);
                let status = slipfit_scrubber_check(&mut scrubber, most, &mut rounds);
                if rounds != before {
                    assert_eq!(rounds, before + 1);
                    return status;
                }
                assert_eq!(status, SLIPFIT_OK);
            }
        };
        for most in [0, 1, 64, u32::MAX] {
            assert_eq!(round(most), SLIPFIT_OK);
        }
        // In the data, and in the stored checksum. Flash changes by itself; an interpreter of Rust calls that undefined.
        for place in [layout::HEADER_SIZE, length - 1].into_iter().take(if cfg!(miri) { 0 } else { 2 }) {
            *pointer.add(place) ^= 1;
            assert_eq!(round(64), SLIPFIT_TABLE_CHECKSUM);
            *pointer.add(place) ^= 1;
            assert_eq!(round(64), SLIPFIT_OK);
        }
        assert_eq!(rounds, 41 + if cfg!(miri) { 4 } else { 8 });
        assert_eq!(slipfit_scrubber_check(&mut scrubber, 1, ptr::null_mut()), SLIPFIT_NULL);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(if cfg!(miri) { 4 } else { 2000 }) })]

    #[test]
    fn any_scene_is_refused_or_stays_finite(
        changes in prop::collection::vec((0..NUMBERS, any::<u32>()), 0..6),
        n in any::<f32>(),
    ) {
        stays_finite(&changed(scene(), &changes), n)?;
        ahead_stays_finite(&changed(regularised(), &changes), n, &LIMITS)?;
    }

    #[test]
    fn any_table_is_refused_or_gives_finite_numbers(
        changes in prop::collection::vec((0usize..188, any::<u8>()), 0..4),
        numbers in prop::collection::vec(any::<f32>(), 1..12),
    ) {
        let mut bytes = table();
        bytes.truncate(bytes.len() - layout::CHECKSUM_SIZE);
        for (place, byte) in changes {
            bytes[place] = byte;
        }
        uses_of_a_table(sealed(bytes).leak(), &numbers)?;
    }
}
