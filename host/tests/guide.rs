//! The guide's commands, as they stand there. Those that need the repository, a target or minutes are in `console` blocks.

use std::{path::Path, process::Command};

/// The lines of the guide's shell blocks, without their comments.
fn commands() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("guide/src");
    let mut commands = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "md") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let blocks = text.split("```sh\n").skip(1).filter_map(|block| block.split("```").next());
        for line in blocks.flat_map(str::lines) {
            let command = line.split("  #").next().unwrap_or(line).trim();
            if !command.is_empty() {
                commands.push((path.display().to_string(), command.to_owned()));
            }
        }
    }
    commands
}

#[test]
fn every_command_of_the_guide_works() {
    let folder = tempfile::tempdir().unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_slipfit")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let commands = commands();
    assert!(commands.len() >= 4, "{commands:?}");
    for (page, command) in commands {
        assert!(command.starts_with("slipfit "), "{page}: {command}");
        let output = Command::new("sh").current_dir(folder.path()).env("PATH", &path).args(["-c", &command]).output();
        let output = output.unwrap();
        assert!(output.status.success(), "{page}: {command}: {}", String::from_utf8_lossy(&output.stderr));
    }
}
