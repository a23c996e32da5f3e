//! The program at a terminal, and interrupted.

use std::{
    fs::File,
    io::Read,
    path::Path,
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use nix::{
    pty::openpty,
    sys::signal::{Signal, kill},
    unistd::Pid,
};

fn slipfit(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_slipfit"));
    command.current_dir(folder).args(arguments).stdout(Stdio::null());
    command
}

/// Starts the program with a terminal as its standard error, and takes it down once `expected` is shown there.
fn shows(arguments: &[&str], expected: &str) {
    let folder = tempfile::tempdir().unwrap();
    let terminal = openpty(None, None).unwrap();
    let child = slipfit(folder.path(), arguments).env("TERM", "xterm").stderr(File::from(terminal.slave)).spawn();
    let mut child = child.unwrap();
    let (mut seen, mut found) = (Vec::new(), false);
    let mut screen = File::from(terminal.master);
    let mut buffer = [0; 4096];
    // Reading fails where the program has ended.
    while !found && let Ok(count) = screen.read(&mut buffer) {
        seen.extend_from_slice(&buffer[..count]);
        let text = String::from_utf8_lossy(&seen);
        found = text.contains(expected) && text.contains(" left");
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(found, "{arguments:?} shows {}", String::from_utf8_lossy(&seen));
}

#[test]
fn what_takes_long_shows_how_far_it_is_and_the_time_left() {
    shows(&["table", "--over", "position", "-o", "z.bin"], "simulating");
    shows(&["precision"], "measuring");
    shows(&["precision", "--stability", "--threads", "1"], "simulating");
    shows(&["sweep", "--stroke", "--n", "-3:5:0.02"], "simulating");
    shows(&["sweep", "telescopic-drawer", "--n", "-1:1:0.01"], "simulating");
    shows(&["run"], "simulating");
}

#[test]
fn an_interrupted_main_job_leaves_no_folder() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["run", "cd-rom-slide", "--out", "results", "--n", "-3:5:0.01"];
    let mut child = slipfit(folder.path(), &arguments).stderr(Stdio::null()).spawn().unwrap();
    let out = folder.path().join("results");
    let start = Instant::now();
    while !out.exists() {
        assert!(start.elapsed() < Duration::from_secs(20), "no folder is made");
        std::thread::sleep(Duration::from_millis(10));
    }
    kill(Pid::from_raw(child.id().try_into().unwrap()), Signal::SIGINT).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1));
    assert!(!out.exists());
}

#[test]
fn files_of_another_product_in_the_folder_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let run =
        |scene: &str| slipfit(folder.path(), &["run", scene, "--out", "results", "--n", "0:1:1"]).output().unwrap();
    assert!(!String::from_utf8(run("cd-rom-slide-drawing").stderr).unwrap().contains("histogram"));
    let second = String::from_utf8(run("cd-rom-slide").stderr).unwrap();
    assert!(second.contains("contributors-2.svg") && second.contains("and 23 more"), "{second}");
}
