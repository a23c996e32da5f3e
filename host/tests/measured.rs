//! Measured parts and models from other programs, as commands take them.

mod common;

use std::path::{Path, PathBuf};

use common::{json, slipfit, stdout};
use slipfit_measured::csv;
use slipfit_qif::results;

/// A file of the QIF crate's tests.
fn qif(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("qif/tests/data").join(name)
}

/// The same data give the same bytes, whichever file they come in.
#[test]
fn capability_of_qif_results_is_that_of_the_same_csv() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["SheetMetal_QIF_Results_6_samples.QIF", "WIDGET_QIF_RESULTS.QIF"] {
        let file = qif(name);
        let table = results::read(&std::fs::read_to_string(&file).unwrap()).unwrap();
        std::fs::write(folder.path().join("parts.csv"), csv::write(&table)).unwrap();
        let by = |file: &str| {
            let output = slipfit(folder.path(), &["capability", file, "--family", "normal", "--json"]);
            (output.status.code(), output.stdout, String::from_utf8(output.stderr).unwrap())
        };
        let [(code, bytes, errors), (code_of_csv, bytes_of_csv, errors_of_csv)] =
            [by(file.to_str().unwrap()), by("parts.csv")];
        assert_eq!((code, &bytes), (code_of_csv, &bytes_of_csv), "{name}: {errors} {errors_of_csv}");
        // One part of each characteristic has no variation to tell.
        assert_eq!(code, Some(if name.starts_with("Sheet") { 0 } else { 2 }), "{name}: {errors}");
    }
}

/// Mean and standard deviation by hand: 1, 2, 4 and 5 have 3 and √(10/3).
#[test]
fn figures_are_those_of_the_values() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("p.csv"), "part,a [mm]\nupper,9\n1,1\n2,2\n3,4\n4,5\n5,-\n").unwrap();
    let found = json(folder.path(), &["capability", "p.csv", "--family", "normal", "--json"]);
    let a = &found["characteristics"][0];
    let deviation = libm::sqrt(10.0 / 3.0);
    assert_eq!(
        (a["count"].as_u64(), a["missing"].as_u64(), a["mean"]["value"].as_f64()),
        (Some(4), Some(1), Some(3.0))
    );
    assert!((a["deviation"]["value"].as_f64().unwrap() - deviation).abs() < 1e-12);
    assert!((a["performance"]["least"]["value"].as_f64().unwrap() - 6.0 / (3.0 * deviation)).abs() < 1e-12);
    assert!(a["performance"]["spread"].is_null());
}

/// The page has every picture, names outliers and is the same from run to run.
#[test]
fn a_page_shows_every_characteristic() {
    let folder = tempfile::tempdir().unwrap();
    let row = |k: u32| {
        let width = if k == 17 { 11.0 } else { 10.0 + 0.01 * f64::from(k * k % 37) };
        format!("s{k},{},{width}\n", ["A", "B"][k as usize % 2])
    };
    let parts = (0..60).fold("part,tool,width [mm]\nlower,,9.9\nupper,,10.5\n".to_owned(), |text, k| text + &row(k));
    std::fs::write(folder.path().join("parts.csv"), parts).unwrap();
    let arguments = ["capability", "parts.csv", "--group", "tool", "--page", "parts.html"];
    stdout(&slipfit(folder.path(), &arguments));
    let page = std::fs::read_to_string(folder.path().join("parts.html")).unwrap();
    assert_eq!(page.matches("<svg").count(), 4);
    for expected in
        ["Capability of parts.csv", "probability plot", "Outlier: part s17", "Assumed: a ", "Cpk within tool"]
    {
        assert!(page.contains(expected), "{expected}");
    }
    stdout(&slipfit(folder.path(), &arguments));
    assert_eq!(std::fs::read_to_string(folder.path().join("parts.html")).unwrap(), page);
}

/// Errors name file, line and column, and what to do.
#[test]
fn bad_files_are_told_where_they_are_wrong() {
    let folder = tempfile::tempdir().unwrap();
    for (text, expected) in [
        ("part,a [mm],tool\n1,2,A\n", "p.csv:2:5: \"A\" in column \"tool\" is not a number"),
        ("part,a [mm]\n1,2,3\n", "p.csv:2:"),
        ("part,a [kg]\n1,2\n", "p.csv:1:"),
        ("part,a\n1,2\n", "\"a\" has 1 measured parts"),
        ("", "p.csv:1:1: the file is empty"),
    ] {
        std::fs::write(folder.path().join("p.csv"), text).unwrap();
        let output = slipfit(folder.path(), &["capability", "p.csv", "--family", "normal"]);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && errors.contains(expected), "{text}: {errors}");
    }
    std::fs::write(folder.path().join("six.csv"), "part,a\n1,1\n2,2\n3,4\n4,5\n5,7\n6,3\n").unwrap();
    for (arguments, expected) in [
        (vec!["capability", "six.csv"], "takes 30 measured parts, but there are 6; state its family"),
        (
            vec!["capability", "six.csv", "--family", "johnson-su"],
            "johnson-su needs 30 measured parts, but there are 6",
        ),
        (vec!["capability", "six.csv", "--family", "gamma"], "allowed are normal, lognormal"),
        (vec!["capability", "absent.csv"], "absent.csv: No such file"),
        (vec!["capability", "p.qif", "--group", "a"], "--group names a column of a CSV file"),
        (vec!["import", "p.csv"], "p.csv:1:1"),
    ] {
        let output = slipfit(folder.path(), &arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && errors.contains(expected), "{arguments:?}: {errors}");
    }
}

/// Subgroups of one part each are warned of; the error for a file that is not UTF-8 has its line.
#[test]
fn what_tells_nothing_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let rows = (0..8).map(|k| format!("{k},tool {k},{}\n", 10 + k % 3)).collect::<String>();
    std::fs::write(folder.path().join("p.csv"), format!("part,tool,a [mm]\n{rows}")).unwrap();
    let output = slipfit(folder.path(), &["capability", "p.csv", "--group", "tool", "--family", "normal"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("no two subgroups by tool"), "{}", stdout(&output));
    std::fs::write(folder.path().join("p.qif"), b"<Q>\n\xe4</Q>").unwrap();
    let output = slipfit(folder.path(), &["capability", "p.qif"]);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && errors.contains("p.qif: line 2 has the byte 0xe4"), "{errors}");
}

/// Cp and Cpk are of the normal distribution; it is said where the parts have another one.
#[test]
fn a_capability_that_is_not_the_parts_own_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let row = |k: i32| format!("{k},{},{}\n", k % 2, libm::exp(0.02 * f64::from(k * 13 % 60) - 0.6));
    let rows: String = (0..60).map(row).collect();
    std::fs::write(folder.path().join("p.csv"), format!("part,tool,a [mm]\nlower,,0.1\nupper,,5\n{rows}")).unwrap();
    for (family, warned) in [("lognormal", true), ("normal", false)] {
        let output = slipfit(folder.path(), &["capability", "p.csv", "--group", "tool", "--family", family]);
        assert!(stdout(&output).contains("Cpk"), "{family}");
        let warnings = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(warnings.contains("Cp and Cpk are those of a normal distribution"), warned, "{family}: {warnings}");
    }
}

/// A page takes the place of nothing else.
#[test]
fn a_page_is_a_file_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let text = "part,a [mm]\nupper,9\n1,1\n2,2\n3,4\n4,5\n";
    std::fs::write(folder.path().join("p.html"), text).unwrap();
    for (file, page, wanted) in [("p.html", "p.html", "--page"), ("p.html", "q.csv", "--page writes .html or .htm")] {
        let output = slipfit(folder.path(), &["capability", file, "--family", "normal", "--page", page]);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && errors.contains(wanted), "{errors}");
    }
    assert_eq!(std::fs::read_to_string(folder.path().join("p.html")).unwrap(), text);
}
