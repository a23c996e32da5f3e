//! The JSON Schema of scenes: no scene that the program reads is marked, and mistakes are.

mod common;

use boon::{Compiler, Schemas};
use common::{slipfit, stdout};
use serde_json::Value;

/// The printed schema, ready to judge.
struct Judge {
    schemas: Schemas,
    index: boon::SchemaIndex,
}

impl Judge {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let printed = stdout(&slipfit(folder.path(), &["schema"]));
        stdout(&slipfit(folder.path(), &["schema", "-o", "s.json"]));
        assert_eq!(std::fs::read_to_string(folder.path().join("s.json")).unwrap(), printed);
        let mut compiler = Compiler::new();
        compiler.add_resource("scene.json", serde_json::from_str(&printed).unwrap()).unwrap();
        let mut schemas = Schemas::new();
        let index = compiler.compile("scene.json", &mut schemas).unwrap();
        Self { schemas, index }
    }

    /// What it marks in the text of a scene.
    fn marks(&self, scene: &str) -> Option<String> {
        let table: toml::Table = scene.parse().unwrap();
        let value: Value = serde_json::to_value(table).unwrap();
        self.schemas.validate(&value, self.index).err().map(|error| format!("{error:#}"))
    }
}

/// Shipped scenes, those of the reference, and every block of the guide that is a scene.
fn sound() -> Vec<(String, String)> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut scenes = Vec::new();
    for folder in ["scenes", "src/scene/reference"] {
        for entry in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "toml") {
                scenes.push((path.display().to_string(), std::fs::read_to_string(path).unwrap()));
            }
        }
    }
    for entry in std::fs::read_dir(root.join("guide/src")).unwrap() {
        let path = entry.unwrap().path();
        let Ok(page) = std::fs::read_to_string(&path) else { continue };
        let blocks = page.split("```toml").skip(1).filter_map(|rest| rest.split_once('\n')?.1.split("```").next());
        for block in blocks {
            let is_scene =
                |table: toml::Table| ["dimension", "part", "slide", "body"].iter().any(|key| table.contains_key(*key));
            if block.parse::<toml::Table>().is_ok_and(is_scene) {
                scenes.push((path.display().to_string(), block.to_owned()));
            }
        }
    }
    scenes
}

#[test]
fn no_scene_of_the_program_or_the_guide_is_marked() {
    let judge = Judge::new();
    let scenes = sound();
    assert!(scenes.len() > 30, "{}", scenes.len());
    let marks = scenes.iter().filter_map(|(name, scene)| Some(format!("{name}: {}\n", judge.marks(scene)?)));
    let marks: String = marks.collect();
    assert!(marks.is_empty(), "{marks}");
}

/// Each is refused by the program, too.
#[test]
fn mistakes_are_marked() {
    let judge = Judge::new();
    let folder = tempfile::tempdir().unwrap();
    let shipped =
        |name: &str| std::fs::read_to_string(format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let slide = shipped("cd-rom-slide");
    let lid = shipped("lid-on-pins");
    let hatch = shipped("hatch");
    let changes = [
        (&slide, "mass = 81.8", "mas = 81.8"),
        (&slide, "[slide]", "[slid]"),
        (&slide, "law = \"regularised\"", "law = \"regularized\""),
        (&slide, "coefficient = 0.3", "coefficient = \"much\""),
        (&slide, "coefficient = 0.3", "coefficient = -1"),
        (&slide, "gravity = [", "gravity = [1, "),
        (&slide, "[slide]", "[[slide.mass]]"),
        (&lid, "flatness = 0.05", "flatnes = 0.05"),
        (&lid, "zone = 0.1", "zon = 0.1"),
        (&lid, "extents = [100, 60]", "extents = [100]"),
        (&hatch, "space = \"space\"", "space = \"line\""),
        (&hatch, "kind = \"cylindrical\"", "kind = \"cylinder\""),
    ];
    for (scene, from, to) in changes {
        let changed = scene.replacen(from, to, 1);
        assert_ne!(&changed, scene, "{from}");
        assert!(changed.parse::<toml::Table>().is_err() || judge.marks(&changed).is_some(), "{from} → {to}");
        std::fs::write(folder.path().join("scene.toml"), &changed).unwrap();
        assert_eq!(slipfit(folder.path(), &["check", "scene.toml"]).status.code(), Some(2), "{from} → {to}");
    }
}

/// Whatever hovers over a key says what it is.
#[test]
fn every_key_has_a_description() {
    let schema: Value = serde_json::from_str(include_str!("../schema.json")).unwrap();
    let tables = schema["definitions"].as_object().unwrap().values().chain([&schema]);
    let mut keys = 0;
    for (key, what) in tables.flat_map(|table| table["properties"].as_object().unwrap()) {
        assert!(what["description"].as_str().is_some_and(|text| text.len() > 5), "{key}");
        keys += 1;
    }
    assert!(keys > 250, "{keys}");
}
