//! The flash table that the image of the drive works with.

use std::{
    fs,
    path::{Path, PathBuf},
};

use slipfit::{
    firmware::force_table::{self, Demand},
    scene::{CD_ROM_SLIDE, Override},
    setup::Scene,
};

/// Its file, written into `folder`: the shipped slide's stroke with exact friction, at levels from 1 to 3.
///
/// # Panics
/// If the folder takes no files.
pub fn written(folder: &str) -> PathBuf {
    let mut set = ["friction.law=exact", "run.duration=1500"].map(Override::set).to_vec();
    set.push(Override::option("", "sweep.n", "1:3:0.1"));
    let scene = Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &set).expect("the shipped scene");
    let (table, _) = force_table::make(&scene, Demand::Full, || ()).expect("its table");
    let file = Path::new(folder).join("drive.bin");
    fs::write(&file, table.bytes).expect("the test's folder takes files");
    file
}
