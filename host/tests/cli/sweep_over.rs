//! `slipfit sweep --over`.

use super::common::{json, slipfit, stdout};

/// A point of a sweep over a key is what other commands say of the scene with that value.
#[test]
fn a_sweep_over_a_key_is_what_other_commands_say_at_its_values() {
    let folder = tempfile::tempdir().unwrap();
    let over = ["sweep", "--over", "friction.coefficient=0.2:0.3:0.1", "--stroke", "--units", "64", "--json"];
    let swept = json(folder.path(), &over);
    assert_eq!((swept["keys"].as_array().unwrap().len(), swept["points"].as_array().unwrap().len()), (1, 2));
    for (k, value) in ["0.2", "0.3"].into_iter().enumerate() {
        let point = &swept["points"][k];
        assert_eq!(point["values"][0].as_f64().unwrap().to_string(), value);
        let set = format!("friction.coefficient={value}");
        let level = json(folder.path(), &["sweep", "--n", "0:0:1", "--stroke", "--set", &set, "--json"]);
        for figure in ["verdict", "peak_force", "breakaway", "final_velocity", "end"] {
            assert_eq!(point[figure], level["levels"][0][figure], "{figure} at {value}");
        }
        let units = json(folder.path(), &["population", "--units", "64", "--set", &set, "--json"]);
        assert_eq!(point["population"], units["statistics"], "at {value}");
    }
    let [few, many] = [0, 1].map(|k| swept["points"][k]["population"]["malfunctions"]["units"].as_u64().unwrap());
    assert!(few == 0 && many > 10, "{few} {many}");
}

/// Two keys, of which one is the level, in CSV and as a picture; a mechanism by one of its keys.
#[test]
fn two_keys_are_combined_and_mechanisms_have_keys_too() {
    let folder = tempfile::tempdir().unwrap();
    let over = ["--over", "n=-1:2:3", "--over", "slide.mass=80:100:10", "--csv", "a.csv", "--plot", "a.svg"];
    let text = stdout(&slipfit(folder.path(), &[&["sweep", "--stroke"][..], &over].concat()));
    assert!(text.contains("of 6 combinations"), "{text}");
    let csv = std::fs::read_to_string(folder.path().join("a.csv")).unwrap();
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..3], ["slide.mass", "n", "verdict"]);
    let values: Vec<[&str; 2]> = rows[1..].iter().map(|row| [row[0], row[1]]).collect();
    assert_eq!(values, [["80", "-1"], ["90", "-1"], ["100", "-1"], ["80", "2"], ["90", "2"], ["100", "2"]]);
    let svg = std::fs::read_to_string(folder.path().join("a.svg")).unwrap();
    assert!(svg.contains("over n and slide.mass") && svg.contains("slide.mass = 90"), "{svg}");
    let stiffness =
        ["sweep", "slider-crank", "--over", "contact.stiffness=1000:3000:1000", "--set", "run.duration=100"];
    let text = stdout(&slipfit(folder.path(), &stiffness));
    assert!(text.contains("contact.stiffness = 1000 … 3000: runs") && text.contains("peak, N·m"), "{text}");
}

#[test]
fn what_cannot_be_swept_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, why) in [
        (&["--over", "friction.coefficient"][..], "allowed is KEY=A:B:STEP"),
        (&["--over", "friction.coefficient=0.3:0.1:0.1"], "is below the first"),
        (&["--over", "friction.nothing=0:1:1"], "friction.nothing"),
        (&["--over", "friction.coefficient=-0.1:0.1:0.1"], "--over friction.coefficient=-0.1"),
        (&["--over", "n=0:1:1", "--over", "n=0:1:1"], "names n twice"),
        (&["--over", "n=0:1:1", "--n", "2"], "--over has the level n as a key"),
        (&["--over", "slide.mass=80:90:10", "--n", "0:1:1"], "one level is allowed"),
        (
            &["--over", "n=0:1:1", "--over", "slide.mass=80:90:1", "--over", "drive.gain=1:2:1"],
            "allowed are one or two keys",
        ),
        (&["--units", "100"], "--over"),
        (&["--over", "n=0:1:1", "--units", "64"], "units have gaps of their own"),
        (&["--over", "slide.mass=80:90:10", "--units", "64", "--step", "1ms"], "they are the desk's"),
        (
            &["--over", "slide.mass=80:90:10", "--units", "64", "--set", "uncertain.friction.coefficient=[0.2, 0.3]"],
            "allowed is a scene without [uncertain] and [measured]",
        ),
        (&["--over", "slide.mass=80:90:10", "--over", "friction.coefficient=0.3:-0.1:0.2"], "is below the first"),
    ] {
        let output = slipfit(folder.path(), &[&["sweep"][..], arguments].concat());
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && told.contains(why), "{arguments:?}: {told}");
    }
}

/// The opening ends before the ramp does: no unit has a verdict, and none counts as one that does its job.
#[test]
fn a_share_that_is_not_known_is_not_the_least() {
    let folder = tempfile::tempdir().unwrap();
    let over = ["sweep", "--over", "slide.mass=80:90:10", "--units", "64", "--plot", "a.svg"];
    let text = stdout(&slipfit(folder.path(), &over));
    assert!(
        text.contains("not known: none of 64 units comes to a verdict") && !text.contains("The least share"),
        "{text}"
    );
    let svg = std::fs::read_to_string(folder.path().join("a.svg")).unwrap();
    assert!(!svg.contains("NaN") && svg.contains("peak drive force"), "{svg}");
}

/// A warning that holds from some value on says from which.
#[test]
fn warnings_say_at_which_values_they_hold() {
    let folder = tempfile::tempdir().unwrap();
    let output = slipfit(folder.path(), &["sweep", "--stroke", "--over", "friction.coefficient=0.1:0.4:0.1"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.contains("at friction.coefficient = 0.3 (and at another point): self-locking"), "{told}");
    // That of the stated clearance holds at all.
    assert!(told.contains("warning: the scene states a clearance"), "{told}");
}
