//! The paper's slide and sweeps of it, for the tests of plots and reports.

use super::{
    driven::Driven,
    sweep::{Keep, Sweep},
};
use crate::{
    scene::CD_ROM_SLIDE,
    setup::{LevelRange, Scene},
};

/// The scene of the paper.
pub fn cd_rom() -> Scene {
    Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).unwrap()
}

/// The paper's slide with a friction that is so uncertain that some units have a negative one, which is out of bounds.
pub fn of_uncertain_friction() -> Scene {
    let vary = "\n[vary]\nfriction.coefficient = { distribution = { kind = \"normal\", deviation = 0.15 }, tolerance = 0.45 }\n";
    Scene::parse("cd-rom-slide.toml", &(CD_ROM_SLIDE.to_owned() + vary), &[]).unwrap()
}

/// The paper's slide at `levels` for `duration` (s), the ramp ending at `ramp_end` (s).
pub fn sweep(levels: LevelRange, duration: f64, ramp_end: f64) -> Sweep {
    let mut scene = cd_rom();
    scene.drive.ramp_end = ramp_end;
    scene.run.duration = duration;
    let unit = |n| scene.level(n, scene.motion(1e-3));
    super::sweep::sweep(&scene, &levels.levels(), Keep::Samples, unit, || ()).unwrap()
}
