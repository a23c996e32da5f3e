//! Populations of mechanisms as a user meets them.

mod common;

use common::{json, slipfit, stdout};
use slipfit::{
    mechanism::run,
    population::production::Production,
    scene::{SceneFile, shipped},
};

/// A slider of 200 g on an ideal guide, which a motor pushes to 100 mm/s in 0.05 s, and `more`.
fn slider(title: &str, gravity: &str, gain: u32, duration: u32, more: &str) -> String {
    format!(
        r#"
title = "{title}"
[mechanism]
space = "plane"
gravity = {gravity}
[contact]
stiffness = "1e8 N/m^1.5"
exponent = 1.5
damping = "200 N·s/m"
depth = 0.01
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
[[drive]]
name = "motor"
pushes = "slider"
axis = [1, 0]
gain = "{gain} N·s/m"
ramp_start = 0
ramp_end = 0.05
speed = 100
[run]
duration = {duration}
{more}"#
    )
}

/// It comes 21 mm far, if it does not meet a stop before.
fn stopped() -> String {
    let stop = r#"
[[joint]]
name = "stop"
kind = "stop"
between = ["frame", "slider"]
at = [0, 0]
normal = [1, 0]
clearance = [20, 1]
[sweep]
n = "-2:2:1"
"#;
    slider("Slider before a stop", "[0, 0]", 20, 245, stop)
}

/// Failure has this cause, and no other: its true share is 100 %.
#[track_caller]
fn is_the_only_cause(found: &serde_json::Value, name: &str) {
    let drivers = found["malfunction_drivers"].as_array().unwrap();
    let of = |i: usize, key: &str| drivers[i][key].as_f64().unwrap();
    let (share, error) = (of(0, "share"), of(0, "error"));
    println!("{name}: {share} ± {error}");
    assert!(drivers[0]["name"] == name && (share - 1.0).abs() <= 2.0 * error && error < 0.06, "{drivers:?}");
    assert!(of(0, "share") > of(0, "chance"), "{drivers:?}");
}

/// Units whose stop is nearer than that malfunction: Φ(1) of them.
#[test]
fn units_of_a_mechanism_fail_as_often_as_their_gap_says() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("stop.toml"), stopped()).unwrap();
    let found = json(folder.path(), &["population", "stop.toml", "--units", "4000", "--json"]);
    let share = &found["statistics"]["malfunctions"];
    let (least, most) = (share["interval"][0].as_f64().unwrap(), share["interval"][1].as_f64().unwrap());
    assert!(least < 0.841_345 && 0.841_345 < most && most - least < 0.03, "{share}");
    is_the_only_cause(&found, "stop gap");
    // `run` draws the same units.
    let run = json(folder.path(), &["run", "stop.toml", "--units", "500", "--json"]);
    let few = json(folder.path(), &["population", "stop.toml", "--units", "500", "--json"]);
    assert_eq!(run["population"], few["statistics"]);
    // The worst unit again, alone and by the desk's own error.
    let worst = &found["worst"][0];
    let number = worst["number"].to_string();
    let alone = json(folder.path(), &["simulate", "stop.toml", "--unit", &number, "--json"]);
    let of = |report: &serde_json::Value, key: &str| report[key].as_f64().unwrap();
    assert!((of(&alone["drives"][0], "peak_force") / of(worst, "peak_force") - 1.0).abs() < 1e-3, "{worst}");
    assert!((alone["n"][0].as_f64().unwrap() - of(worst, "tightness")).abs() < 1e-9, "{worst}");
}

/// A sixth of pins whose mean play is one standard deviation are wider than their holes.
#[test]
fn units_that_cannot_be_assembled_count_as_jammed() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["--set", "run.duration=20", "--set", "joint.big end.clearance=[0.05, 0.05]"];
    let found = json(folder.path(), &[&["population", "slider-crank", "--units", "800", "--json"][..], &set].concat());
    let unassembled = found["statistics"]["unassembled"].as_u64();
    let share = unassembled.unwrap() as f64 / 800.0;
    assert!((share - 0.158_655).abs() < 3.0 * libm::sqrt(0.1335 / 800.0), "{share}");
    assert!(found["statistics"]["jammed"]["units"].as_u64() >= unassembled);
    assert!(found["warnings"][0].as_str().unwrap().contains("cannot be assembled"), "{found}");
}

/// Two joints whose gap is the same measure have the same gap in every unit, with the spread that its dimensions give.
#[test]
fn joints_of_one_measure_have_one_gap() {
    let folder = tempfile::tempdir().unwrap();
    let text = shipped("linear-guide").unwrap();
    let of_measure = "clearance = \"play\"";
    let lines = text.lines().map(|line| if line.starts_with("clearance = ") { of_measure } else { line });
    let product = "[[dimension]]\nname = \"hole\"\nvalue = 8.1\ntolerance = 0.03\n\
                   [[dimension]]\nname = \"rod\"\nvalue = 8\ntolerance = 0.03\n\
                   [[measure]]\nname = \"play\"\nis = \"(hole - rod) / 2\"\n";
    let scene = format!("{}\n{product}", lines.collect::<Vec<_>>().join("\n"));
    std::fs::write(folder.path().join("guide.toml"), scene).unwrap();
    let arguments = ["population", "guide.toml", "--units", "400", "--csv", "units.csv", "--set", "run.duration=5"];
    stdout(&slipfit(folder.path(), &arguments));
    let mut reader = csv::Reader::from_path(folder.path().join("units.csv")).unwrap();
    let gaps: Vec<Vec<f64>> =
        reader.records().map(|row| row.unwrap().iter().skip(10).map(|cell| cell.parse().unwrap()).collect()).collect();
    assert!(gaps.iter().all(|unit| unit.len() == 4 && unit.iter().all(|gap| *gap == unit[0])));
    let mean = gaps.iter().map(|unit| unit[0]).sum::<f64>() / 400.0;
    let square = gaps.iter().map(|unit| (unit[0] - mean) * (unit[0] - mean)).sum::<f64>() / 400.0;
    let deviation = 0.005e-3 * std::f64::consts::SQRT_2;
    assert!((mean - 0.05e-3).abs() < 4.0 * deviation / 20.0 && (libm::sqrt(square) / deviation - 1.0).abs() < 0.12);
}

/// It is lifted, without friction, and its mass varies.
fn lifted() -> String {
    let varies = r#"
[[vary.body]]
name = "slider"
mass = { tolerance = 30, sigma = 3 }
"#;
    slider("Lift", "[-9.81, 0]", 200, 100, varies)
}

/// Its greatest force (N) with a `mass` m (kg): of Ḟ = gain·(v̇ + g − F/m), v the ramp's speed, by exact steps with a constant
/// acceleration.
fn lifting(mass: f64) -> f64 {
    let (gain, gravity, speed, ramp, step) = (200.0, 9.81, 0.1, 0.05, 1e-6);
    let decay = libm::exp(-gain * step / mass);
    let (mut force, mut greatest) = (0.0, 0.0f64);
    for i in 0..50_000 {
        let s = (f64::from(i) + 0.5) * step / ramp;
        let end = mass * (speed / ramp * 6.0 * s * (1.0 - s) + gravity);
        force = end + (force - end) * decay;
        greatest = greatest.max(force);
    }
    greatest
}

/// One unit in six is heavier by a standard deviation, 10 g, than the mean one; one in 31,574 by four.
#[test]
fn a_motor_is_too_weak_as_often_as_the_mass_says() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lift.toml"), lifted()).unwrap();
    let of = |units: &str, mass: f64, options: &[&str]| {
        let limit = lifting(mass).to_string();
        let arguments = ["population", "lift.toml", "--json", "--units", units, "--force-limit", &limit];
        json(folder.path(), &[&arguments[..], options].concat())
    };
    let found = of("2000", 0.21, &[]);
    let share = found["statistics"]["over_limit"]["share"].as_f64().unwrap();
    assert!((share - 0.158_655).abs() < 3.0 * libm::sqrt(0.1335 / 2000.0), "{share}");
    assert_eq!(found["force_drivers"][0]["name"], "slider.mass");
    // The unit alone has the mass that it was drawn with.
    let worst = &found["worst"][0];
    let alone = json(folder.path(), &["simulate", "lift.toml", "--json", "--unit", &worst["number"].to_string()]);
    let peak = |report: &serde_json::Value| report["peak_force"].as_f64().unwrap();
    assert!((peak(&alone["drives"][0]) / peak(worst) - 1.0).abs() < 1e-3 && peak(worst) > lifting(0.225), "{worst}");

    let rare = of("200", 0.24, &["--rare"])["rare"].clone();
    let interval = &rare["malfunction"]["interval"];
    let [low, high] = [0, 1].map(|i| interval[i].as_f64().unwrap());
    assert!(low < 3.167e-5 && 3.167e-5 < high && high < 2.0 * low, "{rare}");
}

/// The mass alone decides: at 1 % and at 68 % of failing units it is found to have all of the failures.
#[test]
fn the_only_cause_of_failure_has_all_of_it() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lift.toml"), lifted()).unwrap();
    for (mass, share) in [(0.2 + 0.023_263, 0.01), (0.2 - 0.004_677, 0.68)] {
        let limit = lifting(mass).to_string();
        let found =
            json(folder.path(), &["population", "lift.toml", "--json", "--units", "5000", "--force-limit", &limit]);
        let failing = found["statistics"]["malfunctions"]["share"].as_f64().unwrap();
        assert!((failing - share).abs() < 4.0 * libm::sqrt(share * (1.0 - share) / 5000.0), "{failing} {share}");
        is_the_only_cause(&found, "slider.mass");
    }
}

#[test]
fn what_varies_has_to_be_there() {
    let folder = tempfile::tempdir().unwrap();
    for (from, to, why) in [
        ("name = \"slider\"\nmass = {", "name = \"box\"\nmass = {", "box"),
        ("[[vary.body]]\nname = \"slider\"\nmass", "[[vary.drive]]\nname = \"pump\"\ngain", "allowed: motor"),
        ("[[vary.body]]\nname = \"slider\"\nmass", "[vary.mechanism]\ntilt_x", "leaves the plane"),
        ("[[vary.body]]\nname = \"slider\"\n", "[vary.slide]\n", "[[vary.body]]"),
        ("[[vary.body]]\nname = \"slider\"\nmass", "[vary.drive]\ngain", "allowed"),
    ] {
        std::fs::write(folder.path().join("lift.toml"), lifted().replace(from, to)).unwrap();
        let output = slipfit(folder.path(), &["population", "lift.toml"]);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{to}: {errors}");
        assert!(errors.contains(why) && errors.contains("lift.toml:"), "{to}: {errors}");
    }
}

/// Shards end in the bytes of one run, and what is drawn and written of them is the same.
#[test]
fn shards_of_a_mechanism_are_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("stop.toml"), stopped()).unwrap();
    let at = |name: &str| folder.path().join(name);
    let common = ["population", "stop.toml", "--units", "1100", "--force-limit", "3", "--json"];
    let of = |options: &[&str]| stdout(&slipfit(folder.path(), &[&common[..], options].concat()));
    let whole = of(&["--out", "whole", "--page", "page.html", "--plot-distance", "distance.svg"]);
    of(&["--shard", "1/2", "--out", "a"]);
    of(&["--shard", "2/2", "--out", "b"]);
    let merged = stdout(&slipfit(folder.path(), &["merge", "b", "a", "--out", "merged", "--json"]));
    assert!(merged == whole && std::fs::read(at("merged")).unwrap() == std::fs::read(at("whole")).unwrap());
    let page = std::fs::read_to_string(at("page.html")).unwrap();
    // Forces over tightness, their histogram, the sides, what drives them, the hypothesis; and the player.
    assert_eq!(page.matches("<figure").count(), 6);
    let svg = std::fs::read_to_string(at("distance.svg")).unwrap();
    assert!(svg.contains("loosest"), "{svg}");
}

/// The steps of a population cost less than 0.1 % of the peak effort in 95 % of the units, against runs at the scene's own tolerance.
#[test]
fn peaks_of_units_are_good_to_a_thousandth() {
    let units = 40;
    let folder = tempfile::tempdir().unwrap();
    for name in ["four-bar", "slider-crank", "hatch", "linear-guide"] {
        let count = units.to_string();
        let output = slipfit(folder.path(), &["population", name, "--units", &count, "--csv", "units.csv"]);
        assert!(output.status.success(), "{output:?}");
        let text = std::fs::read_to_string(folder.path().join("units.csv")).unwrap();
        let mut lines = text.lines();
        let at = lines.next().unwrap().split(',').position(|head| head.starts_with("peak_")).unwrap();
        let mechanism = SceneFile::parse(name, shipped(name).unwrap(), &[]).unwrap().mechanism.unwrap();
        let drawn = Production::of_mechanism(&mechanism, None, 0.0, 1).unwrap().draw(0..units);
        let error = |(line, gaps): (&str, &Vec<f64>)| {
            let found: f64 = line.split(',').nth(at).unwrap().parse().unwrap();
            let exact = run(&mechanism, gaps, 1.0).unwrap().outcomes[0].peak_force.unwrap();
            (found / exact - 1.0).abs()
        };
        let mut errors: Vec<f64> = lines.zip(&drawn.gaps).map(error).collect();
        assert_eq!(errors.len(), units as usize);
        errors.sort_by(f64::total_cmp);
        let p95 = errors[errors.len() * 95 / 100];
        assert!(p95 < 1e-3 && errors[0] > 0.0, "{name}: {p95}");
    }
}

/// A run that ends while the drive still ramps judges no unit: how many fail is not known, and why.
#[test]
fn units_without_a_verdict_are_no_success() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["population", "slider-crank", "--units", "20", "--set", "run.duration=10"];
    let text = stdout(&slipfit(folder.path(), &arguments));
    assert!(text.contains("Malfunction     not known: none of 20 units comes to a verdict"), "{text}");
    assert!(text.contains("undecided: the run ends at 10 ms, what is commanded at "), "{text}");
    assert!(!text.contains("None malfunctions") && !text.contains("Sigma level"), "{text}");
    let found = json(folder.path(), &[&arguments[..], &["--json"]].concat());
    assert!(found["statistics"]["undecided"]["units"] == 20 && found["statistics"]["sigma_level"].is_null(), "{found}");
}
