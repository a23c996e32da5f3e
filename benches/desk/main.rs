//! The desk's sweep over 81 levels, each stroke with its verdict held against a run at a tenth of the tolerance, beside one
//! stroke by fixed steps of 50 µs: a ratio, which depends on the machine less than a time does.
//!
//! `cargo bench --bench desk`. Fails above [`MOST`].

use std::{process::ExitCode, time::Instant};

use slipfit::{
    dynamics::{
        driven::Driven,
        outcome::Verdict,
        scheme::{IntegratorKind, ScalarKind},
        simulate::{Settings, simulate},
        sweep::{Keep, sweep},
    },
    scene::{CD_ROM_SLIDE, Override},
    setup::{ControllerSpec, Scene},
};

/// The most that the sweep may take of the time of one stroke by fixed steps, on two cores.
const MOST: f64 = 4.0;

/// The least time (s) of some runs of `work`.
fn least(mut work: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    (0..5).map(time).fold(f64::INFINITY, f64::min)
}

fn main() -> ExitCode {
    let set = [Override::set("run.duration=1500")];
    let scene = Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &set).expect("the shipped scene");
    let spec = ControllerSpec { step: 50e-6, integrator: IntegratorKind::Extrapolated, scalar: ScalarKind::F64 };
    let gaps = scene.gaps_at(&[2.5; 16]);
    let fixed = least(|| {
        simulate(&scene, &gaps, &Settings::controller(&scene, 1e-3).by(spec)).expect("it stays finite");
    });
    let desk = least(|| {
        simulate(&scene, &gaps, &Settings::desk(&scene, 1e-3)).expect("it is solved");
    });
    let levels = scene.sweep.levels();
    let all = least(|| {
        let unit = |n| scene.level(n, scene.motion(1e-3));
        let swept = sweep(&scene, &levels, Keep::Figures, unit, || ()).expect("it is solved");
        assert!(swept.levels.iter().all(|level| level.outcome.verdict != Verdict::Undecided));
    });
    let threads = rayon::current_num_threads();
    println!("one stroke, fixed steps of 50 µs   {:8.1} ms", fixed * 1e3);
    println!("one stroke, the desk               {:8.2} ms, {:.3} of that", desk * 1e3, desk / fixed);
    println!(
        "{} strokes and verdicts, {threads} threads {:8.1} ms, {:.2} of that",
        levels.len(),
        all * 1e3,
        all / fixed
    );
    ExitCode::from(u8::from(all > MOST * fixed && threads >= 2))
}
