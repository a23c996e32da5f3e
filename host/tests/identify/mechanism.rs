//! Mechanisms by their simulated and by their measured motion.

use std::path::Path;

use super::common::{json, slipfit, stdout};
use super::write;
use slipfit_core::sampling::stream::unit_stream;
use slipfit_tolerance::failure::subset::normals;

/// A stage of 2 kg under a position loop, with these lines in `[identify]`.
pub fn stage(identify: &str) -> String {
    format!(
        "mechanism = {{ space = \"plane\" }}\nrun = {{ duration = 2000, error = 1e-6 }}\n\
         [[body]]\nname = \"stage\"\nmass = 2000\ninertia = 1e6\ncentre = [0, 0]\n\
         [[joint]]\nname = \"guide\"\nkind = \"prismatic\"\nbetween = [\"frame\", \"stage\"]\nat = [0, 0]\naxis = [1, 0]\n\
         [[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = \"150 N·s/m\"\nposition_gain = 20\nsampling = 0.002\n\
         coulomb = 5\nstick_band = 1\nviscous = \"3 N·s/m\"\noffset = 1\n\
         segment = [{{ kind = \"sine\", amplitude = 200, frequency = 1, duration = 1 }}, {{ kind = \"chirp\", amplitude = 200, frequency = [1, 6], duration = 1 }}]\n\
         [identify]\n{identify}"
    )
}

/// What `slipfit simulate` computes of that stage with these settings: time, position and force with white noise of 0.05 N, which is
/// recorded `late` samples later.
fn simulated(folder: &Path, set: &[&str], (seed, late): (u64, usize)) -> String {
    write(folder, "true.toml", &stage("delay = [0, 0.01]\n"));
    let mut arguments = vec!["simulate", "true.toml", "--every", "1", "--csv", "true.csv"];
    set.iter().for_each(|set| arguments.extend(["--set", set]));
    stdout(&slipfit(folder, &arguments));
    let text = std::fs::read_to_string(folder.join("true.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|head| *head == name).unwrap();
    let (force, x) = (column("motor.force (N)"), column("stage.x (m)"));
    let noise = normals(&mut unit_stream(seed, 4), rows.len());
    let row = |k: usize| {
        let recorded: f64 = rows[1 + k.saturating_sub(late)][force].parse().unwrap();
        format!("{},{},{}\n", rows[1 + k][0], rows[1 + k][x], recorded + 0.05 * noise[k])
    };
    (0..rows.len() - 1).fold("t (s),position (m),force (N)\n".to_owned(), |text, k| text + &row(k))
}

const SOUGHT: &str = "body = [{ name = \"stage\", mass = [1000, 4000] }]\n\
                      drive = [{ name = \"motor\", coulomb = [0, 20], viscous = [\"0 N·s/m\", \"20 N·s/m\"], offset = [-5, 5] }]\n";

/// Each parameter of a found estimate: value and deviation.
fn values(found: &serde_json::Value) -> Vec<[f64; 2]> {
    let parameters = found["compared"][0]["parameters"].as_array().unwrap();
    parameters.iter().map(|one| ["value", "deviation"].map(|field| one[field].as_f64().unwrap())).collect()
}

#[test]
fn a_mechanism_is_known_from_its_simulated_and_from_its_measured_motion() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "run.csv", &simulated(folder.path(), &[], (5, 0)));
    for (along, most) in [("", 0.005), ("along = \"motion\"\n", 0.05)] {
        write(folder.path(), "stage.toml", &stage(&format!("{along}{SOUGHT}")));
        let found = values(&json(folder.path(), &["identify", "stage.toml", "run.csv", "--json"]));
        for ([value, deviation], truth) in found.iter().zip([2.0, 5.0, 3.0, 1.0]) {
            // What is measured is filtered and differentiated, and a controller holds its force between samples.
            assert!((value - truth).abs() < 4.0 * deviation + most * truth, "{along} {found:?}");
        }
    }
}

#[test]
fn a_late_record_tells_its_delay_and_a_prior_what_the_record_does_not() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "late.csv", &simulated(folder.path(), &[], (6, 4)));
    write(folder.path(), "stage.toml", &stage(&format!("delay = [0, 0.01]\n{SOUGHT}")));
    let found = values(&json(folder.path(), &["identify", "stage.toml", "late.csv", "--json"]));
    assert!((found.last().unwrap()[0] - 0.004).abs() < 1e-4, "{found:?}");
    // At constant speed friction and offset are known as a sum: 6 N.
    let rows = (0..500).fold("t (s),speed (mm/s),force (N)\n".to_owned(), |text, k| {
        text + &format!("{},{},{}\n", 0.002 * f64::from(k), 50.0, 6.15 + 0.01 * f64::from(k % 7))
    });
    write(folder.path(), "steady.csv", &rows);
    let sought = |offset: &str| {
        stage(&format!("along = \"motion\"\ndrive = [{{ name = \"motor\", coulomb = [0, 20], offset = {offset} }}]\n"))
    };
    write(folder.path(), "sum.toml", &sought("[-5, 5]"));
    let text = stdout(&slipfit(folder.path(), &["identify", "sum.toml", "steady.csv"]));
    assert!(text.contains("motor.coulomb and motor.offset only as a sum"), "{text}");
    write(folder.path(), "known.toml", &sought("{ between = [-5, 5], mean = 1, deviation = 0.1 }"));
    let found = values(&json(folder.path(), &["identify", "known.toml", "steady.csv", "--json"]));
    assert!((found[0][0] - 5.03).abs() < 0.05 && (found[0][1] - 0.1).abs() < 0.01, "{found:?}");
    assert!((found[1][0] - 1.0).abs() < 0.02 && (found[1][1] - 0.1).abs() < 0.01, "{found:?}");
    // What is known of all units counts once, not once for each.
    let each = slipfit(folder.path(), &["identify", "known.toml", "steady.csv", "steady.csv", "--each"]);
    assert!(String::from_utf8(each.stderr).unwrap().contains("would count once for every unit"));
}

/// Four units that differ in their friction, two runs of each.
#[test]
fn units_have_a_mean_and_a_spread() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "stage.toml", &stage(SOUGHT));
    let coulomb = [4.0, 4.6, 5.4, 6.0];
    for (k, coulomb) in coulomb.iter().enumerate() {
        let unit = folder.path().join(format!("unit{k}"));
        std::fs::create_dir(&unit).unwrap();
        for run in 0..2 {
            let text = simulated(folder.path(), &[&format!("drive.motor.coulomb={coulomb}")], (10 * k as u64 + run, 0));
            write(&unit, &format!("{run}.csv"), &text);
        }
    }
    let arguments = ["identify", "stage.toml", "unit0", "unit1", "unit2", "unit3", "--each", "-o", "found.toml"];
    let found = json(folder.path(), &[&arguments[..], &["--json"]].concat());
    assert_eq!(found["units"].as_array().unwrap().len(), 4);
    let of = |name: &str| found["between"].as_array().unwrap().iter().find(|one| one["name"] == name).unwrap().clone();
    let number = |of: &serde_json::Value, field: &str| of[field].as_f64().unwrap();
    let friction = of("motor.coulomb");
    // Their mean is 5 N, their standard deviation 0.89 N.
    assert!((number(&friction, "mean") - 5.0).abs() < 0.05, "{friction}");
    assert!((number(&friction, "spread") - 0.888).abs() < 0.05, "{friction}");
    assert!((number(&friction, "deviation") - 0.444).abs() < 0.03, "{friction}");
    let mass = of("stage.mass");
    assert!(number(&mass, "spread") < 0.002 && (number(&mass, "mean") - 2.0).abs() < 0.003, "{mass}");
    let written = std::fs::read_to_string(folder.path().join("found.toml")).unwrap();
    assert!(written.contains("# motor.coulomb differs from unit to unit by a standard deviation of 0.8"), "{written}");
    write(folder.path(), "known.toml", &format!("include = \"found.toml\"\n{}", stage(SOUGHT)));
    let text = stdout(&slipfit(folder.path(), &["population", "known.toml", "--units", "20"]));
    assert!(text.contains("motor.coulomb"), "{text}");
    let text = stdout(&slipfit(folder.path(), &arguments[..7]));
    assert!(text.contains("mechanism of 4 units") && text.contains("spread between units"), "{text}");
    let alone = slipfit(folder.path(), &["identify", "stage.toml", "unit0", "--each"]);
    assert!(alone.status.code() == Some(2), "{alone:?}");
}

/// A carriage that a nut takes along by stops with play, its friction 3 N.
const WITH_PLAY: &str = r#"
mechanism = { space = "plane" }
run = { duration = 1200 }
contact = { stiffness = "1e5 N/m", exponent = 1, damping = "100 N·s/m", depth = 0.01 }
friction = { law = "none" }
body = [
  { name = "nut", mass = 200, inertia = 1e6, centre = [0, 0] },
  { name = "carriage", mass = 1000, inertia = 1e6, centre = [0, 0] },
]
joint = [
  { name = "screw", kind = "prismatic", between = ["frame", "nut"], at = [0, 0], axis = [1, 0] },
  { name = "rail", kind = "prismatic", between = ["frame", "carriage"], at = [0, 0], axis = [1, 0], coulomb = 3, stick_band = 1 },
  { name = "ahead", kind = "stop", between = ["nut", "carriage"], at = [0, 0], normal = [1, 0], clearance = [0.5, 0.1] },
  { name = "behind", kind = "stop", between = ["nut", "carriage"], at = [0, 0], normal = [-1, 0], clearance = [0.5, 0.1] },
]
[[drive]]
name = "motor"
pushes = "nut"
axis = [1, 0]
gain = "200 N·s/m"
segment = [
  { kind = "ramp", speed = 20, duration = 0.1 },
  { kind = "hold", duration = 0.5 },
  { kind = "ramp", speed = -20, duration = 0.2 },
  { kind = "hold", duration = 0.4 },
]
[identify]
force = "motor.force"
gaps = [{ of = "ahead", n = [-3, 3] }, { of = "behind", n = [-3, 3] }]
"#;

/// A record that begins when the nut already pushes shows the play at the reversal, but not how much of it was on either side.
#[test]
fn a_reversal_tells_the_play_and_not_its_split() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "play.toml", WITH_PLAY);
    let arguments = ["simulate", "play.toml", "--n", "0.5", "--every", "1", "--csv", "whole.csv"];
    stdout(&slipfit(folder.path(), &arguments));
    let whole = std::fs::read_to_string(folder.path().join("whole.csv")).unwrap();
    let (head, rows) = whole.split_once('\n').unwrap();
    let is_late = |row: &&str| row.split(',').next().unwrap().parse::<f64>().unwrap() > 0.2999;
    let late: Vec<&str> = rows.lines().filter(is_late).collect();
    write(folder.path(), "late.csv", &format!("{head}\n{}\n", late.join("\n")));
    let text = stdout(&slipfit(folder.path(), &["identify", "play.toml", "late.csv"]));
    assert!(text.contains("n of ahead and n of behind only as a sum"), "{text}");
    // From the first contact on, both are known.
    let found = values(&json(folder.path(), &["identify", "play.toml", "whole.csv", "--json"]));
    assert!(found.iter().all(|[level, _]| (level - 0.5).abs() < 1e-6), "{found:?}");
}
