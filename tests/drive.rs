//! The drive at work on the emulated Cortex-M4F: what it says is what it says on the desk, and what it said before.

use std::{fs, path::Path, process::Command};

use slipfit::{
    force_table::{self, Demand},
    scene::{CD_ROM_SLIDE, Override, Scene},
    simulate::ScalarKind,
};
use slipfit_tests::cross::{self, TARGET, cargo, printed};

const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");

fn drive(table: &Path, options: &[&str]) -> String {
    let mut cargo: Command = cargo(FOLDER);
    printed(cargo.args(["run", "-p", "slipfit-firmware", "--bin", "slipfit-drive"]).args(options).arg("--").arg(table))
}

#[test]
fn says_what_it_said_and_what_the_desk_says() {
    let mut set = ["friction.law=exact", "run.duration=1500"].map(Override::set).to_vec();
    set.push(Override::option("", "sweep.n", "1:3:0.1"));
    let scene = Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &set).expect("the shipped scene");
    let (table, _) = force_table::make(&scene, ScalarKind::F64, Demand::Full, || ()).expect("its table");
    let file = Path::new(FOLDER).join("drive.bin");
    fs::write(&file, table.bytes).expect("the test's folder takes files");

    cross::require_target();
    cross::require_emulator();
    let on_target = drive(&file, &["--release", "--target", TARGET]);
    let counted = |line: &&str| line.starts_with("instructions ") || line.starts_with("stack ");
    let same: Vec<_> = on_target.lines().filter(|line| !counted(line)).collect();
    assert_eq!(same, drive(&file, &[]).lines().collect::<Vec<_>>());
    insta::assert_snapshot!("log", on_target);

    // Free where the unit is what it is taken for, tight with more friction, a jam where it jams.
    let ends: Vec<_> = on_target.lines().filter(|line| line.starts_with("first tight")).collect();
    assert_eq!(ends[0], "first tight at None ms, first jam at None ms");
    assert!(ends[1].starts_with("first tight at Some(") && ends[1].ends_with("first jam at None ms"), "{}", ends[1]);
    assert!(ends[2].contains("first jam at Some("), "{}", ends[2]);
    cross::assert_single_precision(&cross::image(FOLDER, "slipfit-drive"));
    assert_eq!(on_target.matches("table damaged in 0 rounds").count(), 3);
}
