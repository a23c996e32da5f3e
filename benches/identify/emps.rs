//! What identification makes of the record of EMPS, beside what is published.

use std::path::Path;

use slipfit::{
    identify::{MotionModel, Subject},
    scene::SceneFile,
};
use slipfit_identify::{
    compare::compare,
    drive_train::{DriveTrain, LAWS, Options, filtered},
    estimate::{Estimate, estimate},
    fit::{self, Loss},
    model::Model,
    record::{Columns, Needs, Record, read_file},
};

/// Mass (kg), viscous (N·s/m) and Coulomb friction (N) and offset (N), as published, and by which share each may differ.
const PUBLISHED: [(&str, f64, f64); 4] =
    [("mass", 95.1089, 0.02), ("viscous", 203.5034, 0.04), ("coulomb", 20.3935, 0.02), ("offset", -3.1648, 0.02)];
/// Standard errors by a block bootstrap with blocks of 1 s, in the same order.
const ERRORS: [f64; 4] = [0.20, 7.2, 0.52, 0.23];
/// Greatest relative error of the simulated force; 8.94 % is published.
const SIMULATED: f64 = 0.095;

/// The drive under its position loop, with what is sought of it; the record is at `path`.
fn scene(path: &str) -> String {
    format!(
        r#"
title = "EMPS"
mechanism = {{ space = "plane" }}
run = {{ duration = 24840 }}
[[body]]
name = "stage"
mass = "95.1089 kg"
inertia = 1e6
centre = [0, 0]
[[joint]]
name = "guide"
kind = "prismatic"
between = ["frame", "stage"]
at = [0, 0]
axis = [1, 0]
[[drive]]
name = "motor"
pushes = "stage"
axis = [1, 0]
gain = "8557.438 N·s/m"
position_gain = 160.18
sampling = 0.001
measures = "position"
limit = 351.507
viscous = "203.5034 N·s/m"
coulomb = 20.3935
stick_band = 0.1
offset = -3.1648
record = {{ file = {path:?}, position = "reference position" }}
[identify]
loss = "squares"
body = [{{ name = "stage", mass = [50000, 200000] }}]
drive = [{{ name = "motor", viscous = ["0 N·s/m", "1000 N·s/m"], coulomb = [0, 100], offset = [-50, 50] }}]
"#
    )
}

/// Judges the record at `path`; whether something leaves what is published.
pub fn judge(path: &str) -> bool {
    let path = std::path::absolute(path).unwrap_or_else(|error| panic!("{path}: {error}")).display().to_string();
    let record =
        read_file(Path::new(&path), &Columns::default(), Needs::Motion).unwrap_or_else(|error| panic!("{error}"));
    let mut fails = by_effort(&record);
    let file = SceneFile::parse("emps.toml", &scene(&path), &[]).unwrap_or_else(|error| panic!("{error}"));
    let (Some(mechanism), Some(identify)) = (&file.mechanism, &file.identify) else { unreachable!("a mechanism") };
    let Subject::Mechanism(of) = &identify.subject else { unreachable!("of a mechanism") };
    let model = MotionModel::new(mechanism, Vec::new(), of, &[record]).unwrap_or_else(|error| panic!("{error}"));
    let value =
        |name: &str| PUBLISHED.iter().find(|(own, ..)| name.ends_with(own)).map_or(f64::NAN, |(_, value, _)| *value);
    let published: Vec<f64> = model.parameters().iter().map(|parameter| value(&parameter.name)).collect();
    let output = model.simulate(&published).unwrap_or_else(|error| panic!("{error}"));
    let error = relative(model.measured(), &output);
    println!(
        "simulated with what is published: force within {:.2} %, {:.1} % are allowed",
        100.0 * error,
        100.0 * SIMULATED
    );
    fails |= error > SIMULATED;
    let found = estimate(&model, &identify.options).unwrap_or_else(|error| panic!("{error}"));
    println!("fitted by simulation: {}; force within {:.2} %", words(&found), 100.0 * found.lack.relative_error);
    fails
}

fn by_effort(record: &Record) -> bool {
    let run = filtered(record, &Options { cutoff: None });
    let laws: Vec<_> =
        LAWS.iter().map(|(name, terms)| (*name, DriveTrain::new(terms, std::slice::from_ref(&run)))).collect();
    let models: Vec<(&str, &dyn Model)> = laws.iter().map(|(name, law)| (*name, law as &dyn Model)).collect();
    let (compared, _) = compare(&models, &fit::Options { loss: Loss::Squares, ..fit::Options::default() });
    let of = |name: &str| compared.iter().find(|one| one.name == name).expect("it has an estimate");
    for one in &compared {
        let lack = &one.estimate.lack;
        let verdict = if lack.verdict.is_some() { ", lack of fit" } else { "" };
        println!(
            "{}: {}; force within {:.1} %, lag-1 correlation {:.2}, behind {:.0}{verdict}",
            one.name,
            words(&one.estimate),
            100.0 * lack.relative_error,
            lack.lag_1_correlation,
            one.behind
        );
    }
    let symmetric = &of("symmetric").estimate;
    let mut fails = false;
    for ((name, published, share), error) in PUBLISHED.into_iter().zip(ERRORS) {
        let own = symmetric.parameters.iter().find(|own| own.name == name).expect("it is sought");
        let deviation = own.deviation.expect("it is determined");
        fails |= (own.value / published - 1.0).abs() > share || deviation < error;
    }
    let dry = &of("coulomb").estimate.lack;
    fails |= dry.verdict.is_none() || (dry.relative_error - 0.162).abs() > 0.005;
    // Friction by direction is preferred, with and without a delay.
    fails |= of("by-direction").behind > of("symmetric").behind - 10.0;
    fails |= of("by-direction-delayed").behind > of("symmetric-delayed").behind - 10.0;
    fails
}

fn words(estimate: &Estimate) -> String {
    let of = |own: &slipfit_identify::estimate::Estimated| {
        format!("{} {:.4} ± {:.2} {}", own.name, own.value, own.deviation.unwrap_or(f64::NAN), own.unit)
    };
    estimate.parameters.iter().map(of).collect::<Vec<_>>().join(", ")
}

fn relative(measured: &[f64], output: &[f64]) -> f64 {
    let squares = |of: &mut dyn Iterator<Item = f64>| of.map(|one| one * one).sum::<f64>();
    let apart = squares(&mut measured.iter().zip(output).map(|(measured, output)| measured - output));
    libm::sqrt(apart / squares(&mut measured.iter().copied()))
}
