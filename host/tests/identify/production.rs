//! Units of which only the production is known.

use super::slide::noisy;
use slipfit::{
    dynamics::{
        driven::Driven,
        simulate::{Settings, simulate},
    },
    identify::{Identification, MotionModel, OfRecord, Subject},
    population::{
        production::Production,
        tally::Duty,
        uncertain::{
            design::Design,
            study::{counted, of_slide},
        },
    },
    scene::{CD_ROM_SLIDE, Override, SceneFile},
    setup::{Adjustable, Scene, SlideParameter},
};
use slipfit_core::{sampling::stream::unit_stream, slide::CONTACTS};
use slipfit_identify::{
    between::between,
    estimate::{Estimate, estimate},
    fit::Options,
    record::Record,
};
use slipfit_tolerance::failure::subset::normals;

const FRICTION: f64 = 0.25;
/// Units that are measured, each at constant speed.
const UNITS: u64 = 10;
/// From when on (s) their force is recorded.
const START: f64 = 0.25;
/// Until when (s).
const END: f64 = 1.5;
/// The interval (s) of samples.
const STEP: f64 = 1e-3;

/// The shipped slide, driven to 50 mm/s within 0.2 s. Its friction and the gaps are sought, which the production gives.
fn at_constant_speed() -> (Scene, OfRecord<SlideParameter>) {
    let sought = "[identify]\nfriction.coefficient = [0.1, 0.5]\ngaps = \"production\"\n";
    // Beside noise of 2 % a hundred times the usual error of a step does not matter.
    let set = ["drive.ramp_start=0", "drive.ramp_end=0.2", "drive.speed=50", "run.error=3e-5", "run.duration=1500"];
    let file = SceneFile::parse("slide.toml", &format!("{CD_ROM_SLIDE}\n{sought}"), &set.map(Override::set));
    let file = file.unwrap_or_else(|error| panic!("{error}"));
    let Some(Identification { subject: Subject::Slide(of), .. }) = file.identify else { panic!("no slide") };
    (file.slide.unwrap(), of)
}

/// The force of a random unit with noise of 2 % of its peak, fitted without knowing its gaps.
fn measured(scene: &Scene, of: &OfRecord<SlideParameter>, seed: u64) -> Estimate {
    let draws = normals(&mut unit_stream(seed, 4), CONTACTS);
    let mut unit = scene.clone();
    SlideParameter::Friction.set(&mut unit, FRICTION);
    let mut settings = Settings::desk(&unit, STEP);
    // As exactly as usual, whatever the model is computed with.
    (settings.run.stroke, settings.run.duration, settings.run.error) = (None, END, 3e-7);
    let motion = simulate(&unit, &unit.gaps_at(&draws.try_into().unwrap()), &settings).unwrap().trajectory;
    let force = &motion.force[(START / STEP) as usize..];
    let peak = force.iter().fold(0.0f64, |most, force| most.max(force.abs()));
    let noise: Vec<f64> = normals(&mut unit_stream(seed, 5), force.len()).iter().map(|x| 0.02 * peak * x).collect();
    let record = Record {
        name: format!("unit {seed}"),
        start: START,
        step: STEP,
        samples: force.len(),
        position: None,
        speed: None,
        force: Some(noisy(force, &noise)),
    };
    let model = MotionModel::new(scene, vec![0.0; CONTACTS], of, &[record]).unwrap();
    estimate(&model, &Options::default()).unwrap()
}

/// The shipped slide as its production has it, with a friction coefficient of this text.
fn openings(friction: &str) -> Scene {
    let mut scene = Scene::parse("slide.toml", CD_ROM_SLIDE, &[Override::set(friction)]).unwrap();
    scene.run.duration = scene.stroke_duration().unwrap();
    scene
}

#[test]
fn a_unit_whose_gaps_nobody_knows_tells_its_friction() {
    let (scene, of) = at_constant_speed();
    let levels = &of.sought[1..];
    assert!(levels.len() == CONTACTS && levels.iter().all(|of| of.prior == Some([0.0, 1.0])), "{levels:?}");
    assert_eq!(levels[0].name, "n of left back left");
    let found = measured(&scene, &of, 3);
    let friction = &found.parameters[0];
    let deviation = friction.deviation.unwrap();
    assert!(deviation < 0.01 && (friction.value - FRICTION).abs() < 4.0 * deviation, "{friction:?}");
    // The gap of a wall that nothing touches stays as it was known beforehand.
    assert!(found.parameters.iter().any(|of| of.deviation.is_some_and(|own| own > 0.999)), "{:?}", found.parameters);
    assert!(found.undetermined.is_empty() && found.lack.verdict.is_none(), "{:?}", found.lack);
}

#[test]
#[ignore = "ten fits of 17 parameters take half a minute"]
fn ten_units_at_constant_speed_tell_how_many_fail() {
    assert_eq!(ten_units_tell(1), 1);
}

#[test]
#[ignore = "1000 fits of 17 parameters take half an hour with --release"]
fn study_how_often_ten_units_tell_how_many_fail() {
    const REPEATS: u64 = 100;
    let held = ten_units_tell(REPEATS);
    assert!(100 * held >= 92 * REPEATS, "{held} of {REPEATS}");
}

/// Ten units at constant speed tell the friction of all, and with it how many units of the production fail: in how many of the `repeats` the
/// interval holds the true share.
fn ten_units_tell(repeats: u64) -> u64 {
    const POPULATION: u64 = 1000;
    const SEED: u64 = 1;
    let share_of = |counts: slipfit::population::tally::Counts| counts.malfunctions as f64 / counts.units as f64;
    let known = openings("friction.coefficient=0.25");
    let duty = Duty { limit: None, stroke: known.run.stroke };
    let production = Production::new(&known, None, 0.0, SEED).unwrap();
    let truth = share_of(counted(&known, &production, 0..20_000, duty, |_| ()).unwrap().0);
    let (scene, of) = at_constant_speed();
    let (mut held, mut of_friction) = (0, 0);
    for repeat in 0..repeats {
        let found: Vec<Estimate> = (0..UNITS).map(|unit| measured(&scene, &of, UNITS * repeat + unit)).collect();
        let pooled = between(&found.iter().collect::<Vec<_>>());
        let friction = pooled.iter().find(|of| of.name == "friction.coefficient").unwrap();
        let [mean, deviation] = [friction.mean, friction.deviation];
        let known = openings(&format!("uncertain.friction.coefficient={{mean={mean},deviation={deviation}}}"));
        let production = Production::new(&known, None, 0.0, SEED).unwrap();
        let design = Design::beside(POPULATION, SEED + repeat).unwrap();
        let answer = of_slide(&known, &production, design, duty, |_| ()).unwrap();
        let [low, high] = answer.malfunctions.interval;
        held += u64::from((low..=high).contains(&truth));
        of_friction += u64::from((friction.interval[0]..=friction.interval[1]).contains(&FRICTION));
        println!(
            "{repeat}: friction {mean:.4} ± {deviation:.4}, {:.1} to {:.1} % of the units fail, {:.1} % do; {held} hold, of the friction \
             {of_friction}",
            100.0 * low,
            100.0 * high,
            100.0 * truth
        );
    }
    held
}
