//! What every command does of bad names, encodings, implausible scenes and closed pipes.

use slipfit::scene::CD_ROM_SLIDE;

use super::common::{json, slipfit};

#[test]
fn names_promise_the_format_that_is_written() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, message) in [
        (&["simulate", "--csv", "x.xlsx"][..], "--csv writes .csv, not .xlsx: x.xlsx"),
        (&["simulate", "--plot", "x.png"], "--plot writes .svg, not .png"),
        (&["simulate", "--page", "x.mp4"], "--page writes .html or .htm, not .mp4"),
        (&["simulate", "slider-crank", "--csv", "x.csv.gz"], "--csv writes .csv, not .gz"),
        (&["simulate", "slider-crank", "--page", "x.pdf"], "--page writes"),
        (&["sweep", "--plot", "x.jpg"], "--plot writes"),
        (&["check", "slider-crank", "--plot", "x.png"], "--plot writes"),
        (&["population", "--plot-distance", "x.png"], "--plot-distance writes"),
        (&["precision", "--csv", "x.txt"], "--csv writes"),
        (&["table", "-o", "x.bin", "--plot", "x.png"], "--plot writes"),
        (&["tolerance", "--draws", "x.parquet"], "--draws writes .csv, not .parquet"),
        (&["tolerance", "--csv", "x.json"], "--csv writes"),
        (&["allocate", "clutch-processes", "--write", "x.yaml"], "--write writes .toml, not .yaml"),
        (&["fmu", "-o", "x.zip"], "--output writes .fmu, not .zip"),
    ] {
        let output = slipfit(folder.path(), arguments);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && told.contains(message), "{arguments:?}: {told}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    // Without an ending, in capitals, and a stream.
    for path in ["run", "RUN.CSV", "/dev/null"] {
        assert!(slipfit(folder.path(), &["simulate", "slider-crank", "--csv", path]).status.success(), "{path}");
    }
}

#[test]
fn another_encoding_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let wide: Vec<u8> = std::iter::once(0xfeff).chain(CD_ROM_SLIDE.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    std::fs::write(folder.path().join("wide.toml"), wide).unwrap();
    let output = slipfit(folder.path(), &["check", "wide.toml"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(
        (output.status.code(), &*told),
        (Some(2), "error: cannot read the scene wide.toml: it is in UTF-16: save it as UTF-8\n")
    );
    std::fs::write(folder.path().join("marked.toml"), format!("\u{feff}{CD_ROM_SLIDE}")).unwrap();
    assert!(slipfit(folder.path(), &["check", "marked.toml"]).status.success());
}

/// `check` and all that simulates say what is implausible, of slides and of mechanisms.
#[test]
fn every_command_that_simulates_warns() {
    let folder = tempfile::tempdir().unwrap();
    let commands: [&[&str]; 9] = [
        &["check", "cd-rom-slide", "--set", "slide.gravity=[0,-9810,0]"],
        &["simulate", "cd-rom-slide", "--set", "slide.gravity=[0,-9810,0]", "--set", "run.duration=60"],
        &["sweep", "cd-rom-slide", "--n", "0:0:1", "--set", "friction.coefficient=25", "--set", "run.duration=60"],
        &["population", "cd-rom-slide", "--opening", "--units", "128", "--set", "friction.coefficient=25"],
        &["kernel", "cd-rom-slide", "--set", "friction.coefficient=25"],
        &["check", "slider-crank", "--set", "friction.coefficient=25"],
        &["simulate", "slider-crank", "--set", "friction.coefficient=25", "--set", "run.duration=20"],
        &["sweep", "slider-crank", "--n", "0:0:1", "--set", "friction.coefficient=25", "--set", "run.duration=20"],
        &["table", "slider-crank", "--n", "0:1:1", "--set", "friction.coefficient=25", "--set", "run.duration=20"],
    ];
    for arguments in commands {
        let output = slipfit(folder.path(), arguments);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success() && told.contains("usual is"), "{arguments:?}: {told}");
    }
    for scene in ["cd-rom-slide", "slider-crank"] {
        let set = "friction.coefficient=25";
        for command in ["check", "simulate"] {
            let report = json(folder.path(), &[command, scene, "--set", set, "--set", "run.duration=60", "--json"]);
            let warnings = report["warnings"].as_array().unwrap();
            assert!(
                warnings.iter().any(|one| one.as_str().unwrap().contains("`friction.coefficient` is 25")),
                "{command} {scene}"
            );
        }
    }
}

/// A reader that closes its pipe has read what it wants: no message, no panic, and what is to be written is written.
#[test]
fn a_closed_pipe_ends_quietly() {
    use std::process::{Command, Stdio};
    let folder = tempfile::tempdir().unwrap();
    let closed = || {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        writer
    };
    let commands: [&[&str]; 5] = [
        &["--help"],
        &[],
        &["check"],
        &["simulate", "--json", "--csv", "run.csv"],
        &["simulate", "slider-crank", "--csv", "/dev/stdout"],
    ];
    for arguments in commands {
        let mut command = Command::new(env!("CARGO_BIN_EXE_slipfit"));
        command.current_dir(folder.path()).args(arguments);
        let output = command.stdout(Stdio::from(closed())).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {told}");
        assert!(!told.contains("ipe"), "{arguments:?}: {told}");
        // Nobody reads warnings and errors either.
        let status = command.stdout(Stdio::from(closed())).stderr(Stdio::from(closed())).status().unwrap();
        assert_eq!(status.code(), Some(0), "{arguments:?}");
    }
    assert!(folder.path().join("run.csv").exists());
    let mut wrong = Command::new(env!("CARGO_BIN_EXE_slipfit"));
    wrong.args(["check", "no-such-scene"]).stderr(Stdio::from(closed()));
    assert_eq!(wrong.status().unwrap().code(), Some(2));
}
