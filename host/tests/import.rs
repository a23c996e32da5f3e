//! Parts that come from a model: what a scene of several parts makes of them, and how they follow the model.

mod common;

use std::path::{Path, PathBuf};

use common::{slipfit, stdout};

fn qif(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("qif/tests/data").join(name)
}

const CTC_01: &str = "nist_ctc_01_asme1_ap242.qif";

#[test]
fn an_imported_model_is_a_part_that_check_accepts() {
    let folder = tempfile::tempdir().unwrap();
    for (name, [in_part, all]) in [(CTC_01, [11, 14]), ("nist_ctc_03_asme1_ap242.qif", [18, 22])] {
        let file = qif(name);
        let output = slipfit(folder.path(), &["import", file.to_str().unwrap(), "-o", "part.toml"]);
        let told = String::from_utf8(output.stderr.clone()).unwrap();
        stdout(&output);
        assert!(told.starts_with(&format!("{in_part} of {all} tolerances")), "{told}");
        stdout(&slipfit(folder.path(), &["check", "part.toml"]));
        let printed = stdout(&slipfit(folder.path(), &["import", file.to_str().unwrap()]));
        assert_eq!(printed, std::fs::read_to_string(folder.path().join("part.toml")).unwrap());
    }
}

/// CTC-01 typed from its drawing, without an import.
const TYPED: &str = r#"
[[part]]
name = "plate"
[[part.plane]]
name = "A"
at = ["0 mm", 0, 0]
normal = [0, 0, 1]
along = [1, 0, 0]
extents = ["80 cm", 450.0]
flatness = "0.2 mm"

[[part.axis]]
name = "B"
at = [-325, -175, -50]
along = [0, 0, -1]
length = 100
kind = "hole"
diameter = { value = 35, tolerance = [-0.2, 0] }

[[part.axis]]
name = "C"
at = [325, -175, -50]
along = [0, 0, -1]
length = 100
kind = "hole"
diameter = { value = 35, tolerance = [0, 0.2] }

[[part.axis]]
name = "Nominal 2175"
at = [-30, -102.5, -25]
along = "+y"
length = 45
kind = "hole"
diameter = { value = 20, tolerance = [-0.1, 0.05] }

[[part.axis]]
name = "Nominal 2176"
at = [30, -102.5, -25]
along = "+y"
length = 45
kind = "hole"
diameter = { value = 20, tolerance = [-0.05, 0.1] }

[[part.axis]]
name = "Nominal 2177"
at = [325, 175, -50]
along = "-z"
length = 100
kind = "hole"
diameter = { value = 35, tolerance = 0.2 }

[[part.axis]]
name = "Nominal 2178"
at = [-325, 175, -50]
along = "-z"
length = 100
kind = "hole"
diameter = { value = 35, tolerance = 0.2 }

[[part.axis]]
name = "Nominal 2182"
at = [160, 45, -25]
along = "-z"
length = 50
kind = "hole"
diameter = { value = 25, tolerance = 0.15 }


[[part.plane]]
name = "Nominal 2159"
at = [-150, 117.5, -25]
normal = "+x"
along = "-y"
extents = [15, 50]
position = { zone = 0.75, datum = ["plate.A", "plate.B", "plate.C"] }

[[part.plane]]
name = "Nominal 2161"
at = [285, 0, -25]
normal = "-y"
along = "+x"
extents = [80, 50]
position = { zone = 0.75, datum = ["plate.A", "plate.B", "plate.C"] }

[[part.plane]]
name = "Nominal 2162"
at = [400, 0, -50]
normal = "+x"
along = "+y"
extents = [350, 100]
perpendicularity = { zone = 1.5, datum = "plate.A" }
"#;

/// What the plate is mated with: pins of a base, and a cover on two of its other holes.
const BASE: &str = r#"title = "Three parts"

[[part]]
name = "base"
plane = [{ name = "top", at = [0, 0, 0], normal = "-z", along = "+x", extents = [800, 450], flatness = 0.1 }]
axis = [
  { name = "pin 1", at = [-325, -175, -10], along = "-z", length = 20, diameter = { value = 34.6, tolerance = 0.05 } },
  { name = "pin 2", at = [325, -175, -10], along = "-z", length = 20, diameter = { value = 34.6, tolerance = 0.05 }, position = { zone = 0.1, datum = ["base.top", "base.pin 1"] } },
]
"#;
const COVER: &str = r#"
[[part]]
name = "cover"
plane = [{ name = "foot", at = [0, 0, 0], normal = "-z", along = "+x", extents = [700, 60], flatness = 0.1 }]
axis = [
  { name = "pin 1", at = [325, 175, -10], along = "-z", length = 20, diameter = { value = 34.6, tolerance = 0.05 } },
  { name = "pin 2", at = [-325, 175, -10], along = "-z", length = 20, diameter = { value = 34.6, tolerance = 0.05 } },
]
point = [{ name = "tip", at = [300, 0, 40], normal = "+x" }]

[[mate]]
part = "plate"
contacts = [["plate.A", "base.top"], ["plate.B", "base.pin 1"], ["plate.C", "base.pin 2"]]

[[mate]]
part = "cover"
contacts = [["cover.foot", "plate.A"], ["cover.pin 1", "plate.Nominal 2177"], ["cover.pin 2", "plate.Nominal 2178"]]

[[measure]]
name = "tip to face"
distance = ["cover.tip", "plate.Nominal 2162"]
lower = "-101 mm"
upper = "-99 mm"

[[measure]]
name = "slot to pin"
distance = ["plate.Nominal 2159", "base.pin 1"]

[[measure]]
name = "play on pin 1"
is = "'plate.B.diameter' - 'base.pin 1.diameter'"
lower = 0
"#;

/// A part that was imported is the part that is typed from the same drawing, to the last bit of every result.
#[test]
fn an_imported_part_in_an_assembly_is_the_typed_one() {
    let [one, two] = [0, 1].map(|_| tempfile::tempdir().unwrap());
    let model = qif(CTC_01);
    let whole = stdout(&slipfit(one.path(), &["import", model.to_str().unwrap(), "--name", "plate"]));
    let imported = whole.split("\n# Mates").next().unwrap();
    for (folder, part) in [(&one, imported), (&two, TYPED)] {
        std::fs::write(folder.path().join("scene.toml"), format!("{BASE}\n{part}\n{COVER}")).unwrap();
    }
    for arguments in [
        &["tolerance", "scene.toml", "--json", "--samples", "20000"][..],
        &["tolerance", "scene.toml", "--samples", "20000"],
        &["check", "scene.toml", "--json"],
    ] {
        let [imported, typed] = [&one, &two].map(|folder| stdout(&slipfit(folder.path(), arguments)));
        assert!(imported == typed && imported.contains("slot to pin"), "{arguments:?}\n{imported}\n{typed}");
    }
}

/// A scene follows its model: changes are reported, and what the user wrote stays.
#[test]
fn a_scene_follows_its_model() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(qif(CTC_01)).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    write("plate.qif", &text);
    let whole = stdout(&slipfit(folder.path(), &["import", "plate.qif", "--name", "plate"]));
    let imported = whole.split("\n# Mates").next().unwrap();
    write("scene.toml", &format!("{BASE}\n{imported}\n{COVER}"));
    let before = read("scene.toml");
    let update = ["import", "plate.qif", "--name", "plate", "--update", "scene.toml"];
    let told = |arguments: &[&str]| {
        let output = slipfit(folder.path(), arguments);
        assert_eq!(stdout(&output), "");
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(told(&update).starts_with("nothing of the part plate changes\n11 of 14"));
    assert_eq!(read("scene.toml"), before);
    // The flatness of A.
    let zone = "<ToleranceValue linearUnit=\"mm\">0.2<";
    assert!(text.contains(zone));
    write("plate.qif", &text.replace(zone, &zone.replace("0.2", "0.1")));
    let elsewhere = [&update[..], &["-o", "other.toml"]].concat();
    assert!(told(&elsewhere).starts_with("plate.A: flatness is 0.1; it was 0.2\n"));
    assert_eq!(read("scene.toml"), before);
    told(&update);
    assert_eq!(read("scene.toml"), read("other.toml"));
    let lines =
        |text: &str| text.lines().filter(|line| !line.starts_with("flatness")).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(lines(&read("scene.toml")), lines(&before));
    stdout(&slipfit(folder.path(), &["check", "scene.toml"]));
    for (arguments, expected) in [
        (vec!["import", "plate.qif", "--update", "scene.toml"], "parts that it has: base, plate, cover (--name)"),
        (vec!["import", "plate.qif", "--name", "base", "--update", "scene.toml"], "was imported"),
        (vec!["import", "plate.qif", "--update", "absent.toml"], "cannot read the scene absent.toml"),
        (vec!["import", "plate.qif", "--update", "bad.toml"], "bad.toml:2:5: "),
        (vec!["import", "plate.qif", "-o", "plate.qif"], "--output writes .toml"),
        (vec!["import", "plate.toml", "-o", "plate.toml"], "--output"),
    ] {
        write("bad.toml", "a = 1\nb = \n");
        let output = slipfit(folder.path(), &arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && errors.contains(expected), "{arguments:?}: {errors}");
    }
}
