//! The paper's slide and sweeps of it, for the tests of plots and reports.

use crate::{
    scene::{CD_ROM_SLIDE, LevelRange, Scene},
    simulate::{ScalarKind, Settings},
    sweep::Sweep,
};

/// The scene of the paper.
pub fn cd_rom() -> Scene {
    Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).unwrap()
}

/// The paper's slide at `levels` for `duration` (s), the ramp ending at `ramp_end` (s).
pub fn sweep(levels: LevelRange, duration: f64, ramp_end: f64) -> Sweep {
    let mut scene = cd_rom();
    scene.drive.ramp_end = ramp_end;
    (scene.run.duration, scene.run.step) = (duration, 1e-4);
    let settings = Settings::fixed(scene.run, 1e-3, ScalarKind::F64);
    crate::sweep::sweep(&scene, &levels.levels(), &settings, || ()).unwrap()
}
