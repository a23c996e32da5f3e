//! A kernel corrected by a noisy speed, on units whose friction and play the kernel does not know.
//!
//! `cargo test --release -p slipfit-problems --test observer -- --nocapture` prints what the guide says of it.

use slipfit_core::{
    drive::{Commandable as _, Push as _},
    integrator::{ImplicitEuler, Rodas4},
    kernel::Kernel,
    menu::{FrictionData, SlideData},
    observer::{Noise, Observer},
    pose::Pose,
    sampling::{
        normal::score,
        stream::{Rng as _, unit_stream},
    },
};
use slipfit_problems::cd_rom::{self, CdRomSlide};

/// Standard deviation of the measured speed (m/s): 2 % of the greatest force over the gain.
const SPEED: f64 = 0.02 * 1.0 / 40.0;

/// A stroke that takes 1.45 s, and when its ramp is over.
const PERIODS: [usize; 2] = [200, 1450];

fn real(n: f64, friction: f64) -> SlideData<f64> {
    let mut data = cd_rom::data::<f64>(n);
    let FrictionData::Regularised { coefficient, .. } = &mut data.friction else { unreachable!() };
    *coefficient *= friction;
    data.drive.ramp_end = 0.15;
    data
}

/// Root of the mean square.
fn rms(errors: &[f64]) -> f64 {
    libm::sqrt(errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64)
}

/// Errors of force (N, rms) without a measurement, of the measured speed alone, and of both; the force that the model lacks at the end (N).
fn errors(real: &SlideData<f64>, force: f64) -> ([f64; 3], f64) {
    let slide: CdRomSlide<f64> = cd_rom::from_data(real);
    let unit = Kernel::<f64, _, Rodas4>::new(slide, 1e-4).expect("in bounds");
    let mut unit_state = unit.at_rest(Pose::nominal());

    let mut nominal: SlideData<f64> = cd_rom::data(2.0);
    nominal.drive.ramp_end = 0.15;
    let (gain, mass) = (nominal.drive.gain, nominal.body.mass);
    let model: CdRomSlide<f32> = cd_rom::from_data(&nominal.cast(|x| x as f32));
    let free = Kernel::<f32, _, ImplicitEuler<4>>::new(model, 1e-3).expect("in bounds");
    let mut corrected = free;
    let [mut free_state, mut state] = [free.at_rest(Pose::nominal()); 2];
    let noise = Noise { speed: SPEED as f32, force: force as f32 };
    let mut observer = Observer::new(gain as f32, mass as f32, 1e-3, noise, 4.0).expect("in bounds");
    let mut random = unit_stream(7, 0);
    let mut found = [const { Vec::new() }; 3];
    for period in 1..=PERIODS[1] {
        for _ in 0..10 {
            let _ = unit.step(&mut unit_state);
        }
        let (time, speed) = (period as f64 * 1e-3, unit_state.motion.velocity.z);
        let truth = slide.drive().effort(time, speed);
        let measured = speed + SPEED * score::<f64>(random.next_u64());

        let _ = free.step(&mut free_state);
        let command = truth / gain + speed;
        corrected.mechanism_mut().drive_mut().set_command(observer.command(command as f32));
        let _ = corrected.step(&mut state);
        state.motion.velocity.z += observer.correct(state.motion.velocity.z, measured as f32);
        if period > PERIODS[0] {
            let speeds = [f64::from(free_state.motion.velocity.z), measured, f64::from(state.motion.velocity.z)];
            for (found, speed) in found.iter_mut().zip(speeds) {
                found.push(gain * (command - speed) - truth);
            }
        }
    }
    (found.map(|errors| rms(&errors)), f64::from(observer.missing()))
}

/// What the force that is missing changes by in a step (N).
const FORCE: f64 = 0.01;

#[test]
fn it_is_better_than_the_model_and_the_sensor() {
    let mut rows = Vec::new();
    for (unit, n, friction) in [
        ("as its model", 2.0, 1.0),
        ("play of n = 1.5", 1.5, 1.0),
        ("friction 10 % higher", 2.0, 1.1),
        ("friction 20 % higher", 2.0, 1.2),
        ("friction 20 % lower", 2.0, 0.8),
    ] {
        let ([model, sensor, observed], missing) = errors(&real(n, friction), FORCE);
        rows.push(format!("| {unit} | {model:.3} N | {sensor:.3} N | {observed:.3} N | {missing:.2} N |"));
        assert!(observed < 0.8 * sensor && observed < 1.05 * model, "{rows:?}");
        // Friction is almost all of the force: what is missing is its share.
        let more = (friction - 1.0) * -1.33;
        assert!((missing - more).abs() < 0.04, "{rows:?} {more}");
    }
    // The unit jams where its model runs: its force rises to four times the model's.
    let ([model, sensor, observed], _) = errors(&real(3.0, 1.0), FORCE);
    rows.push(format!("| jams (n = 3) | {model:.3} N | {sensor:.3} N | {observed:.3} N | |"));
    assert!(observed < 1.6 * sensor && observed < 0.02 * model, "{rows:?}");
    println!("{}", rows.join("\n"));
    let page = include_str!("../../../host/guide/src/firmware.md");
    for row in rows {
        assert!(page.contains(&row), "not in the guide: {row}");
    }
}

/// Whatever noise is stated, it is not worse than the sensor.
#[test]
fn noise_that_is_stated_wrong_costs_little() {
    for force in [1e-3, 3e-3, 3e-2, 0.1, 1.0] {
        for friction in [0.8, 1.0, 1.2] {
            let ([_, sensor, observed], _) = errors(&real(2.0, friction), force);
            assert!(observed < sensor, "{force} {friction}: {observed} {sensor}");
        }
    }
}
