//! Energy accounts and the reduced stability map.

use rayon::prelude::*;
use slipfit::{
    dynamics::{
        audit::Audit,
        confirm::confirmed,
        controller::audited,
        scheme::{IntegratorKind, ScalarKind},
        simulate::{Settings, simulate},
    },
    quality::stability::{self, Grade},
    scene::{CD_ROM_SLIDE, Override},
    setup::{ControllerSpec, Scene},
};
use slipfit_core::slide::CONTACTS;

fn scene(settings: &[&str]) -> Scene {
    let settings: Vec<_> = settings.iter().map(|setting| Override::set(setting)).collect();
    Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &settings).unwrap()
}

/// The account of the slide with all gaps at `gap` (m).
fn account(scene: &Scene, gap: f64, integrator: IntegratorKind, step: f64) -> Audit {
    let spec = ControllerSpec { step, integrator, scalar: ScalarKind::F64 };
    let settings = Settings::desk(scene, 1e-3).by(spec);
    audited(scene, &[gap; CONTACTS], &settings).unwrap().audit.unwrap()
}

/// A slide held by interference all round, linear and lossless, swings under gravity and a drive that pulls at once:
/// smooth, so that defects fall with the order. Relative defects at 20 µs and 10 µs.
fn smooth_defects(integrator: IntegratorKind, more: &[&str]) -> [f64; 2] {
    let mut settings = vec![
        "contact.exponent=1",
        "contact.stiffness=10",
        "contact.damping=0.001",
        "drive.ramp_start=-0.05",
        "drive.ramp_end=0.1",
        "drive.point=[20,0,0]",
        "run.duration=2",
    ];
    settings.extend(more);
    let scene = scene(&settings);
    [20e-6, 10e-6].map(|step| account(&scene, -0.2e-3, integrator, step).relative_defect())
}

const LOSSLESS: [&str; 3] = ["friction.law=none", "contact.damping=0", "drive.gain=0"];

#[test]
fn energy_is_conserved_to_the_order_of_the_method() {
    let schemes = [
        (IntegratorKind::SemiImplicitEuler, 1.0),
        (IntegratorKind::ImplicitEuler, 1.0),
        (IntegratorKind::Sdirk2, 2.0),
        (IntegratorKind::Extrapolated, 2.0),
    ];
    for (integrator, order) in schemes {
        let [coarse, fine] = smooth_defects(integrator, &LOSSLESS);
        let found = libm::log2(coarse / fine);
        println!("lossless {integrator:?} {coarse:.2e} {fine:.2e} order {found:.2}");
        assert!(found > order - 0.25, "{integrator:?}: {coarse:e} {fine:e}");
    }
}

#[test]
fn the_defect_falls_with_the_order_of_the_method() {
    let schemes = [
        (IntegratorKind::SemiImplicitEuler, 1.0),
        (IntegratorKind::RungeKutta4, 3.0),
        (IntegratorKind::ImplicitEuler, 1.0),
        (IntegratorKind::Sdirk2, 2.0),
        (IntegratorKind::Extrapolated, 2.0),
        (IntegratorKind::Rodas3, 3.0),
        // The account itself is of third order.
        (IntegratorKind::Rodas4, 3.0),
    ];
    for (integrator, order) in schemes {
        let [coarse, fine] = smooth_defects(integrator, &["friction.stick_band=100"]);
        let found = libm::log2(coarse / fine);
        println!("driven {integrator:?} {coarse:.2e} {fine:.2e} order {found:.2}");
        assert!(found > order - 0.25, "{integrator:?}: {coarse:e} {fine:e}");
    }
}

#[test]
fn implicit_euler_only_loses_energy() {
    let settings = ["contact.exponent=1", "run.duration=50"].into_iter().chain(LOSSLESS).collect::<Vec<_>>();
    let audit = account(&scene(&settings), -0.2e-3, IntegratorKind::ImplicitEuler, 50e-6);
    assert!(audit.defect > 0.0 && audit.rise <= 1e-9 * audit.exchanged, "{audit:?}");
}

#[test]
fn runs_with_too_large_a_step_say_so() {
    let (opening, stroke) = (scene(&[]), scene(&["run.duration=1500"]));
    let cases = [
        (&opening, 5.0, 1e-3),
        (&opening, 7.0, 1e-3),
        (&opening, 8.0, 5e-3),
        (&stroke, 0.0, 1e-3),
        (&stroke, 2.5, 1e-3),
        (&opening, 0.0, 50e-6),
        (&opening, 5.0, 50e-6),
    ];
    let mut wrong = 0;
    for integrator in stability::SCHEMES {
        for (scene, n, step) in cases {
            let spec = ControllerSpec { step, integrator, scalar: ScalarKind::F64 };
            let settings = Settings::desk(scene, 5e-3).by(spec);
            let gaps = scene.gaps_at(&[n; CONTACTS]);
            let truth = simulate(scene, &gaps, &settings.to(1e-7)).unwrap();
            let run = confirmed(scene, &gaps, &settings, simulate(scene, &gaps, &settings).unwrap()).unwrap();
            let error = run.trajectory.greatest_difference(&truth.trajectory, scene.drive.ramp_start);
            println!("{integrator:?} n = {n} at {step} s: {error:.1e} {:?}", run.trust);
            assert!(error <= stability::WRONG || !run.trust.is_sound(), "{integrator:?} n = {n} at {step} s: {error}");
            assert!(step > 50e-6 || run.trust.is_sound(), "{integrator:?} n = {n}: {:?}", run.trust);
            wrong += u32::from(error > stability::WRONG);
        }
    }
    assert!(wrong > 0);
}

/// Combinations of extremes, each far outside what a slide is made of.
#[test]
fn every_random_scene_stays_finite_in_steps_of_50_microseconds() {
    let scene = scene(&[]);
    (0..400).into_par_iter().for_each(|i| {
        let (values, mut setup) = stability::random_setup(&scene, 2, i);
        setup.scene.controller.step = stability::STEP;
        let run = simulate(&setup.scene, &setup.gaps(), &setup.settings());
        assert!(run.is_ok(), "{:?} {values:?}: {:?}", setup.scene.controller.integrator, run.err());
    });
}

#[test]
fn no_point_of_a_reduced_map_is_wrong_and_silent_whatever_the_threads() {
    let scene = scene(&[]);
    let points = stability::random(&scene, 1, 40, || ()).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(points[..16], pool.install(|| stability::random(&scene, 1, 16, || ())).unwrap());
    let silent: Vec<_> = points.iter().filter(|point| point.grade() == Grade::Silent).collect();
    assert!(silent.is_empty(), "{silent:?}");
    assert!(points.iter().any(|point| point.grade() == Grade::Warned));
}
