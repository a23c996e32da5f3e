//! The wheel is built, installed into a fresh virtual environment, and tested from Python there.

use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};

/// What the Python tests import; maturin builds the wheel.
const PACKAGES: [&str; 4] = ["maturin>=1.9,<2", "mypy>=1.15,<2", "numpy", "pytest"];

/// Runs a program, which has to succeed.
fn run(program: &Path, arguments: &[&str], folder: &Path) {
    let status = Command::new(program).args(arguments).current_dir(folder).env_remove("PYTHONPATH").status();
    let status = status.unwrap_or_else(|error| panic!("{}: {error}", program.display()));
    assert!(status.success(), "{} {arguments:?}: {status}", program.display());
}

/// Needs the newest Python that is called python3, 3.11 or newer, and packages from PyPI.
#[test]
#[ignore = "installs packages and builds the module: about two minutes"]
fn the_wheel_passes_its_tests_in_a_fresh_environment() {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scratch = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let [environment, wheels] = ["venv", "wheels"].map(|name| scratch.join(name));
    let _ = std::fs::remove_dir_all(&wheels);
    run(Path::new("python3"), &["-m", "venv", "--clear", environment.to_str().unwrap()], &scratch);
    let program = |name: &str| environment.join("bin").join(name);
    run(&program("pip"), &[&["install", "--quiet"], &PACKAGES[..]].concat(), &scratch);
    // The profile of the other tests, whose compiled crates it shares.
    let build = ["build", "--quiet", "--profile", "dev", "--out", wheels.to_str().unwrap()];
    run(&program("maturin"), &build, crate_folder);
    let wheel = std::fs::read_dir(&wheels).unwrap().next().unwrap().unwrap().path();
    run(&program("pip"), &["install", "--quiet", wheel.to_str().unwrap()], &scratch);
    let tests = crate_folder.join("tests");
    run(&program("pytest"), &["-q", "-p", "no:cacheprovider", tests.to_str().unwrap()], &scratch);
    run(&program("mypy"), &["--strict", "-p", "slipfit"], &scratch);
    let allowed = ["-m", "mypy.stubtest", "slipfit._slipfit"];
    run(&program("python"), &allowed, &scratch);
}
