//! Friction at rest, creeping, and locking, against closed forms.

use slipfit_core::{
    Vector3,
    integrator::{Extrapolated, ImplicitEuler, Integrator, Sdirk2},
    kernel::{Kernel, StateOf},
    law::{Exact, Friction, Regularised, ThreeHalves},
    menu::SlideData,
    pose::Pose,
    slide::{ABSENT, Slide},
};
use slipfit_problems::cd_rom;

type SlideWith<F> = Slide<f64, ThreeHalves<f64>, F>;

const COEFFICIENT: f64 = 0.3;

/// The slide with free gaps on its sides, hanging on its rails alone, pushed by a steady `share` of the friction μ·m·g.
fn loaded(share: f64) -> SlideData<f64> {
    let mut data = cd_rom::data(-3.0);
    // Even rails, so that the slide does not hang askew and gravity has no part along them.
    for gaps in data.body.gaps.as_chunks_mut::<4>().0 {
        gaps[2] = 0.0;
    }
    // A gain so small that the speed of a creeping slide takes nothing off the load.
    data.drive.gain = 1e-3;
    data.drive.speed = share * COEFFICIENT * data.body.mass * 9.81 / data.drive.gain;
    data.drive.ramp_end = data.drive.ramp_start + 1e-3;
    data
}

/// The state after `duration` (s) and the last step at which any bit of the motion changed.
fn settled<I: Integrator, F: Friction<f64>>(
    slide: SlideWith<F>,
    step: f64,
    duration: f64,
) -> (StateOf<f64, SlideWith<F>, 6>, u32) {
    let kernel = Kernel::<f64, _, I>::new(slide, step).unwrap();
    let mut state = kernel.at_rest(Pose::nominal());
    let mut changed = 0;
    for _ in 0..(duration / step).round() as u32 {
        let before = state.motion;
        let _ = kernel.step(&mut state);
        if before != state.motion {
            changed = state.steps;
        }
    }
    (state, changed)
}

fn holds<I: Integrator>(step: f64) {
    let (state, changed) =
        settled::<I, _>(cd_rom::with_friction(&loaded(0.99), Exact::new(COEFFICIENT).unwrap()), step, 10.0);
    let (z, v) = (state.motion.pose.displacement_w.z, state.motion.velocity.z);
    eprintln!("0.99: last change at {:.3} s, z {z:e} m, v {v:e} m/s", f64::from(changed) * step);
    assert!(f64::from(changed) * step <= 0.155, "still moving: {:?}", state.motion.velocity);
    assert!(v.abs() < 1e-12 && z.abs() < 2e-6, "{z} {v}");
    let (state, _) = settled::<I, _>(cd_rom::with_friction(&loaded(1.01), Exact::new(COEFFICIENT).unwrap()), step, 0.5);
    // 1 % of the load accelerates the slide by 0.03 m/s².
    let v = state.motion.velocity.z;
    assert!(v > 5e-3, "{v}");
}

#[test]
fn exact_friction_holds_below_breakaway_without_any_change_and_moves_above() {
    holds::<ImplicitEuler<4>>(1e-3);
    holds::<ImplicitEuler<4>>(2.5e-4);
    holds::<Sdirk2<4>>(1e-3);
    holds::<Extrapolated<2, 4>>(1e-3);
}

/// At steps so short that a force makes less of a velocity than rounding at 1 ms takes away, f32 moves as it should, either way.
#[test]
fn exact_friction_does_not_freeze_at_short_steps() {
    for share in [0.1f32, -0.1] {
        for step in [1e-6f32, 1e-7, 1e-8] {
            let mut data = cd_rom::data(-3.0f32);
            for gaps in data.body.gaps.as_chunks_mut::<4>().0 {
                gaps[2] = 0.0;
            }
            let acceleration = share * COEFFICIENT as f32 * 9.81;
            data.drive.gain = 1e-3;
            data.drive.speed = acceleration * data.body.mass / data.drive.gain;
            (data.drive.ramp_start, data.drive.ramp_end) = (-2.0, -1.0);
            let slide = cd_rom::with_friction(&data, Exact::new(COEFFICIENT as f32).unwrap());
            let kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(slide, step).unwrap();
            let mut state = kernel.at_rest(Pose::nominal());
            for _ in 0..100 {
                let _ = kernel.step(&mut state);
            }
            // Its rails carry nothing yet.
            let velocity = state.motion.velocity;
            let [along, down] = [velocity.z / (100.0 * step), velocity.y / (100.0 * step)];
            assert!((along / acceleration - 1.0).abs() < 0.01, "{share} {step}: {along} {acceleration}");
            assert!((down / -9.81 - 1.0).abs() < 0.01, "{share} {step}: {down}");
        }
    }
}

#[test]
fn regularised_friction_creeps_as_its_law_says() {
    for share in [0.1, 0.5, 0.9, 0.99] {
        let law = Regularised::new(COEFFICIENT, cd_rom::STICK_BAND).unwrap();
        let (state, _) = settled::<Sdirk2<4>, _>(cd_rom::with_friction(&loaded(share), law), 1e-3, 0.5);
        let u = state.motion.velocity.z / cd_rom::STICK_BAND;
        // As it moves off, its weight leaves the middle of its pins and it tilts by a few µrad: gravity helps by that much.
        let tilt = 2.0 * state.motion.pose.orientation.v.x;
        let (found, expected) = ((3.0 * u - u * u * u) / 2.0, share + tilt / COEFFICIENT);
        assert!((found - expected).abs() <= 1e-6 * expected, "{share}: {found} {expected}");
    }
}

/// Distance of the two guiding contacts (m), and of the drive from their line.
const GUIDE: [f64; 2] = [0.036, 0.062];

/// Whether a slide locks that two pins guide across, on the line of its centre of mass, and a drive pushes beside it.
fn locks(coefficient: f64) -> bool {
    let [length, distance] = GUIDE;
    let mut data = cd_rom::data(0.0);
    data.body.gaps = [ABSENT; 16];
    for (pin, z) in [(0, -length / 2.0), (2, length / 2.0)] {
        data.body.pins_w[pin] = Vector3::new(0.0, 0.0, z);
        data.body.gaps[4 * pin] = 0.0;
        data.body.gaps[4 * pin + 1] = 0.0;
    }
    data.body.gravity_w = Vector3::zeros();
    data.drive.point_b = Vector3::new(distance, 0.0, 0.0);
    data.drive.ramp_start = 0.0;
    data.drive.ramp_end = 0.05;
    data.drive.speed = 0.02;
    let (state, _) =
        settled::<Sdirk2<4>, _>(cd_rom::with_friction(&data, Exact::new(coefficient).unwrap()), 1e-4, 0.15);
    state.motion.velocity.z < 1e-3
}

#[test]
fn a_drawer_locks_at_the_friction_that_its_geometry_says() {
    let (mut runs, mut jams) = (0.2, 0.4);
    assert!(!locks(runs) && locks(jams));
    while jams - runs > 1e-4 {
        let middle = (runs + jams) / 2.0;
        if locks(middle) { jams = middle } else { runs = middle }
    }
    let critical = GUIDE[0] / (2.0 * GUIDE[1]);
    eprintln!("locks at {jams:.4}, rule {critical:.4}");
    assert!((jams - critical).abs() <= 1e-3, "{jams} {critical}");
}
