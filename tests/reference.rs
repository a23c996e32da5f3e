//! The kernel against the reference runs, through the same path that `simulate` takes.

use std::fmt::Write;

use slipfit::{
    dynamics::{
        deviation::Deviation,
        outcome::Verdict,
        scheme::{IntegratorKind, ScalarKind},
        simulate::{Run, Settings, simulate},
    },
    scene::CD_ROM_SLIDE,
    setup::{ControllerSpec, Scene},
};
use slipfit_core::{menu::FrictionData, slide::CONTACTS};
use slipfit_tests::known_runs::{Reference, references};

fn scene_of(reference: &Reference) -> Scene {
    let mut scene = Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).unwrap();
    let FrictionData::Regularised { coefficient, .. } = scene.friction else { panic!("{:?}", scene.friction) };
    scene.friction = FrictionData::Regularised { coefficient, stick_band: reference.stick_band };
    scene.drive.ramp_end = reference.ramp_end;
    (scene.run.duration, scene.run.stroke) = (reference.duration, None);
    scene
}

fn run(reference: &Reference, integrator: IntegratorKind, step: f64, scalar: ScalarKind) -> Run {
    let scene = scene_of(reference);
    let settings = Settings::desk(&scene, 1e-3).by(ControllerSpec { step, integrator, scalar });
    simulate(&scene, &scene.gaps_at(&[reference.n; CONTACTS]), &settings).unwrap()
}

/// What a user gets who asks for nothing else.
fn default_run(reference: &Reference) -> Run {
    let scene = scene_of(reference);
    simulate(&scene, &scene.gaps_at(&[reference.n; CONTACTS]), &Settings::desk(&scene, 1e-3)).unwrap()
}

fn openings() -> Vec<Reference> {
    references().into_iter().filter(|r| r.name.contains("opening")).collect()
}

const SCHEMES: [IntegratorKind; 3] =
    [IntegratorKind::ImplicitEuler, IntegratorKind::Sdirk2, IntegratorKind::Extrapolated];

#[test]
fn openings_at_one_millisecond_are_within_half_a_percent_after_the_release() {
    assert_eq!(openings().len(), 4);
    for reference in openings() {
        for scheme in SCHEMES {
            for scalar in [ScalarKind::F32, ScalarKind::F64] {
                let errors = reference.errors(&run(&reference, scheme, 1e-3, scalar).trajectory.force);
                assert!(errors.late_max <= 0.5, "{} {scheme:?} {scalar:?}: {errors:?}", reference.name);
            }
        }
    }
}

#[test]
fn by_default_every_run_is_within_a_fiftieth_of_a_percent_throughout() {
    for reference in references() {
        let run = default_run(&reference);
        let errors = reference.errors(&run.trajectory.force);
        eprintln!("{:20} {:.4} %, {}", reference.name, errors.max, run.solved.describe());
        assert!(errors.max <= 0.02, "{}: {errors:?}", reference.name);
        assert_eq!(run.trajectory, default_run(&reference).trajectory, "deterministic");
    }
}

#[test]
fn the_default_scheme_meets_its_bounds_at_fixed_steps() {
    for reference in references() {
        let errors = |step| {
            reference.errors(&run(&reference, IntegratorKind::Extrapolated, step, ScalarKind::F64).trajectory.force)
        };
        let [coarse, fine] = [1e-3, 1e-4].map(errors);
        if reference.name.contains("opening") {
            assert!(coarse.late_max <= 0.1 && fine.max <= 1.0, "{}: {coarse:?} {fine:?}", reference.name);
        }
        if reference.name.contains("stroke") {
            assert!(coarse.rms <= 1.0 && fine.rms <= 0.1, "{}: {coarse:?} {fine:?}", reference.name);
        }
    }
}

#[test]
fn the_desk_s_exact_friction_is_the_limit_of_a_vanishing_stick_band() {
    for reference in references().into_iter().filter(|r| r.name.contains("limit")) {
        let mut scene = scene_of(&reference);
        scene.friction = FrictionData::Exact { coefficient: scene.friction.coefficient() };
        let gaps = scene.gaps_at(&[reference.n; CONTACTS]);
        let run = simulate(&scene, &gaps, &Settings::desk(&scene, 1e-3)).unwrap();
        let errors = reference.errors(&run.trajectory.force);
        eprintln!("{:20} {:.4} %, {}", reference.name, errors.max, run.solved.describe());
        assert!(errors.max <= 0.02, "{}: {errors:?}", reference.name);
    }
}

#[test]
fn exact_friction_is_the_limit_of_a_vanishing_stick_band() {
    for reference in references().into_iter().filter(|r| r.name.contains("limit")) {
        for scheme in [IntegratorKind::Sdirk2, IntegratorKind::Extrapolated] {
            let errors = |step| {
                let mut scene = scene_of(&reference);
                scene.friction = FrictionData::Exact { coefficient: scene.friction.coefficient() };
                scene.run.stroke = None;
                let spec = ControllerSpec { step, integrator: scheme, scalar: ScalarKind::F64 };
                let settings = Settings::desk(&scene, 1e-3).by(spec);
                let run = simulate(&scene, &scene.gaps_at(&[reference.n; CONTACTS]), &settings).unwrap();
                reference.errors(&run.trajectory.force).late_max
            };
            let [coarse, fine] = [1e-3, 1e-4].map(errors);
            eprintln!("{} {}: {coarse:.4} % at 1 ms, {fine:.4} % at 100 µs", reference.name, scheme.name());
            assert!(fine <= 0.05, "{} {scheme:?}: {fine}", reference.name);
            // SDIRK2's own error at 1 ms is 0.21 % at n = 2.5, with regularised friction too.
            assert!(
                coarse <= if scheme == IntegratorKind::Sdirk2 { 0.25 } else { 0.2 },
                "{} {scheme:?}: {coarse}",
                reference.name
            );
        }
    }
}

#[test]
fn error_control_comes_close_to_every_reference() {
    for reference in references() {
        let scene = scene_of(&reference);
        let gaps = scene.gaps_at(&[reference.n; CONTACTS]);
        let run = |force: f64| simulate(&scene, &gaps, &Settings::desk(&scene, 1e-3).to(force)).unwrap();
        let [coarse, fine] = [1e-4, 1e-7].map(|force| reference.errors(&run(force).trajectory.force));
        eprintln!("{:20} 1e-4 N: {:.4} %   1e-7 N: {:.4} %", reference.name, coarse.max, fine.max);
        assert!(coarse.max <= 0.5 && fine.max <= 0.01, "{}: {coarse:?} {fine:?}", reference.name);
    }
}

#[test]
fn the_stroke_jams_at_0_and_runs_at_2_5() {
    for (name, verdict) in [("slide-stroke-n0", Verdict::Jammed), ("slide-stroke-n2.5", Verdict::Runs)] {
        let reference = references().into_iter().find(|r| r.name == name).unwrap();
        let run = default_run(&reference);
        assert_eq!(run.outcome.verdict, verdict, "{name}");
        let (end, known) = (run.trajectory.force.last().unwrap(), reference.force.last().unwrap());
        assert!((end / known - 1.0).abs() <= 0.005, "{name}: {end} N, reference {known} N");
    }
}

#[test]
fn single_and_double_precision_agree_on_openings() {
    for reference in openings() {
        for scheme in SCHEMES {
            let [single, double] =
                [ScalarKind::F32, ScalarKind::F64].map(|scalar| run(&reference, scheme, 1e-3, scalar).trajectory.force);
            let difference = Deviation::between(&single, &double);
            assert!(difference.late_max <= 0.1, "{} {scheme:?}: {difference:?}", reference.name);
        }
    }
}

/// A table of errors in % of the peak force: every number here is the same on every machine.
#[test]
fn errors_by_scheme_and_step() {
    let mut table = String::from("scheme          step   run                  whole max    rms   late max    rms\n");
    let chosen = SCHEMES.into_iter().flat_map(|scheme| [(scheme, 1e-3), (scheme, 1e-4)]);
    for (scheme, step) in chosen.chain([(IntegratorKind::Extrapolated, 50e-6)]) {
        for reference in references() {
            let e = reference.errors(&run(&reference, scheme, step, ScalarKind::F64).trajectory.force);
            writeln!(
                table,
                "{:14} {:4.0}µs   {:20} {:9.4} {:6.4}  {:9.4} {:6.4}",
                scheme.name(),
                step * 1e6,
                reference.name,
                e.max,
                e.rms,
                e.late_max,
                e.late_rms
            )
            .unwrap();
        }
    }
    writeln!(table, "\nsingle against double precision, extrapolated at 1 ms").unwrap();
    for reference in references() {
        let [single, double] = [ScalarKind::F32, ScalarKind::F64]
            .map(|scalar| run(&reference, IntegratorKind::Extrapolated, 1e-3, scalar).trajectory.force);
        let e = Deviation::between(&single, &double);
        writeln!(table, "{:20} whole {:8.4}  late {:8.4}", reference.name, e.max, e.late_max).unwrap();
    }
    insta::assert_snapshot!(table);
}
