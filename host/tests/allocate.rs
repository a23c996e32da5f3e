//! `slipfit allocate` as a user meets it.

mod common;

use std::path::Path;

use common::{json, slipfit, stdout};

use serde_json::Value;

fn refused(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = slipfit(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?} {errors}");
    assert!(output.stdout.is_empty());
    errors
}

fn numbers(list: &Value, key: &str) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|entry| entry[key].as_f64().unwrap()).collect()
}

#[test]
fn the_shipped_scenes_have_the_known_optima() {
    let folder = tempfile::tempdir().unwrap();
    let clutch = json(folder.path(), &["allocate", "clutch-processes", "--json"]);
    assert!((clutch["cost"].as_f64().unwrap() - 24.46243).abs() < 1e-4, "{clutch}");
    let found = numbers(&clutch["tolerances"], "tolerance");
    for (t, expected) in found.iter().zip([0.173842, 0.166160, 0.128409, 0.2]) {
        assert!((t - expected).abs() < 1e-6, "{found:?}");
    }
    let processes: Vec<_> = clutch["tolerances"].as_array().unwrap().iter().map(|t| &t["process"]).collect();
    assert_eq!(processes, ["turning", "turning", "drawing", "turning"]);
    // RSS promises 2,700 ppm; 5,100 fail.
    let check = &clutch["check"][0];
    let ppm = |key: &str| check[key].as_f64().unwrap();
    assert!((ppm("rss_ppm") - 2699.8).abs() < 0.1, "{check}");
    assert!((ppm("ppm") - 5053.0).abs() < 5.0 && (ppm("counted_ppm") - ppm("ppm")).abs() < 300.0, "{check}");

    let shaft = json(folder.path(), &["allocate", "shaft-housing", "--json"]);
    assert!((shaft["cost"].as_f64().unwrap() - 8.05361).abs() < 1e-4, "{shaft}");
    let found = numbers(&shaft["tolerances"], "tolerance");
    for (t, expected) in found.iter().zip([0.00811423, 0.00638180, 0.00793439, 0.00638180]) {
        assert!((t / 25.4 - expected).abs() < 1e-8, "{found:?}");
    }
}

#[test]
fn a_promise_of_ppm_is_kept_and_written_into_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["allocate", "clutch-processes", "--require", "ppm=2700", "--write", "new.toml", "--json"];
    let found = json(folder.path(), &arguments);
    assert!((found["check"][0]["ppm"].as_f64().unwrap() - 2700.0).abs() < 2.0, "{found}");
    let written = std::fs::read_to_string(folder.path().join("new.toml")).unwrap();
    assert!(written.contains("# ±; what it is before anything is chosen") && !written.contains("tolerance = 0.1 "));
    // What is written is what was found: the same cost, and the same units fail.
    let again = json(folder.path(), &["allocate", "new.toml", "--require", "ppm=2700", "--json"]);
    let [before, cost] = [&again["cost_before"], &found["cost"]].map(|cost| cost.as_f64().unwrap());
    assert!((before / cost - 1.0).abs() < 1e-5, "{before} {cost}");
    let tolerance = json(folder.path(), &["tolerance", "new.toml", "--samples", "100000", "--json"]);
    let measure = &tolerance["measures"][0];
    let dpm = [0, 1].map(|side| measure["dpm"][side]["dpm"].as_f64().unwrap());
    assert!((dpm[0] + dpm[1] - 2700.0).abs() < 5.0, "{measure}");
}

#[test]
fn the_curve_falls_and_no_byte_depends_on_threads() {
    let folder = tempfile::tempdir().unwrap();
    for threads in ["1", "3"] {
        let [csv, svg] = ["csv", "svg"].map(|kind| format!("{threads}.{kind}"));
        let arguments =
            ["allocate", "clutch-processes", "--samples", "20000", "--threads", threads, "--csv", &csv, "--plot", &svg];
        std::fs::write(folder.path().join(format!("{threads}.txt")), stdout(&slipfit(folder.path(), &arguments)))
            .unwrap();
    }
    for kind in ["csv", "svg", "txt"] {
        let [one, three] = ["1", "3"].map(|threads| std::fs::read(folder.path().join(format!("{threads}.{kind}"))));
        assert_eq!(one.unwrap(), three.unwrap(), "{kind}");
    }
    let csv = std::fs::read_to_string(folder.path().join("1.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("ppm,cost,\"hub, mm\",\"roller 1, mm\",\"roller 2, mm\",\"cage, mm\""));
    let costs: Vec<f64> = lines.map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect();
    assert!(costs.len() == 9 && costs.is_sorted_by(|a, b| a < b), "{costs:?}");
}

#[test]
fn what_cannot_be_met_is_told_with_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let narrow = "measure.pressure angle.upper=0.1272 rad";
    let arguments =
        ["allocate", "clutch-processes", "--set", narrow, "--set", "measure.pressure angle.lower=0.1172 rad"];
    // Half the distance of the limits is 0.2865°; the tightest tolerances have an RSS of 0.655°.
    let said = refused(folder.path(), &arguments, 1);
    assert!(
        said.contains("pressure angle: rss: ") && said.contains("allowed is 0.286479 °") && said.contains("missing"),
        "{said}"
    );
    let worst = refused(folder.path(), &[&arguments[..], &["--require", "ppm=10"]].concat(), 1);
    assert!(worst.contains("allowed is 10 ppm"), "{worst}");
}

#[test]
fn bad_input_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let text = include_str!("../scenes/clutch-processes.toml");
    std::fs::write(folder.path().join("clutch.toml"), text).unwrap();
    for (arguments, said) in [
        (&["allocate"][..], "SCENE"),
        (&["allocate", "clutch.toml", "--write", "clutch.toml"], "the scene"),
        (&["allocate", "clutch.toml", "--write", "a", "--csv", "./a"], "one file"),
        (&["allocate", "clutch.toml", "--write", "a", "--set", "title=x"], "cannot be used with"),
        (&["allocate", "clutch.toml", "--require", "ppm=0"], "more than 0"),
        (&["allocate", "clutch.toml", "--require", "cheap"], "allowed are rss"),
        (&["allocate", "clutch.toml", "--set", "dimension.hub.tolerance=0.2"], "tolerance of hub"),
        (&["allocate", "clutch"], "nothing is required"),
        (&["allocate", "clutch", "--require", "rss"], "has a cost"),
        (&["allocate", "slider-crank", "--require", "rss"], "no product"),
    ] {
        let errors = refused(folder.path(), arguments, 2);
        assert!(errors.contains(said), "{arguments:?}: {errors}");
    }
    for (from, to, said) in [
        ("range = [0.015, 0.08]", "range = [0.08, 0.015]", "clutch.toml:12:64"),
        ("fixed = 10, reciprocal = 0.015, ", "", "cost.reciprocal` is missing"),
        ("reciprocal = 0.015, ", "reciprocal = 0.015, exponential = 1, ", "two laws is not supported"),
        ("fixed = 10", "fixd = 10", "did you mean `dimension.cost.fixed`"),
        ("require = \"rss\"", "require = \"RSS\"", "`measure.require` is \"RSS\""),
        ("lower = \"0.087 rad\"           # 0.122 ± 0.035\nupper = \"0.157 rad\"\n", "", "`measure.lower` is missing"),
        (
            "tolerance = 0.1               #",
            "distribution = { kind = \"trapezoidal\", shoulders = [-0.01, 0.01] }\ntolerance = 0.1 #",
            "lengths of its own",
        ),
        ("fixed = 5, reciprocal = 0.5,", "fixed = 5, reciprocal = 0.5, grades = [6, 30],", "dimension.cost.range"),
    ] {
        assert!(text.contains(from), "{from}");
        std::fs::write(folder.path().join("clutch.toml"), text.replacen(from, to, 1)).unwrap();
        let errors = refused(folder.path(), &["allocate", "clutch.toml", "--write", "a"], 2);
        assert!(errors.contains(said), "{to}: {errors}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// The scene of processes with two tolerances to choose, both of the slots' heights: the same costs left and right.
fn two_to_choose() -> String {
    let scene = include_str!("../scenes/slide-processes.toml");
    let mut text = String::new();
    let mut dimension = "";
    let mut inside = false;
    for line in scene.lines() {
        if let Some(name) = line.strip_prefix("name = ") {
            dimension = name;
        }
        let starts = line.starts_with("cost = ");
        inside |= starts && !dimension.contains("slot height");
        if !inside {
            let line = if line == "tolerance = 0.05" && !dimension.contains("slot height") {
                "tolerance = 0.02"
            } else {
                line
            };
            text += &format!("{line}\n");
        }
        inside &= !(line == "]" || (starts && line.ends_with('}')));
    }
    text
}

/// What is required holds in units that neither search nor confirmation has seen, and no tolerances that are the same left and right are
/// much cheaper.
#[test]
fn few_enough_units_malfunction_with_tolerances_that_are_found() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("two.toml"), two_to_choose()).unwrap();
    let arguments = ["allocate", "two.toml", "--write", "new.toml", "--samples", "100", "--units", "400", "--json"];
    let found = json(folder.path(), &arguments);
    let row = &found["requirements"][0];
    let share = row["found"].as_f64().unwrap();
    assert!(row["requirement"] == "malfunction" && row["unit"] == "%" && row["allowed"] == 5.0, "{row}");
    assert!(share < 5.0 + 1e-9 && share > 2.0, "{row}");
    let confirmation = &found["malfunctions"];
    assert_eq!(confirmation["units"], 3200);
    assert!(confirmation["at_most"].as_f64().unwrap() <= 0.05, "{confirmation}");
    let tolerances = numbers(&found["tolerances"], "tolerance");
    assert_eq!(tolerances.len(), 2);
    // The units that the search has seen are those of the population.
    let counted = |scene: &str, units: &str, options: &[&str]| {
        let population =
            json(folder.path(), &[&["population", scene, "--units", units, "--json"][..], options].concat());
        population["statistics"]["malfunctions"]["share"].as_f64().unwrap()
    };
    let again = counted("new.toml", "400", &[]);
    assert!((100.0 * again - share).abs() < 0.26, "{again} {share}");
    // Others: 0.35 percentage points are two standard errors of 16,000.
    let other = counted("new.toml", "16000", &["--seed", "77"]);
    assert!(other < 0.0535, "{other}");
    let cost = |t: f64| if t <= 0.04 { 0.3 + 0.004 / t } else { 0.016 / t };
    let spent: f64 = tolerances.iter().map(|t| cost(*t)).sum();
    assert!((spent - found["cost"].as_f64().unwrap()).abs() < 1e-6 * spent, "{spent} {}", found["cost"]);
    for t in [0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.07, 0.1, 0.15].into_iter().filter(|t| 2.0 * cost(*t) < 0.9 * spent)
    {
        let set = ["left", "right"].map(|side| format!("dimension.{side} slot height.tolerance={t}"));
        let counted = counted("two.toml", "4000", &["--set", &set[0], "--set", &set[1]]);
        assert!(
            counted > 0.045,
            "±{t} costs {} and {counted} malfunction; found {tolerances:?} for {spent}",
            2.0 * cost(t)
        );
    }
}

/// Front pins matter little here. A slope from a few hundred units says otherwise, and would keep them ground: their widest tolerances beside
/// these of the others meet the requirement, too, and are found or bettered.
#[test]
fn a_tolerance_that_matters_little_is_wide() {
    let folder = tempfile::tempdir().unwrap();
    let tolerances = [
        ("left slot height", 0.0187077, 0.5138),
        ("right slot height", 0.0196593, 0.5035),
        ("left back pin height", 0.015962, 0.1826),
        ("right back pin height", 0.0175331, 0.177),
        ("left front pin height", 0.1, 0.06),
        ("right front pin height", 0.1, 0.06),
        ("left slot width", 0.0971117, 0.0412),
    ];
    let set = tolerances.map(|(name, t, _)| format!("dimension.{name}.tolerance={t}"));
    let set = set.iter().flat_map(|set| ["--set", set]);
    let units = ["population", "slide-processes", "--units", "200", "--json"];
    let population = json(folder.path(), &units.into_iter().chain(set).collect::<Vec<_>>());
    assert!(population["statistics"]["malfunctions"]["share"].as_f64().unwrap() <= 0.05);
    let known: f64 = tolerances.iter().map(|(.., cost)| cost).sum();
    let found = json(folder.path(), &["allocate", "slide-processes", "--units", "200", "--json"]);
    let [cost, bound] = ["cost", "bound"].map(|name| found[name].as_f64().unwrap());
    assert!(cost < known && bound < cost, "{cost} {bound}, known is {known}");
}

/// Units that are never judged are no units that do their job: without a stroke, in a run that ends before the ramp does.
#[test]
fn a_requirement_on_units_without_a_verdict_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = two_to_choose();
    let without: String =
        scene.lines().filter(|line| !line.starts_with("stroke")).map(|line| format!("{line}\n")).collect();
    assert!(without.len() < scene.len());
    std::fs::write(folder.path().join("short.toml"), without).unwrap();
    let short = ["allocate", "short.toml", "--units", "100", "--set", "run.duration=60", "--json"];
    let errors = refused(folder.path(), &short, 2);
    assert!(
        errors.contains("100 of 100 units come to no verdict") && errors.contains("the run ends at 60 ms"),
        "{errors}"
    );
}

#[test]
fn malfunction_that_no_tolerance_mends_is_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("two.toml"), two_to_choose()).unwrap();
    // Self-locking: half of the units tip to the wrong side, however tight they are.
    let set = ["--set", "friction.coefficient=0.32", "--units", "100"];
    let errors = refused(folder.path(), &[&["allocate", "two.toml", "--write", "new.toml"][..], &set].concat(), 2);
    assert!(errors.contains("--set"), "{errors}");
    let errors = refused(folder.path(), &[&["allocate", "two.toml"][..], &set].concat(), 1);
    assert!(errors.contains("malfunction") && errors.contains('%'), "{errors}");
    for (arguments, code, words) in [
        (&["allocate", "clutch-processes", "--require", "malfunction=0.05"][..], 2, "no [slide]"),
        (&["allocate", "two.toml", "--require", "malfunction=0.7"], 2, "at most 0.5"),
        (&["allocate", "two.toml", "--force-limit", "3"], 2, "--require"),
    ] {
        let errors = refused(folder.path(), arguments, code);
        assert!(errors.contains(words), "{errors}");
    }
    let wrong = two_to_choose().replace("malfunction = 0.05 ", "force_limit = 3\n");
    std::fs::write(folder.path().join("wrong.toml"), wrong).unwrap();
    let errors = refused(folder.path(), &["allocate", "wrong.toml"], 2);
    assert!(errors.contains("wrong.toml:") && errors.contains("malfunction"), "{errors}");
    assert!(!folder.path().join("new.toml").exists());
}

/// Chosen tolerances are listed by feature as on a drawing, with nominal sizes, conditions of material and datums.
#[test]
fn tolerances_are_listed_by_feature() {
    let folder = tempfile::tempdir().unwrap();
    let scene = r#"
[[dimension]]
name = "shim"
value = "0.04 in"
tolerance = "0.002 in"
cost = { reciprocal = 0.01, at = "0.001 in", range = ["0.0005 in", "0.004 in"] }

[[part]]
name = "plate"
plane = [
  { name = "base", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 60] },
  { name = "top", at = [0, 0, 20], normal = "+z", along = "+x", extents = [100, 60], profile = { zone = 0.2, datum = "plate.base", cost = { reciprocal = 0.02, range = [0.05, 0.4] } } },
]
axis = [
  { name = "bore", at = [-30, 0, 10], along = "+z", length = 20, kind = "hole", diameter = { value = 8, tolerance = [0, 0.1], cost = { reciprocal = 0.02, range = [0.01, 0.1] } }, position = { zone = 0.2, datum = ["plate.base"], material = "maximum", cost = { reciprocal = 0.02, range = [0.05, 0.4] } } },
  { name = "slot", at = [30, 0, 10], along = "+z", length = 20, position = { zone = 0.3, datum = ["plate.base", "plate.bore (M)"], cost = { reciprocal = 0.02, range = [0.05, 0.4] } } },
]

[[measure]]
name = "holes"
distance = ["plate.bore", "plate.slot"]
require = "rss"
lower = 59.8
upper = 60.2

[[measure]]
name = "height"
is = "shim"
require = "rss"
lower = 0.95
upper = 1.08
"#;
    std::fs::write(folder.path().join("plate.toml"), scene).unwrap();
    let printed = stdout(&slipfit(folder.path(), &["allocate", "plate.toml", "--samples", "10000"]));
    let list = printed.split("On the drawing, by feature\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let shape: Vec<String> = list.lines().map(without_figures).collect();
    let expected = [
        "  shim  0.04 ± # in",
        "  plate",
        "    top   profile 0.4 mm | base",
        "    bore  diameter 8 +0.15 / -0.05 mm",
        "          position # mm (M) | base",
        "    slot  position # mm | base | bore (M)",
    ];
    assert_eq!(shape, expected, "{printed}");
    let found = json(folder.path(), &["allocate", "plate.toml", "--samples", "10000", "--json"]);
    for chosen in found["tolerances"].as_array().unwrap() {
        assert!(list.contains(chosen["callout"].as_str().unwrap()), "{chosen}");
        let written = chosen["tolerance"].as_f64().unwrap();
        assert!(written > 0.0 && chosen["feature"].is_string(), "{chosen}");
    }
}

/// A line in which `#` stands for figures with three decimals or more.
fn without_figures(line: &str) -> String {
    let is_figure = |word: &str| word.split('.').nth(1).is_some_and(|decimals| decimals.len() > 2);
    line.split(' ').map(|word| if is_figure(word) { "#" } else { word }).collect::<Vec<_>>().join(" ")
}
