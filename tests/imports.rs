//! Layers: in every crate a folder or file at the top may import those below it alone, so that there is no circle.
//!
//! Between crates the compiler sees to that. The order within each crate is here; a module that is missing in it fails.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// The modules at the top of each crate, the lowest first.
const LAYERS: [(&str, &[&str]); 4] = [
    (
        "host/src",
        &["xml", "setup", "dynamics", "mechanism", "scene", "population", "quality", "firmware", "show", "cli"],
    ),
    (
        "host/tolerance/src",
        &[
            "number",
            "unit",
            "numeric",
            "model",
            "distribution",
            "sampling",
            "theory",
            "counting",
            "statistics",
            "failure",
            "analysis",
            "report",
            "allocate",
            "product",
        ],
    ),
    (
        "host/desk/src",
        &[
            "settled",
            "contact",
            "laws",
            "closing",
            "scheme",
            "pack",
            "out_of_line",
            "element",
            "side_by_side",
            "error_control",
            "plant",
            "slide",
            "population",
        ],
    ),
    (
        "core/src",
        &[
            "power",
            "scalar",
            "product",
            "error",
            "linear",
            "pose",
            "law",
            "drive",
            "clearance",
            "mechanism",
            "integrator",
            "kernel",
            "ahead",
            "system",
            "slide",
            "menu",
            "scene",
            "table",
            "monitor",
            "sampling",
        ],
    ),
];

/// Imports that point up all the same, from a file to a module. None may be added.
const UPWARDS: [(&str, &str); 1] = [("core/src/slide/abreast.rs", "menu")];

fn files(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        match entry.extension() {
            None if entry.is_dir() => files(&entry, all),
            Some(extension) if extension == "rs" => all.push(entry),
            _ => {}
        }
    }
}

/// `line` without its texts; of a text that goes on to the next line or comes from the one before, no more than what stands before it.
fn without_texts(line: &str) -> String {
    let pieces: Vec<&str> = line.split('"').collect();
    if pieces.len() % 2 == 1 { pieces.into_iter().step_by(2).collect() } else { pieces[0].into() }
}

/// The modules at the top of its crate that `text` names, by a path from there or from its own module, which is `depth` levels below; without
/// its tests, comments and texts.
fn imported(text: &str, depth: usize) -> BTreeSet<String> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let code: Vec<String> =
        code.lines().filter(|line| !line.trim_start().starts_with("//")).map(without_texts).collect();
    let code = code.join("\n").replace(&"super::".repeat(depth), "crate::");
    let mut found = BTreeSet::new();
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        let Some(group) = rest.strip_prefix('{') else {
            found.insert(word(rest));
            continue;
        };
        // The first names of a group, which may hold groups.
        let (mut depth, mut start) = (0, true);
        for (i, c) in group.char_indices() {
            match c {
                '}' if depth == 0 => break,
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => start = true,
                c if start && !c.is_whitespace() => {
                    found.insert(word(&group[i..]));
                    start = false;
                }
                _ => {}
            }
        }
    }
    found
}

#[test]
fn nothing_is_imported_from_above() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut upwards, mut excepted, mut count) = (Vec::new(), BTreeSet::new(), 0);
    for (folder, layers) in LAYERS {
        let height = |module: &str| layers.iter().position(|layer| *layer == module);
        for layer in layers {
            let there =
                [format!("{layer}.rs"), format!("{layer}/mod.rs")].map(|file| root.join(folder).join(file).exists());
            assert!(there.contains(&true), "{folder} has no {layer}");
        }
        let mut all = Vec::new();
        files(&root.join(folder), &mut all);
        for path in all {
            let name = path.strip_prefix(root).expect("within").display().to_string();
            let modules = path.strip_prefix(root.join(folder)).expect("within").with_extension("");
            let modules: Vec<_> =
                modules.iter().map(|name| name.to_string_lossy()).filter(|name| name != "mod").collect();
            let own = modules[0].to_string();
            let text = fs::read_to_string(&path).expect("a text");
            // Modules of tests alone are declared so by the module above them.
            let is_test =
                name.contains("test") || text.contains("#![cfg(test)]") || TEST_MODULES.contains(&name.as_str());
            if ["lib", "main"].contains(&own.as_str()) || is_test {
                continue;
            }
            let Some(from) = height(&own) else { panic!("{name} is in no layer") };
            for to in imported(&text, modules.len()) {
                // What is no module is a name at the top of the crate.
                let Some(to) = height(&to) else { continue };
                count += 1;
                if to > from && UPWARDS.contains(&(name.as_str(), layers[to])) {
                    excepted.insert((name.clone(), layers[to]));
                } else if to > from {
                    upwards.push(format!("{name} imports {}", layers[to]));
                }
            }
        }
    }
    assert!(count > 500, "only {count} imports were read");
    assert!(upwards.is_empty(), "{}", upwards.join("\n"));
    assert_eq!(excepted.len(), UPWARDS.len(), "an exception that is none any more: {excepted:?}");
}

/// Modules of tests whose names do not say so.
const TEST_MODULES: [&str; 3] =
    ["host/src/dynamics/example.rs", "host/src/reference.rs", "host/tolerance/src/examples.rs"];

#[test]
fn groups_and_paths_are_read() {
    let text = "use crate::{\n    a::{b, c::{d}},\n    e,\n};\nfn f() { crate::g::h() }\n// crate::no\n";
    assert_eq!(imported(text, 1), BTreeSet::from(["a", "e", "g"].map(String::from)));
    let text = "use super::super::a::b;\nuse super::c;\nlet d = crate::d::f(\"crate::no\", crate::e::G);\n";
    assert_eq!(imported(text, 2), BTreeSet::from(["a", "d", "e"].map(String::from)));
}
