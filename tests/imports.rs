//! Layers: in every crate a folder or file at the top may import those below it alone, so that there is no circle.
//!
//! Between crates the compiler sees to that. The order within each crate is here; a module that is missing in it fails. Nor do any two files
//! import each other, directly or by others.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// The modules at the top of each crate, the lowest first.
const LAYERS: [(&str, &[&str]); 7] = [
    (
        "host/src",
        &[
            "xml",
            "setup",
            "dynamics",
            "mechanism",
            "identify",
            "scene",
            "possible",
            "population",
            "quality",
            "firmware",
            "show",
            "cli",
        ],
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
    ("host/measured/src", &["unit", "table", "csv", "numeric", "families", "capability", "production"]),
    (
        "host/identify/src",
        &["signal", "record", "model", "beforehand", "fit", "doubt", "estimate", "between", "compare", "drive_train"],
    ),
    ("host/qif/src", &["error", "file", "drawing", "format", "xml", "words", "units", "model", "part", "results"]),
    (
        "host/desk/src",
        &[
            "settled",
            "contact",
            "cast",
            "laws",
            "scheme",
            "pack",
            "real",
            "closing",
            "out_of_line",
            "drive",
            "element",
            "side_by_side",
            "step_control",
            "error_control",
            "plant",
            "units",
            "slide",
            "population",
        ],
    ),
    (
        "core/src",
        &[
            "power",
            "scalar",
            "cast",
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
            "observer",
            "deadline",
            "system",
            "slide",
            "menu",
            "scene",
            "table",
            "monitor",
            "production",
            "sampling",
        ],
    ),
];

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

/// `text` without its tests, comments and texts.
fn code(text: &str) -> String {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let code: Vec<String> =
        code.lines().filter(|line| !line.trim_start().starts_with("//")).map(without_texts).collect();
    code.join("\n")
}

/// The modules at the top of its crate that `text` names, by a path from there or from its own module, which is `depth` levels below; without
/// its tests, comments and texts.
fn imported(text: &str, depth: usize) -> BTreeSet<String> {
    let code = code(text).replace(&"super::".repeat(depth), "crate::");
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
    let (mut upwards, mut count) = (Vec::new(), 0);
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
                if to > from {
                    upwards.push(format!("{name} imports {}", layers[to]));
                }
            }
        }
    }
    assert!(count > 500, "only {count} imports were read");
    assert!(upwards.is_empty(), "{}", upwards.join("\n"));
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

/// A path from the top of a crate.
type Name = Vec<String>;

/// The modules of a crate.
#[derive(Default)]
struct Modules {
    /// What each imports: names by their paths.
    imports: BTreeMap<Name, Vec<Name>>,
    /// Where the names come from that a module passes on.
    passed_on: BTreeMap<Name, BTreeMap<String, Name>>,
}

impl Modules {
    /// Those of the crate in `folder`, tests excepted.
    fn of(folder: &Path, root: &Path) -> Self {
        let mut all = Vec::new();
        files(folder, &mut all);
        let module = |path: &Path| -> Name {
            let inside = path.strip_prefix(folder).expect("within").with_extension("");
            let names = inside.iter().map(|name| name.to_string_lossy().into_owned());
            names.filter(|name| !["mod", "lib", "main"].contains(&name.as_str())).collect()
        };
        let mut modules = Self::default();
        let texts: Vec<(Name, String)> = all
            .iter()
            .filter(|path| {
                let name = path.strip_prefix(root).expect("within").display().to_string();
                !name.contains("test") && !TEST_MODULES.contains(&name.as_str())
            })
            .map(|path| (module(path), fs::read_to_string(path).expect("a text")))
            .filter(|(_, text)| !text.contains("#![cfg(test)]"))
            .collect();
        modules.imports = texts.iter().map(|(module, _)| (module.clone(), Vec::new())).collect();
        for (module, text) in texts {
            let code = code(&text);
            let (mut body, mut brought) = (String::new(), BTreeMap::new());
            for statement in code.split_inclusive(';') {
                let start = statement.rfind("use ").filter(|at| {
                    let before = statement[..*at].chars().next_back();
                    before.is_none_or(|c| c.is_whitespace() || c == ')') && statement.ends_with(';')
                });
                let Some(start) = start else {
                    body += statement;
                    continue;
                };
                body += &statement[..start];
                let is_public = statement[..start].lines().next_back().is_some_and(|line| line.contains("pub"));
                for path in expanded(&statement[start + 4..statement.len() - 1]) {
                    let (path, name) = path.split_once(" as ").map_or((path.as_str(), None), |(a, b)| (a, Some(b)));
                    let Some(path) = modules.absolute(&module, path) else { continue };
                    let name = name.map(str::to_owned).or(path.last().cloned()).unwrap_or_default();
                    brought.insert(name.clone(), path.clone());
                    if is_public {
                        modules.passed_on.entry(module.clone()).or_default().insert(name, path);
                    } else {
                        modules.imports.entry(module.clone()).or_default().push(path);
                    }
                }
            }
            let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
            let paths = body.split(|c: char| !is_path(c)).filter(|path| path.contains("::"));
            // By a name that was brought, such as a module's, or from the module itself.
            let absolute = |path: &str| match path.split_once("::").map(|(first, rest)| (brought.get(first), rest)) {
                Some((Some(from), rest)) => {
                    Some(from.iter().cloned().chain(rest.split("::").map(str::to_owned)).collect())
                }
                _ => modules.absolute(&module, path),
            };
            let paths: Vec<Name> = paths.filter_map(absolute).collect();
            modules.imports.entry(module).or_default().extend(paths);
        }
        modules
    }

    /// A `path` in a `module` from the top of the crate; `None` of one into another crate.
    fn absolute(&self, module: &Name, path: &str) -> Option<Name> {
        let mut names: Vec<&str> = path.split("::").map(str::trim).collect();
        let mut from = module.clone();
        match names.first()? {
            &"crate" => from.clear(),
            &"self" | &"super" => {}
            child => {
                from.push((*child).to_owned());
                return self.imports.contains_key(&from).then(|| {
                    from.extend(names.drain(1..).map(str::to_owned));
                    from
                });
            }
        }
        let ups = names.iter().take_while(|name| **name == "super").count();
        from.truncate(from.len() - ups.min(from.len()));
        from.extend(names.drain(ups.max(1)..).map(str::to_owned));
        Some(from)
    }

    /// The module that has what is named so, where names are passed on.
    fn module_of(&self, name: &[String]) -> Name {
        let depth = (0..=name.len()).rev().find(|depth| self.imports.contains_key(&name[..*depth])).unwrap_or(0);
        let (module, rest) = name.split_at(depth);
        match rest.first().and_then(|name| self.passed_on.get(module)?.get(name)) {
            Some(from) => self.module_of(&[from.as_slice(), &rest[1..]].concat()),
            None => module.to_vec(),
        }
    }

    /// The modules that a module imports.
    fn imported(&self, module: &Name) -> BTreeSet<Name> {
        let imports = self.imports.get(module).into_iter().flatten();
        imports.map(|name| self.module_of(name)).filter(|other| other != module).collect()
    }

    /// The modules that import themselves by others.
    fn in_circles(&self) -> Vec<String> {
        let edges: BTreeMap<&Name, BTreeSet<Name>> =
            self.imports.keys().map(|module| (module, self.imported(module))).collect();
        let is_in_circle = |module: &&Name| {
            let (mut seen, mut waiting) = (BTreeSet::new(), vec![*module]);
            while let Some(next) = waiting.pop() {
                for other in edges.get(next).into_iter().flatten() {
                    if other == *module {
                        return true;
                    }
                    if seen.insert(other) {
                        waiting.push(other);
                    }
                }
            }
            false
        };
        self.imports.keys().filter(is_in_circle).map(|module| module.join("/")).collect()
    }
}

/// The paths of a `use` with groups.
fn expanded(tree: &str) -> Vec<String> {
    let Some((before, group)) = tree.split_once('{') else { return vec![tree.trim().to_owned()] };
    let group = group.rsplit_once('}').map_or(group, |(group, _)| group);
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (i, c) in group.char_indices().chain([(group.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&group[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    let paths = parts.into_iter().filter(|part| !part.trim().is_empty()).flat_map(expanded);
    paths
        .map(|path| format!("{}{path}", before.trim()))
        .map(|path| path.trim_end_matches("::self").to_owned())
        .collect()
}

#[test]
fn no_files_import_each_other() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for folder in [
        "core/src",
        "host/src",
        "host/desk/src",
        "host/measured/src",
        "host/qif/src",
        "host/system/src",
        "host/tolerance/src",
    ] {
        let modules = Modules::of(&root.join(folder), root);
        count += modules.imports.keys().map(|module| modules.imported(module).len()).sum::<usize>();
        let circles = modules.in_circles();
        assert!(circles.is_empty(), "{folder}: {}", circles.join("\n"));
    }
    assert!(count > 1500, "only {count} imports were read");
}

#[test]
fn circles_are_found_where_names_are_passed_on() {
    let module = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Name>();
    let mut modules = Modules::default();
    for name in [&[][..], &["a"], &["a", "b"], &["c"]] {
        modules.imports.insert(module(name), Vec::new());
    }
    modules.passed_on.insert(module(&["a"]), BTreeMap::from([("B".to_owned(), module(&["a", "b", "B"]))]));
    let tree = "super::{c::{self, D}, e::F as G}";
    assert_eq!(expanded(tree), ["super::c", "super::c::D", "super::e::F as G"]);
    assert_eq!(modules.absolute(&module(&["a", "b"]), "super::super::c::D"), Some(module(&["c", "D"])));
    assert_eq!(modules.absolute(&module(&["a"]), "b::B"), Some(module(&["a", "b", "B"])));
    assert_eq!(modules.absolute(&module(&["a"]), "std::mem"), None);
    modules.imports.insert(module(&["c"]), vec![module(&["a", "B"])]);
    assert!(modules.in_circles().is_empty());
    modules.imports.insert(module(&["a", "b"]), vec![module(&["c", "D"])]);
    assert_eq!(modules.in_circles(), ["a/b", "c"]);
}
