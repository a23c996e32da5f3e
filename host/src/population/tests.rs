//! Populations against the desk, and their laws.

use slipfit_core::menu::{FrictionData, SlideData};

use super::{
    Course, production::Production, simulate, simulate_in, simulate_units, slide, study::Population, tally::Duty,
    unit::Fault,
};
use crate::{
    dynamics::{
        desk,
        driven::Driven,
        example,
        outcome::{Outcome, Verdict},
        simulate as one,
        simulate::{Settings, SimulateError},
    },
    setup::Scene,
};

fn slides(scene: &Scene, units: u64) -> Vec<SlideData<f64>> {
    let drawn = Production::new(scene, None, 0.0, 1).unwrap().draw(0..units);
    drawn.gaps.iter().map(|gaps| scene.slide_data(gaps)).collect()
}

fn at_desk(scene: &Scene, gaps: &[f64]) -> Outcome {
    one::simulate(scene, gaps, &Settings::desk(scene, 1.0)).unwrap().outcome
}

/// A stroke of the scene.
fn stroke() -> Scene {
    let mut scene = example::cd_rom();
    scene.run.duration = scene.stroke_duration().unwrap();
    scene
}

#[test]
fn figures_have_the_same_bits_for_any_number_of_lanes() {
    for friction in [example::cd_rom().friction, FrictionData::None] {
        figures_have_the_same_bits(&Scene { friction, ..example::cd_rom() });
    }
}

fn figures_have_the_same_bits(scene: &Scene) {
    let slides = slides(scene, 40);
    let course = slide::course(scene);
    let expected = format!("{:?}", simulate(course, &slides));
    for lanes in [1, 8] {
        assert_eq!(format!("{:?}", simulate_in(lanes, course, &slides)), expected, "{lanes}");
    }
    // In another order, and alone.
    let reversed: Vec<_> = slides.iter().rev().copied().collect();
    let figures: Vec<_> = simulate(course, &reversed).into_iter().rev().collect();
    assert_eq!(format!("{figures:?}"), expected);
}

#[test]
fn a_population_is_the_same_for_any_number_of_threads_and_any_split() {
    let scene = example::cd_rom();
    let production = Production::new(&scene, None, 0.3, 5).unwrap();
    let units = |threads: usize, ends: &[u64]| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut all = Vec::new();
        for part in ends.windows(2) {
            pool.install(|| {
                simulate_units(&scene, &production, part[0]..part[1], |_| (), |_, units| all.extend_from_slice(units))
            })
            .unwrap();
        }
        all
    };
    let expected = units(1, &[0, 700]);
    assert_eq!(expected.len(), 700);
    assert_eq!(units(2, &[0, 700]), expected);
    assert_eq!(units(8, &[0, 256, 700]), expected);
}

/// Where no verdict can follow, a better run would tell nothing more.
#[test]
fn units_without_a_verdict_are_not_run_again() {
    let scene = example::cd_rom();
    let drawn = Production::new(&scene, None, 0.0, 1).unwrap().draw(0..500);
    let units = slide::units(&scene, &drawn).unwrap();
    assert!(units.iter().all(|unit| unit.outcome.verdict == Verdict::Undecided && !unit.outcome.at_desk));
}

/// One unit that cannot be simulated ends no population: it is counted, with its number, and comes to no verdict.
#[test]
fn units_without_a_run_are_counted() {
    let scene = example::of_uncertain_friction();
    let production = Production::new(&scene, None, 0.0, 3).unwrap();
    let drawn = production.draw(0..600);
    let friction = |i: usize| match slide::scene_of(&scene, &drawn, i).friction {
        FrictionData::Regularised { coefficient, .. } => coefficient,
        _ => f64::NAN,
    };
    let outside: Vec<usize> = (0..600).filter(|i| friction(*i) < 0.0).collect();
    assert!((3..60).contains(&outside.len()), "{outside:?}");
    let found = Population::study(&scene, &production, 600, Duty::default(), |_| ()).unwrap();
    let statistics = &found.statistics;
    assert_eq!((statistics.units, statistics.out_of_bounds as usize), (600, outside.len()));
    assert_eq!((statistics.unsolved, statistics.unassembled), (0, 0));
    let kept = found.tally.first.iter().flatten().filter(|unit| unit.outcome.fault == Some(Fault::OutOfBounds));
    assert_eq!(kept.map(|unit| unit.number as usize).collect::<Vec<_>>(), outside);
    // The others are what they are alone.
    let alone = slide::units(&scene, &drawn).unwrap();
    let with_figures = alone.iter().filter(|unit| unit.outcome.peak_force.is_some()).count();
    assert_eq!(statistics.final_velocity.as_ref().unwrap().units as usize, 600 - outside.len());
    assert!(with_figures <= 600 - outside.len());
}

/// What has to do with one unit is its fault; to be stopped is not.
#[test]
fn faults_are_those_of_a_unit() {
    assert_eq!(Fault::of(SimulateError::Unsolved { time: 0.1 }).unwrap(), Fault::Unsolved);
    assert_eq!(Fault::of(SimulateError::NotFinite { time: 0.1, step: 1e-6 }).unwrap(), Fault::Unsolved);
    assert_eq!(Fault::of(SimulateError::Parameter(String::new())).unwrap(), Fault::OutOfBounds);
    assert!(Fault::of(SimulateError::Interrupted).is_err());
    assert!(Fault::Unsolved.outcome().peak_force.is_none() && Fault::Unsolved.outcome().verdict == Verdict::Undecided);
}

/// The 95th percentile and the greatest of some errors.
fn p95_and_worst(mut errors: Vec<f64>) -> [f64; 2] {
    errors.sort_by(f64::total_cmp);
    [errors[errors.len() * 95 / 100], errors[errors.len() - 1]]
}

/// Openings and strokes of drawn units against the desk, which knows them to 0.02 % of the peak: the greatest force and the
/// force at the end.
#[test]
fn figures_are_those_of_the_desk() {
    for (scene, count) in [(example::cd_rom(), 150), (stroke(), 150)] {
        let drawn = Production::new(&scene, None, 0.0, 2).unwrap().draw(0..count);
        let (mut peaks, mut ends, mut breakaways) = (Vec::new(), Vec::new(), Vec::new());
        for unit in &slide::units(&scene, &drawn).unwrap() {
            let desk = at_desk(&scene, &unit.gaps);
            let found = unit.outcome;
            assert_eq!(found.verdict, desk.verdict, "unit {}", unit.number);
            let peak = desk.peak_force.unwrap();
            peaks.push((found.peak_force.unwrap() - peak).abs() / peak);
            ends.push(scene.drive.gain * (found.final_velocity - desk.final_velocity).abs() / peak);
            assert_eq!(found.breakaway.is_some(), desk.breakaway.is_some(), "unit {}", unit.number);
            breakaways.extend(found.breakaway.zip(desk.breakaway).map(|(found, desk)| (found - desk).abs() / desk));
        }
        let found = [peaks, ends, breakaways].map(p95_and_worst);
        println!("greatest force, force at the end, breakaway: p95 and worst {found:?}");
        assert!(found.iter().all(|[p95, _]| *p95 < 1e-3), "{found:?}");
    }
}

/// Where sticking and sliding alternate fast before the slide breaks away, the desk itself errs by percents: only units on which
/// two of its tolerances agree tell anything.
#[test]
fn true_stick_is_simulated_as_the_desk_does() {
    let mut scene = example::cd_rom();
    scene.friction = FrictionData::Exact { coefficient: 0.3 };
    let drawn = Production::new(&scene, None, 0.0, 4).unwrap().draw(0..600);
    let mut errors = Vec::new();
    for unit in slide::units(&scene, &drawn).unwrap() {
        let peak = |error: f64| {
            let settings = Settings::desk(&scene, 1.0).to(desk::tolerance_of(&scene, error));
            one::simulate(&scene, &unit.gaps, &settings).unwrap().outcome.peak_force.unwrap()
        };
        let (coarse, fine) = (peak(3e-7), peak(1e-7));
        if (coarse / fine - 1.0).abs() < 1e-3 {
            errors.push((unit.outcome.peak_force.unwrap() / fine - 1.0).abs());
        }
    }
    assert!(errors.len() >= 400, "{}", errors.len());
    errors.sort_by(f64::total_cmp);
    let median = errors[errors.len() / 2];
    let [p95, worst] = p95_and_worst(errors);
    println!("median {median:.2e}, p95 {p95:.2e}, worst {worst:.2e}");
    assert!(median < 2e-4 && p95 < 5e-3, "{median} {p95}");
}

/// A stroke is decided by a better tolerance too: what would not be is simulated at the desk.
#[test]
fn no_verdict_changes_with_a_tenth_of_the_tolerance() {
    let scene = stroke();
    let drawn = Production::new(&scene, None, 0.0, 3).unwrap().draw(0..1500);
    let course = slide::course(&scene);
    let found = slide::units(&scene, &drawn).unwrap();
    let slides: Vec<SlideData<f64>> = drawn.gaps.iter().map(|gaps| scene.slide_data(gaps)).collect();
    let finer = simulate(Course { tolerance: course.tolerance / 10.0, ..course }, &slides);
    let changed: Vec<u64> = found
        .iter()
        .zip(&finer)
        .filter(|(unit, finer)| {
            let command = scene.drive.command(f64::from(finer.end));
            let verdict = Verdict::of(f64::from(finer.final_velocity) / command, true);
            !unit.outcome.at_desk && verdict != unit.outcome.verdict
        })
        .map(|(unit, _)| unit.number)
        .collect();
    assert!(changed.is_empty(), "{changed:?}");
}
