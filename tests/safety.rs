//! Every claim of the page for an audit has its test.

use std::{fs, path::Path};

use slipfit_tests::guide;

/// Sources below `folder`, as one text.
fn sources(folder: &Path, text: &mut String) {
    for entry in fs::read_dir(folder).expect("a folder of the repository").map(|entry| entry.expect("its entry").path())
    {
        if entry.is_dir() && !entry.ends_with("target") {
            sources(&entry, text);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            text.push_str(&fs::read_to_string(&entry).expect("a source"));
        }
    }
}

#[test]
fn every_test_that_is_named_exists() {
    let mut text = String::new();
    for folder in ["core", "host", "tests"] {
        sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut text);
    }
    let page = guide::page("safety");
    let rows: Vec<_> = page.lines().filter(|line| line.starts_with("| ") && line.ends_with("` |")).collect();
    for row in &rows {
        let name = row.trim_end_matches("` |").rsplit('`').next().expect("a name");
        assert!(text.contains(&format!("fn {name}(")), "no test for {row}");
    }
    assert!(rows.len() >= 20, "{rows:#?}");
}
