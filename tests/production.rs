//! The watch by a table of a production on the emulated Cortex-M4F: the same text, and so the same bits, as on the host, and no more
//! instructions than are promised.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use slipfit::{
    dynamics::driven::Driven as _,
    firmware::production_table::{Over, Wish, make},
    population::production::Production,
    scene::CD_ROM_SLIDE,
    setup::Scene,
};
use slipfit_tests::cross::{self, TARGET, cargo, printed, whole_program};

const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");

/// Instructions that a sample and the end of a stroke may take together.
const MOST: u32 = 1500;

/// Bytes of what is kept of a unit and a stroke.
const STATE_MOST: u32 = 256;

/// A table of few units, as large as one of many.
static TABLE: LazyLock<PathBuf> = LazyLock::new(|| {
    let mut scene = Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).expect("the shipped scene");
    scene.run.duration = scene.stroke_duration().expect("it has a stroke");
    let production = Production::new(&scene, None, 0.0, 1).expect("its gaps are independent");
    let wish = Wish { over: Over::Time, units: 400, seed: 1, noise: 0.02, friction: 0.03, period: 2e-3, bytes: 16_384 };
    let table = make(&scene, &production, &wish, || {}).expect("a table");
    let file = Path::new(FOLDER).join("production.bin");
    fs::write(&file, table.bytes).expect("the test's folder takes files");
    file
});

static ON_TARGET: LazyLock<String> = LazyLock::new(|| {
    cross::require_target();
    cross::require_emulator();
    let image = ["run", "--release", "-p", "slipfit-firmware", "--bin", "slipfit-production", "--target", TARGET, "--"];
    printed(whole_program(FOLDER).args(image).arg(&*TABLE))
});

/// The numbers behind `before` in what the image printed.
fn numbers(before: &str) -> Vec<u32> {
    let line = ON_TARGET.lines().find_map(|line| line.split_once(before)).expect("a line").1;
    line.split(|c: char| !c.is_ascii_digit()).flat_map(str::parse).collect()
}

#[test]
fn image_and_host_see_the_same_bits() {
    let host = printed(
        cargo(FOLDER).args(["run", "-p", "slipfit-firmware", "--bin", "slipfit-production", "--"]).arg(&*TABLE),
    );
    let is_count = |line: &&str| line.starts_with("instructions of ") || line.starts_with("stack of ");
    let target: Vec<&str> = ON_TARGET.lines().filter(|line| !is_count(line)).collect();
    assert_eq!(host.lines().collect::<Vec<_>>(), target);
    let strokes: Vec<&str> = target.iter().filter(|line| line.starts_with("stroke ")).copied().collect();
    assert_eq!(strokes.len(), 16);
    for (k, stroke) in strokes.iter().enumerate() {
        assert!(stroke.contains(if k < 14 { ": Free" } else { ": Tight" }), "{stroke}");
        assert!(stroke.ends_with("saved true"), "{stroke}");
    }
}

#[test]
fn a_period_takes_no_more_than_is_promised() {
    let greatest = |what: &str| *numbers(what).last().expect("a count");
    let (sample, end) = (greatest("instructions of a sample: "), greatest("instructions of a stroke's end: "));
    println!("a sample {sample}, a stroke's end {end} instructions");
    println!("stack {:?} and {:?} bytes", numbers("stack of a sample: "), numbers("stack of a stroke's end: "));
    assert!(sample + end <= MOST, "{sample} {end}");
    let [unit, stroke] = numbers("unit ")[..] else { panic!("{}", *ON_TARGET) };
    assert!(unit + stroke <= STATE_MOST, "{unit} {stroke}");
}

#[test]
fn the_image_has_no_double_precision() {
    assert!(!ON_TARGET.is_empty(), "it has been built");
    cross::assert_single_precision(&cross::image(FOLDER, "slipfit-production"));
}
