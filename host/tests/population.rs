//! `slipfit population` as a user meets it.

mod common;

use std::{
    path::Path,
    process::{Command, Stdio},
};

use common::{slipfit, stdout};

use serde_json::Value;

fn json(folder: &Path, arguments: &[&str]) -> Value {
    common::json(folder, &[arguments, &["--json"]].concat())
}

/// Of 300 units of the drawing that were simulated one by one by another program 142 ran, 37 crawled and 121 jammed.
#[test]
fn about_half_of_the_cd_rom_slides_run() {
    let folder = tempfile::tempdir().unwrap();
    let found = json(folder.path(), &["population", "cd-rom-slide-drawing", "--units", "1500"]);
    for (verdict, other) in [("runs", 142.0), ("crawls", 37.0), ("jammed", 121.0)] {
        let share = found["statistics"][verdict]["share"].as_f64().unwrap();
        let expected: f64 = other / 300.0;
        let error = libm::sqrt(expected * (1.0 - expected) * (1.0 / 300.0 + 1.0 / 1500.0));
        assert!((share - expected).abs() < 4.0 * error, "{verdict} {share} {expected}");
    }
    // The walls of the frame that the pins stand on drive both.
    let first = found["malfunction_drivers"][0]["name"].as_str().unwrap();
    assert!(first.contains("back wall"), "{first}");
}

#[test]
fn the_files_do_not_depend_on_threads_and_a_unit_can_be_drawn_again() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str, name: &str| {
        let (csv, plot) = (format!("{name}.csv"), format!("{name}.svg"));
        let arguments = ["population", "--units", "600", "--threads", threads, "--csv", &csv, "--plot", &plot];
        let printed = stdout(&slipfit(folder.path(), &arguments));
        let read = |file: &str| std::fs::read_to_string(folder.path().join(file)).unwrap();
        (printed, read(&csv), read(&plot))
    };
    let one = run("1", "one");
    assert_eq!(run("3", "three"), one);
    let row: Vec<&str> = one.1.lines().nth(1 + 123).unwrap().split(',').collect();
    assert_eq!(row[0], "123");
    let alone = json(folder.path(), &["simulate", "--unit", "123", "--stroke"]);
    assert_eq!(alone["verdict"], row[8]);
    let peak: f64 = row[3].parse().unwrap();
    assert!((alone["peak_force"].as_f64().unwrap() / peak - 1.0).abs() < 5e-3, "{peak} {}", alone["peak_force"]);
    let gap: f64 = row[10].parse().unwrap();
    assert!((alone["gaps"][0]["mm"].as_f64().unwrap() - 1e3 * gap).abs() < 1e-8);
}

/// The most memory (bytes) that a process had.
#[cfg(target_os = "linux")]
fn peak_memory(folder: &Path, arguments: &[&str]) -> u64 {
    let mut child = Command::new(env!("CARGO_BIN_EXE_slipfit"))
        .args(arguments)
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    while child.try_wait().unwrap().is_none() {
        let status = std::fs::read_to_string(&status).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<u64>().ok());
        peak = kilobytes.map_or(peak, |kilobytes| peak.max(1024 * kilobytes));
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!(child.wait().unwrap().success());
    peak
}

/// Whatever is kept of a unit for good would take 6 MB of memory for every 20 bytes of it.
#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_population() {
    let folder = tempfile::tempdir().unwrap();
    let units = |units: &str| {
        let arguments = ["population", "--opening", "--units", units, "--csv", "units.csv", "--out", "units.pop"];
        let peak = peak_memory(folder.path(), &arguments);
        let size = |file: &str| std::fs::metadata(folder.path().join(file)).unwrap().len();
        assert!(size("units.csv") > 100 * units.parse::<u64>().unwrap());
        [peak, size("units.pop")]
    };
    // Counted one by one up to about 30,000 values, then in as many classes.
    let [few, many] = [units("50000"), units("350000")];
    println!("memory and file (bytes): of 50,000 units {few:?}, of 350,000 {many:?}");
    assert!(many[0] < few[0] + (6 << 20), "{few:?} {many:?}");
    assert!(many[1] < few[1] + (1 << 20), "{few:?} {many:?}");
}

#[test]
fn what_varies_is_read_and_what_cannot_be_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/cd-rom-slide.toml")).unwrap();
    let write = |vary: &str| std::fs::write(&scene, format!("{text}\n[vary]\n{vary}\n")).unwrap();
    write("friction.coefficient = 0.06\ndrive.gain = \"2 N·s/m\"\ncontact.stiffness = { tolerance = 0.1 }");
    let arguments = ["population", "scene.toml", "--units", "512", "--opening"];
    let found = json(folder.path(), &arguments);
    let names: Vec<&str> =
        found["force_drivers"].as_array().unwrap().iter().map(|driver| driver["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"friction.coefficient") && names.contains(&"drive.gain"), "{names:?}");
    for (vary, told) in [
        ("friction.coeficient = 0.1", "coefficient"),
        ("slide.mass = \"3 mm\"", "slide.mass"),
        ("slide.mass = 0", "more than 0"),
    ] {
        write(vary);
        let output = slipfit(folder.path(), &arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{vary}: {error}");
        assert!(error.contains("scene.toml:") && error.contains(told), "{vary}: {error}");
    }
    // So wide that a unit has less than no friction.
    write("friction.coefficient = 1.5");
    let output = slipfit(folder.path(), &arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("unit ") && error.contains("friction"), "{error}");
    for bad in [["--correlation", "1.5"], ["--force-limit", "-1"], ["--units", "0"]] {
        assert_eq!(slipfit(folder.path(), &[&["population"][..], &bad].concat()).status.code(), Some(2), "{bad:?}");
    }
}

/// The slide with every gap certain.
fn certain() -> String {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/cd-rom-slide.toml")).unwrap();
    text.lines()
        .map(|line| match line.split_once(" = [") {
            Some((name, rest)) if ["left", "right", "rail", "wall"].contains(&name.trim()) => {
                let mean = rest.split(',').next().unwrap();
                format!("{name} = [{mean}, 0]\n")
            }
            _ => format!("{line}\n"),
        })
        .collect()
}

/// With every gap certain, all units are one, and a force limit splits nothing.
#[test]
fn a_production_without_variation_is_one_unit() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("certain.toml"), certain()).unwrap();
    let share_over = |limit: &str| {
        let arguments = [
            "population",
            "certain.toml",
            "--units",
            "40",
            "--opening",
            "--set",
            "drive.ramp_end=0.1",
            "--force-limit",
            limit,
        ];
        let statistics = json(folder.path(), &arguments)["statistics"].clone();
        let forces = statistics["peak_force"]["quantiles"].as_array().unwrap().clone();
        assert!(forces.iter().all(|force| force == &forces[0]), "{statistics}");
        (forces[0].as_f64().unwrap(), statistics["over_limit"]["share"].as_f64().unwrap())
    };
    let (force, _) = share_over("100");
    assert_eq!(share_over(&(force * 1.001).to_string()).1, 0.0);
    assert_eq!(share_over(&(force * 0.999).to_string()).1, 1.0);
}

/// Only the mass varies, and the force grows with it: the limit is the force of a unit as heavy as one in a thousand.
#[test]
fn a_rare_malfunction_is_as_probable_as_it_is() {
    const Z: f64 = 3.090_232_306_167_813;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("certain.toml");
    // As short as it may be: tens of thousands of units are simulated.
    let set = ["drive.ramp_start=0.001", "drive.ramp_end=0.011", "run.duration=16"];
    let short = set.map(|set| ["--set", set]).concat();
    let of = |options: &[&str]| {
        json(
            folder.path(),
            &[&["population", "certain.toml", "--units", "2", "--opening"], &short[..], options].concat(),
        )
    };
    std::fs::write(&path, certain()).unwrap();
    let mass = format!("slide.mass={}", 81.8 + 2.0 * Z);
    let limit = of(&["--set", &mass])["statistics"]["peak_force"]["mean"].as_f64().unwrap().to_string();
    // Three standard deviations.
    std::fs::write(&path, certain() + "\n[vary]\nslide.mass = \"6 g\"\n").unwrap();
    let found = of(&["--force-limit", &limit, "--rare"])["rare"].clone();
    let parts = found["parts"].as_array().unwrap();
    let kinds: Vec<&str> = parts.iter().map(|part| part["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["crawls", "jams", "overruns", "over-limit"]);
    assert!(parts.iter().all(|part| part["side"] == "any"));
    let [probability, error] =
        ["probability", "standard_error"].map(|name| parts[3][name].as_f64().unwrap_or(f64::NAN));
    assert!((probability - 1e-3).abs() < 4.0 * error && error < 3e-4, "{found}");
}

/// What is not known has a reason instead of a figure, whatever the number of threads.
#[test]
fn no_figure_is_given_without_a_verdict() {
    let folder = tempfile::tempdir().unwrap();
    let of = |threads: &str| {
        let arguments = ["population", "--units", "2", "--opening", "--rare", "--set", "run.duration=60"];
        json(folder.path(), &[&arguments[..], &["--threads", threads]].concat())["rare"].clone()
    };
    let found = of("1");
    assert!(found["malfunction"]["probability"].is_null(), "{found}");
    assert!(found["parts"][0]["reason"].as_str().unwrap().contains("no verdict"), "{found}");
    assert_eq!(of("3"), found);
}

/// Starts a population and sends it a signal once it has kept something, with as many units as that takes. What it says on
/// errors, its exit code, and the command.
fn stopped(folder: &Path, out: &str, signal: &str) -> (String, Option<i32>, Vec<String>) {
    let partial = folder.join(format!("{out}.partial"));
    let mut units = 10_000;
    loop {
        let count = units.to_string();
        let csv = format!("{out}.csv");
        let command =
            ["population", "--seed", "4", "--opening", "--json", "--out", out, "--csv", &csv, "--units", &count];
        let mut victim = Command::new(env!("CARGO_BIN_EXE_slipfit"))
            .current_dir(folder)
            .args(command)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        while !partial.exists() && victim.try_wait().unwrap().is_none() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let sent = Command::new("kill").args([signal, &victim.id().to_string()]).stderr(Stdio::null()).status();
        assert!(sent.is_ok());
        let ended = victim.wait_with_output().unwrap();
        if partial.exists() {
            let said = String::from_utf8(ended.stderr).unwrap();
            return (said, ended.status.code(), command.map(str::to_owned).into());
        }
        let _ = std::fs::remove_file(folder.join(out));
        units *= 2;
    }
}

/// What was reported done is kept, whether a run is killed or interrupted: it goes on from there, to the bytes of one run.
#[test]
fn stopped_runs_go_on_where_they_were() {
    let folder = tempfile::tempdir().unwrap();
    for (out, signal, code) in [("killed", "-KILL", None), ("interrupted", "-INT", Some(1))] {
        let (said, ended, command) = stopped(folder.path(), out, signal);
        assert_eq!(ended, code, "{said}");
        assert!(!folder.path().join(out).exists());
        let command: Vec<_> = command.iter().map(String::as_str).collect();
        let left = slipfit(folder.path(), &command);
        assert!(String::from_utf8(left.stderr).unwrap().contains("--resume goes on"));
        let rows = || std::fs::read(folder.path().join(format!("{out}.csv"))).unwrap();
        let resumed = (stdout(&slipfit(folder.path(), &[&command[..], &["--resume"]].concat())), rows());
        std::fs::remove_file(folder.path().join(out)).unwrap();
        let whole = (stdout(&slipfit(folder.path(), &[&command[..], &["--threads", "3"]].concat())), rows());
        assert!(whole == resumed);
    }
    // Nowhere to keep anything: told before the first unit.
    let nowhere = slipfit(folder.path(), &["population", "--units", "10", "--opening", "--out", "no/where"]);
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(String::from_utf8(nowhere.stderr).unwrap().contains("no/where"));
}

/// A disk that is full when the first checkpoint, or the result, is written: told by name, and nothing half written is left. With
/// room again the run goes on to the bytes of one run.
#[test]
fn a_full_disk_is_told_and_nothing_is_half_written() {
    let folder = tempfile::tempdir().unwrap();
    let options = "population --units 2000 --opening --seed 4 --json --out units";
    let program = env!("CARGO_BIN_EXE_slipfit");
    // No file may grow beyond 100 blocks; without the trap a signal would end the program.
    let script = format!("trap '' XFSZ; ulimit -f 100; exec {program} {options}");
    let full = Command::new("sh").current_dir(folder.path()).args(["-c", &script]).output().unwrap();
    let said = String::from_utf8(full.stderr).unwrap();
    assert!(full.status.code() == Some(1) && said.contains("units"), "{said}");
    assert!(full.stdout.is_empty());
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| name == "units.partial"), "{left:?}");
    let command: Vec<_> = options.split(' ').chain(["--resume"]).collect();
    let resumed = stdout(&slipfit(folder.path(), &command));
    let whole = ["population", "--units", "2000", "--opening", "--seed", "4", "--json"];
    assert_eq!(stdout(&slipfit(folder.path(), &whole)), resumed);
}

/// Shards in any order end in the bytes of one run.
#[test]
fn shards_end_in_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let common = ["population", "--units", "1300", "--opening", "--seed", "4", "--json"];
    let of = |options: &[&str]| slipfit(folder.path(), &[&common[..], options].concat());
    let whole = stdout(&of(&["--out", "whole", "--threads", "1"]));
    for (shard, out) in [("1/3", "a"), ("2/3", "b"), ("3/3", "c")] {
        let written: Value = serde_json::from_str(&stdout(&of(&["--shard", shard, "--out", out]))).unwrap();
        assert_eq!((&written["of"], &written["file"]), (&3.into(), &out.into()));
    }
    let merged = stdout(&slipfit(folder.path(), &["merge", "c", "a", "b", "--out", "merged", "--json"]));
    assert!(merged == whole && std::fs::read(at("merged")).unwrap() == std::fs::read(at("whole")).unwrap());

    let refused = |arguments: &[&str]| {
        let output = slipfit(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(refused(&["merge", "a", "c"]).contains("missing: 2"));
    assert!(refused(&["merge", "a", "b", "c", "--csv", "x"]).contains("--csv"));
    of(&["--shard", "3/3", "--out", "d", "--force-limit", "1"]);
    assert!(refused(&["merge", "a", "b", "d"]).contains("another force limit"));
}

/// Where the ramp is not over nobody knows whether a unit does its job, and before it there is no force.
#[test]
fn what_is_not_known_is_no_malfunction() {
    let folder = tempfile::tempdir().unwrap();
    let of = |options: &[&str]| {
        json(folder.path(), &[&["population", "--units", "30", "--opening"][..], options].concat())["statistics"]
            .clone()
    };
    let opening = of(&[]);
    assert_eq!(
        (opening["malfunctions"]["units"].as_u64(), opening["undecided"]["units"].as_u64()),
        (Some(0), Some(30))
    );
    assert_eq!(of(&["--force-limit", "0.01"])["malfunctions"]["units"], 30);
    let before = of(&["--set", "run.duration=20"]);
    assert!(before["peak_force"].is_null(), "{before}");
    // A page shows what there is: no picture of where units fail of which none is known to.
    of(&["--set", "run.duration=20", "--page", "early.html"]);
    let page = std::fs::read_to_string(folder.path().join("early.html")).unwrap();
    assert!(page.contains("not known: none of 30 units comes to a verdict"));
    assert!(!["where units fail", "greatest drive force (N)", "NaN"].iter().any(|picture| page.contains(picture)));
}
