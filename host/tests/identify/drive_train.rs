//! Drive trains by their effort along the measured motion.

use super::common::{json, slipfit, stdout};
use super::{TRAIN, swinging, write};
use slipfit_core::sampling::stream::unit_stream;
use slipfit_tolerance::failure::subset::normals;

#[test]
fn a_drive_train_gives_its_parameters_back() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "train.toml", TRAIN);
    write(folder.path(), "run.csv", &swinging());
    let found = json(
        folder.path(),
        &["identify", "train.toml", "run.csv", "run.csv", "--set", "identify.law=symmetric", "--json"],
    );
    assert_eq!((&found["law"], &found["records"]), (&"symmetric".into(), &["run.csv", "run.csv"][..].into()));
    let symmetric = found["compared"].as_array().unwrap().iter().find(|one| one["name"] == "symmetric").unwrap();
    for (parameter, truth) in symmetric["parameters"].as_array().unwrap().iter().zip([2.0, 3.0, 5.0, 0.0]) {
        let [value, deviation] = ["value", "deviation"].map(|field| parameter[field].as_f64().unwrap());
        assert!((value - truth).abs() < 4.0 * deviation.max(0.005), "{parameter}");
    }
    assert!(symmetric["lack"]["verdict"].is_null());
}

/// What is found of a drive train is what a mechanism's drive may have as unknown.
#[test]
fn an_identified_drive_train_goes_into_a_mechanism() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "train.toml", TRAIN);
    write(folder.path(), "run.csv", &swinging());
    let law = "identify.law=symmetric";
    stdout(&slipfit(folder.path(), &["identify", "train.toml", "run.csv", "--set", law, "-o", "found.toml"]));
    let found = std::fs::read_to_string(folder.path().join("found.toml")).unwrap();
    let scene = "mechanism = { space = \"plane\" }\nrun = { duration = 300 }\n\
         [[body]]\nname = \"stage\"\nmass = 2000\ninertia = 1e6\ncentre = [0, 0]\n\
         [[joint]]\nname = \"guide\"\nkind = \"prismatic\"\nbetween = [\"frame\", \"stage\"]\nat = [0, 0]\naxis = [1, 0]\n\
         [[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = 0.1\nramp_start = 0\nramp_end = 0.1\nspeed = 100\n\
         limit = 30\ncoulomb = 5\nstick_band = 1\nviscous = \"3 N·s/m\"\n";
    write(folder.path(), "stage.toml", &format!("{scene}{found}"));
    let text = stdout(&slipfit(folder.path(), &["population", "stage.toml", "--units", "40"]));
    for name in ["stage.mass", "motor.coulomb", "motor.viscous", "motor.offset"] {
        assert!(text.contains(name), "{name} in\n{text}");
    }
}

#[test]
fn a_law_that_lacks_a_term_says_so_first() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "train.toml", TRAIN);
    write(folder.path(), "run.csv", &swinging());
    let law = "identify.law=[\"coulomb\", \"offset\"]";
    let output = slipfit(folder.path(), &["identify", "train.toml", "run.csv", "--set", law, "-o", "found.toml"]);
    assert!(stdout(&output).starts_with("Lack of fit: "), "{}", stdout(&output));
    assert!(String::from_utf8(output.stderr).unwrap().contains("decisively better than coulomb, offset"));
    let written = std::fs::read_to_string(folder.path().join("found.toml")).unwrap();
    assert!(
        written.contains("# Lack of fit")
            && written.contains("\n[uncertain]\ndrive = [{ name = \"motor\", coulomb = { mean = \""),
        "{written}"
    );
}

/// One unit coasts by the symmetric law, the other rubs by direction: one law describes both.
#[test]
fn units_of_a_drive_train_are_compared_by_one_law() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "train.toml", TRAIN);
    write(folder.path(), "one.csv", &swinging());
    let noise = normals(&mut unit_stream(2, 0), 3000);
    let row = |i: usize| {
        let t = 1e-3 * i as f64;
        let (speed, acceleration) = (libm::sin(8.0 * t), 8.0 * libm::cos(8.0 * t));
        let friction = if speed > 0.0 { 4.0 + 2.0 * speed } else { -7.0 + 5.0 * speed };
        format!("{t},{},{}\n", 1e3 * speed, 2.0 * acceleration + friction + 0.1 * noise[i])
    };
    write(
        folder.path(),
        "two.csv",
        &(0..3000).fold("t (s),speed (mm/s),force (N)\n".to_owned(), |text, i| text + &row(i)),
    );
    let found = json(folder.path(), &["identify", "train.toml", "one.csv", "two.csv", "--each", "--json"]);
    let laws: Vec<&str> = found["units"].as_array().unwrap().iter().map(|unit| unit["law"].as_str().unwrap()).collect();
    assert!(laws[0] == laws[1] && laws[0].starts_with("by-direction"), "{laws:?}");
    let forwards = found["between"].as_array().unwrap().iter().find(|one| one["name"] == "viscous forwards").unwrap();
    assert!((forwards["mean"].as_f64().unwrap() - 2.5).abs() < 0.1, "{forwards}");
}

/// A unit whose force has something that no law knows does not count in the mean, and is named.
#[test]
fn a_unit_that_is_not_explained_is_left_out_of_the_mean() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "train.toml", TRAIN);
    write(folder.path(), "one.csv", &swinging());
    write(folder.path(), "two.csv", &swinging());
    let pulled = |(i, row): (usize, &str)| {
        let (rest, force) = row.rsplit_once(',').unwrap();
        // A load that hangs on the drive for half of the time.
        let load = if (i / 300) % 2 == 0 { 0.0 } else { 9.0 };
        format!("{rest},{}\n", force.parse::<f64>().unwrap() + load)
    };
    let rows: String = swinging().lines().skip(1).enumerate().map(pulled).collect();
    write(folder.path(), "three.csv", &format!("t (s),speed (mm/s),force (N)\n{rows}"));
    let arguments = ["identify", "train.toml", "one.csv", "two.csv", "three.csv", "--each"];
    let found = json(folder.path(), &[&arguments[..], &["--json"]].concat());
    let mass = found["between"].as_array().unwrap().iter().find(|one| one["name"] == "mass").unwrap();
    assert!(mass["units"] == 2 && (mass["mean"].as_f64().unwrap() - 2.0).abs() < 0.01, "{mass}");
    let output = slipfit(folder.path(), &arguments);
    let warnings = String::from_utf8(output.stderr).unwrap();
    assert!(warnings.contains("three.csv is left out of the mean"), "{warnings}");
}
