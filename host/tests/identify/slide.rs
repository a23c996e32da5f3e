//! Slides by the force of their drive.

use super::common::{json, slipfit, stdout};
use super::write;
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
use slipfit_identify::{
    estimate::{Estimate, estimate},
    fit::Options,
    record::Record,
};
use slipfit_tolerance::failure::subset::normals;

/// What is written is a table of the scene that was fitted, with all units.
#[test]
fn an_estimate_goes_back_into_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let sought =
        "friction.coefficient = [0.1, 0.5]\ncontact.stiffness = [10, 1000]\ngaps = [{ of = \"left\", n = [-1, 4] }]\n";
    write(folder.path(), "slide.toml", &format!("{CD_ROM_SLIDE}\n[identify]\n{sought}"));
    stdout(&slipfit(folder.path(), &["simulate", "--n", "1.5", "--stroke", "--csv", "run.csv"]));
    stdout(&slipfit(folder.path(), &["identify", "slide.toml", "run.csv", "--n", "1.5", "-o", "found.toml"]));
    let written = std::fs::read_to_string(folder.path().join("found.toml")).unwrap();
    assert!(written.contains("N/m^1.5\"") && written.contains("\n# n of left: mean 1."), "{written}");
    write(folder.path(), "known.toml", &format!("include = \"found.toml\"\n{CD_ROM_SLIDE}"));
    assert!(
        written.contains("[[uncertain.correlation]]\nof = [\"friction.coefficient\", \"contact.stiffness\"]"),
        "{written}"
    );
    let found = json(folder.path(), &["population", "known.toml", "--units", "32", "--json"]);
    let names: Vec<&str> =
        found["uncertain"]["unknowns"].as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["friction.coefficient", "contact.stiffness"]);
}

/// Friction, mass, and the levels of the gaps to the left and to the right.
const TRUE: [f64; 4] = [0.3, 0.0818, 1.5, 1.5];

/// The shipped slide at n = 1.5 and its force (N) over the stroke at 1 kHz.
fn stroke() -> (Scene, Vec<f64>) {
    let mut scene = Scene::parse("cd-rom-slide", CD_ROM_SLIDE, &[]).unwrap();
    scene.run.duration = scene.stroke_duration().unwrap();
    let run = simulate(&scene, &scene.gaps_at(&[1.5; CONTACTS]), &Settings::desk(&scene, 1e-3)).unwrap();
    (scene, run.trajectory.force)
}

/// The shipped slide of which so many of these are sought: friction, mass, and the levels to the left and to the right.
fn sought(count: usize) -> OfRecord<SlideParameter> {
    let table = "[identify]\nfriction.coefficient = [0.2, 0.4]\nslide.mass = [60, 110]\n\
                 gaps = [{ of = \"left\", n = [-1, 4] }, { of = \"right\", n = [-1, 4] }]\n";
    let file =
        SceneFile::parse("slide.toml", &format!("{CD_ROM_SLIDE}\n{table}"), &[]).unwrap_or_else(|e| panic!("{e}"));
    let Some(Identification { subject: Subject::Slide(mut of), .. }) = file.identify else { panic!("no slide") };
    of.sought.truncate(count);
    of
}

/// First-order autoregressive noise of a standard `deviation`.
fn noise(seed: u64, count: usize, correlation: f64, deviation: f64) -> Vec<f64> {
    let own = deviation * libm::sqrt(1.0 - correlation * correlation);
    let mut x = 0.0;
    let next = |score: f64| {
        x = correlation * x + own * score;
        x
    };
    normals(&mut unit_stream(seed, 9), count + 200).into_iter().map(next).skip(200).collect()
}

fn estimated(scene: &Scene, count: usize, force: Vec<f64>) -> Estimate {
    let samples = force.len();
    let name = "stroke".to_owned();
    let record = Record { name, start: 0.0, step: 1e-3, samples, position: None, speed: None, force: Some(force) };
    let model = MotionModel::new(scene, vec![1.5; CONTACTS], &sought(count), &[record]).unwrap();
    estimate(&model, &Options::default()).unwrap()
}

pub fn noisy(force: &[f64], noise: &[f64]) -> Vec<f64> {
    force.iter().zip(noise).map(|(force, noise)| force + noise).collect()
}

fn peak(force: &[f64]) -> f64 {
    force.iter().fold(0.0, |most, force| most.max(force.abs()))
}

#[test]
fn a_slide_is_known_from_its_stroke_and_outliers_do_not_count() {
    let (scene, force) = stroke();
    let deviation = 0.01 * peak(&force);
    let clean = noisy(&force, &noise(3, force.len(), 0.0, deviation));
    let mut spoilt = clean.clone();
    spoilt.iter_mut().skip(3).step_by(20).for_each(|force| *force += 10.0 * deviation);
    let [clean, spoilt] = [clean, spoilt].map(|force| estimated(&scene, 2, force));
    for ((clean, spoilt), truth) in clean.parameters.iter().zip(&spoilt.parameters).zip(TRUE) {
        let deviation = clean.deviation.unwrap();
        assert!((clean.value - truth).abs() < 3.0 * deviation, "{clean:?}");
        assert!((spoilt.value - clean.value).abs() < 0.5 * deviation, "{clean:?} {spoilt:?}");
    }
}

#[test]
#[ignore = "20 fits of four parameters take a quarter of a minute"]
fn intervals_hold() {
    let held = intervals_that_hold(5);
    assert!(held.iter().all(|count| *count >= 16), "{held:?} of 20");
}

#[test]
#[ignore = "200 fits of four parameters take minutes"]
fn study_how_often_intervals_hold() {
    let held = intervals_that_hold(50);
    assert!(held.iter().all(|count| (184..=196).contains(count)), "{held:?} of 200");
}

/// How many intervals of each parameter hold the truth, with noise that is white and noise that follows itself, of 1 and 5 % of the peak: in
/// `records` of each of the four.
fn intervals_that_hold(records: u64) -> [usize; 4] {
    let (scene, force) = stroke();
    let peak = peak(&force);
    let mut held = [0; 4];
    for (correlation, share) in [(0.0, 0.01), (0.9, 0.01), (0.0, 0.05), (0.9, 0.05)] {
        let mut of_kind = [0; 4];
        for seed in 0..records {
            let found = estimated(&scene, 4, noisy(&force, &noise(seed, force.len(), correlation, share * peak)));
            for ((count, parameter), truth) in of_kind.iter_mut().zip(&found.parameters).zip(TRUE) {
                *count += usize::from(parameter.interval.is_none_or(|[low, high]| (low..=high).contains(&truth)));
            }
        }
        println!("noise {share} of the peak, correlation {correlation}: {of_kind:?} of {records}");
        held.iter_mut().zip(of_kind).for_each(|(held, of_kind)| *held += of_kind);
    }
    held
}
