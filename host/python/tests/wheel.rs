//! The Python module, from its wheel: builds it, installs it into fresh environments, and runs its tests and its types.

use std::{
    path::{Path, PathBuf},
    process::Command,
    time::Instant,
};

/// What the tests import.
const PACKAGES: [&str; 10] = [
    "ipykernel",
    "matplotlib",
    "mypy>=1.15,<3",
    "nbclient",
    "numpy",
    "pandas>=3",
    "polars>=1",
    "pyarrow",
    "pytest",
    "scipy",
];
/// Versions of Python that the wheel is for, the oldest first.
const VERSIONS: std::ops::RangeInclusive<u32> = 11..=15;
/// Tests that take long, of what does not depend on Python's version.
const SLOW: &str = "not notebook and not fmu and not precision and not production and not ten_thousand";

/// Runs a program, which has to succeed.
fn run(program: &Path, arguments: &[&str], folder: &Path) {
    let mut command = Command::new(program);
    // A user's own settings would change what is found.
    command.args(arguments).current_dir(folder).env_remove("PYTHONPATH").env_remove("PYTHONHOME");
    let status = command.status().unwrap_or_else(|error| panic!("{}: {error}", program.display()));
    assert!(status.success(), "{} {arguments:?}: {status}", program.display());
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

/// The oldest and the newest Python of this machine that the wheel is for: on the path, or where pyenv has them.
fn pythons() -> Vec<PathBuf> {
    let pyenv = std::env::home_dir().unwrap_or_default().join(".pyenv/versions");
    let folders = std::fs::read_dir(pyenv).into_iter().flatten().flatten().map(|entry| entry.path().join("bin"));
    let folders: Vec<_> = std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()).chain(folders).collect();
    let runs = |path: &PathBuf| {
        Command::new(path).args(["-c", "import venv, ensurepip"]).output().is_ok_and(|output| output.status.success())
    };
    let found = |minor: u32| folders.iter().map(|folder| folder.join(format!("python3.{minor}"))).find(runs);
    let mut all: Vec<_> = VERSIONS.filter_map(found).collect();
    assert!(!all.is_empty(), "Python 3.11 or newer, with venv, is needed");
    all.drain(1..all.len().max(2) - 1);
    all.dedup();
    all
}

/// A fresh environment of a `python` with these packages.
fn environment(python: &Path, folder: &Path, packages: &[&str]) {
    run(python, &["-m", "venv", "--clear", text(folder)], Path::new("/"));
    run(&folder.join("bin/pip"), &[&["install", "--quiet", "--disable-pip-version-check"], packages].concat(), folder);
}

/// Builds a wheel of this `profile` into a folder.
fn wheel(profile: &str, scratch: &Path) -> PathBuf {
    let wheels = scratch.join(format!("wheels-{profile}"));
    let _ = std::fs::remove_dir_all(&wheels);
    let tools = scratch.join("maturin");
    environment(&pythons()[0], &tools, &["maturin>=1.9,<2"]);
    let build = ["build", "--quiet", "--strip", "--profile", profile, "--out", text(&wheels)];
    run(&tools.join("bin/maturin"), &build, Path::new(env!("CARGO_MANIFEST_DIR")));
    std::fs::read_dir(&wheels).unwrap().next().unwrap().unwrap().path()
}

#[test]
#[ignore = "installs packages and builds the module: some minutes"]
fn the_wheel_passes_its_tests_with_the_oldest_and_the_newest_python() {
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    // The profile of the other tests, whose compiled crates it shares.
    let wheel = wheel("dev", scratch);
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let pythons = pythons();
    for (k, python) in pythons.iter().enumerate() {
        let folder = scratch.join(format!("python-{k}"));
        environment(python, &folder, &[&PACKAGES[..], &[text(&wheel)]].concat());
        let is_newest = k + 1 == pythons.len();
        let chosen: &[&str] = if is_newest { &[] } else { &["-k", SLOW] };
        run(
            &folder.join("bin/pytest"),
            &[&["-q", "-p", "no:cacheprovider"], chosen, &[text(&tests)]].concat(),
            scratch,
        );
        if is_newest {
            run(&folder.join("bin/mypy"), &["--strict", "-p", "slipfit"], &folder);
            run(&folder.join("bin/python"), &["-m", "mypy.stubtest", "slipfit._slipfit"], &folder);
        }
    }
}

/// Of the wheel that users install: how large it is, how long it takes to install and to import, and what calls from Python cost.
#[test]
#[ignore = "a study: builds the module as for a release, some minutes"]
fn study_of_the_wheel() {
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let wheel = wheel("release", scratch);
    let bytes = wheel.metadata().unwrap().len();
    eprintln!("wheel: {:.1} MB", bytes as f64 / 1e6);
    assert!(bytes <= 12_000_000);
    let folder = scratch.join("python-fresh");
    let begun = Instant::now();
    environment(pythons().last().unwrap(), &folder, &[text(&wheel)]);
    let first = "import slipfit; print(slipfit.Scene('cd-rom-slide').simulate(n=1).verdict)";
    run(&folder.join("bin/python"), &["-c", first], &folder);
    let seconds = begun.elapsed().as_secs_f64();
    eprintln!("environment, installation and first example: {seconds:.1} s");
    assert!(seconds < 10.0);
    run(&folder.join("bin/python"), &[text(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/study.py"))], &folder);
}
