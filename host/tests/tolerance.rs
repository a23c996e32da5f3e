//! Tolerance analysis as a user meets it: bad input, and the same bytes however the work is split.

mod random_stacks;

use std::{
    path::Path,
    process::{Command, Output, Stdio},
    time::{Duration, Instant},
};

use slipfit::scene::shipped;

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_slipfit"));
    command.current_dir(folder).args(arguments);
    command
}

fn slipfit(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

#[track_caller]
fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = slipfit(folder, arguments);
    assert!(output.status.success(), "{arguments:?}\n{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&done(folder, arguments)).unwrap()
}

/// Names and contents of all files of a folder.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let files = entries.filter(|entry| entry.path().is_file());
    let mut files: Vec<_> =
        files.map(|file| (file.file_name().into_string().unwrap(), std::fs::read(file.path()).unwrap())).collect();
    files.sort();
    files
}

/// Exit code 2, all of `named` in the message, nothing on the output, no file made or changed.
#[track_caller]
fn refused(folder: &Path, arguments: &[&str], named: &[&str]) {
    let before = contents(folder);
    let output = slipfit(folder, arguments);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}\n{message}");
    for part in named {
        assert!(message.contains(part), "{arguments:?}: {part} is not in\n{message}");
    }
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(contents(folder) == before, "{arguments:?}");
}

/// Line and column (from 1 on) of `marked` in `text`, as the program shows them.
fn place(file: &str, text: &str, marked: &str) -> String {
    let at = text.find(marked).unwrap_or_else(|| panic!("{marked}"));
    let (line, column) = (text[..at].matches('\n').count() + 1, at - text[..at].rfind('\n').map_or(0, |end| end + 1));
    format!("{file}:{line}:{}", column + 1)
}

/// A shipped scene with one thing changed, where that is shown, and what is said of it.
struct Spoilt {
    scene: &'static str,
    change: [&'static str; 2],
    at: &'static str,
    said: &'static str,
}

const fn spoilt(scene: &'static str, change: [&'static str; 2], at: &'static str, said: &'static str) -> Spoilt {
    Spoilt { scene, change, at, said }
}

const SPOILT: &[Spoilt] = &[
    spoilt(
        "lid-on-pins",
        ["datum = \"box.bottom\" } },\n  { name = \"front", "datum = \"box.base\" } },\n  { name = \"front"],
        "\"box.base\"",
        "no feature `box.base`",
    ),
    spoilt(
        "lid-on-pins",
        ["[\"lid.bottom\", \"box.rim\"]", "[\"lid.bottom\", \"lever.flange\"]"],
        "[[mate]]",
        "the mates form a loop",
    ),
    spoilt(
        "lid-on-pins",
        ["[\"lid.hole 2\", \"box.pin 2\"]", "[\"lid.bottom\", \"box.bottom\"]"],
        "\"lid.bottom\", \"box.bottom\"]",
        "over-constrained",
    ),
    spoilt("lid-on-pins", [", [\"lid.hole 2\", \"box.pin 2\"]", ""], "\"lid\"\ncontacts", "1 of 6 freedoms are left"),
    spoilt(
        "lid-on-pins",
        ["flatness = 0.05 },\n  { name = \"top", "flatness = 0 },\n  { name = \"top"],
        "0 },\n  { name = \"top",
        "is 0 mm",
    ),
    spoilt(
        "three-part-stack",
        ["tolerance = 0.2", "tolerance = 0"],
        "0               # ±",
        "`dimension.tolerance` is 0 mm",
    ),
    spoilt("three-part-stack", ["tolerance = 0.2", "tolerance = -0.2"], "-0.2", "is -0.2 mm"),
    spoilt("three-part-stack", ["[-0.1, 0.3]", "[0.3, -0.1]"], "[0.3", "the lower limit is above the upper one"),
    spoilt("three-part-stack", ["value = 19.5", "value = 4000.1"], "4000.1", "for 4000.1 mm"),
    spoilt("three-part-stack", ["value = 19.5", "value = 0.4"], "0.4", "for 0.4 mm"),
    spoilt("three-part-stack", ["channel - 'block A' -", "channel - - ) -"], ") -", "found `)`"),
    spoilt("three-part-stack", ["channel - 'block A' -", "channel / ('block A' - 40 mm) *"], "/ (", "divides by zero"),
    spoilt(
        "three-part-stack",
        ["upper = 1 ", "upper = -1 "],
        "-1                     # and",
        "not above the lower limit",
    ),
    spoilt("worn-tool", ["coefficient = 0.8", "coefficient = 1.0"], "1.0", "not positive definite"),
    spoilt(
        "lid-on-pins",
        ["perpendicularity = 0.02", "line_profile = 0.02"],
        "line_profile",
        "line_profile, the profile of a line, is not supported",
    ),
];

#[test]
fn spoilt_scenes_are_refused_where_they_are_wrong() {
    let folder = tempfile::tempdir().unwrap();
    for Spoilt { scene, change: [from, to], at, said } in SPOILT {
        let text = shipped(scene).unwrap();
        assert!(text.contains(from), "{scene}: {from}");
        let text = text.replacen(from, to, 1);
        std::fs::write(folder.path().join("spoilt.toml"), &text).unwrap();
        let arguments =
            ["tolerance", "spoilt.toml", "--csv", "m.csv", "--plots", "plots", "--draws", "d.csv", "--out", "o"];
        refused(folder.path(), &arguments, &[&place("spoilt.toml", &text, at), said]);
        assert!(!folder.path().join("plots").exists(), "{said}");
    }
}

#[test]
fn options_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let cases: &[(&[&str], &str)] = &[
        (&["--shard", "5/4", "--out", "o"], "shard 5 of 4, allowed are 1 to 4"),
        (&["--shard", "0/4", "--out", "o"], "shard 0 of 4, allowed are 1 to 4"),
        (&["--shard", "1/0", "--out", "o"], "0 shards"),
        (&["--shard", "half", "--out", "o"], "nor of the form i/n"),
        (&["--shard", "1/4"], "--out"),
        (&["--resume"], "--out"),
        (&["--samples", "1"], "1"),
        (&["--samples", "9223372036854775808", "--replicates", "2"], "in 2 replicates are too many"),
        (&["--replicates", "2000"], "--replicates is 2000"),
        (&["--method", "dice"], "dice"),
        (&["--method", "factorial", "--csv", "m.csv"], "--csv"),
        (&["--method", "factorial", "--samples", "8"], "--samples: a designed experiment has no random units"),
        (&["--method", "taguchi", "--replicates", "8"], "--replicates"),
        (&["--method", "taguchi3", "--seed", "3"], "--seed"),
        (&["--replicates", "0"], "--replicates is 0, allowed are 1 to 1024"),
        (&["--n", "inf"], "--n"),
        (&["--n", "3"], "--n: the scene has no slide"),
        (&["--csv", "nowhere/m.csv"], "nowhere"),
        (&["--draws", "nowhere/d.csv"], "nowhere"),
        (&["--set", "dimension.block A.tolerance=0"], "`dimension.tolerance` is 0 mm"),
        (&["--set", "dimension.block C.tolerance=1"], "block C"),
    ];
    for (options, named) in cases {
        let arguments: Vec<_> = ["tolerance", "three-part-stack"].iter().chain(*options).copied().collect();
        refused(folder.path(), &arguments, &[named]);
    }
    refused(folder.path(), &["tolerance", "cd-rom-slide", "--draws", "d.csv"], &["--draws", "no product"]);
    refused(folder.path(), &["merge", "absent"], &["absent"]);
    refused(folder.path(), &["merge"], &["FILES"]);
}

/// A study that has enough blocks for three shards, and one in a slow scene.
const STUDY: [&str; 6] = ["tolerance", "clutch", "--samples", "50000", "--seed", "4"];

fn study(folder: &Path, out: &str, more: &[&str]) -> Vec<u8> {
    let arguments: Vec<_> = STUDY.iter().chain(&["--out", out]).chain(more).copied().collect();
    done(folder, &arguments);
    std::fs::read(folder.join(out)).unwrap()
}

#[test]
fn threads_shards_and_their_order_change_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for more in [&[][..], &["--method", "lhs", "--replicates", "2"], &["--method", "sobol", "--replicates", "4"]] {
        let with = |other: &[&'static str]| more.iter().chain(other).copied().collect::<Vec<_>>();
        let whole = study(folder, "whole", &with(&["--threads", "1", "--csv", "whole.csv"]));
        for threads in ["2", "8"] {
            assert!(study(folder, "again", &with(&["--threads", threads, "--csv", "again.csv"])) == whole, "{threads}");
        }
        for (count, order) in [(3, &[2, 3, 1][..]), (5, &[5, 3, 1, 2, 4])] {
            let mut merge =
                vec!["merge".to_owned(), "--out".into(), "merged".into(), "--csv".into(), "merged.csv".into()];
            for number in order {
                let (shard, out) = (format!("{number}/{count}"), format!("part{number}"));
                let threads = (number % 3 + 1).to_string();
                let mut arguments: Vec<&str> = STUDY.iter().chain(more).copied().collect();
                arguments.extend(["--shard", &shard, "--threads", &threads, "--out", &out]);
                done(folder, &arguments);
                merge.push(out);
            }
            done(folder, &merge.iter().map(String::as_str).collect::<Vec<_>>());
            let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
            assert!(read("merged") == whole, "{more:?} {count}");
            assert!(read("merged.csv") == read("whole.csv") && read("again.csv") == read("whole.csv"));
        }
    }
}

#[test]
fn what_does_not_belong_together_is_not_merged() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let part = |scene: &str, shard: &str, out: &str, more: &[&str]| {
        let basis = ["tolerance", scene, "--samples", "20000", "--shard", shard, "--out", out];
        done(folder, &basis.iter().chain(more).copied().collect::<Vec<_>>());
    };
    part("clutch", "1/2", "one", &[]);
    part("clutch", "2/2", "two", &[]);
    part("clutch", "2/2", "seed", &["--seed", "2"]);
    part("clutch", "2/2", "set", &["--set", "dimension.a.tolerance=0.06"]);
    part("clutch", "2/2", "lhs", &["--method", "lhs", "--replicates", "1"]);
    part("clutch", "2/3", "third", &[]);
    part("three-part-stack", "2/2", "stack", &[]);
    let whole = std::fs::read(folder.join("two")).unwrap();
    std::fs::write(folder.join("short"), &whole[..whole.len() - 100]).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 4;
    std::fs::write(folder.join("flipped"), flipped).unwrap();
    std::fs::write(folder.join("empty"), []).unwrap();
    for (other, said) in [
        ("seed", "seed is of another seed than one"),
        ("set", "set is of another scene than one"),
        ("stack", "stack is of another scene than one"),
        ("lhs", "lhs is of another method than one"),
        ("third", "third is of another number of shards than one"),
        ("one", "shard 1 is there twice: one and one"),
        ("short", "short: it is truncated or corrupted"),
        ("flipped", "flipped: it is truncated or corrupted"),
        ("empty", "empty: it is truncated or corrupted"),
    ] {
        refused(folder, &["merge", "one", other, "--out", "merged", "--csv", "m.csv"], &[said]);
    }
    refused(folder, &["merge", "two", "--out", "merged"], &["of 2 shards these are missing: 1"]);
    done(folder, &["merge", "two", "one"]);
}

#[test]
fn no_output_replaces_an_input_or_another_output() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for number in ["1", "2"] {
        let (shard, out) = (format!("{number}/2"), format!("p{number}"));
        done(folder, &["tolerance", "clutch", "--samples", "20000", "--shard", &shard, "--out", &out]);
    }
    std::fs::write(folder.join("scene.toml"), shipped("clutch").unwrap()).unwrap();
    let one = "are one file";
    let cases: &[(&[&str], &str)] = &[
        (&["merge", "p1", "p2", "--out", "p1"], "it is one of the shards"),
        (&["merge", "p1", "p2", "--csv", "./p2"], "it is one of the shards"),
        (&["merge", "p1", "p2", "--out", "m", "--csv", "m"], one),
        (&["merge", "p1", "p2", "--csv", "m", "--plots", "m"], one),
        (&["tolerance", "clutch", "--csv", "a", "--draws", "a"], one),
        (&["tolerance", "clutch", "--out", "x", "--csv", "./x"], one),
        (&["tolerance", "clutch", "--out", "x", "--draws", "./x"], one),
        (&["tolerance", "clutch", "--out", "x.csv"], "a file for `slipfit merge`"),
        (&["merge", "p1", "p2", "--out", "m.JSON"], "a file for `slipfit merge`"),
        (&["tolerance", "clutch", "--plots", "x", "--csv", "x/histogram-1.svg"], "--csv writes .csv"),
        (&["tolerance", "scene.toml", "--draws", "none/../scene.toml"], "--draws writes .csv"),
        (&["simulate", "scene.toml", "--csv", "a.csv"], "neither a slide"),
        (&["precision", "--csv", "a", "--plot", "a"], one),
    ];
    for (arguments, said) in cases {
        refused(folder, arguments, &[said]);
    }
    done(folder, &["merge", "p1", "p2", "--out", "m", "--csv", "m.csv"]);
}

#[test]
fn a_checkpoint_is_not_dropped_without_a_word() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("o.partial"), b"work of hours").unwrap();
    refused(folder, &["tolerance", "clutch", "--out", "o"], &["o.partial", "--resume", "remove it"]);
}

#[test]
fn what_nearly_always_fails_is_shown_as_that() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = ["tolerance", "three-part-stack", "--json", "--set", "dimension.block A.value=50"];
    let measure = &json(folder, &scene)["measures"][0];
    let ppm: Vec<_> = measure["dpm"].as_array().unwrap().iter().map(|side| side["dpm"].as_f64()).collect();
    assert!((ppm[0].unwrap() - 1e6).abs() < 1.0 && ppm[1].is_none_or(|ppm| ppm < 1.0), "{measure}");
    let scene = "[[dimension]]\nname = \"d\"\nvalue = 5\ntolerance = 0.1\ndistribution = \"uniform\"\n\
                 [[measure]]\nname = \"fixed\"\nis = \"3 mm + 0 * d\"\nupper = 4\n";
    std::fs::write(folder.join("fixed.toml"), scene).unwrap();
    let measure = &json(folder, &["tolerance", "fixed.toml", "--json"])["measures"][0];
    assert!(measure["skew"].is_null() && measure["kurtosis"].is_null() && measure["sd"] == 0.0, "{measure}");
    let text = done(folder, &["tolerance", "fixed.toml"]);
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
}

#[test]
fn a_killed_run_is_resumed_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Long enough to be killed in; as many units as fit into a few seconds of a slow machine.
    let arguments =
        ["tolerance", "lid-on-pins", "--samples", "400000", "--method", "sobol", "--replicates", "4", "--threads", "1"];
    let into = |out: &'static str| arguments.iter().copied().chain(["--out", out]).collect::<Vec<_>>();
    let mut victim = command(folder, &into("killed")).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    let partial = folder.join("killed.partial");
    while !partial.exists() {
        assert!(victim.try_wait().unwrap().is_none(), "ended before it saved anything");
        assert!(start.elapsed() < Duration::from_secs(120));
        std::thread::sleep(Duration::from_millis(2));
    }
    // On Unix this is signal 9.
    victim.kill().unwrap();
    victim.wait().unwrap();
    assert!(!folder.join("killed").exists());
    refused(folder, &["merge", "killed.partial"], &["unfinished"]);
    let resumed = |more: &[&'static str]| {
        into("killed").into_iter().chain(["--resume"]).chain(more.iter().copied()).collect::<Vec<_>>()
    };
    refused(folder, &resumed(&["--seed", "9"]), &["killed.partial is of another seed than this run"]);
    let resumed = done(folder, &resumed(&[]));
    assert_eq!(done(folder, &into("whole")), resumed);
    assert!(std::fs::read(folder.join("killed")).unwrap() == std::fs::read(folder.join("whole")).unwrap());
    assert!(!partial.exists());
}

#[test]
fn a_unit_is_the_same_in_every_production_of_its_seed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let draws = |samples: &str, seed: &str, threads: &str| {
        let arguments = ["tolerance", "lid-on-pins", "--samples", samples, "--seed", seed, "--threads", threads];
        done(folder, &[&arguments[..], &["--draws", "units.csv"]].concat());
        let text = std::fs::read_to_string(folder.join("units.csv")).unwrap();
        text.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let (few, many, other) = (draws("50", "1", "1"), draws("2000", "1", "2"), draws("50", "2", "1"));
    assert_eq!((few.len(), many.len()), (51, 2001));
    assert_eq!(few, many[..51]);
    assert_eq!(few[0], other[0]);
    assert!((1..51).all(|unit| few[unit] != other[unit]));
}

#[test]
fn the_drawing_is_analysed_down_to_table_2_s_derived_columns() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let report = json(folder, &["tolerance", "--json", "--samples", "1000"]);
    let tightest = &report["tightest"];
    assert_eq!((&tightest["pin"], &tightest["direction"]), (&"left front".into(), &"across".into()));
    assert!((tightest["n"].as_f64().unwrap() - 3.43).abs() < 1e-3, "{tightest}");
    assert_eq!(report["derived_m"]["pins"].as_array().unwrap().len(), 4, "{}", report["derived_m"]);
    let sum = report["sums"].as_array().unwrap().iter().find(|sum| sum["name"] == "left front across").unwrap();
    for (reading, ppm, bound) in [("eq9_ppm", 302.0, 0.5), ("independent_ppm", 0.74, 0.01)] {
        assert!((sum[reading].as_f64().unwrap() - ppm).abs() < bound, "{sum}");
    }
    assert!(sum["correlation"].as_f64().unwrap() < -0.5 && sum["model"]["dpm"].as_f64().unwrap() < 1e-5, "{sum}");
    let text = done(folder, &["tolerance", "--samples", "1000", "--n", "0"]);
    assert!(text.contains("n* = 3.4302 closes left front across first"), "{text}");
    // A product without a slide has no such columns.
    let clutch = json(folder, &["tolerance", "clutch", "--json", "--samples", "1000"]);
    assert!(clutch["derived_m"].is_null() && clutch["measures"][0]["quadrature"]["sd"].is_number());
}

#[test]
fn every_shipped_product_is_analysed_and_pictured() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, text) in slipfit::scene::SHIPPED {
        if !text.contains("[[measure]]") {
            continue;
        }
        let plots = format!("{name}-plots");
        let arguments = ["tolerance", name, "--samples", "1000", "--csv", "m.csv", "--plots", &plots, "--json"];
        let measures = json(folder, &arguments)["measures"].as_array().unwrap().len();
        assert_eq!(std::fs::read_to_string(folder.join("m.csv")).unwrap().lines().count(), measures + 1, "{name}");
        let pictures = contents(&folder.join(plots));
        let contributors = pictures.iter().filter(|(file, _)| file.contains("contributors")).count();
        // A histogram each, one of correlations where there are several, and as many of contributors as a sheet of paper
        // asks for.
        let correlations = usize::from(measures > 1);
        assert!(contributors > 0 && pictures.len() == measures + correlations + contributors, "{name}");
    }
}
