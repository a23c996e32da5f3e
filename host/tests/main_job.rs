//! The main job of a slide, `slipfit run`: its files, its first screen, its advice.

mod common;

use common::{files, json, slipfit, stdout};

#[test]
fn the_main_job_writes_its_files_and_the_same_for_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    for (out, threads) in [("one", "1"), ("two", "2"), ("eight", "8")] {
        stdout(&slipfit(folder.path(), &["run", "--out", out, "--threads", threads, "--n", "0:4:1"]));
    }
    // From the drawing: what the dynamics give, and what the tolerance analysis of 18 measures gives.
    let mut expected: Vec<String> = (1..=18).map(|i| format!("histogram-{i}.svg")).collect();
    let of_slide = [
        "opening-force.svg",
        "opening-velocity.svg",
        "population-drivers.svg",
        "population-forces.svg",
        "population-sides.svg",
        "population.svg",
        "report.html",
        "stroke-force.svg",
        "stroke-velocity.svg",
        "sweep.csv",
        "table.bin",
        "verdict.svg",
    ];
    expected.extend((2..=6).map(|i| format!("contributors-{i}.svg")));
    expected.extend(
        of_slide.iter().chain(&["contributors.svg", "correlation.svg", "tolerance.csv"]).map(|name| (*name).to_owned()),
    );
    expected.sort();
    assert_eq!(files(&folder.path().join("one")), expected);
    // Of Table 2 as given, there is no product to analyse.
    stdout(&slipfit(folder.path(), &["run", "cd-rom-slide", "--out", "given", "--n", "0:4:1"]));
    assert_eq!(files(&folder.path().join("given")), of_slide);
    for name in files(&folder.path().join("one")) {
        let [one, two, eight] = ["one", "two", "eight"].map(|out| std::fs::read(folder.path().join(out).join(&name)));
        let one = one.unwrap();
        assert!(one == two.unwrap() && one == eight.unwrap(), "{name}");
    }
    let page = std::fs::read_to_string(folder.path().join("one/report.html")).unwrap();
    assert!(page.contains("<h2>Tolerance analysis</h2>") && page.contains("left front across"));
    let given = std::fs::read_to_string(folder.path().join("given/report.html")).unwrap();
    assert!(!given.contains("Tolerance analysis"));
    for external in ["http://", "https://", "src=\"", "<link"] {
        let without_namespaces = page.replace("http://www.w3.org/", "");
        assert!(!without_namespaces.contains(external), "{external}");
    }
}

#[test]
fn a_stroke_s_table_has_fewer_instants_and_gives_verdicts() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["run", "--json", "--n", "0:5:0.25", "--set", "run.duration=1500"];
    let report = json(folder.path(), &arguments);
    assert!(report["table_bytes"].as_u64().unwrap() < 256 * 1024);
    let verdicts: Vec<_> = report["levels"].as_array().unwrap().iter().map(|level| &level["verdict"]).collect();
    assert!(verdicts.contains(&&"jammed".into()) && verdicts.contains(&&"runs".into()), "{verdicts:?}");
    assert_eq!(report["levels"][0]["classes"]["left front left"], "compressed");
    let csv = std::fs::read_to_string(folder.path().join("slipfit-out/cd-rom-slide-drawing/sweep.csv")).unwrap();
    assert!(csv.starts_with("n,breakaway_s,") && csv.lines().next().unwrap().ends_with(",right front wall"));
}

#[test]
fn the_main_job_answers_in_its_first_lines_and_leaves_no_level_undecided() {
    let folder = tempfile::tempdir().unwrap();
    for scene in ["cd-rom-slide-drawing", "cd-rom-slide", "cd-rom-slide-fast"] {
        let output = slipfit(folder.path(), &["run", scene, "--n", "-3:5:0.5", "--out", scene]);
        let text = stdout(&output);
        assert!(text.lines().count() <= 15, "{text}");
        for part in ["n = ", "runs", "Closes first    left front across", "What to change", "Look at", "report.html"] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        assert!(!text.contains("undecided"), "{text}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("warning: self-locking"), "{text}");
        let page = std::fs::read_to_string(folder.path().join(scene).join("report.html")).unwrap();
        assert!(page.contains("class=\"answer\"") && page.contains("<details>"));
        // The forces with marks for runs, crawls and jams stand before all other pictures.
        assert!(page.split("<figure>").nth(1).unwrap().contains(": verdict and force, "));
        for word in ["the paper", "Fig. 8", "Fig. 9"] {
            assert!(!page.contains(word), "{word} in the report of {scene}");
        }
    }
    // What an earlier run of another scene has left is told of.
    let again = slipfit(folder.path(), &["run", "cd-rom-slide", "--n", "0:4:1", "--out", "cd-rom-slide-drawing"]);
    let warnings = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(warnings.contains("also holds what this run did not write: contributors-2.svg"), "{warnings}");
    assert!(warnings.contains(" more\n") && warnings.lines().all(|line| line.len() < 400), "{warnings}");
}

#[test]
fn the_advice_follows_what_drives_failure() {
    let folder = tempfile::tempdir().unwrap();
    let text = stdout(&slipfit(folder.path(), &["run", "--n", "-3:5:0.5", "--set", "friction.coefficient=0.25"]));
    let line = |start: &str| text.lines().find(|line| line.starts_with(start)).unwrap().to_owned();
    let strongest = line("Failure due to")[16..].split(" 1").next().unwrap().to_owned();
    assert!(line("What to change").contains(&format!("start with {strongest}; tight levels")), "{text}");
}
