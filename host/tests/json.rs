//! What `--json` prints is what the guide says, field by field.

#[path = "common/fields.rs"]
mod fields;

use std::process::Command;

use serde_json::Value;

use fields::{check_object, guide};

/// The guide's heading of what is printed for a shard.
const SHARD: &str = "A shard of tolerance or population";

/// Unknowns of a slide, and of a mechanism.
const FRICTION: &str = "uncertain.friction.coefficient=[0.2, 0.3]";
const STIFFNESS: &str = "uncertain.contact.stiffness={ median = 3000, factor = 3 }";

#[test]
fn every_field_is_in_the_guide() {
    let tables = guide();
    let folder = tempfile::tempdir().unwrap();
    let row = |k: u32| format!("{k},{},{}\n", ["A", "B"][k as usize % 2], 10.0 + 0.01 * f64::from(k * k % 37));
    let parts = (0..70).fold("part,tool,width [mm]\nlower,,9.9\nupper,,10.5\n".to_owned(), |text, k| text + &row(k));
    std::fs::write(folder.path().join("parts.csv"), parts).unwrap();
    std::fs::write(folder.path().join("train.toml"), "[identify]\nmodel = \"drive-train\"\n").unwrap();
    let scene = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/cd-rom-slide.toml")).unwrap();
    std::fs::write(folder.path().join("sought.toml"), scene + "[identify]\nfriction.coefficient = [0.1, 0.5]\n")
        .unwrap();
    let simulate = ["simulate", "--n", "2", "--stroke", "--csv", "run.csv"];
    let output =
        Command::new(env!("CARGO_BIN_EXE_slipfit")).current_dir(folder.path()).args(simulate).output().unwrap();
    assert!(output.status.success());
    let commands: [(&str, &[&str]); 42] = [
        ("check", &["check"]),
        ("capability", &["capability", "parts.csv", "--group", "tool"]),
        ("identify", &["identify", "sought.toml", "run.csv"]),
        ("identify", &["identify", "train.toml", "run.csv"]),
        ("identify --each", &["identify", "sought.toml", "run.csv", "run.csv", "--each"]),
        ("check of a mechanism", &["check", "telescopic-drawer"]),
        ("check of a product", &["check", "clutch"]),
        ("simulate", &["simulate", "--n", "2.5"]),
        ("simulate", &["simulate", "--audit", "--set", "friction.law=exact"]),
        ("simulate", &["simulate", "--set", "friction.law=exact", "--stroke"]),
        ("simulate of a mechanism", &["simulate", "slider-crank", "--every", "10ms"]),
        ("simulate of a mechanism", &["simulate", "woodpecker-toy", "--every", "10ms"]),
        ("sweep", &["sweep", "--n", "0:4:2", "--stroke"]),
        ("sweep", &["sweep", "slider-crank", "--n", "0:1:1"]),
        ("sweep --over", &["sweep", "--over", "friction.coefficient=0.2:0.3:0.1", "--stroke", "--units", "64"]),
        ("simulate", &["simulate", "cd-rom-slide-drawing", "--unit", "17", "--stroke"]),
        ("population", &["population", "--units", "300", "--force-limit", "2"]),
        (
            "population",
            &["population", "slider-crank", "--units", "200", "--force-limit", "0.6", "--set", "run.duration=50"],
        ),
        // Forces have a figure, verdicts have none in an opening.
        ("population", &["population", "--units", "300", "--opening", "--force-limit", "0.25", "--rare"]),
        ("population", &["population", "--units", "100", "--force-limit", "2", "--set", FRICTION]),
        (
            "population",
            &["population", "slider-crank", "--units", "20", "--set", "run.duration=50", "--set", STIFFNESS],
        ),
        ("table", &["table", "--n", "0:2:1", "-o", "table.bin"]),
        ("table", &["table", "--over", "position", "--n", "0:2:1", "-o", "z.bin"]),
        ("table --production", &["table", "--production", "--units", "300", "--period", "5", "-o", "units.bin"]),
        ("tolerance", &["tolerance", "clutch", "--samples", "1000"]),
        ("tolerance", &["tolerance", "--samples", "1000"]),
        ("tolerance of given gaps", &["tolerance", "cd-rom-slide"]),
        ("tolerance by an experiment", &["tolerance", "clutch", "--method", "taguchi"]),
        (SHARD, &["tolerance", "clutch", "--samples", "9000", "--shard", "1/2", "--out", "one"]),
        (SHARD, &["tolerance", "clutch", "--samples", "9000", "--shard", "2/2", "--out", "two"]),
        ("tolerance", &["merge", "one", "two"]),
        (SHARD, &["population", "--units", "300", "--opening", "--shard", "1/2", "--out", "units"]),
        (
            "precision --stability",
            &["precision", "--stability", "--random", "2", "--set", "run.duration=60", "--seed", "3"],
        ),
        ("allocate", &["allocate", "clutch-processes", "--samples", "1000"]),
        (
            "allocate",
            &["allocate", "slide-processes", "--samples", "1000", "--units", "100", "--require", "malfunction=0.2"],
        ),
        (
            "allocate",
            &[
                "allocate",
                "slide-processes",
                "--samples",
                "1000",
                "--units",
                "100",
                "--require",
                "malfunction=0.3",
                "--set",
                FRICTION,
            ],
        ),
        ("allocate", &["allocate", "shaft-housing", "--samples", "1000", "--require", "yield=0.99", "--csv", "c.csv"]),
        ("run", &["run", "--n", "0:2:1"]),
        ("run", &["run", "cd-rom-slide", "--n", "0:1:1", "--units", "20", "--set", FRICTION]),
        ("run", &["run", "slider-crank", "--n", "0:1:1", "--set", "run.duration=100"]),
        ("table", &["table", "slider-crank", "--n", "0:1:1", "--set", "run.duration=100", "-o", "torque.bin"]),
        ("kernel", &["kernel", "slider-crank", "-o", "unit.rs"]),
    ];
    for (name, arguments) in commands {
        let mut command = Command::new(env!("CARGO_BIN_EXE_slipfit"));
        let output = command.current_dir(folder.path()).args(arguments).arg("--json").output().unwrap();
        assert!(output.status.success(), "{arguments:?} {}", String::from_utf8_lossy(&output.stderr));
        let value: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(value["json_version"], 2, "{arguments:?}");
        check_object(&tables, &value, name, &arguments.join(" "));
    }
}
