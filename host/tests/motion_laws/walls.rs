//! Walls that converge or are bowed.

use super::{columns, planar, ran, wedge};

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
