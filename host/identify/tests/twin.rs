//! A synthetic twin of a measured drive: its parameters are found again, and their deviations are right.

use slipfit_core::sampling::stream::unit_stream;
use slipfit_identify::{
    drive_train::{DriveTrain, Options, Term, filtered},
    estimate::{Estimate, estimate},
    fit::{self, Loss},
    record::Record,
};
use slipfit_tolerance::failure::subset::normals;

/// Mass (kg), viscous (N·s/m) and Coulomb friction (N), offset (N).
const TRUE: [f64; 4] = [95.11, 203.5, 20.39, -3.165];
/// Samples a second.
const RATE: f64 = 1000.0;
const SAMPLES: usize = 24_841;

/// The commanded position (m): strokes of a quarter of a metre to and fro, each faster than the one before, by fifth-order polynomials.
fn command(t: f64) -> f64 {
    let (mut start, mut from, mut to) = (0.0, 0.0, 0.25);
    for stroke in 0.. {
        let length = [3.2, 2.4, 1.6, 1.0][stroke % 4];
        if t < start + length {
            let x = ((t - start) / (0.9 * length)).min(1.0);
            return from + (to - from) * x * x * x * (10.0 + x * (6.0 * x - 15.0));
        }
        start += length;
        (from, to) = (to, from);
    }
    from
}

/// Position (m) and force (N) of the twin under its position and speed loops, which hold the force for 1 ms; integrated by steps of 20 µs.
fn twin() -> [Vec<f64>; 2] {
    let [mass, viscous, coulomb, offset] = TRUE;
    let (mut position, mut speed) = (0.0, 0.0);
    let [mut positions, mut forces] = [Vec::new(), Vec::new()];
    let step = 2e-5;
    for k in 0..SAMPLES {
        let voltage: f64 = 243.45 * (160.18 * (command(k as f64 / RATE) - position) - speed);
        let force = 35.1507 * voltage.clamp(-10.0, 10.0);
        positions.push(position);
        forces.push(force);
        for _ in 0..50 {
            let push = force - offset - viscous * speed;
            let moved = speed + step / mass * (push - coulomb * f64::signum(if speed == 0.0 { push } else { speed }));
            // Friction stops, and does not turn around; from rest it yields only to more than itself.
            let rests = (speed == 0.0 && push.abs() <= coulomb) || moved * speed < 0.0;
            let next = if rests { 0.0 } else { moved };
            position += 0.5 * step * (speed + next);
            speed = next;
        }
    }
    [positions, forces]
}

/// First-order autoregressive noise of a standard `deviation`.
fn coloured(seed: u64, count: usize, correlation: f64, deviation: f64) -> Vec<f64> {
    let own = deviation * libm::sqrt(1.0 - correlation * correlation);
    let mut x = 0.0;
    let next = |score: f64| {
        x = correlation * x + own * score;
        x
    };
    normals(&mut unit_stream(seed, 7), count + 500).into_iter().map(next).skip(500).collect()
}

/// The record with the noise of this `seed`, its position rounded to an encoder's steps of 0.1 µm.
fn record([position, force]: &[Vec<f64>; 2], seed: u64, correlation: f64) -> Record {
    let noise = coloured(seed, force.len(), correlation, 2.0);
    Record {
        name: "twin".into(),
        start: 0.0,
        step: 1.0 / RATE,
        samples: position.len(),
        position: Some(position.iter().map(|position| (position * 1e7).round() / 1e7).collect()),
        speed: None,
        force: Some(force.iter().zip(noise).map(|(force, noise)| force + noise).collect()),
    }
}

fn estimated(record: &Record, terms: &[Term]) -> Estimate {
    let run = filtered(record, &Options { cutoff: None });
    let options = fit::Options { loss: Loss::Squares, ..fit::Options::default() };
    estimate(&DriveTrain::new(terms, &[run]), &options).expect("an estimate")
}

/// How many of `repeats` estimates lie within two deviations of the truth, parameter by parameter.
fn within(repeats: u64, correlation: f64) -> [usize; 4] {
    let twin = twin();
    let mut count = [0; 4];
    for seed in 0..repeats {
        let found = estimated(&record(&twin, seed, correlation), &Term::SYMMETRIC_DELAYED);
        for (i, parameter) in found.parameters.iter().take(4).enumerate() {
            let off = parameter.value - TRUE[i];
            count[i] += usize::from(off.abs() <= 2.0 * parameter.deviation.expect("determined"));
        }
    }
    count
}

#[test]
fn parameters_are_found_within_two_deviations() {
    let count = within(12, 0.98);
    assert!(count.iter().all(|count| *count >= 10), "{count:?}");
}

#[test]
#[ignore = "200 records with each of two noises take half a minute"]
fn deviations_hold_in_92_to_98_percent() {
    for correlation in [0.9, 0.98] {
        let count = within(200, correlation);
        println!("correlation {correlation}: {count:?} of 200");
        assert!(count.iter().all(|count| (184..=196).contains(count)), "{correlation}: {count:?}");
    }
}
