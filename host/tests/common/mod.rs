//! The program as tests start it.

use std::{
    path::Path,
    process::{Command, Output},
};

/// Runs the program in `folder`.
pub fn slipfit(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_slipfit")).current_dir(folder).args(arguments).output().unwrap()
}

/// What it printed; it has to have done its work.
#[track_caller]
pub fn stdout(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// What it prints as JSON; not every test reads any.
#[allow(dead_code)]
#[track_caller]
pub fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&stdout(&slipfit(folder, arguments))).unwrap()
}

/// The names of what a folder holds, in order; not every test looks.
#[allow(dead_code)]
pub fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}
