//! What `--json` prints is what the guide says, field by field.

use std::{collections::BTreeMap, path::Path, process::Command};

use serde_json::Value;

/// Field and type, as the guide has them.
type Fields = Vec<(String, String)>;

/// The tables of the guide by their headings.
fn guide() -> BTreeMap<String, Fields> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("guide/src/json.md");
    let text = std::fs::read_to_string(path).unwrap();
    let mut tables: BTreeMap<String, Fields> = BTreeMap::new();
    let mut heading = String::new();
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("##") {
            heading = name.trim_start_matches('#').trim().replace('`', "");
        } else if let [_, field, kind, _, _] = line.split('|').map(str::trim).collect::<Vec<_>>()[..]
            && !matches!(field, "field" | "---")
        {
            tables.entry(heading.clone()).or_default().push((field.to_owned(), kind.to_owned()));
        }
    }
    tables
}

/// Whether `value` is of the type `kind`; `at` says where.
fn check(tables: &BTreeMap<String, Fields>, value: &Value, kind: &str, at: &str) {
    if let Some(kind) = kind.strip_suffix(" or null") {
        if !value.is_null() {
            check(tables, value, kind, at);
        }
    } else if let Some(kind) = kind.strip_prefix("list of ") {
        let list = value.as_array().unwrap_or_else(|| panic!("{at} is no list"));
        list.iter().for_each(|value| check(tables, value, kind, &format!("{at}[]")));
    } else if let Some(kind) = kind.strip_prefix("map of ") {
        let map = value.as_object().unwrap_or_else(|| panic!("{at} is no object"));
        map.iter().for_each(|(key, value)| check(tables, value, kind, &format!("{at}.{key}")));
    } else {
        let fits = match kind {
            "number" => value.is_number(),
            "count" => value.is_u64(),
            "text" => value.is_string(),
            "bool" => value.is_boolean(),
            "any" => true,
            _ => {
                check_object(tables, value, kind, at);
                true
            }
        };
        assert!(fits, "{at} is not a {kind}: {value}");
    }
}

/// The fields of a table, those of `*` among them.
fn flat(tables: &BTreeMap<String, Fields>, name: &str) -> Fields {
    let fields = tables.get(name).unwrap_or_else(|| panic!("the guide has no table `{name}`"));
    fields
        .iter()
        .flat_map(|(field, kind)| if field == "*" { flat(tables, kind) } else { vec![(field.clone(), kind.clone())] })
        .collect()
}

fn check_object(tables: &BTreeMap<String, Fields>, value: &Value, name: &str, at: &str) {
    let object = value.as_object().unwrap_or_else(|| panic!("{at} is no object"));
    let fields = flat(tables, name);
    for key in object.keys() {
        assert!(fields.iter().any(|(field, _)| field == key), "the guide does not know {at}.{key} of {name}");
    }
    for (field, kind) in &fields {
        let (kind, optional) = kind.strip_suffix(" optional").map_or((kind.as_str(), false), |kind| (kind, true));
        match object.get(field) {
            Some(value) => check(tables, value, kind, &format!("{at}.{field}")),
            None => assert!(optional, "{at}.{field} is missing"),
        }
    }
}

#[test]
fn every_field_is_in_the_guide() {
    let tables = guide();
    let folder = tempfile::tempdir().unwrap();
    let commands: [(&str, &[&str]); 22] = [
        ("check", &["check"]),
        ("check of a mechanism", &["check", "telescopic-drawer"]),
        ("check of a product", &["check", "clutch"]),
        ("simulate", &["simulate", "--n", "2.5"]),
        ("simulate", &["simulate", "--audit", "--set", "friction.law=exact"]),
        ("simulate", &["simulate", "--set", "friction.law=exact", "--stroke"]),
        ("simulate of a mechanism", &["simulate", "slider-crank", "--every", "10ms"]),
        ("simulate of a mechanism", &["simulate", "woodpecker-toy", "--every", "10ms"]),
        ("sweep", &["sweep", "--n", "0:4:2", "--stroke"]),
        ("sweep of a mechanism", &["sweep", "slider-crank", "--n", "0:1:1"]),
        ("simulate", &["simulate", "cd-rom-slide-drawing", "--unit", "17", "--stroke"]),
        ("population", &["population", "--units", "300", "--force-limit", "2"]),
        // Forces have a figure, verdicts have none in an opening.
        ("population", &["population", "--units", "300", "--opening", "--force-limit", "0.25", "--rare"]),
        ("table", &["table", "--n", "0:2:1", "-o", "table.bin"]),
        ("table", &["table", "--over", "position", "--n", "0:2:1", "-o", "z.bin"]),
        ("allocate", &["allocate", "clutch-processes", "--samples", "1000"]),
        (
            "allocate",
            &["allocate", "slide-processes", "--samples", "1000", "--units", "100", "--require", "malfunction=0.2"],
        ),
        ("allocate", &["allocate", "shaft-housing", "--samples", "1000", "--require", "yield=0.99", "--csv", "c.csv"]),
        ("run", &["run", "--n", "0:2:1"]),
        ("run of a mechanism", &["run", "slider-crank", "--n", "0:1:1", "--set", "run.duration=100"]),
        ("table", &["table", "slider-crank", "--n", "0:1:1", "--set", "run.duration=100", "-o", "torque.bin"]),
        ("kernel", &["kernel", "slider-crank", "-o", "unit.rs"]),
    ];
    for (name, arguments) in commands {
        let mut command = Command::new(env!("CARGO_BIN_EXE_slipfit"));
        let output = command.current_dir(folder.path()).args(arguments).arg("--json").output().unwrap();
        assert!(output.status.success(), "{arguments:?} {}", String::from_utf8_lossy(&output.stderr));
        let value: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(value["json_version"], 1, "{arguments:?}");
        check_object(&tables, &value, name, &arguments.join(" "));
    }
}
