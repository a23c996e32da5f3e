//! Units of a population per second, on one thread, beside diffsol's BDF on the same units.
//!
//! `cargo bench --features peers --bench population`. Both are held to an error of the force at the end of 0.1 % of the peak in
//! 95 % of the units, against the desk: the peer's force is known every millisecond, which is too rare for a greatest one.
//! Rates are compared in turns, because a shared machine changes its pace. Then, on all threads, every verdict of a large
//! population is held against a run at a tenth of the tolerance; fails if one changes.

#[path = "../work_precision/diffsol_peer.rs"]
#[allow(dead_code, reason = "one of its solvers is enough here")]
mod diffsol_peer;
#[path = "../work_precision/entry.rs"]
#[allow(dead_code)]
mod entry;

use std::{process::ExitCode, time::Instant};

use entry::Tolerances;
use rayon::prelude::*;
use slipfit::{
    dynamics::{
        driven::Driven,
        outcome::Verdict,
        simulate::{Settings, simulate as at_desk},
    },
    population::{Course, production::Production, simulate, simulate_in, slide},
    scene::CD_ROM_SLIDE,
    setup::Scene,
};
use slipfit_core::menu::SlideData;
use slipfit_problems::cd_rom;

/// What 95 % of the units may err by.
const ERROR: f64 = 1e-3;
/// Turns of the comparison.
const TURNS: usize = 9;

/// Units whose verdicts are held against a better tolerance, and how many of them at a time.
const JUDGED: [u64; 2] = [100_000, 500];

fn main() -> ExitCode {
    let opening = Scene::parse("cd-rom-slide", CD_ROM_SLIDE, &[]).expect("it is shipped");
    let mut stroke = opening.clone();
    // A unit's whole run: the peer knows no end of the stroke.
    (stroke.run.duration, stroke.run.stroke) = (1.5, None);
    for (name, scene, units, peers) in [("openings", &opening, 2000, 24), ("strokes of 1.5 s", &stroke, 400, 40)] {
        compare(name, scene, units, peers);
    }
    let mut whole = opening;
    whole.run.duration = whole.stroke_duration().expect("it has a stroke");
    ExitCode::from(u8::from(changed_verdicts(&whole)))
}

/// Whether a verdict of the strokes of `scene` changes at a tenth of the tolerance, of those that were not left to the desk.
fn changed_verdicts(scene: &Scene) -> bool {
    let [all, piece] = JUDGED;
    let production = Production::new(scene, None, 0.0, 3).expect("it can be drawn");
    let course = slide::course(scene);
    let pieces = (0..all / piece).into_par_iter().map(|k| {
        let drawn = production.draw(k * piece..(k + 1) * piece);
        let units = slide::units(scene, &drawn).expect("the desk solves what it is left");
        let slides: Vec<SlideData<f64>> = drawn.gaps.iter().map(|gaps| scene.slide_data(gaps)).collect();
        let finer = simulate(Course { tolerance: course.tolerance / 10.0, ..course }, &slides);
        let mut counts = [0, 0];
        for (unit, finer) in units.iter().zip(&finer) {
            let command = scene.drive.command(f64::from(finer.end));
            let verdict = Verdict::of(f64::from(finer.final_velocity) / command, true);
            counts[0] += u64::from(unit.outcome.at_desk);
            counts[1] += u64::from(!unit.outcome.at_desk && verdict != unit.outcome.verdict);
        }
        counts
    });
    let [at_desk, changed] = pieces.reduce(|| [0, 0], |one, other| [one[0] + other[0], one[1] + other[1]]);
    println!(
        "verdicts of {all} strokes: {at_desk} decided at the desk; {changed} of the others change at a tenth of the tolerance"
    );
    changed > 0
}

/// The error of force (share of the peak) that 95 % of the units do not exceed.
fn p95(mut errors: Vec<f64>) -> f64 {
    errors.sort_by(f64::total_cmp);
    errors[errors.len() * 95 / 100]
}

fn compare(name: &str, scene: &Scene, units: usize, peers: usize) {
    let drawn = Production::new(scene, None, 0.0, 1).expect("it can be drawn").draw(0..units as u64);
    let slides: Vec<SlideData<f64>> = drawn.gaps.iter().map(|gaps| scene.slide_data(gaps)).collect();
    let course = slide::course(scene);
    // Peak and end.
    let truth: Vec<[f64; 2]> = drawn.gaps[..100]
        .iter()
        .map(|gaps| {
            let run = at_desk(scene, gaps, &Settings::desk(scene, 1e-3)).expect("the desk solves it");
            let force = run.trajectory.force;
            [run.outcome.peak_force.unwrap_or_default(), force.last().copied().unwrap_or_default()]
        })
        .collect();
    let error = |[peak, end]: [f64; 2], found: f64| (found - end).abs() / peak;
    let figures = simulate(course, &slides);
    let of_lanes = truth.iter().zip(&slides).zip(&figures).map(|((truth, slide), figures)| {
        let end = slide.drive.force(scene.run.duration, f64::from(figures.final_velocity));
        error(*truth, end)
    });
    let of_lanes = p95(of_lanes.collect());
    let of_width = |width: usize| {
        let start = Instant::now();
        std::hint::black_box(simulate_in(width, course, &slides));
        units as f64 / start.elapsed().as_secs_f64()
    };
    let lanes = || of_width(16);
    let milliseconds = (scene.run.duration * 1e3).round() as u32;
    let solved = |tolerances: Tolerances, count: usize| -> Option<(f64, f64)> {
        let (mut errors, mut time) = (Vec::new(), 0.0);
        for (slide, truth) in slides.iter().zip(&truth).take(count) {
            let slide = cd_rom::from_data(slide);
            let Some(run) = diffsol_peer::solve(&slide, milliseconds, diffsol_peer::BDF, tolerances) else {
                // It gave up.
                errors.push(f64::INFINITY);
                continue;
            };
            errors.push(error(*truth, run.force.last().copied()?));
            time += run.time.as_secs_f64();
        }
        Some((p95(errors), count as f64 / time))
    };
    let able = Tolerances::all().filter_map(|tolerances| Some((tolerances, solved(tolerances, peers)?)));
    let quickest = able.filter(|(_, (error, _))| *error <= ERROR).max_by(|one, other| one.1.1.total_cmp(&other.1.1));
    let Some((tolerances, (of_peer, _))) = quickest else {
        println!("{name}: diffsol meets the error with none of the tolerances; slipfit {:.0} units/s", lanes());
        return;
    };
    let mut turns: Vec<(f64, f64)> = (0..TURNS).filter_map(|_| Some((lanes(), solved(tolerances, peers)?.1))).collect();
    turns.sort_by(|one, other| (one.0 / one.1).total_cmp(&(other.0 / other.1)));
    let (ours, peer) = turns[turns.len() / 2];
    println!("{name}");
    println!("  slipfit      {ours:10.0} units/s, p95 of the error {:.4} %", of_lanes * 100.0);
    println!("  diffsol BDF  {peer:10.0} units/s, p95 of the error {:.4} % ({tolerances})", of_peer * 100.0);
    println!("  ratio        {:10.1}", ours / peer);
    // In turns again, at another pace of the machine.
    let mut narrow: Vec<f64> = (0..TURNS).filter_map(|_| Some(of_width(8) / solved(tolerances, peers)?.1)).collect();
    narrow.sort_by(f64::total_cmp);
    println!("  of 8 lanes   {:10.1}", narrow[narrow.len() / 2]);
}
