//! Productions whose distributions are those of measured parts, as commands take them.

mod common;

use std::{fmt::Write, path::Path};

use common::{json, slipfit, stdout};
use serde_json::Value;
use slipfit_core::sampling::{
    normal::score,
    stream::{Rng, unit_stream},
};

/// A ring in a groove, of which the ring is measured.
const STACK: &str = "
title = \"stack\"
dimension = [{ name = \"ring\", value = 20, tolerance = 0.1 }, { name = \"groove\", value = 20.2, tolerance = 0.1 }]
measure = [{ name = \"play\", is = \"groove - ring\", lower = 0.05, upper = 0.35 }]
[measured]
file = \"parts.csv\"
column = [{ of = \"ring\", heading = \"width\" }]
";

/// Writes parts with a column for each of `columns`: its heading, and its value from two correlated standard normal scores.
fn write_parts(folder: &Path, parts: usize, seed: u64, rho: f64, columns: [(&str, &dyn Fn(f64) -> f64); 2]) {
    let mut stream = unit_stream(seed, 0);
    let mut text = format!("part,{},{}\n", columns[0].0, columns[1].0);
    for part in 0..parts {
        let [a, b] = [(); 2].map(|()| score::<f64>(stream.next_u64()));
        let other = rho * a + libm::sqrt(1.0 - rho * rho) * b;
        let _ = writeln!(text, "{part},{},{}", columns[0].1(a), columns[1].1(other));
    }
    std::fs::write(folder.join("parts.csv"), text).unwrap();
}

fn stderr(output: &std::process::Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn measure<'a>(report: &'a Value, key: &str) -> &'a Value {
    &report["measures"][0]["estimates"][key]
}

/// The measured distribution takes the place of the drawing's, whose limits stay.
#[test]
fn a_measured_dimension_has_mean_and_deviation_of_its_parts() {
    let folder = tempfile::tempdir().unwrap();
    let width = |z: f64| 20.02 + 0.01 * z;
    write_parts(folder.path(), 400, 1, 0.0, [("width [mm]", &width), ("width2 [in]", &|z| width(z) / 25.4)]);
    std::fs::write(folder.path().join("stack.toml"), STACK).unwrap();
    let run = |set: &str| json(folder.path(), &["tolerance", "stack.toml", "--json", "--set", set]);
    let plain = run("title=a");
    let worst = plain["measures"][0]["worst_case"][0].as_f64().unwrap();
    assert!(worst.abs() < 1e-9, "the limits are those of the drawing");
    let [mean, sd] = ["mean", "sd"].map(|key| measure(&plain, key)["value"].as_f64().unwrap());
    let expected = libm::hypot(0.1 / 3.0, 0.01);
    assert!((mean - 0.18).abs() < 0.003 && (sd / expected - 1.0).abs() < 0.04, "{mean} {sd}");
    // The unit of the column counts, not that of the scene.
    let other = run("measured.column=[{ of = \"ring\", heading = \"width2\" }]");
    assert!((measure(&other, "mean")["value"].as_f64().unwrap() - 0.18).abs() < 0.003);
}

/// Of a measure that is the measured dimension alone, the intervals are the textbook's: t and χ² with n − 1 degrees of freedom.
#[test]
fn intervals_are_those_of_the_number_of_parts() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "
        title = \"one\"
        dimension = [{ name = \"ring\", value = 20, tolerance = 0.1 }]
        measure = [{ name = \"width\", is = \"ring\", lower = 19.9, upper = 20.1 }]
        [measured]
        file = \"parts.csv\"
        distribution = \"normal\"
        column = [{ of = \"ring\" }]
    ";
    std::fs::write(folder.path().join("one.toml"), scene).unwrap();
    // 2.5 % quantiles of Student's t and of χ², from tables.
    for (parts, t, chi) in [(6_usize, 2.570_58, [0.831_21, 12.832_5]), (30, 2.045_23, [16.047_1, 45.722_3])] {
        write_parts(folder.path(), parts, 5, 0.0, [("ring [mm]", &|z| 20.01 + 0.03 * z), ("other", &|z| z)]);
        let text = std::fs::read_to_string(folder.path().join("parts.csv")).unwrap();
        let values: Vec<f64> =
            text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect();
        let n = parts as f64;
        let mean = values.iter().sum::<f64>() / n;
        let deviation = libm::sqrt(values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0));
        let report = json(folder.path(), &["tolerance", "one.toml", "--json", "--samples", "100000"]);
        let interval = |key: &str| [0, 1].map(|end| measure(&report, key)["interval"][end].as_f64().unwrap());
        let ends = interval("mean");
        let half = t * deviation / libm::sqrt(n);
        // Interval ends are quantiles of 120 draws.
        assert!(
            ends.iter().zip([mean - half, mean + half]).all(|(a, b)| (a - b).abs() < 0.3 * half),
            "{ends:?} {mean} {half}"
        );
        let ends = interval("sd");
        let expected = [chi[1], chi[0]].map(|chi| deviation * libm::sqrt((n - 1.0) / chi));
        assert!(ends.iter().zip(expected).all(|(a, b)| (a / b - 1.0).abs() < 0.25), "{ends:?} {expected:?}");
    }
}

/// Two gaps of the CD-ROM slide that move together: their production has the correlation of the parts.
#[test]
fn measured_gaps_are_drawn_together() {
    let folder = tempfile::tempdir().unwrap();
    let columns: [(&str, &dyn Fn(f64) -> f64); 2] =
        [("front [mm]", &|z| -0.0223 + 0.0624 * z), ("back [mm]", &|z| 0.0064 + 0.0404 * z)];
    write_parts(folder.path(), 2000, 3, 0.9, columns);
    let measured = "[measured]\nfile = \"parts.csv\"\ncolumn = [{ of = \"left front left\", heading = \"front\" }, \
                    { of = \"left back left\", heading = \"back\" }]\n";
    let scene = slipfit::scene::shipped("cd-rom-slide").unwrap();
    std::fs::write(folder.path().join("slide.toml"), format!("{scene}\n{measured}")).unwrap();
    let args = ["population", "slide.toml", "--units", "2000", "--opening", "--csv", "units.csv", "--json"];
    json(folder.path(), &args);
    let mut units = csv::Reader::from_path(folder.path().join("units.csv")).unwrap();
    let heads = units.headers().unwrap().clone();
    let at = |name: &str| heads.iter().position(|head| head.starts_with(name)).unwrap_or_else(|| panic!("{heads:?}"));
    let [front, back, other] = ["left front left", "left back left", "right back left"].map(at);
    let rows: Vec<[f64; 3]> = units
        .records()
        .map(|row| row.unwrap())
        .map(|row| [front, back, other].map(|i| row[i].parse().unwrap()))
        .collect();
    let correlation = |i: usize, j: usize| {
        let n = rows.len() as f64;
        let mean = |i: usize| rows.iter().map(|row| row[i]).sum::<f64>() / n;
        let [a, b] = [i, j].map(mean);
        let sum = |i: usize, a: f64, j: usize, b: f64| rows.iter().map(|row| (row[i] - a) * (row[j] - b)).sum::<f64>();
        sum(i, a, j, b) / libm::sqrt(sum(i, a, i, a) * sum(j, b, j, b))
    };
    assert!((correlation(0, 1) - 0.9).abs() < 0.02, "{}", correlation(0, 1));
    assert!(correlation(0, 2).abs() < 0.09, "{}", correlation(0, 2));
}

/// What few parts leave open is in the interval of the share that malfunctions: of 30 parts it is wider than of 3000.
#[test]
fn few_parts_leave_the_failing_share_open() {
    let folder = tempfile::tempdir().unwrap();
    let scene = slipfit::scene::shipped("cd-rom-slide").unwrap().replace("coefficient = 0.3", "coefficient = 0.2");
    let measured = "[measured]\nfile = \"parts.csv\"\ndistribution = \"normal\"\ncolumn = [{ of = \"left front left\", heading = \"a\" }, \
                    { of = \"left front right\", heading = \"b\" }]\n";
    std::fs::write(folder.path().join("slide.toml"), format!("{scene}\n{measured}")).unwrap();
    let gap = |z: f64| 0.1 + 0.15 * z;
    let [few, many] = [30, 3000].map(|parts| {
        write_parts(folder.path(), parts, 4, 0.9, [("a [mm]", &gap), ("b [mm]", &gap)]);
        let found = json(folder.path(), &["population", "slide.toml", "--units", "3000", "--json"]);
        let unknown = &found["uncertain"];
        assert_eq!(unknown["measured"], serde_json::json!(["left front left", "left front right"]));
        [0, 1].map(|end| unknown["malfunctions"]["interval"][end].as_f64().unwrap())
    });
    // Of the true joint distribution 11 % malfunction.
    assert!(many[0] > 0.07 && many[1] < 0.16, "{many:?}");
    assert!(few[0] < 0.11 && 0.11 < few[1] && few[1] - few[0] > 2.0 * (many[1] - many[0]), "{few:?} {many:?}");
    let output = slipfit(folder.path(), &["population", "slide.toml", "--rare"]);
    assert!(stderr(&output).contains("a scene without [uncertain] and [measured]"), "{}", stderr(&output));
}

/// Both gaps of a pin that are tight together: the share that malfunctions is that of the true joint distribution, and not that of
/// gaps which are independent.
#[test]
#[ignore = "eight populations"]
fn shares_are_those_of_the_joint_distribution() {
    const SAMPLES: u64 = 6;
    let folder = tempfile::tempdir().unwrap();
    let scene = slipfit::scene::shipped("cd-rom-slide").unwrap().replace("coefficient = 0.3", "coefficient = 0.2");
    let measured = "[measured]\nfile = \"parts.csv\"\ncolumn = [{ of = \"left front left\", heading = \"a\" }, \
                    { of = \"left front right\", heading = \"b\" }]\n";
    std::fs::write(folder.path().join("slide.toml"), format!("{scene}\n{measured}")).unwrap();
    let gap = |z: f64| 0.1 + 0.15 * z;
    let shares = |parts: usize, seed: u64, rho: f64| {
        write_parts(folder.path(), parts, seed, rho, [("a [mm]", &gap), ("b [mm]", &gap)]);
        let seed = format!("{seed}");
        let found = json(folder.path(), &["population", "slide.toml", "--units", "2500", "--seed", &seed, "--json"]);
        ["malfunctions", "crawls"].map(|kind| found["statistics"][kind]["share"].as_f64().unwrap())
    };
    let truth = shares(50_000, 100, 0.9);
    let independent = shares(50_000, 101, 0.0);
    let found: Vec<[f64; 2]> = (0..SAMPLES).map(|seed| shares(100, seed, 0.9)).collect();
    let n = SAMPLES as f64;
    for (kind, name) in ["malfunctions", "crawls"].into_iter().enumerate() {
        let mean = found.iter().map(|shares| shares[kind]).sum::<f64>() / n;
        let square = found.iter().map(|shares| (shares[kind] - mean) * (shares[kind] - mean)).sum::<f64>() / (n - 1.0);
        let error = libm::sqrt(square / n);
        println!("{name}: {mean:.4} ± {error:.4}, true {:.4}, independent {:.4}", truth[kind], independent[kind]);
        assert!((mean - truth[kind]).abs() < 4.0 * error, "{name}");
        assert!((mean - independent[kind]).abs() > 4.0 * error, "{name}");
    }
}

/// An outlier of a few parts is named, too, and so is a mean far from the middle of the tolerance.
#[test]
fn doubtful_parts_are_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("stack.toml"), STACK).unwrap();
    let rows = [20.03, 20.04, 20.05, 20.04, 20.03, 20.05, 20.04, 20.3].map(|width| width.to_string());
    let text =
        rows.iter().enumerate().fold("part,width [mm]\n".to_owned(), |text, (i, row)| text + &format!("{i},{row}\n"));
    std::fs::write(folder.path().join("parts.csv"), text).unwrap();
    let output = slipfit(folder.path(), &["tolerance", "stack.toml", "--set", "measured.distribution=normal"]);
    let told = stderr(&output);
    assert!(output.status.success() && told.contains("`ring`: part 8 lies 2.5 standard deviations"), "{told}");
    assert!(
        told.contains("`ring`: the measured mean lies 73 % of half the tolerance above its middle, and 1 of 8 parts"),
        "{told}"
    );
}

/// What is wrong is said at its line, or with the file's line.
#[test]
fn mistakes_are_named() {
    let folder = tempfile::tempdir().unwrap();
    write_parts(folder.path(), 60, 1, 0.0, [("width [mm]", &|z| 20.0 + 0.01 * z), ("angle [°]", &|z| z)]);
    std::fs::write(folder.path().join("stack.toml"), STACK).unwrap();
    std::fs::write(folder.path().join("bad.csv"), "part,width [mm]\n1,20\n2,x\n").unwrap();
    std::fs::write(folder.path().join("few.csv"), "part,width [mm]\n1,20\n2,20.01\n3,19.99\n").unwrap();
    for (set, wanted) in [
        ("measured.file=none.csv", "none.csv"),
        ("measured.file=bad.csv", "bad.csv:3:3"),
        ("measured.file=few.csv", "50 measured parts, but there are 3"),
        ("measured.only=A", "`measured.only` has no effect without a `group`"),
        ("measured.group=width", "`measured.group` has no effect without `only`"),
        ("measured.distribution=cauchy", "smoothed: the values themselves"),
        ("measured.column=[]", "`measured.column` is a list of 0"),
        (
            "measured.column=[{ of = \"rung\", heading = \"width\" }]",
            "there is no dimension or gap that could be measured `rung`",
        ),
        (
            "measured.column=[{ of = \"ring\", heading = \"size\" }]",
            "there is no column \"size\" for measured values; the columns are \"part\", \"width\", \"angle\"",
        ),
        ("measured.column=[{ of = \"ring\", heading = \"angle\" }]", "is in °"),
        ("measured.column=[{ of = \"ring\", heading = \"width\" }, { of = \"ring\", heading = \"width\" }]", "again"),
        (
            "measured.column=[{ of = \"ring\", heading = \"width\", least = 20 }]",
            "mm, which is beyond `least` or `most`",
        ),
        (
            "measured.column=[{ of = \"ring\", heading = \"width\", least = 19, distribution = \"normal\" }]",
            "no effect",
        ),
    ] {
        let output = slipfit(folder.path(), &["tolerance", "stack.toml", "--set", set]);
        assert_eq!(output.status.code(), Some(2), "{set}");
        assert!(stderr(&output).contains(wanted), "{set}: {}", stderr(&output));
    }
    let scene =
        STACK.replace("tolerance = 0.1 }, {", "tolerance = 0.1, cost = { reciprocal = 1, range = [0.01, 0.2] } }, {");
    std::fs::write(folder.path().join("costed.toml"), scene).unwrap();
    let output = slipfit(folder.path(), &["allocate", "costed.toml"]);
    assert!(stderr(&output).contains("does not change measured parts"), "{}", stderr(&output));
}

/// Measured parts are an input: no output takes their place, and shards of others are not joined.
#[test]
fn measured_parts_are_an_input() {
    let folder = tempfile::tempdir().unwrap();
    let parts = |shift: f64| {
        (0..60).fold("groove [mm]\n".to_owned(), |text, k| {
            text + &format!("{}\n", 10.0 + shift + 0.001 * f64::from(k * 7 % 60))
        })
    };
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let scene = "[[dimension]]\nname = \"groove\"\nvalue = 10\ntolerance = 0.1\n[[measure]]\nname = \"twice\"\nis = \"2 * groove\"\n\
                 [measured]\nfile = \"parts.csv\"\n[[measured.column]]\nof = \"groove\"\n";
    write("parts.csv", &parts(0.0));
    write("s.toml", scene);
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    write("sub/s.toml", &scene.replace("parts.csv", "../parts.csv"));
    for (scene, output) in [
        ("s.toml", ["--csv", "parts.csv"]),
        ("s.toml", ["--draws", "./parts.csv"]),
        ("s.toml", ["--out", "parts.csv.x/../parts.csv"]),
        ("sub/s.toml", ["--csv", "parts.csv"]),
    ] {
        let output = slipfit(folder.path(), &[&["tolerance", scene, "--samples", "1000"][..], &output].concat());
        assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(std::fs::read_to_string(folder.path().join("parts.csv")).unwrap(), parts(0.0));
    }
    let set = ["tolerance", "s.toml", "--samples", "1000", "--set", "measured.file=other.csv", "--csv", "other.csv"];
    write("other.csv", &parts(0.01));
    assert_eq!(slipfit(folder.path(), &set).status.code(), Some(2));
    let draw = |shard: &str, out: &str| {
        stdout(&slipfit(folder.path(), &["tolerance", "s.toml", "--samples", "20000", "--shard", shard, "--out", out]))
    };
    draw("1/2", "a.part");
    draw("2/2", "b.part");
    stdout(&slipfit(folder.path(), &["merge", "a.part", "b.part"]));
    write("parts.csv", &parts(0.02));
    let output = slipfit(folder.path(), &["merge", "a.part", "b.part"]);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && errors.contains("measured parts are others"), "{errors}");
    draw("2/2", "c.part");
    let output = slipfit(folder.path(), &["merge", "a.part", "c.part"]);
    assert_ne!(output.status.code(), Some(0));
}

/// The interval of a yield ends at 100 %.
#[test]
fn no_yield_is_above_all_units() {
    let folder = tempfile::tempdir().unwrap();
    let parts = (0..60).fold("groove [mm]\n".to_owned(), |text, k| {
        text + &format!("{}\n", 10.0 + 0.001 * (f64::from(k * 7 % 60) - 29.5))
    });
    std::fs::write(folder.path().join("parts.csv"), parts).unwrap();
    for half in [0.05, 0.052, 0.055] {
        let scene = format!(
            "[[dimension]]\nname = \"groove\"\nvalue = 10\ntolerance = 0.1\n[[measure]]\nname = \"once\"\nis = \"groove\"\nlower = \
             {}\nupper = {}\n[measured]\nfile = \"parts.csv\"\ndistribution = \"normal\"\n[[measured.column]]\nof = \"groove\"\n",
            10.0 - half,
            10.0 + half
        );
        std::fs::write(folder.path().join("s.toml"), scene).unwrap();
        for samples in ["500", "1000"] {
            let found = json(folder.path(), &["tolerance", "s.toml", "--samples", samples, "--json"]);
            let of_all = &found["yield_of_all"];
            let [low, high] = [0, 1].map(|end| of_all["interval"][end].as_f64().unwrap());
            assert!(low < of_all["value"].as_f64().unwrap() && high <= 1.0 && high > 0.99, "{of_all}");
        }
    }
}
