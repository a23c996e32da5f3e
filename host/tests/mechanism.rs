//! Tables and the main job of mechanisms, against the runs they are made from and closed forms.

mod common;

use std::path::Path;

use common::{json, slipfit, stdout};
use nalgebra::{Rotation3, Vector3};
use slipfit::{
    dynamics::driven::Driven,
    firmware::{
        force_table,
        force_table::{
            Demand, position,
            position::{TURN_STEP, Wish},
        },
    },
    mechanism::{ByDrive, Mechanism, run},
    scene::{Override, SceneFile, shipped},
};
use slipfit_core::table::{AxisKind, MotionVerdict, Table};

fn mechanism(name: &str, set: &[&str], levels: &str) -> Mechanism {
    let mut set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    set.push(Override::option("", "sweep.n", levels));
    SceneFile::parse(name, shipped(name).unwrap(), &set).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap()
}

#[test]
fn nodes_over_time_are_what_a_run_gives() {
    let mechanism = mechanism("slider-crank", &["run.duration=100"], "-1:1:1");
    let driven = ByDrive::new(&mechanism, 0).unwrap();
    let (made, sweep) = force_table::make(&driven, Demand::Full, || ()).unwrap();
    let table = Table::<2>::open(&made.bytes).unwrap().expect_axes([AxisKind::Level, AxisKind::Time]).unwrap();
    table.expect_scene(driven.hash()).unwrap();
    assert_eq!(table.axes().map(|axis| axis.count()), [3, 101]);
    assert_eq!(made.verdicts, [MotionVerdict::Runs; 3]);
    assert_eq!(sweep.gaps, ["big end"]);
    for n in [-1.0f32, 0.0, 1.0] {
        let run = run(&mechanism, &mechanism.gaps_at(&[n.into()]).unwrap(), 1e-3).unwrap();
        for row in run.samples.rows.iter().step_by(7) {
            let found = table.lookup([n, row[0] as f32]);
            assert!((f64::from(found.force) - row[1]).abs() < 1e-6, "{n} {row:?} {found:?}");
        }
    }
}

/// A drawer is at its stroke's end before the table ends: from there on the table holds what it does under a drive that goes on, not what it
/// came there with; its verdict is that of the stroke.
#[test]
fn over_time_a_table_goes_on_beyond_the_stroke() {
    let mechanism = mechanism("telescopic-drawer", &[], "0:1:1");
    let driven = ByDrive::new(&mechanism, 0).unwrap();
    let (made, sweep) = force_table::make(&driven, Demand::Full, || ()).unwrap();
    let table = Table::<2>::open(&made.bytes).unwrap().expect_axes([AxisKind::Level, AxisKind::Time]).unwrap();
    assert_eq!(made.verdicts, [MotionVerdict::Runs; 2]);
    let on = Mechanism { run: slipfit::setup::RunSpec { stroke: None, ..mechanism.run }, ..mechanism.clone() };
    let step = f64::from(table.axes()[1].step());
    let mut apart: f64 = 0.0;
    for level in &sweep.levels {
        let (end, last) = (level.outcome.end, *level.trajectory.force.last().unwrap());
        assert!((end.z - 0.065).abs() < 1e-9 && end.t < mechanism.run.duration - 0.1, "{end:?}");
        let run = run(&on, &mechanism.gaps_at(&[level.n]).unwrap(), step).unwrap();
        for row in run.samples.rows.iter().filter(|row| row[0] > end.t) {
            let found = f64::from(table.lookup([level.n as f32, row[0] as f32]).force);
            assert!((found - row[1]).abs() < 1e-3 * driven.greatest_force(), "{} {row:?} {found}", level.n);
            apart = apart.max((row[1] - last).abs());
        }
    }
    assert!(apart > 5.0, "what it came there with is {apart} N off");
}

/// Turned slowly and without friction a hatch takes the moment of its weight, m·g·l·cos φ, wherever its pins are in their holes:
/// these move its centre by 0.1 mm of 150.
#[test]
fn over_its_angle_a_hatch_takes_the_moment_of_its_weight() {
    let set = ["friction.law=none", "run.error=1e-6"];
    let mechanism = mechanism("hatch", &set, "0:1:1");
    let driven = ByDrive::new(&mechanism, 0).unwrap();
    let wish = Wish { speeds: None, stroke: Some(0.9), demand: Demand::Full };
    let made = position::make(&driven, &wish, || ()).unwrap();
    let table =
        Table::<2>::open(&made.table.bytes).unwrap().expect_axes([AxisKind::Level, AxisKind::Position]).unwrap();
    assert!((f64::from(table.axes()[1].step()) / TURN_STEP - 1.0).abs() < 1e-6);
    for degrees in [25.0f64, 35.0, 50.0] {
        let angle = degrees.to_radians();
        let moment = 2.0 * 9.81 * 0.15 * libm::cos(angle);
        let found = table.lookup([0.5, angle as f32]);
        assert!((f64::from(found.force) / moment - 1.0).abs() < 4e-3, "{degrees} {found:?} {moment}");
        // What the drive lags behind by gives that moment.
        assert!((20.0 * (1.0 - f64::from(found.velocity)) / moment - 1.0).abs() < 4e-3, "{degrees} {found:?}");
    }
    let far = position::make(&driven, &Wish { stroke: Some(3.0), ..wish }, || ()).unwrap_err().to_string();
    assert!(far.starts_with("no unit comes 171.8873385 ° far: in 1500 ms the farthest"), "{far}");
}

/// A lever of 0.1 kg·m² about an ideal joint, driven upwards at 0.5 rad/s, if `set` says nothing else.
fn lever(set: &[&str]) -> Mechanism {
    let scene = r#"
        title = "Lever"
        mechanism = { space = "plane", gravity = [0, -9.81] }
        run = { duration = 1000, stroke = 20 }
        [[body]]
        name = "lever"
        mass = 1000
        inertia = "0.09 kg·m²"
        centre = [100, 0]
        [[joint]]
        name = "shaft"
        kind = "revolute"
        between = ["lever", "frame"]
        at = [0, 0]
        [[drive]]
        name = "motor"
        turns = "lever"
        gain = 100
        ramp_start = 0
        ramp_end = 0.01
        speed = 0.5
    "#;
    let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    SceneFile::parse("lever.toml", scene, &set).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap()
}

/// The stroke counts from where the lever starts, in the direction of its drive, also where it starts beyond its end. The moment that
/// holds the weight against the fall counts like one that lifts it: m·g·l·cos φ and what the ramp takes.
#[test]
fn travel_counts_from_the_start_and_braking_is_effort() {
    for (angle, speed) in [(0.0, 0.5), (40.0, 0.5), (-30.0, 0.5), (80.0, -0.5), (20.0, -0.5)] {
        let set = [format!("body.lever.angle={angle}"), format!("drive.motor.speed={speed}")];
        let mechanism = lever(&set.each_ref().map(String::as_str));
        let run = run(&mechanism, &[], 1e-3).unwrap();
        let outcome = run.outcomes[0];
        assert_eq!(outcome.stroke_reached, Some(true), "{angle}: {outcome:?}");
        assert!((outcome.end.z - 20f64.to_radians()).abs() < 1e-9, "{angle}: {outcome:?}");
        let [first, last] = [&run.samples.rows[0], run.samples.rows.last().unwrap()];
        assert!((first[4] - f64::to_radians(angle)).abs() < 1e-12, "columns count from the drawn pose: {first:?}");
        assert!(((last[4] - first[4]) * f64::signum(speed) - 20f64.to_radians()).abs() < 2e-3, "{last:?}");
        let greatest = run.samples.rows.iter().fold(0.0f64, |most, row| most.max(row[1].abs()));
        assert!((outcome.peak_force.unwrap() / greatest - 1.0).abs() < 0.02, "{outcome:?} {greatest}");
    }
}

/// Joints without play hold exactly, and the slide is where the crank, the rod and the play of its ball let it be: with A the lower ball,
/// the slide at s = A_y + √(l² − A_x² − A_z²) but for the play in each direction.
#[test]
fn a_ball_rod_keeps_its_joints_and_moves_its_slide() {
    let mechanism = mechanism("ball-rod", &["run.duration=400"], "0:1:1");
    let gaps = mechanism.gaps_at(&[0.0]).unwrap();
    let samples = run(&mechanism, &gaps, 1e-3).unwrap().samples;
    let column = |name: &str| samples.columns.iter().position(|column| column.starts_with(name)).unwrap();
    let vector = |row: &[f64], name: &str| {
        let first = column(name);
        Vector3::from_column_slice(&row[first..first + 3])
    };
    let axis = Vector3::new(0.0, 0.6, 0.8);
    let mut turned = 0.0;
    for row in &samples.rows {
        let [crank, rod, slide] = ["crank.ax", "rod.ax", "slide.ax"].map(|name| vector(row, name));
        assert!((crank - axis * axis.dot(&crank)).norm() < 1e-9 && slide.norm() < 1e-9, "{crank} {slide}");
        let moved = vector(row, "slide.x");
        assert!(moved.xz().norm() < 1e-9, "{moved}");
        let [lower, on_rod] = [(crank, [0.015, 0.0, 0.0]), (rod, [0.0, -0.03, 0.0])]
            .map(|(turn, arm)| Rotation3::from_scaled_axis(turn) * Vector3::from(arm));
        let centre = Vector3::new(0.015, 0.03, 0.0) + vector(row, "rod.x");
        assert!((centre + on_rod - lower).norm() < 1e-9, "{lower}");
        // The rod leans by up to 30°, so that play across it counts as well; walls yield by some micrometres.
        let apart = [lower.x - 0.015, lower.z];
        let closed = lower.y + libm::sqrt(0.06 * 0.06 - apart[0] * apart[0] - apart[1] * apart[1]);
        assert!((0.06 + moved.y - closed).abs() < 0.12e-3, "{} {closed}", moved.y);
        turned = axis.dot(&crank);
    }
    assert!(turned > 2.0 * std::f64::consts::PI, "angles go on from turn to turn: {turned}");
}

/// The turn from one sample to the next but one is that of the angular velocity between them, about the same axis of the frame.
#[test]
fn angular_velocities_in_space_are_how_fast_bodies_turn_in_the_frame() {
    let mechanism = mechanism("hatch", &["run.duration=300"], "0:1:1");
    let every = 2e-5;
    let samples =
        run(&mechanism, &mechanism.gaps_at(&vec![0.0; mechanism.gaps.len()]).unwrap(), every).unwrap().samples;
    let vector = |row: &[f64], name: &str| {
        let first = samples.columns.iter().position(|column| column.starts_with(&format!("hatch.{name}x "))).unwrap();
        Vector3::from_column_slice(&row[first..first + 3])
    };
    let turn = |row: &[f64]| Rotation3::new(vector(row, "a"));
    let most = samples.rows.iter().map(|row| vector(row, "w").norm()).fold(0.0, f64::max);
    assert!(most > 0.5, "{most}");
    let mut worst: f64 = 0.0;
    for rows in samples.rows.windows(3) {
        let turned = (turn(&rows[2]) * turn(&rows[0]).inverse()).scaled_axis() / (2.0 * every);
        worst = worst.max((turned - vector(&rows[1], "w")).norm());
    }
    assert!(worst < 1e-3 * most, "{worst} of {most}");
}

#[test]
fn the_main_job_of_a_mechanism_answers_and_writes_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let run = ["run", "slider-crank", "--n", "-1:1:1", "--set", "run.duration=200"];
    let output = slipfit(folder.path(), &run);
    let text = stdout(&output);
    assert!(text.lines().count() <= 15, "{text}");
    let parts = [
        "runs",
        "peak torque",
        "N·m",
        "Closes first    big end, at n* = 10.000",
        "nothing: every level runs",
        "Production      0.00 %",
    ];
    assert!(parts.iter().all(|part| text.contains(part)), "{text}");
    let out = folder.path().join("slipfit-out/slider-crank");
    for file in ["mechanism.svg", "sweep.csv", "table.bin", "torque.svg", "velocity.svg", "verdict.svg"] {
        assert!(out.join(file).exists(), "{file}");
    }
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("peak torque<br>(N·m)") && page.contains("big end: revolute, gap 0.2 mm"), "{page}");
    let csv = std::fs::read_to_string(out.join("sweep.csv")).unwrap();
    assert!(csv.starts_with("n,breakaway_s,peak_torque_N_m,") && csv.lines().next().unwrap().ends_with(",big end"));
    let report = json(folder.path(), &[&run[..], &["--json"]].concat());
    assert_eq!((report["effort_unit"].as_str(), report["drive"].as_str()), (Some("N·m"), Some("motor")));
}

/// Of a run that ends before its ramp nobody knows whether anything works.
#[test]
fn the_main_job_of_a_mechanism_says_where_there_are_no_verdicts() {
    let folder = tempfile::tempdir().unwrap();
    let run = ["run", "slider-crank", "--n", "-1:1:1", "--units", "20", "--set", "run.duration=40"];
    let text = stdout(&slipfit(folder.path(), &run));
    for part in ["none of 20 units comes to a verdict", "it ends before there are verdicts; take a longer run.duration"]
    {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

/// The firmware of a mechanism refuses the table of another.
#[test]
fn kernel_and_table_of_a_mechanism_have_one_hash() {
    let folder = tempfile::tempdir().unwrap();
    let kernel = json(folder.path(), &["kernel", "slider-crank", "-o", "unit.rs", "--json"]);
    let arguments = ["table", "slider-crank", "--n", "0:1:1", "--set", "run.duration=50", "-o", "t.bin", "--json"];
    assert_eq!(json(folder.path(), &arguments)["scene_hash"], kernel["scene_hash"]);
    let source = std::fs::read_to_string(folder.path().join("unit.rs")).unwrap();
    assert!(source.contains(&format!("SCENE_HASH: u64 = 0x{}", kernel["scene_hash"].as_str().unwrap())), "{source}");
}

#[test]
fn a_drive_is_asked_for_by_name() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, expected) in [
        (&["table", "woodpecker-toy"][..], "the mechanism has no [[drive]]"),
        (&["run", "woodpecker-toy"], "simulate tells how it moves"),
        (&["table", "slider-crank", "--drive", "pump"], "there is no drive \"pump\", there is motor"),
        (&["run", "--drive", "motor"], "--drive is for mechanisms"),
        (&["table", "slider-crank", "--over", "position", "--end", "0.01"], "allowed is 0.25 ° to 3600 °"),
        (&["check", "--plot", "a.svg"], "--plot draws mechanisms"),
        (&["run", "slider-crank", "--set", "run.stroke=80 mm"], "unit does not fit"),
    ] {
        let output = slipfit(folder.path(), arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && error.contains(expected), "{arguments:?}: {error}");
    }
    assert!(std::fs::read_dir(folder.path()).unwrap().next().is_none());
}

#[test]
fn what_a_mechanism_has_not_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, why) in [
        (&["simulate", "slider-crank", "--audit"][..], "--scalar and --stroke are for slides on pins"),
        (&["population", "slider-crank", "--opening"], "--opening is for slides on pins"),
        (&["tolerance", "slider-crank"], "there is no product to draw"),
    ] {
        let output = slipfit(folder.path(), arguments);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
        assert!(errors.contains(why), "{arguments:?}: {errors}");
    }
}

/// Driven 10 mm beside its middle the carriage runs, at 150 mm it stands still: `check` says so before.
#[test]
fn a_carriage_that_locks_is_told_before() {
    let folder = tempfile::tempdir().unwrap();
    for (x, locks) in [("10", false), ("150", true)] {
        let set = format!("drive.motor.point=[{x}, 0, 0]");
        let check = slipfit(folder.path(), &["check", "linear-guide", "--set", &set]);
        let warned = String::from_utf8_lossy(&check.stderr).contains("self-locking: friction 0.3");
        let sweep = stdout(&slipfit(folder.path(), &["sweep", "linear-guide", "--n", "0:0:1", "--set", &set]));
        assert_eq!([warned, sweep.contains("jammed")], [locks; 2], "{x}: {sweep}");
    }
}

/// The controller's error falls with its step, as that of a scheme of second order does. What is shown with `--step` is its run.
#[test]
fn the_controller_of_a_mechanism_is_held_against_the_desk() {
    let folder = tempfile::tempdir().unwrap();
    let of = |options: &[&str]| {
        let found = json(folder.path(), &[&["simulate", "slider-crank-guide", "--json"][..], options].concat());
        (found["controller"]["difference"].as_f64().unwrap(), found["controller"]["shown"].as_bool().unwrap(), found)
    };
    let (own, shown, desk) = of(&[]);
    assert!(!shown && own < 2e-3, "{own}");
    let (coarse, shown, controller) = of(&["--step", "500us"]);
    assert!(shown && coarse > 2.5 * own, "{coarse} {own}");
    let (fine, ..) = of(&["--step", "125us"]);
    assert!(2.5 * fine < own, "{fine} {own}");
    // What is shown is the controller's: its peak differs by no more than it does somewhere.
    let peak = |found: &serde_json::Value| found["drives"][0]["peak_force"].as_f64().unwrap();
    let apart = (peak(&controller) / peak(&desk) - 1.0).abs();
    assert!(0.0 < apart && apart <= coarse, "{apart} {coarse}");
    for (options, code, why) in [
        (["--integrator", "rk4"], 2, "only implicit ones"),
        (["--scalar", "f32"], 2, "--scalar"),
        (["--step", "2s"], 2, "step"),
    ] {
        let output = slipfit(folder.path(), &[&["simulate", "slider-crank"][..], &options].concat());
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(code) && errors.contains(why), "{options:?}: {errors}");
    }
}

/// Errors fall with the order of the scheme: at a quarter of the step to a sixteenth by extrapolated implicit Euler, to a quarter by
/// implicit Euler.
#[test]
fn schemes_of_a_mechanism_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["--set", "run.duration=60"];
    let found = json(folder.path(), &[&["precision", "four-bar", "--n", "0", "--json"][..], &set].concat());
    let floor = found["floors"][0]["max"].as_f64().unwrap();
    assert!(floor < 1e-3, "{floor}");
    let error = |solver: &str, setting: f64| {
        let points = found["points"].as_array().unwrap();
        let is = |point: &&serde_json::Value| point["solver"] == solver && point["setting"] == setting;
        points.iter().find(is).unwrap_or_else(|| panic!("{solver} {setting}"))["max_percent"].as_f64().unwrap()
    };
    let [coarse, fine] = [100e-6, 25e-6].map(|step| error("extrapolated", step));
    assert!((8.0..24.0).contains(&(coarse / fine)), "{coarse} {fine}");
    let [coarse, fine] = [100e-6, 25e-6].map(|step| error("implicit-euler", step));
    assert!((3.0..5.0).contains(&(coarse / fine)), "{coarse} {fine}");
    assert!(error("desk", 1e-8) < error("desk", 1e-5));
    let output = slipfit(folder.path(), &["precision", "four-bar", "--stability"]);
    assert_eq!(output.status.code(), Some(2));
}

/// A run that a finer one does not confirm gives way to it, and what is printed then is right; where two finer ones do not suffice, a
/// warning names the column, even where the figures of the verdict agree.
#[test]
fn runs_that_a_finer_one_does_not_confirm_give_way_or_are_warned_of() {
    let rows = |error: &str| {
        let set = format!("run.error={error}");
        let found = json(Path::new("."), &["simulate", "linear-guide", "--set", &set, "--json"]);
        let rows: Vec<Vec<f64>> = serde_json::from_value(found["samples"].clone()).unwrap();
        (rows, found["tolerance_m_per_s"].as_f64().unwrap())
    };
    let [(coarse, given), (same, finer), (truth, _)] = ["1e-3", "1e-5", "1e-8"].map(rows);
    assert!(coarse == same && given == finer, "{given} {finer}");
    for k in 1..truth[0].len() {
        // A share is one of the greatest of its kind: of the drive, or of three columns of the body.
        let kind = if k == 1 { 1..2 } else { k - (k - 2) % 3..k + 3 - (k - 2) % 3 };
        let peak = truth.iter().flat_map(|row| &row[kind.clone()]).fold(0.0, |most: f64, x| most.max(x.abs()));
        let apart = coarse.iter().zip(&truth).fold(0.0, |most: f64, (one, other)| most.max((one[k] - other[k]).abs()));
        assert!(apart < 5e-3 * peak, "column {k}: {apart} of {peak}");
    }
    let warned = |error: &str| {
        let output = slipfit(Path::new("."), &["simulate", "linear-guide", "--set", &format!("run.error={error}")]);
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let warning = warned("0.1");
    let told = "a run at a tenth of the tolerance differs by 8.0 % of the body's greatest spin in carriage.wy (rad/s)";
    assert!(warning.contains(told) && warning.contains("run.error"), "{warning}");
    assert!(!warned("1e-3").contains("a run at a tenth"));
    // A sweep says at which levels.
    let swept = |error: &str| {
        let set = ["--set", &format!("run.error={error}"), "--n", "0:1:1"];
        let output = slipfit(Path::new("."), &[&["sweep", "linear-guide"][..], &set].concat());
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let warning = swept("0.1");
    assert!(
        warning.contains("at n = 0, +1, worst at n = +1: a run at a tenth of the tolerance differs by"),
        "{warning}"
    );
    assert!(!swept("1e-3").contains("a run at a tenth"));
}
