//! Translational and torsion springs with preload.

use super::{MASS, STAGE, columns, planar, ran};
use slipfit::mechanism::MechanismRun;

/// The stage with a spring from its point (20, 0) to (120, 0) mm of the frame.
fn sprung(spring: &str, speed: f64) -> MechanismRun {
    let body = format!("centre = [0, 0]\nspeed = {speed}");
    let scene = STAGE.replace("centre = [0, 0]", &body);
    planar(&format!("{scene}[[spring]]\nname = \"spring\"\nbetween = [\"stage\", \"frame\"]\n{spring}"), &[])
}

#[test]
fn a_spring_along_a_line_swings_with_its_frequency_about_its_preload() {
    // 200 N/m: ω = 10 rad/s. A preload of 8 N pulls the stage 40 mm along before it is relaxed.
    for (spring, shift, damping) in [
        ("ends = [[20, 0], [120, 0]]\nstiffness = 0.2\n", 0.0, 0.0),
        ("ends = [[20, 0], [120, 0]]\nstiffness = 0.2\npreload = 8\n", 0.04, 0.0),
        ("ends = [[20, 0], [120, 0]]\nstiffness = 0.2\nfree_length = 130\n", -0.03, 0.0),
        ("ends = [[20, 0], [120, 0]]\nstiffness = 0.2\npreload = -2\ndamping = \"8 N·s/m\"\n", -0.01, 8.0),
    ] {
        let decay = damping / (2.0 * MASS);
        let omega = libm::sqrt(100.0 - decay * decay);
        for [t, x] in columns(&sprung(spring, 100.0), ["t (s)", "stage.x (m)"]) {
            let swing = -shift * libm::cos(omega * t) + (0.1 - decay * shift) / omega * libm::sin(omega * t);
            let expected = shift + libm::exp(-decay * t) * swing;
            assert!((x - expected).abs() < 1e-6, "{spring} {t}: {x} {expected}");
        }
    }
}

#[test]
fn a_preloaded_spring_across_the_way_holds_like_a_string() {
    // From 100 mm above, pulled with 20 N: across it holds with 20 N/0.1 m, and with the cube of the way beside.
    let run = sprung("ends = [[0, 0], [0, 100]]\nstiffness = 0.5\npreload = 20\n", 1.0);
    let omega = libm::sqrt(20.0 / 0.1 / MASS);
    for [t, x] in columns(&run, ["t (s)", "stage.x (m)"]) {
        let expected = 1e-3 / omega * libm::sin(omega * t);
        assert!((x - expected).abs() < 2e-9, "{t}: {x} {expected}");
    }
}

#[test]
fn a_torsion_spring_with_a_preload_turns_what_nothing_holds() {
    let scene = "[run]\nduration = 500\nerror = 1e-7\n[[body]]\nname = \"lever\"\nmass = 100\ninertia = \"1e-3 kg·m²\"\ncentre = [0, 0]\n\
                 [[joint]]\nname = \"axle\"\nkind = \"revolute\"\nbetween = [\"frame\", \"lever\"]\nat = [0, 0]\n\
                 [[spring]]\nname = \"spring\"\nbetween = [\"lever\", \"frame\"]\nstiffness = 0.4\npreload = \"0.1 N·m\"\n";
    for [t, angle] in columns(&planar(scene, &[]), ["t (s)", "lever.angle (rad)"]) {
        assert!((angle - 0.25 * (1.0 - libm::cos(20.0 * t))).abs() < 1e-6, "{t} {angle}");
    }
}

#[test]
fn springs_in_space_do_what_they_do_in_the_plane() {
    // A plate that hangs on two springs of different preload, thrown.
    let plate = |planar: bool| {
        let three = |x: f64, y: f64| if planar { format!("[{x}, {y}]") } else { format!("[{x}, {y}, 0]") };
        let joint = "[[joint]]\nname = \"limit\"\nkind = \"stop\"\nbetween = [\"plate\", \"frame\"]\n";
        format!(
            "[mechanism]\nspace = \"{}\"\ngravity = {}\n[run]\nduration = 300\nerror = 1e-7\n\
             [contact]\nstiffness = 100\nexponent = 1.5\ndamping = 0\ndepth = 0.01\n\
             [[body]]\nname = \"plate\"\nmass = 500\ninertia = {}\ncentre = {}\n\
             {joint}at = {}\nnormal = {}\nclearance = [500, 0]\n\
             [[spring]]\nname = \"left\"\nbetween = [\"plate\", \"frame\"]\nends = [{}, {}]\nstiffness = 0.3\npreload = 3\ndamping = \"0.5 N·s/m\"\n\
             [[spring]]\nname = \"right\"\nbetween = [\"frame\", \"plate\"]\nends = [{}, {}]\nstiffness = 0.2\nfree_length = 40\n",
            if planar { "plane" } else { "space" },
            three(0.0, -9.81),
            if planar { "\"1e-3 kg·m²\"" } else { "[\"1e-3 kg·m²\", \"1e-3 kg·m²\", \"1e-3 kg·m²\"]" },
            three(0.0, 0.0),
            three(0.0, 0.0),
            three(0.0, -1.0),
            three(-40.0, 10.0),
            three(-60.0, 90.0),
            three(55.0, 70.0),
            three(40.0, 5.0),
        )
    };
    let [flat, space] = [plate(true), plate(false)].map(|scene| ran(&scene, &[]));
    let flat = columns(&flat, ["plate.x (m)", "plate.y (m)", "plate.angle (rad)"]);
    let space = columns(&space, ["plate.x (m)", "plate.y (m)", "plate.az (rad)"]);
    let mut most: f64 = 0.0;
    for (k, (one, other)) in flat.iter().zip(&space).enumerate() {
        for (one, other) in one.iter().zip(other) {
            assert!((one - other).abs() < 1e-6, "{k}: {one} {other}");
        }
        most = most.max(one[2].abs());
    }
    assert!(most > 0.05, "{most}");
}
