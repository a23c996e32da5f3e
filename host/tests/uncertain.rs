//! Unknowns of a production, as a user meets them.

mod common;

use std::path::Path;

use common::{json, slipfit, stdout};
use serde_json::Value;

const FRICTION: &str = "uncertain.friction.coefficient=[0.2, 0.3]";

/// Expected share, and the ends of its interval.
fn share(of: &Value) -> [f64; 3] {
    [&of["expected"], &of["interval"][0], &of["interval"][1]].map(|number| number.as_f64().unwrap())
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = slipfit(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// With a friction of 0.2 none of the units fails, with 0.25 a third, with 0.3 half: counted one by one.
#[test]
fn unknown_friction_leaves_all_open() {
    let folder = tempfile::tempdir().unwrap();
    let found = json(folder.path(), &["population", "--units", "5000", "--set", FRICTION, "--json"]);
    let unknown = &found["uncertain"];
    let [expected, low, high] = share(&unknown["malfunctions"]);
    assert!(low < 0.02 && high > 0.44 && high < 0.6, "{low} {high}");
    // A third in the middle, none at one end and half at the other.
    assert!((0.24..0.38).contains(&expected), "{expected}");
    let [crawls, jammed] = ["crawls", "jammed"].map(|kind| share(&unknown[kind])[0]);
    assert!((crawls + jammed - expected).abs() < 1e-9, "{crawls} {jammed} {expected}");
    // At most five times the units of one population.
    let each = unknown["units_each"].as_u64().unwrap();
    let values = unknown["values"].as_array().unwrap();
    assert!(5000 + each * values.len() as u64 <= 5 * 5000 && values.len() == 64);
    // Counted at the ends of the range.
    let at = |range: std::ops::Range<f64>| {
        let own = values.iter().filter(|value| range.contains(&value["values"][0].as_f64().unwrap()));
        let counts: Vec<u64> = own.map(|value| value["malfunctions"].as_u64().unwrap()).collect();
        counts.iter().sum::<u64>() as f64 / (each * counts.len() as u64) as f64
    };
    let [least, most] = [at(0.2..0.205), at(0.295..0.3)];
    assert!(least < 0.01 && (0.42..0.55).contains(&most), "{least} {most}");
    assert_eq!(unknown["decides"][0]["name"], "friction.coefficient");
    // What the scene states is counted as without it.
    let plain = json(folder.path(), &["population", "--units", "5000", "--json"]);
    assert_eq!(found["statistics"], plain["statistics"]);
    assert!(plain["uncertain"].is_null());
}

/// The mass is known to 2 %, which changes nothing; the friction decides. The same bytes for any number of threads.
#[test]
fn of_two_unknowns_the_one_that_matters_decides() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str| {
        let page = format!("{threads}.html");
        let arguments = ["population", "--units", "1100", "--threads", threads, "--page", &page, "--set", FRICTION];
        let mass = ["--set", "uncertain.slide.mass={mean=81.8,deviation=0.5}"];
        let printed = stdout(&slipfit(folder.path(), &[&arguments[..], &mass].concat()));
        (printed, std::fs::read_to_string(folder.path().join(&page)).unwrap())
    };
    let (printed, page) = run("1");
    assert_eq!(run("3"), (printed.clone(), page.clone()));
    let decided = printed.lines().find(|line| line.contains("decided by")).unwrap();
    assert!(decided.contains("friction.coefficient") && decided.ends_with("measure it"), "{decided}");
    let share: f64 = decided.split("friction.coefficient ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((85.0..=100.0).contains(&share), "{decided}");
    assert!(page.contains("friction.coefficient</text>"), "the page has no picture over the friction");
}

/// A slider comes 100 mm/s · (245 ms − 10 ms − r/2) far, where r is the ramp's end, and fails if a stop at 20 ± 1 mm is nearer. With r
/// between 30 and 110 ms it comes 18 to 22 mm far: Φ(−1.9) to Φ(1.9) of the units fail with 95 %, half are expected.
#[test]
fn a_mechanism_fails_as_often_as_its_unknown_ramp_says() {
    let folder = tempfile::tempdir().unwrap();
    let scene = r#"
title = "Slider before a stop"
mechanism = { space = "plane" }
contact = { stiffness = "1e8 N/m^1.5", exponent = 1.5, damping = "200 N·s/m", depth = 0.01 }
run.duration = 245
[[body]]
name = "slider"
mass = 200
inertia = "1e-4 kg·m²"
centre = [0, 0]
[[joint]]
name = "guide"
kind = "prismatic"
between = ["frame", "slider"]
at = [0, 0]
axis = [1, 0]
[[joint]]
name = "stop"
kind = "stop"
between = ["frame", "slider"]
at = [0, 0]
normal = [1, 0]
clearance = [20, 1]
[[drive]]
name = "motor"
pushes = "slider"
axis = [1, 0]
gain = "20 N·s/m"
ramp_start = 0
ramp_end = 0.05
speed = 100
[[uncertain.drive]]
name = "motor"
ramp_end = [0.03, 0.11]
"#;
    std::fs::write(folder.path().join("stop.toml"), scene).unwrap();
    let found = json(folder.path(), &["population", "stop.toml", "--units", "300", "--json"]);
    let [expected, low, high] = share(&found["uncertain"]["malfunctions"]);
    println!("{expected}: {low} to {high}");
    // 37 units at each of 32 strata: a standard error of 0.011 in all, and of 0.03 at the ends.
    assert!((expected - 0.5).abs() < 0.045, "{expected}");
    assert!((low - 0.028_7).abs() < 0.08 && (high - 0.971_3).abs() < 0.08, "{low} {high}");
    assert_eq!(found["uncertain"]["decides"][0]["name"], "motor.ramp_end");
    let run = json(folder.path(), &["run", "stop.toml", "--units", "100", "--json"]);
    let [expected, low, high] = share(&run["uncertain"]["malfunctions"]);
    assert!((expected - 0.5).abs() < 0.1 && low < 0.15 && high > 0.85, "{expected}: {low} to {high}");
    assert!(folder.path().join("slipfit-out/stop/population-unknown.svg").exists());
}

/// A parameter may vary about an unknown mean.
#[test]
fn a_parameter_varies_about_its_unknown_mean() {
    let folder = tempfile::tempdir().unwrap();
    let of = |vary: &str| {
        let arguments = ["population", "--units", "3000", "--set", FRICTION, "--set", vary, "--json"];
        share(&json(folder.path(), &arguments)["uncertain"]["malfunctions"])
    };
    let [narrow, wide] = ["0.001", "0.15"].map(|by| of(&format!("vary.friction.coefficient={by}")));
    // Units with a friction above 0.3 fail where the mean is 0.2, too.
    assert!(narrow[1] < 0.02 && wide[1] > narrow[1] + 0.02 && wide[2] < narrow[2], "{narrow:?} {wide:?}");
}

#[test]
fn the_requirement_of_allocate_is_judged_over_the_unknown() {
    let folder = tempfile::tempdir().unwrap();
    let of = |friction: &str| {
        let unknown = format!("uncertain.friction.coefficient={friction}");
        let arguments = ["allocate", "slide-processes", "--units", "100", "--samples", "1000", "--json"];
        let more = ["--require", "malfunction=0.2", "--set", &unknown];
        let found = json(folder.path(), &[&arguments[..], &more].concat());
        (found["uncertain"]["holds"].as_bool().unwrap(), share(&found["uncertain"]["malfunctions"]))
    };
    let (holds, [expected, low, high]) = of("[0.2, 0.3]");
    assert!(!holds && low < 0.05 && high > 0.2 && (low..high).contains(&expected), "{expected} {low} {high}");
    assert!(of("[0.1, 0.15]").0);
}

#[test]
fn what_cannot_carry_it_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["--set", FRICTION];
    for (options, told) in [
        (&["--out", "units"][..], "--out takes the values that the scene states"),
        (&["--shard", "1/2", "--out", "units"], "--shard takes the values"),
        (&["--rare"], "--rare takes the values"),
        (&["--units", "15"], "at least 16 are allowed"),
    ] {
        let error = refused(folder.path(), &[&["population"], options, &set].concat());
        assert!(error.contains(told), "{error}");
    }
    // One unit is simulated as the scene states it.
    let simulate = |set: &[&str]| stdout(&slipfit(folder.path(), &[&["sweep", "--n", "0:2:1"], set].concat()));
    assert_eq!(simulate(&set), simulate(&[]));
    // A friction that varies below 0 where its mean is small.
    let arguments = ["population", "--units", "200", "--set", "uncertain.friction.coefficient=[0, 0.3]"];
    let error = refused(folder.path(), &[&arguments[..], &["--set", "vary.friction.coefficient=0.05"]].concat());
    assert!(error.contains("out of bounds"), "{error}");
}
