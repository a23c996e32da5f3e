//! What `slipfit kernel` writes compiles, and its kernel is the menu's, bit for bit.

use std::{fs, path::Path};

use slipfit::{
    dynamics::simulate::{Settings, simulate},
    firmware::kernel_source::{rust_source, scene_data},
    scene::{CD_ROM_SLIDE, Override},
    setup::Scene,
};
use slipfit_core::{
    integrator::ImplicitEuler,
    kernel::Kernel,
    law::{Elastic, Friction},
    menu::SlideVisitor,
    pose::Pose,
    slide::{CONTACTS, Slide},
};

#[rustfmt::skip]
#[path = "reference/scene.rs"]
mod scene;

fn described() -> Scene {
    let set = ["friction.law=exact"].map(Override::set);
    Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &set).expect("the shipped scene")
}

#[test]
fn the_committed_scene_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/scene.rs");
    let found = rust_source(&described());
    if std::env::var_os("SLIPFIT_WRITE_SCENE").is_some() {
        fs::write(&path, &found).expect("the repository takes files");
    }
    let committed = fs::read_to_string(&path).expect("a file of the repository");
    assert!(committed == found, "to write it: SLIPFIT_WRITE_SCENE=1 cargo test --test kernel");
}

/// Bits of a velocity after every step.
struct Bits;

impl SlideVisitor<f32> for Bits {
    type Output = Vec<u32>;

    fn visit<E: Elastic<f32>, F: Friction<f32>>(self, slide: Slide<f32, E, F>) -> Vec<u32> {
        let kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(slide, 1e-3).expect("the step is in bounds");
        let mut state = kernel.at_rest(Pose::nominal());
        let step = |_| {
            let _ = kernel.step(&mut state);
            state.motion.velocity.z.to_bits()
        };
        (0..1500).map(step).collect()
    }
}

#[test]
fn its_kernel_is_the_menus() {
    assert_eq!(scene_data(&described()), scene::SCENE);
    for n in [-3.0f32, 0.0, 2.5, 5.0] {
        let kernel = scene::predictor(n).expect("the scene is in bounds");
        let mut state = kernel.at_rest(Pose::nominal());
        let expected = scene::SCENE.at(n).and_then(|unit| unit.visit(Bits)).expect("the scene is in bounds");
        assert!(expected.iter().all(|bits| {
            let _ = kernel.step(&mut state);
            state.motion.velocity.z.to_bits() == *bits
        }));
    }
    assert!(scene::predictor(f32::NAN).is_err() && scene::predictor(1e9).is_err());
    assert_ne!(scene::SCENE_HASH, 0);
}

/// What `slipfit simulate --scalar f32` shows is what firmware computes, whose gaps are computed in f32 too.
#[test]
fn the_host_simulates_its_bits_at_every_level() {
    let host = described();
    let settings = Settings::controller(&host, scene::STEP.into());
    for n in [2.5f32, -1.5, 0.0] {
        let kernel = scene::predictor(n).expect("the scene is in bounds");
        let gaps = settings.gaps(&host, &[n.into(); CONTACTS]);
        assert_eq!(gaps, scene::SCENE.at(n).expect("the scene is in bounds").body.gaps.map(f64::from), "{n}");
        let run = simulate(&host, &gaps, &settings).expect("the slide moves").trajectory;
        assert_eq!(run.t.len(), 201);
        let mut state = kernel.at_rest(Pose::nominal());
        for (velocity, force) in run.vz.iter().zip(&run.force) {
            let vz = state.motion.velocity.z;
            let predicted = [vz, kernel.mechanism().drive().force(kernel.time(state.steps), vz)];
            assert_eq!(predicted.map(f64::from), [*velocity, *force], "n = {n}, step {}", state.steps);
            let _ = kernel.step(&mut state);
        }
    }
}
