//! Walls that converge or are bowed.

use super::{
    columns,
    common::{slipfit, stdout},
    planar, ran, wedge,
};

#[test]
fn converging_lines_jam_a_block_where_they_have_closed_and_let_go_by_their_slope() {
    let flat = |scene: &str| ran(&format!("mechanism = {{ space = \"plane\" }}\n{scene}"), &[]);
    let there = "segment = [{ kind = \"ramp\", speed = 50, duration = 0.02 }]\n";
    for (slope, friction) in [(0.01, 0.1), (0.02, 0.3), (0.05, 0.02)] {
        let run = flat(&wedge(slope, friction, there));
        let end = columns(&run, ["stage.x (m)"]).last().unwrap()[0];
        // The leading corners meet the lines where the gap is used up; pressed in by dx, 2·k·slope·dx·(slope + μ) holds 3 N.
        let expected = 1.2e-3 / slope - 0.02 + 3.0 / (2.0 * 1e6 * slope * (slope + friction));
        assert!((end / expected - 1.0).abs() < 2e-3, "{slope} {friction}: {end} {expected}");
        assert_eq!(run.outcomes[0].verdict.to_string(), "jammed");
        // Without the push it stays where μ is above the slope, and is pushed out where it is below.
        let released = wedge(
            slope,
            friction,
            "segment = [{ kind = \"ramp\", speed = 50, duration = 0.02 }, { kind = \"hold\", duration = 2.4 },\n\
             { kind = \"ramp\", speed = 0, duration = 0.02 }]\n",
        );
        let rows = columns(&flat(&released), ["t (s)", "stage.x (m)"]);
        let [before, after] = [rows[2400][1], rows[3000][1]];
        let backs = before - after > 1e-3 * 0.02;
        assert_eq!(backs, slope > friction, "{slope} {friction}: {before} {after}");
    }
}

#[test]
fn lines_without_slope_give_the_bits_of_parallel_ones() {
    let drive = "ramp_start = 0\nramp_end = 0.1\nspeed = 50\n";
    let [stated, plain] = [wedge(0.0, 0.2, drive), wedge(0.0, 0.2, drive).replace("slope = 0\n", "")];
    assert_ne!(stated, plain);
    let [stated, plain] = [stated, plain].map(|scene| planar(&scene, &[]).samples.rows);
    assert_eq!(stated, plain);
}

#[test]
fn a_bow_closes_where_its_height_uses_up_the_gap() {
    // Bowed towards the gap in the middle, where the block starts, by 1.6 mm over 200 mm: the gap of 1.2 mm there is wider at the ends.
    // Away from the middle by −1.6 mm instead, it closes at the corners: 1.2 mm = 8·1.6 mm·t²/(2·(200 mm)²), t = 86.6 mm.
    let drive = "segment = [{ kind = \"ramp\", speed = 50, duration = 0.02 }]\n";
    let bowed = |bow: f64| {
        let scene = wedge(0.0, 0.0, drive).replace("slope = 0\n", &format!("bow = [{bow}, 200]\n"));
        // Without friction it would turn between the lines.
        let scene = scene.replace("3e-5 kg·m²", "1000 kg·m²");
        let run = ran(&format!("mechanism = {{ space = \"plane\" }}\n{scene}"), &[]);
        columns(&run, ["stage.x (m)"]).last().unwrap()[0]
    };
    assert!(bowed(1.6) > 0.1);
    let t = 0.2 * libm::sqrt(1.2f64 / (4.0 * 1.6));
    let found = bowed(-1.6) + 0.02;
    // Pressed in by less than 3 N/(2·k·slope²) at that slope.
    let slope = 8.0 * 1.6e-3 / (0.2 * 0.2) * t;
    assert!(found > t && found < t + 3.0 / (2.0 * 1e6 * slope * slope) + 1e-5, "{found} {t}");
}

#[test]
fn the_walls_of_a_track_may_converge() {
    // A body on an ideal guide along z, with two walls across around a pin of the frame that close towards −z of the body: it moves along +z.
    for (slope, friction) in [(-0.01f64, 0.2), (-0.03, 0.1)] {
        let scene = format!(
            "[mechanism]\nspace = \"space\"\n[run]\nduration = 600\nerror = 1e-7\n\
             [contact]\nstiffness = \"1e6 N/m\"\nexponent = 1\ndamping = \"200 N·s/m\"\ndepth = 0.001\n\
             [friction]\nlaw = \"regularised\"\ncoefficient = {friction}\nstick_band = 0.001\n\
             [[body]]\nname = \"stage\"\nmass = 100\ninertia = [3e4, 3e4, 3e4]\ncentre = [0, 0, 0]\n\
             [[joint]]\nname = \"guide\"\nkind = \"prismatic\"\nbetween = [\"frame\", \"stage\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
             [[joint]]\nname = \"pin\"\nkind = \"track\"\nbetween = [\"frame\", \"stage\"]\nat = [0, 0, 0]\nleft = [0.2, 0]\nright = [0.2, 0]\n\
             slope = {slope}\n\
             [[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [0, 0, 1]\ngain = \"60 N·s/m\"\n\
             segment = [{{ kind = \"ramp\", speed = 50, duration = 0.02 }}]\n"
        );
        let end = columns(&ran(&scene, &[]), ["stage.z (m)"]).last().unwrap()[0];
        let s = slope.abs();
        let expected = 0.2e-3 / s + 3.0 / (2.0 * 1e6 * s * (s + friction));
        assert!((end / expected - 1.0).abs() < 2e-3, "{slope} {friction}: {end} {expected}");
    }
}

/// Gaps at other places of the travel say the same as slope and bow.
#[test]
fn gaps_at_several_places_are_a_slope_and_a_bow() {
    let drive = "segment = [{ kind = \"ramp\", speed = 50, duration = 0.02 }]\n";
    let end = |walls: &str| {
        let scene = wedge(0.0, 0.1, drive).replace("slope = 0\n", walls).replace("duration = 3000", "duration = 2600");
        assert!(scene.contains(walls));
        columns(&planar(&scene, &[]), ["stage.x (m)"]).last().unwrap()[0]
    };
    for (stated, as_gaps) in [
        ("slope = 0.01\n", "along = [{ at = 100, clearance = [0.2, 0] }]\n"),
        ("slope = 0.02\n", "along = [{ at = -50, clearance = [2.2, 0] }]\n"),
        ("bow = [-1.6, 200]\n", "along = [{ at = -100, clearance = [-0.4, 0] }, { at = 50, clearance = [0.8, 0] }]\n"),
    ] {
        let [stated, as_gaps] = [stated, as_gaps].map(end);
        assert!((stated - as_gaps).abs() < 1e-6, "{stated} {as_gaps}");
    }
}

/// A block between lines whose distances at two places are of a drawing: each unit stops where its own lines have closed, as far as it comes.
#[test]
fn units_jam_where_the_walls_of_their_drawing_have_closed() {
    let folder = tempfile::tempdir().unwrap();
    let walls = "along = [{ at = 100, clearance = \"play at the end\" }]\n";
    let product = "[[dimension]]\nname = \"start\"\nvalue = 22.2\ntolerance = 0.3\n\
                   [[dimension]]\nname = \"end\"\nvalue = 20.6\ntolerance = 0.3\n\
                   [[dimension]]\nname = \"block\"\nvalue = 20\ntolerance = 0.15\n\
                   [[measure]]\nname = \"play at the start\"\nis = \"(start - block) / 2\"\n\
                   [[measure]]\nname = \"play at the end\"\nis = \"(end - block) / 2\"\n";
    let drive = "segment = [{ kind = \"ramp\", speed = 50, duration = 0.02 }]\n";
    let scene = wedge(0.0, 0.05, drive)
        .replace("slope = 0\n", walls)
        .replace("clearance = [1.2, 0]", "clearance = \"play at the start\"")
        .replace("duration = 3000", "duration = 2600")
        .replace("error = 1e-7", "error = 1e-5");
    let text = format!("title = \"rails\"\nmechanism = {{ space = \"plane\" }}\n{scene}\n{product}");
    std::fs::write(folder.path().join("rails.toml"), text).unwrap();
    stdout(&slipfit(folder.path(), &["population", "rails.toml", "--units", "300", "--csv", "units.csv"]));
    let mut reader = csv::Reader::from_path(folder.path().join("units.csv")).unwrap();
    let head = reader.headers().unwrap().clone();
    let column = |name: &str| head.iter().position(|own| own == name).unwrap();
    let places = ["travel_m", "guide (m)", "guide at 100 mm (m)"].map(column);
    let rows = reader.records().map(|row| row.unwrap());
    let units: Vec<([f64; 3], bool)> =
        rows.map(|row| (places.map(|k| row[k].parse().unwrap()), &row[column("verdict")] != "runs")).collect();
    let mut stopped = 0;
    for ([travel, start, end], fails) in &units {
        let slope = (start - end) / 0.1;
        let closed = start / slope - 0.02 + 3.0 / (2.0 * 1e6 * slope * (slope + 0.05));
        if (0.0..0.118).contains(&closed) {
            assert!(*fails && (travel / closed - 1.0).abs() < 5e-3, "{travel} {closed}");
            stopped += 1;
        } else if !(0.0..0.135).contains(&closed) {
            assert!(!fails && *travel > 0.128, "{travel} {closed}");
        }
    }
    assert!((30..270).contains(&stopped), "{stopped}");
    // Both gaps have the spread of the drawing, and the block in common.
    let mean = |of: &dyn Fn(&[f64; 3]) -> f64| units.iter().map(|(unit, _)| of(unit)).sum::<f64>() / units.len() as f64;
    let [start, end] = [1, 2].map(|k| mean(&|unit| unit[k]));
    let product =
        |a: usize, b: usize| mean(&|unit| (unit[a] - [0.0, start, end][a]) * (unit[b] - [0.0, start, end][b]));
    let deviation = 0.5e-3 * libm::sqrt(0.01 + 0.0025);
    assert!((end - 0.3e-3).abs() < 4.0 * deviation / libm::sqrt(300.0), "{end}");
    assert!((libm::sqrt(product(2, 2)) / deviation - 1.0).abs() < 0.16, "{}", product(2, 2));
    let correlation = product(1, 2) / libm::sqrt(product(1, 1) * product(2, 2));
    assert!((correlation - 0.2).abs() < 0.23, "{correlation}");
    let checked = stdout(&slipfit(folder.path(), &["check", "rails.toml"]));
    assert!(checked.contains("guide at 100 mm"), "{checked}");
}
