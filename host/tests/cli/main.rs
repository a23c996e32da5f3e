//! The program as a user meets it.

#[path = "../common/mod.rs"]
mod common;
mod sweep_over;

use std::process::Command;

use common::{files, json, slipfit, stdout};

#[test]
fn explains_itself_in_one_screen() {
    let folder = tempfile::tempdir().unwrap();
    let text = stdout(&slipfit(folder.path(), &[]));
    assert!(text.lines().count() <= 40 && text.lines().all(|line| line.chars().count() <= 100), "{text}");
    for command in ["run", "check", "tolerance", "simulate", "sweep", "table", "precision"] {
        assert!(text.contains(&format!("\n  {command} ")), "{command}");
    }
}

#[test]
fn a_clearance_that_contradicts_the_gaps_is_told_by_every_command() {
    let folder = tempfile::tempdir().unwrap();
    for command in ["check", "simulate", "sweep", "table", "run", "population"] {
        let mut arguments = vec![command, "cd-rom-slide"];
        arguments
            .extend(["sweep", "table", "run"].contains(&command).then_some(["--n", "0:1:1"]).into_iter().flatten());
        arguments.extend((command == "population").then_some(["--units", "200"]).into_iter().flatten());
        let output = slipfit(folder.path(), &arguments);
        let warnings = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            warnings.contains("states a clearance of 0.40 mm across where its gaps add up to"),
            "{command} {warnings}"
        );
    }
}

#[test]
fn a_controller_is_told_a_step_that_does_and_where_its_slide_tips() {
    let folder = tempfile::tempdir().unwrap();
    let run = |step: &str| json(folder.path(), &["simulate", "--n", "0", "--stroke", "--step", step, "--json"]);
    let coarse = run("1ms");
    let advice = &coarse["trust"];
    assert_eq!(advice["better_step_tried"], true, "{advice}");
    let step = advice["better_step"].as_f64().unwrap();
    let warning = coarse["warnings"].as_array().unwrap().last().unwrap().as_str().unwrap().to_owned();
    assert!(warning.contains(&format!("take --step {}us", step * 1e6)), "{warning}");
    let fine = run(&format!("{}us", step * 1e6));
    assert!(fine["trust"]["better_step"].is_null() && fine["trust"]["difference"].as_f64().unwrap() < 5e-3, "{step}");
    let desk = json(folder.path(), &["simulate", "--n", "0", "--stroke", "--json"]);
    let tips = |report: &serde_json::Value| report["tips"]["z"].as_f64().unwrap();
    assert!((tips(&fine) - tips(&desk)).abs() < 1e-4, "{} {}", tips(&fine), tips(&desk));
    // A sweep by the controller says so of its worst level.
    let swept = slipfit(folder.path(), &["sweep", "--n", "0:2:1", "--stroke", "--step", "1ms"]);
    assert!(
        String::from_utf8_lossy(&swept.stderr).contains("; take --step "),
        "{}",
        String::from_utf8_lossy(&swept.stderr)
    );
}

#[test]
fn a_table_across_two_worlds_warns() {
    let folder = tempfile::tempdir().unwrap();
    let output = slipfit(folder.path(), &["table", "--over", "position", "--n", "0:4:1"]);
    assert!(output.status.success());
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("neighbouring levels differ by more than can be interpolated")
    );
}

#[test]
fn a_table_that_no_finer_levels_help_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let output = slipfit(folder.path(), &["table", "--over", "position", "--n", "1:3:0.1"]);
    let warnings = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(warnings.contains("the force changes too fast for the positions of the table"), "{warnings}");
}

#[test]
fn all_mistakes_of_a_slide_are_told_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let changes =
        ["controller.step=0", "pin.left back.wall=nope", "sweep.n=5:-3:0.1", "drive.ramp_end=0.01", "slide.mass=-1"];
    let mut arguments = vec!["check", "cd-rom-slide"];
    arguments.extend(changes.iter().flat_map(|change| ["--set", change]));
    let output = slipfit(folder.path(), &arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{errors}");
    for place in
        ["`controller.step` is 0", "nope", "is below the first", "`drive.ramp_end` is 0.01", "`slide.mass` is -1"]
    {
        assert!(errors.contains(place), "{place}\n{errors}");
    }
}

#[test]
fn a_controller_s_motion_without_end_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let output = slipfit(folder.path(), &["simulate", "--n", "2.5", "--integrator", "rk4"]);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(1) && errors.contains("left the finite range"), "{errors}");
}

#[test]
fn pictures_are_drawn_when_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, words) in [
        (&["simulate", "--n", "1", "--plot", "a.svg"][..], "drive force (N)"),
        (&["sweep", "--n", "0:2:1", "--plot", "a.svg"], "verdict and force"),
        (&["table", "--n", "0:2:1", "--plot", "a.svg"], "as the flash table gives it"),
        (&["table", "--n", "0:2:1", "--over", "position", "--plot", "a.svg"], "position (mm)"),
    ] {
        stdout(&slipfit(folder.path(), arguments));
        let svg = std::fs::read_to_string(folder.path().join("a.svg")).unwrap();
        assert!(svg.contains(words) && roxmltree::Document::parse(&svg).is_ok(), "{arguments:?}");
        std::fs::remove_file(folder.path().join("a.svg")).unwrap();
    }
    // One file cannot hold two outputs.
    for arguments in [["simulate", "--csv", "a", "--plot", "a"], ["sweep", "--csv", "a", "--plot", "./a"]] {
        let output = slipfit(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!folder.path().join("a").exists());
    }
}

#[test]
fn machines_are_told_the_version_the_solver_and_the_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let report = json(folder.path(), &["simulate", "--n", "2.5", "--json"]);
    assert_eq!((&report["json_version"], &report["solver"]["by"]), (&2.into(), &"desk".into()));
    assert!(report["solver"]["accepted"].as_u64().unwrap() > 50 && report["solver"]["tolerance_n"] == 1.2e-6);
    assert_eq!(report["controller"]["solver"]["integrator"], "implicit-euler");
    assert!(report["controller"]["trust"]["difference"].as_f64().unwrap() < 0.01);
    assert!(report["warnings"][0].as_str().unwrap().contains("self-locking"));
    let report = json(folder.path(), &["sweep", "--n", "0:1:1", "--stroke", "--json"]);
    assert_eq!((&report["json_version"], &report["ranges"][0]["verdict"]), (&2.into(), &"jammed".into()));
    assert!(report["levels"][0]["stops"]["z"].as_f64().unwrap() > 0.03, "{report}");
    for command in [&["check"][..], &["kernel"], &["table", "--n", "0:1:1"], &["run", "--n", "0:1:1"]] {
        let report = json(folder.path(), &[command, &["--json"]].concat());
        assert_eq!(report["json_version"], 2, "{command:?}");
    }
}

#[test]
fn help_into_a_full_disk_fails() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut help = Command::new(env!("CARGO_BIN_EXE_slipfit"));
    assert_eq!(help.arg("--help").stdout(full).status().unwrap().code(), Some(1));
}

#[test]
fn check_counts_degrees_of_freedom_and_names_the_tightest_pair() {
    let folder = tempfile::tempdir().unwrap();
    let found = json(folder.path(), &["check", "--json"]);
    assert_eq!((&found["n_cl"], &found["degrees_of_freedom"]), (&5.into(), &1.into()));
    let tightest = &found["n_star"][0];
    assert_eq!((&tightest["pin"], &tightest["pair"]), (&"left front".into(), &"across".into()));
    assert!((tightest["n"].as_f64().unwrap() - 3.4299).abs() < 5e-5);
    assert!(stdout(&slipfit(folder.path(), &["check"])).contains("n_cl = 5, n = 1"));
    // A gap is compressed, zero or free.
    let zero = json(folder.path(), &["check", "--json", "--set", "pin.left back.left=[0, 0.04]"]);
    let classes: Vec<_> = zero["gaps"].as_array().unwrap().iter().map(|gap| gap["class"].as_str().unwrap()).collect();
    assert_eq!((classes[0], classes[2], classes[3]), ("zero", "compressed", "free"));
}

#[test]
fn drive_points_on_both_sides_of_the_edge() {
    let folder = tempfile::tempdir().unwrap();
    let guide = |x: &str| json(folder.path(), &["check", "--json", "--set", &format!("drive.point=[{x},0,0]")]);
    for (x, side, critical, warn) in
        [("0", "edge", 0.290_32, true), ("5", "beyond", 0.268_66, true), ("-10", "short", 0.346_15, false)]
    {
        let found = guide(x);
        assert_eq!(found["guide"]["side"], side);
        assert!((found["guide"]["critical_friction"].as_f64().unwrap() - critical).abs() < 1e-5, "{found}");
        let warned = found["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains("self-locking"));
        assert_eq!(warned, warn, "{x}");
    }
}

#[test]
fn a_run_is_sampled_as_asked_and_json_carries_its_figures() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["simulate", "--n", "2.5", "--step", "1ms", "--csv", "run.csv", "--json", "--scalar", "f32"];
    let report = json(folder.path(), &arguments);
    assert!(report["integration_ms"].as_f64().unwrap() > 0.0);
    assert_eq!(report["verdict"], "undecided");
    let csv = std::fs::read_to_string(folder.path().join("run.csv")).unwrap();
    let lines: Vec<_> = csv.lines().collect();
    assert_eq!((lines[0], lines.len()), ("t (s),vz (m/s),force (N),x (m),y (m),z (m)", 202));
    assert!(lines[201].starts_with("0.2,"));
    let sixteen = ["2.5"; 16].join(",");
    let each = json(folder.path(), &["simulate", "--n", &sixteen, "--step", "1ms", "--json", "--scalar", "f32"]);
    assert_eq!(each["samples"], report["samples"]);
}

#[test]
fn tolerance_gives_table_2_in_millimetres() {
    let folder = tempfile::tempdir().unwrap();
    let report = json(folder.path(), &["tolerance", "cd-rom-slide", "--json"]);
    let measures = report["measures"].as_array().unwrap();
    assert_eq!(measures.len(), 16);
    for (measure, [mean, sd]) in measures.iter().zip(slipfit_problems::cd_rom::TABLE_2) {
        assert_eq!((measure["mean"].as_f64(), measure["sd"].as_f64()), (Some(mean), Some(sd)), "{measure}");
    }
}

#[test]
fn every_form_of_the_table_is_written() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["table.bin", "table.hex", "table.h", "table.rs"] {
        let text = stdout(&slipfit(folder.path(), &["table", "-o", name, "--n", "0:2:1"]));
        assert!(text.contains("Worst interpolation error"), "{text}");
    }
    assert_eq!(files(folder.path()), ["table.bin", "table.h", "table.hex", "table.rs"]);
    let bytes = std::fs::read(folder.path().join("table.bin")).unwrap();
    let table: slipfit_core::table::Table<'_> = slipfit_core::table::Table::open(&bytes).unwrap();
    assert!(table.lookup([1.0, 0.2]).force > 0.2);
}

#[test]
fn tables_over_position_and_speed_name_their_axes() {
    let folder = tempfile::tempdir().unwrap();
    let stroke = ["--set", "run.duration=700", "--n", "0:2:1", "--json"];
    let table = |options: &[&str]| {
        let arguments = [&["table", "cd-rom-slide-fast", "-o", "table.bin"], options, &stroke].concat();
        json(folder.path(), &arguments)
    };
    let axes = |report: &serde_json::Value| -> Vec<String> {
        let axes = report["axes"].as_array().unwrap();
        axes.iter()
            .map(|axis| format!("{} {} {}", axis["kind"], axis["unit"], axis["count"]).replace('"', ""))
            .collect()
    };
    assert_eq!(axes(&table(&[])), ["level 1 3", "time s 701"]);
    let report = table(&["--over", "position", "--end", "25"]);
    assert_eq!(axes(&report), ["level 1 3", "position m 101"]);
    assert_eq!(report["axes"][1]["step"].as_f64().map(|step| step as f32), Some(0.25e-3));
    assert!(report["rms_force_error_n"].as_f64() < report["worst_force_error_in_use_n"].as_f64());
    // The tightest of the three jams before.
    assert_eq!((&report["short"][0]["n"], &report["short"][0]["verdict"]), (&2.0.into(), &"jammed".into()));
    let bytes = std::fs::read(folder.path().join("table.bin")).unwrap();
    let found = slipfit_core::table::Table::<2>::open(&bytes).unwrap().lookup([0.0, 0.01]);
    assert!(found.force > 0.2 && found.velocity > 0.05, "{found:?}");
    let report = table(&["--over", "position,speed", "--speeds", "60:100:20", "--end", "15"]);
    assert_eq!(axes(&report), ["level 1 3", "position m 61", "speed m/s 3"]);

    let arguments = ["table", "cd-rom-slide-fast", "--over", "position", "--end", "25"];
    let text = stdout(&slipfit(folder.path(), &[&arguments, &stroke[..4]].concat()));
    assert!(text.contains("n = +2 at 100.0 mm/s jams at z = ") && text.contains("holds the last force"), "{text}");
}

/// Every kind of bad input: exit code 2, a message that names the thing, nothing written.
#[test]
fn bad_input_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let shipped = slipfit::scene::CD_ROM_SLIDE;
    let scene = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).unwrap();
        name.to_owned()
    };
    let unknown = scene("unknown.toml", &shipped.replace("mass =", "mas ="));
    let missing = scene("missing.toml", &shipped.replace("gain = 0.04", ""));
    let broken = scene("broken.toml", "[slide\nmass = 1");
    std::fs::write(folder.path().join("latin.toml"), [0xe9, 0x0a]).unwrap();
    scene("unit.toml", shipped);
    scene("no-stroke.toml", &shipped.replace("stroke = 80 ", ""));
    std::fs::create_dir_all(folder.path().join("taken/report.html")).unwrap();
    let before = files(folder.path());

    let cases: &[(&[&str], &str)] = &[
        (&["check", &unknown], "unknown.toml:12:1"),
        (&["check", &missing], "drive.gain"),
        (&["check", &broken], "broken.toml:1:"),
        (&["check", "latin.toml"], "latin.toml"),
        (&["check", "absent.toml"], "absent.toml"),
        (&["check", "--n", "inf"], "--n"),
        (&["run", "--set", "slide.mass=true"], "`slide.mass` is a boolean"),
        (&["run", "--set", "slide.mass=80 mm"], "unit does not fit"),
        (&["run", "--set", "slide.mass=nan"], "not finite"),
        (&["run", "--set", "contact.stiffness=inf"], "not finite"),
        (&["run", "--set", "slide.mass=-1"], "slide.mass"),
        (&["run", "--set", "contact.stiffness=-1"], "contact.stiffness"),
        (&["run", "--set", "contact.exponent=0.9"], "contact.exponent"),
        (&["run", "--set", "slide.colour=1"], "slide.colour"),
        (&["run", "--set", "friction.law=sticky"], "sticky"),
        (&["run", "--set", "friction.law=exact", "--set", "controller.integrator=rk4"], "cannot do exact friction"),
        (&["run", "--set", "controller.step=0"], "controller.step"),
        (&["run", "--set", "run.step=50"], "unknown key `run.step`, did you mean `controller.step`?"),
        (&["run", "--set", "run.stroke=-80"], "run.stroke"),
        (&["simulate", "--error", "2"], "--error 2"),
        (&["sweep", "--n", "1e300"], "--n 1e300"),
        (&["simulate", "--stroke", "--set", "drive.speed=0"], "--stroke: "),
        (&["run", "--n", ""], "--n"),
        (&["run", "--n", "5:0:1"], "--n"),
        (&["run", "--n", "0:100:0.01"], "TABLE region"),
        (&["run", "--n", "2"], "at least 2 levels"),
        (&["run", "--bogus"], "--bogus"),
        (&["run", "--threads", "0"], "--threads"),
        (&["run", "--out", "unknown.toml"], "unknown.toml"),
        (&["run", "--out", "/proc/slipfit"], "/proc/slipfit"),
        (&["fly"], "fly"),
        (&["table", "-o", "table.txt"], ".hex"),
        (&["table", "-o", "nowhere/table.bin"], "nowhere"),
        (&["table", "--over", "place"], "--over"),
        (
            &["table", "no-stroke.toml", "--over", "position"],
            "the run of 200 ms ends before the drive's ramp does, at 1000 ms",
        ),
        (&["table", "--over", "position,speed"], "needs --speeds"),
        (&["table", "--speeds", "50:100:10"], "--speeds is for --over position,speed"),
        (&["table", "--over", "position", "--speeds", "50:100:10"], "--speeds is for --over position,speed"),
        (&["table", "--over", "position,speed", "--speeds", "100:50:10"], "--speeds 100:50:10: the last, 50, is below"),
        (&["table", "--over", "position,speed", "--speeds", "100"], "the Velocity axis has 1"),
        (
            &["table", "--over", "position,speed", "--speeds=-50:50:10", "--set", "run.duration=1500"],
            "speeds from -50 mm/s to 50 mm/s",
        ),
        (&["table", "--end", "60"], "--end is for --over position"),
        (&["table", "--over", "position", "--end", "0"], "the stroke is 0 mm"),
        (
            &["table", "cd-rom-slide-fast", "--over", "position", "--end", "90", "--n", "1:2:1"],
            "no unit comes 90 mm far",
        ),
        (&["simulate", "--step", "0"], "--step 0"),
        (&["simulate", "--step", "1s"], "--step 1s"),
        (&["simulate", "--every", "130us", "--step", "100us"], "multiple of the step"),
        (&["simulate", "--every", "x"], "--every x"),
        (&["simulate", "--n", "1,2"], "--n"),
        (&["simulate", "--n", "nan"], "--n"),
        (&["simulate", "--n", "1e9"], "--n: at n = 1000000000 the left back left gap is"),
        (&["run", "--n", "0:1000000:500000"], "--n 0:1000000:500000"),
        (&["simulate", "--every", "-1ms"], "--every -1ms"),
        (&["simulate", "--step=-1ms"], "--step -1ms"),
        (&["simulate", "unit.toml", "--csv", "unit.toml"], "--csv writes .csv, not .toml"),
        (&["run", "--out", "taken"], "report.html"),
        (&["check", "--set", "pin.left back.name=left front"], "a name of its own"),
        (&["simulate", "--integrator", "magic"], "--integrator"),
        (&["simulate", "--csv", "nowhere/x.csv"], "nowhere"),
    ];
    for (arguments, named) in cases {
        let output = slipfit(folder.path(), arguments);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}\n{message}");
        assert!(message.contains(named), "{arguments:?}\n{message}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        assert_eq!(files(folder.path()), before, "{arguments:?}");
    }
}

#[test]
fn precision_refuses_before_it_measures() {
    let folder = tempfile::tempdir().unwrap();
    for (bad, word) in
        [(["--n", "inf"], "--n"), (["--csv", "no/such.csv"], "such.csv"), (["--plot", "."], "cannot write")]
    {
        let output = slipfit(folder.path(), &["precision", bad[0], bad[1]]);
        assert_eq!(output.status.code(), Some(2), "{bad:?}");
        assert!(String::from_utf8_lossy(&output.stderr).contains(word), "{bad:?}");
    }
}

#[test]
fn shipped_scenes_go_by_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let found = json(folder.path(), &["check", "cd-rom-slide-drawing", "--json"]);
    assert!((found["n_star"][0]["n"].as_f64().unwrap() - 3.43).abs() < 1e-3, "{found}");
    let product = stdout(&slipfit(folder.path(), &["check", "clutch"]));
    assert!(product.contains("pressure angle") && product.contains("7.0184"), "{product}");
    for (arguments, parts) in [
        (["check", "no-such-scene"], ["shipped scenes are drawer, ", "clutch"]),
        (["simulate", "clutch"], ["the scene has neither a slide", "clutch.toml:1:1"]),
    ] {
        let output = slipfit(folder.path(), &arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    }
    assert!(files(folder.path()).is_empty());
}
