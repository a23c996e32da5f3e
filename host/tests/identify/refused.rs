//! Records and scenes that are refused, with their place.

use super::common::slipfit;
use super::mechanism::stage;
use super::{TRAIN, swinging, write};
use slipfit::scene::CD_ROM_SLIDE;

#[test]
fn bad_records_and_scenes_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "train.toml", TRAIN);
    let good = swinging();
    write(folder.path(), "run.csv", &good);
    let rows: Vec<&str> = good.lines().collect();
    for (line, text, expected) in [
        (7, "0.003,1,1", "bad.csv:7:1: the time is 0.003 s, not after the 0.004 s"),
        (7, "0.005,x,1", "bad.csv:7:7: \"x\" in column \"speed\" is not a number"),
        (7, "0.005,1,", "bad.csv:7:9: column \"force\" has no number"),
        (1, "t (s),speed (kg),force (N)", "bad.csv:1:7: column \"speed\" is in \"kg\""),
        (3001, "9.9,1,1", "bad.csv:3001:1: the record has a gap"),
    ] {
        let mut rows = rows.clone();
        rows[line - 1] = text;
        write(folder.path(), "bad.csv", &rows.join("\n"));
        let output = slipfit(folder.path(), &["identify", "train.toml", "bad.csv"]);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && errors.contains(expected), "{errors}");
    }
    for (arguments, expected) in [
        (vec!["identify", "train.toml", "absent.csv"], "absent.csv: No such file"),
        (vec!["identify", "train.toml", "/dev/zero"], "/dev/zero:1:1: the file has"),
        (vec!["identify", "cd-rom-slide", "run.csv"], "has no table [identify]"),
        (vec!["identify", "train.toml", "run.csv", "--n", "1"], "--n is for slides and mechanisms"),
        (vec!["identify", "train.toml", "run.csv", "-o", "run.csv"], "--output writes .toml"),
        (vec!["identify", "train.toml", "run.csv", "--set", "identify.law=dry"], "allowed: coulomb, symmetric"),
        (vec!["identify", "train.toml", "run.csv", "--set", "identify.search=grid"], "has no effect"),
        (vec!["identify", "train.toml", "run.csv", "--set", "identify.law=[\"coulomb forwards\", \"delay\"]"], ""),
    ] {
        let output = slipfit(folder.path(), &arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        let is_right = if expected.is_empty() { output.status.success() } else { output.status.code() == Some(2) };
        assert!(is_right && errors.contains(expected), "{arguments:?}: {errors}");
    }
}

#[test]
fn what_is_sought_of_a_slide_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "run.csv", "t (s),force (N)\n0,1\n");
    for (table, expected) in [
        ("friction.coefficient = [0.5, 0.1]", "a lower and a higher bound"),
        ("gaps = [{ of = \"roof\", n = [-3, 3] }]", "there is no varying gap `roof`"),
        ("gaps = [{ of = \"rail\", n = [-3, 3] }, { of = \"left back\", n = [-3, 3] }]", "\"left back\" again"),
        ("gaps = \"all\"", "or \"production\""),
        ("loss = \"huber\"", "what is sought"),
        ("friction.coefficient = [0.1, 0.5]\ncutoff = 10", "`identify.cutoff` has no effect"),
        ("friction.coefficient = [0.1, 0.5]", "run.csv:2:1: the record has 1 samples"),
    ] {
        write(folder.path(), "slide.toml", &format!("{CD_ROM_SLIDE}\n[identify]\n{table}\n"));
        let output = slipfit(folder.path(), &["identify", "slide.toml", "run.csv"]);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && errors.contains(expected), "{table}: {errors}");
    }
}

#[test]
fn what_a_measured_motion_does_not_show_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "run.csv", "t (s),force (N)\n0,1\n");
    for (identify, expected) in [
        (
            "along = \"motion\"\ndrive = [{ name = \"motor\", gain = [0.1, 1] }]\n",
            "has no effect along the measured motion",
        ),
        ("along = \"motion\"\ncompare = \"speed\"\ndelay = [0, 0.01]\n", "has no effect along the measured motion"),
        ("delay = [-0.01, 0.01]\n", "0 to 10 s"),
        ("cutoff = 10\ndelay = [0, 0.01]\n", "has no effect where the motion is computed"),
        ("recorded = \"other\"\ndelay = [0, 0.01]\n", "there is no drive `other`"),
        ("delay = { between = [0, 0.01], mean = 0.02, deviation = 0.001 }\n", "a value between the bounds"),
    ] {
        write(folder.path(), "stage.toml", &stage(identify));
        let output = slipfit(folder.path(), &["identify", "stage.toml", "run.csv"]);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && errors.contains(expected), "{identify}: {errors}");
    }
}
