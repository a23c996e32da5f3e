//! Identification: how long fits take, and what it makes of a measured drive.
//!
//! `cargo bench --bench identify` times fits on one thread and fails above [`ONE_FIT`] and [`TWENTY_UNITS`].
//! `cargo bench --bench identify -- RECORD.csv` also judges the record of EMPS, a carriage on a ball screw under a position loop (A. Janot,
//! M. Gautier and M. Brunot, "Data set and reference models of EMPS", 2019), of which no licence is known: time, reference position,
//! position and force, at 1 kHz. It fails where an estimate leaves what is published.

mod emps;

use std::{process::ExitCode, time::Instant};

use slipfit::{
    dynamics::{
        driven::Driven,
        simulate::{Settings, simulate},
    },
    identify::{Identification, MotionModel, OfRecord, Subject},
    scene::{CD_ROM_SLIDE, SceneFile},
    setup::{Scene, SlideParameter},
};
use slipfit_core::{sampling::stream::unit_stream, slide::CONTACTS};
use slipfit_identify::{estimate::estimate, fit::Options, record::Record};
use slipfit_tolerance::failure::subset::normals;

/// Most time (s) of a fit of three parameters to a stroke of 1,500 samples, on one core.
const ONE_FIT: f64 = 0.5;
/// Most time (s) of fits of five parameters to the strokes of twenty units, on one core.
const TWENTY_UNITS: f64 = 20.0;

/// What is sought of the slide.
const SOUGHT: &str = r#"
[identify]
friction.coefficient = [0.2, 0.4]
contact.stiffness = ["1e6 N/m^1.5", "1e7 N/m^1.5"]
slide.mass = [60, 110]
gaps = [{ of = "left", n = [-1, 4] }, { of = "right", n = [-1, 4] }]
"#;

fn main() -> ExitCode {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let mut fails = one.install(fits);
    match std::env::args().skip(1).find(|argument| argument != "--bench") {
        Some(path) => fails |= emps::judge(&path),
        None => println!("EMPS: not judged, as no record is given: cargo bench --bench identify -- RECORD.csv"),
    }
    if fails { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Whether fits take too long.
fn fits() -> bool {
    let text = format!("{CD_ROM_SLIDE}\n{SOUGHT}");
    let file = SceneFile::parse("slide.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let (Some(mut scene), Some(Identification { subject: Subject::Slide(of), .. })) = (file.slide, file.identify)
    else {
        unreachable!("a slide")
    };
    let mut three = of.clone();
    three.sought.retain(|sought| !["contact.stiffness", "n of right"].contains(&&sought.name[..]));
    scene.run.duration = scene.stroke_duration().expect("it has a stroke");
    let times: Vec<f64> = (0..20).map(|unit| fit(&scene, &of, unit)).collect();
    let mut times_of_three: Vec<f64> = (0..7).map(|unit| fit(&scene, &three, unit)).collect();
    times_of_three.sort_by(f64::total_cmp);
    let (three, all) = (times_of_three[3], times.iter().sum::<f64>());
    println!("three parameters of a stroke  {three:.2} s, the median of 7 records; {ONE_FIT} s are allowed");
    println!("five of each of 20 units      {all:.1} s; {TWENTY_UNITS} s are allowed");
    three > ONE_FIT || all > TWENTY_UNITS
}

/// How long (s) a fit takes `of` what is sought to the stroke of a unit, with noise of 1 % of the peak.
fn fit(scene: &Scene, of: &OfRecord<SlideParameter>, unit: u64) -> f64 {
    // Of units that tip on their way all of this has an influence.
    let n = 1.5 + 0.01 * unit as f64;
    let run = simulate(scene, &scene.gaps_at(&[n; CONTACTS]), &Settings::desk(scene, 1e-3)).expect("it runs");
    let peak = run.trajectory.force.iter().fold(0.0f64, |most, force| most.max(force.abs()));
    let noise = normals(&mut unit_stream(unit, 8), run.trajectory.force.len());
    let force: Vec<f64> =
        run.trajectory.force.iter().zip(noise).map(|(force, noise)| force + 0.01 * peak * noise).collect();
    let samples = force.len();
    let name = "stroke".to_owned();
    let record = Record { name, start: 0.0, step: 1e-3, samples, position: None, speed: None, force: Some(force) };
    let model = MotionModel::new(scene, vec![n; CONTACTS], of, &[record]).expect("it begins at 0 s");
    let clock = Instant::now();
    estimate(&model, &Options::default()).expect("an estimate");
    clock.elapsed().as_secs_f64()
}
