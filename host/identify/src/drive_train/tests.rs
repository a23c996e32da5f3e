//! What records of a drive train determine.
#![cfg(test)]

use slipfit_core::sampling::stream::unit_stream;
use slipfit_tolerance::failure::subset::normals;

use super::{DriveTrain, Options, Term, filtered};
use crate::{
    estimate::{Estimate, EstimateError, estimate},
    fit::{self, Loss},
    record::Record,
};

/// Two seconds at 1 kHz with this speed (m/s) over time, and this force.
fn record(speed: impl Fn(f64) -> f64, force: Option<Vec<f64>>) -> Record {
    let speeds = (0..2000).map(|i| speed(1e-3 * f64::from(i))).collect();
    Record { name: "run".into(), start: 0.0, step: 1e-3, samples: 2000, position: None, speed: Some(speeds), force }
}

fn estimated(record: &Record, terms: &[Term]) -> Result<Estimate, EstimateError> {
    let options = fit::Options { loss: Loss::Squares, ..fit::Options::default() };
    estimate(&DriveTrain::new(terms, &[filtered(record, &Options { cutoff: None })]), &options)
}

/// The mean of white noise of deviation σ has the deviation σ/√n.
#[test]
fn constant_speed_gives_the_friction_with_its_textbook_error() {
    let noise = normals(&mut unit_stream(11, 0), 2000);
    let mean = 4.0 + noise.iter().sum::<f64>() / 2000.0 * 0.5;
    let force = noise.iter().map(|score| 4.0 + 0.5 * score).collect();
    let found = estimated(&record(|_| 0.1, Some(force)), &[Term::Coulomb]).expect("an estimate");
    let friction = &found.parameters[0];
    let textbook = 0.5 / libm::sqrt(2000.0);
    assert!((friction.value - mean).abs() < 0.3 * textbook, "{} {mean}", friction.value);
    let deviation = friction.deviation.expect("determined");
    assert!((0.85..1.5).contains(&(deviation / textbook)), "{deviation} {textbook}");
}

#[test]
fn constant_speed_determines_only_a_sum() {
    let force = normals(&mut unit_stream(12, 0), 2000).iter().map(|score| 4.0 + 0.1 * score).collect();
    let found = estimated(&record(|_| 0.1, Some(force)), &[Term::Coulomb, Term::Offset]).expect("an estimate");
    assert_eq!(found.undetermined, ["coulomb and offset only as a sum"]);
    assert!(found.parameters.iter().all(|parameter| parameter.deviation.is_none()));
    let sum: f64 = found.parameters.iter().map(|parameter| parameter.value).sum();
    assert!((sum - 4.0).abs() < 0.02, "{sum}");
}

#[test]
fn a_mass_that_is_not_accelerated_is_an_error() {
    let force = normals(&mut unit_stream(13, 0), 2000).iter().map(|score| 4.0 + 0.1 * score).collect();
    let error = estimated(&record(|_| 0.1, Some(force)), &[Term::Mass, Term::Coulomb]).expect_err("no influence");
    assert!(error.to_string().starts_with("mass has no influence"), "{error}");
}

/// v′ = −(viscous·v + coulomb)/mass has the solution v = (v₀ + c/d)·exp(−d·t) − c/d.
#[test]
fn a_drive_that_coasts_gives_ratios_to_the_mass() {
    let [viscous, coulomb] = [0.8, 0.1];
    let speed = |t: f64| (0.5 + coulomb / viscous) * libm::exp(-viscous * t) - coulomb / viscous;
    let found = estimated(&record(speed, None), &[Term::Mass, Term::Viscous, Term::Coulomb]).expect("an estimate");
    let names: Vec<_> = found.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    assert_eq!(names, ["viscous / mass", "coulomb / mass"]);
    for (parameter, truth) in found.parameters.iter().zip([viscous, coulomb]) {
        assert!((parameter.value / truth - 1.0).abs() < 2e-3, "{} {}", parameter.name, parameter.value);
    }
}

#[test]
fn friction_by_direction_is_told_apart() {
    let speed = |t: f64| libm::sin(8.0 * t);
    let force = (0..2000)
        .map(|i| 1e-3 * f64::from(i))
        .map(|t| {
            2.0 * 8.0 * libm::cos(8.0 * t) + if speed(t) > 0.0 { 5.0 + 3.0 * speed(t) } else { -4.0 + 1.0 * speed(t) }
        })
        .collect();
    let found = estimated(&record(speed, Some(force)), &Term::BY_DIRECTION).expect("an estimate");
    for (parameter, truth) in found.parameters.iter().zip([2.0, 3.0, 5.0, 1.0, 4.0]) {
        assert!((parameter.value - truth).abs() < 0.02, "{} {}", parameter.name, parameter.value);
    }
}

/// One sample in twenty is wrong by ten deviations: the estimate moves by less than half of its own deviation.
#[test]
fn outliers_do_not_count() {
    let speed = |t: f64| libm::sin(8.0 * t);
    let noise = normals(&mut unit_stream(14, 0), 2000);
    let clean: Vec<f64> = (0..2000)
        .map(|i| (1e-3 * i as f64, 0.3 * noise[i]))
        .map(|(t, noise)| 16.0 * libm::cos(8.0 * t) + 3.0 * speed(t) + noise)
        .collect();
    let mut spoilt = clean.clone();
    spoilt.iter_mut().skip(7).step_by(20).for_each(|force| *force += 3.0);
    let terms = [Term::Mass, Term::Viscous, Term::Offset];
    let [clean, spoilt] =
        [clean, spoilt].map(|force| estimated(&record(speed, Some(force)), &terms).expect("an estimate"));
    for (with, without) in spoilt.parameters.iter().zip(&clean.parameters) {
        let deviation = without.deviation.expect("determined");
        assert!((with.value - without.value).abs() < 0.5 * deviation, "{} {} {deviation}", with.value, without.value);
    }
}
