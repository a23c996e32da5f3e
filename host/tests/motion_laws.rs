//! Drives, springs, friction and walls of scenes against closed forms.

mod common;

use std::f64::consts::{PI, TAU};

use common::{slipfit, stdout};
use slipfit::{
    mechanism::{MechanismRun, confirmed, run},
    scene::{Override, SceneFile},
};

/// A stage of 2 kg on an ideal guide along x, with a drive of 50 N·s/m: a time constant of 40 ms.
const STAGE: &str = r#"
[run]
duration = 1000
error = 1e-7
[[body]]
name = "stage"
mass = 2000
inertia = 1e6
centre = [0, 0]
[[joint]]
name = "guide"
kind = "prismatic"
between = ["frame", "stage"]
at = [0, 0]
axis = [1, 0]
"#;

const MASS: f64 = 2.0;
const GAIN: f64 = 50.0;

/// The run of a scene in a plane, sampled every millisecond.
fn planar(scene: &str, set: &[&str]) -> MechanismRun {
    ran(&format!("mechanism = {{ space = \"plane\", gravity = [0, -9.81] }}\n{scene}"), set)
}

fn ran(scene: &str, set: &[&str]) -> MechanismRun {
    let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    let file = SceneFile::parse("scene.toml", scene, &set).unwrap_or_else(|error| panic!("{error}\n{scene}"));
    let mechanism = file.mechanism.unwrap();
    run(&mechanism, &mechanism.gaps_at(&[0.0]).unwrap(), 1e-3).unwrap_or_else(|error| panic!("{error}\n{scene}"))
}

/// The run of the stage under a drive with these lines.
fn stage(drive: &str) -> MechanismRun {
    planar(
        &format!("{STAGE}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = \"50 N·s/m\"\n{drive}"),
        &[],
    )
}

/// The columns of these names, row by row.
fn columns<const N: usize>(run: &MechanismRun, names: [&str; N]) -> Vec<[f64; N]> {
    let of = names.map(|name| {
        run.samples
            .columns
            .iter()
            .position(|column| column == name)
            .unwrap_or_else(|| panic!("{name}: {:?}", run.samples.columns))
    });
    run.samples.rows.iter().map(|row| of.map(|k| row[k])).collect()
}

/// Whether the stage moves with the speed (m/s) that `speed` says at each time (s), and its motor gives `force` (N).
fn follows(run: &MechanismRun, most: [f64; 2], speed: impl Fn(f64) -> f64, force: impl Fn(f64, f64) -> f64) {
    for [t, vx, effort] in columns(run, ["t (s)", "stage.vx (m/s)", "motor.force (N)"]) {
        assert!((vx - speed(t)).abs() < most[0], "{t}: {vx} {}", speed(t));
        assert!((effort - force(t, vx)).abs() < most[1], "{t}: {effort} {}", force(t, vx));
    }
}

#[test]
fn ramps_holds_and_a_reversal_are_answered_like_a_first_order_lag() {
    let run = stage(
        "segment = [{ kind = \"hold\", duration = 0.1 }, { kind = \"ramp\", speed = 100, acceleration = 0.5 },\n\
         { kind = \"hold\", duration = 0.2 }, { kind = \"ramp\", speed = -100, acceleration = 1.0 }]\n",
    );
    let tau = MASS / GAIN;
    let lag = |t: f64| if t > 0.0 { t - tau * (1.0 - libm::exp(-t / tau)) } else { 0.0 };
    let ramp = |t: f64| t.max(0.0);
    // Each bend of the command adds a ramp.
    let bends = [(0.1, 0.5), (0.3, -0.5), (0.5, -1.0), (0.7, 1.0)];
    let sum = |t: f64, of: &dyn Fn(f64) -> f64| bends.iter().map(|(at, slope)| slope * of(t - at)).sum::<f64>();
    follows(&run, [1e-7, 1e-5], |t| sum(t, &lag), |t, v| GAIN * (sum(t, &ramp) - v));
    // Where the segments end, the command stays: the stage runs back at 100 mm/s.
    assert_eq!(run.outcomes[0].verdict.to_string(), "runs");
}

#[test]
fn an_s_curve_keeps_its_acceleration_and_jerk_and_comes_to_its_speed() {
    // 2 m/s² are reached in 0.1 s; the ramp to 0.6 m/s takes 0.3 s and 0.1 s more. One to 0.1 m/s never reaches them: 2·√(0.1/20) s.
    for (speed, build, whole) in [(0.6f64, 0.1, 0.4), (-0.1, libm::sqrt(0.1 / 20.0), 2.0 * libm::sqrt(0.1 / 20.0))] {
        let run = stage(&format!(
            "segment = [{{ kind = \"ramp\", speed = {}, acceleration = 2, jerk = 20 }}]\n",
            speed * 1e3
        ));
        let sign = speed.signum();
        let jerk = |t: f64| match t {
            t if t < build => 20.0 * sign,
            t if t > whole - build && t < whole => -20.0 * sign,
            _ => 0.0,
        };
        // Command, its rate and the speed of the stage by the midpoint rule.
        let (h, mut c, mut a, mut v) = (1e-5, 0.0, 0.0, 0.0);
        let rows = columns(&run, ["t (s)", "stage.vx (m/s)"]);
        for k in 0..100_000u32 {
            let t = h * f64::from(k);
            if k.is_multiple_of(1000) {
                assert!((rows[k as usize / 100][1] - v).abs() < 2e-5, "{t} {v} {}", rows[k as usize / 100][1]);
            }
            let mid = jerk(t + 0.5 * h);
            let command = c + a * 0.5 * h;
            let half = v + 0.5 * h * GAIN / MASS * (c - v);
            v += h * GAIN / MASS * (command - half);
            c += h * (a + 0.5 * h * mid);
            a += h * mid;
        }
        assert!((c - speed).abs() < 1e-4, "{c}");
    }
}

#[test]
fn a_sine_and_a_chirp_are_answered_with_their_amplitude_and_phase() {
    let run = stage("segment = [{ kind = \"sine\", amplitude = 40, frequency = 5, duration = 1 }]\n");
    let (tau, omega) = (MASS / GAIN, TAU * 5.0);
    let answer = |t: f64| {
        let x = omega * tau;
        0.04 / (1.0 + x * x) * (libm::sin(omega * t) - x * libm::cos(omega * t) + x * libm::exp(-t / tau))
    };
    follows(&run, [1e-7, 1e-4], answer, |t, v| GAIN * (0.04 * libm::sin(omega * t) - v));
    let run = stage("segment = [{ kind = \"chirp\", amplitude = 40, frequency = [1, 20], duration = 1 }]\n");
    // The effort tells the command.
    for [t, v, force] in columns(&run, ["t (s)", "stage.vx (m/s)", "motor.force (N)"]).into_iter().take(1000) {
        let command = 0.04 * libm::sin(TAU * (t + 0.5 * 19.0 * t * t));
        assert!((force / GAIN + v - command).abs() < 2e-7, "{t} {command}");
    }
}

#[test]
fn cycles_repeat_and_a_verdict_looks_at_each_hold() {
    let cycle = "cycles = 2\nsegment = [{ kind = \"ramp\", speed = 100, duration = 0.1 }, { kind = \"hold\", duration = 0.15 },\n\
                 { kind = \"ramp\", speed = -100, duration = 0.1 }, { kind = \"hold\", duration = 0.1 },\n\
                 { kind = \"ramp\", speed = 0, duration = 0.05 }]\n";
    let run = stage(cycle);
    let rows = columns(&run, ["t (s)", "stage.vx (m/s)"]);
    for k in 0..450 {
        // The first cycle starts at rest, the second with what is left of its last ramp.
        let left = rows[500][1] * libm::exp(-(k as f64) * 1e-3 * GAIN / MASS);
        assert!((rows[k][1] + left - rows[500 + k][1]).abs() < 1e-7, "{k}");
    }
    assert_eq!(run.outcomes[0].verdict.to_string(), "runs");
    // A wall on the way back: the way out runs, the way back does not.
    let blocked = |normal: f64, gap: f64| {
        let wall = format!(
            "[[joint]]\nname = \"wall\"\nkind = \"stop\"\nbetween = [\"stage\", \"frame\"]\nat = [0, 0]\nnormal = [{normal}, 0]\n\
             clearance = [{gap}, 0]\ncontact = {{ stiffness = 1000, exponent = 1, damping = 1, depth = 0.01 }}\n"
        );
        let drive = "[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = \"50 N·s/m\"\n\
                     segment = [{ kind = \"ramp\", speed = 100, duration = 0.1 }, { kind = \"hold\", duration = 0.15 },\n\
                     { kind = \"ramp\", speed = -100, duration = 0.1 }, { kind = \"hold\", duration = 0.4 },\n\
                     { kind = \"ramp\", speed = 0, duration = 0.05 }]\n";
        planar(&format!("{STAGE}{wall}{drive}"), &[]).outcomes[0].verdict.to_string()
    };
    assert_eq!([blocked(-1.0, 3.0), blocked(1.0, 1.0), blocked(1.0, 30.0)], ["jammed", "jammed", "runs"]);
}

#[test]
fn a_limited_motor_accelerates_evenly_until_it_is_near_its_command() {
    // 3 N at most, of the 10 N that the controller asks for at rest.
    let run = stage("ramp_start = -1\nramp_end = 0\nspeed = 200\nlimit = 3\n");
    let (a, tau, near) = (3.0 / MASS, MASS / GAIN, 3.0 / GAIN);
    let until = (0.2 - near) / a;
    let speed = |t: f64| if t < until { a * t } else { 0.2 - near * libm::exp(-(t - until) / tau) };
    follows(&run, [1e-6, 1e-4], speed, |_, v| (GAIN * (0.2 - v)).min(3.0));
}

#[test]
fn what_coasts_comes_to_rest_when_its_friction_says() {
    for (coulomb, viscous, offset) in [(1.5, 4.0, 0.0), (1.5, 0.0, 0.3), (0.8, 10.0, -0.4)] {
        let scene = format!(
            "{}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = 0\nramp_start = 0\nramp_end = 1\nspeed = 0\n\
             coulomb = {coulomb}\nviscous = \"{viscous} N·s/m\"\noffset = {offset}\nstick_band = 0.001\n",
            STAGE.replace("centre = [0, 0]", "centre = [0, 0]\nspeed = 300")
        );
        let run = planar(&scene, &[]);
        let held = coulomb + offset;
        let speed = |t: f64| match viscous {
            0.0 => 0.3 - held / MASS * t,
            c => (0.3 + held / c) * libm::exp(-c / MASS * t) - held / c,
        };
        let rest = match viscous {
            0.0 => 0.3 * MASS / held,
            c => MASS / c * libm::log(0.3 * c / held + 1.0),
        };
        assert!(rest < 0.9, "{rest}");
        follows(&run, [2e-6, 1e-9], |t| if t < rest - 1e-4 { speed(t) } else { 0.0f64.max(speed(t)) }, |_, _| 0.0);
    }
}

#[test]
fn friction_may_differ_between_both_directions() {
    // Pushed back and forth at constant speed the motor gives 1 + 2·0.05 + 0.25 N one way, −(2 + 2·0.05) + 0.25 N the other.
    let run = stage(
        "coulomb = [1, 2]\nviscous = \"2 N·s/m\"\noffset = 0.25\nstick_band = 0.01\n\
         segment = [{ kind = \"ramp\", speed = 50, duration = 0.1 }, { kind = \"hold\", duration = 0.4 },\n\
         { kind = \"ramp\", speed = -50, duration = 0.1 }, { kind = \"hold\", duration = 0.4 }]\n",
    );
    for [t, v, force] in columns(&run, ["t (s)", "stage.vx (m/s)", "motor.force (N)"]) {
        let expected = match t {
            t if t > 0.45 && t < 0.5 => 1.0 + 2.0 * v + 0.25,
            t if t > 0.95 => -2.0 + 2.0 * v + 0.25,
            _ => continue,
        };
        assert!((force - expected).abs() < 1e-3, "{t} {force} {expected}");
    }
}

#[test]
fn a_rotor_is_felt_as_its_inertia_times_the_square_of_its_gear_and_has_no_weight() {
    // A drive on a screw of 8 mm a turn: 5 g·cm² are 0.308 kg; the slope of the guide pulls with the stage's weight alone.
    let scene = STAGE.replace("axis = [1, 0]", "axis = [0.6, 0.8]");
    let rotor = 5e-7 * (TAU / 8e-3) * (TAU / 8e-3);
    let drive = "[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [0.6, 0.8]\ngain = 0\nramp_start = 0\nramp_end = 1\nspeed = 0\n";
    let moved = |rest: &str| {
        let run = planar(&format!("{scene}{drive}{rest}"), &["run.duration=100"]);
        columns(&run, ["stage.vx (m/s)"])[100][0] / 0.6 / 0.1
    };
    assert!((moved("") + 9.81 * 0.8).abs() < 1e-6);
    let expected = -MASS * 9.81 * 0.8 / (MASS + rotor);
    let found = moved("rotor = \"5e-7 kg·m²\"\ntravel = 8\n");
    assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    // A wheel of 1e-4 kg·m² behind a gear of 20, under a limited torque.
    let wheel = "[run]\nduration = 100\n[[body]]\nname = \"wheel\"\nmass = 100\ninertia = \"1e-4 kg·m²\"\ncentre = [0, 0]\n\
                 [[joint]]\nname = \"axle\"\nkind = \"revolute\"\nbetween = [\"frame\", \"wheel\"]\nat = [0, 0]\n\
                 [[drive]]\nname = \"motor\"\nturns = \"wheel\"\ngain = 1\nramp_start = -1\nramp_end = 0\nspeed = 500\nlimit = 0.02\n\
                 rotor = \"2e-7 kg·m²\"\ngear = 20\n";
    let spin = columns(&planar(wheel, &[]), ["wheel.spin (rad/s)"])[100][0];
    assert!((spin - 0.02 * 0.1 / (1e-4 + 400.0 * 2e-7)).abs() < 1e-5, "{spin}");
}

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

/// A block of 1 kg on a floor, pulled by a spring of 100 N/m from a carriage at 20 mm/s: with a static coefficient of 0.3 and a kinetic one
/// of 0.2 it sticks and slips.
fn stick_slip(friction: &str) -> f64 {
    let scene = format!(
        "[run]\nduration = 12000\nerror = 1e-8\n[contact]\nstiffness = 100\nexponent = 1\ndamping = 1\ndepth = 0.01\n[friction]\n{friction}\n\
         [[body]]\nname = \"block\"\nmass = 1000\ninertia = 1e6\ncentre = [0, 0]\n\
         [[body]]\nname = \"carriage\"\nmass = 1000\ninertia = 1e6\ncentre = [100, 0]\nspeed = 20\n\
         [[joint]]\nname = \"rail\"\nkind = \"prismatic\"\nbetween = [\"frame\", \"carriage\"]\nat = [100, 0]\naxis = [1, 0]\n\
         [[joint]]\nname = \"heel\"\nkind = \"stop\"\nbetween = [\"block\", \"frame\"]\nat = [-50, 0]\nnormal = [0, 1]\nclearance = [0, 0]\n\
         [[joint]]\nname = \"toe\"\nkind = \"stop\"\nbetween = [\"block\", \"frame\"]\nat = [50, 0]\nnormal = [0, 1]\nclearance = [0, 0]\n\
         [[spring]]\nname = \"spring\"\nbetween = [\"block\", \"carriage\"]\nends = [[0, 0], [100, 0]]\nstiffness = 0.1\n\
         [[drive]]\nname = \"motor\"\npushes = \"carriage\"\naxis = [1, 0]\ngain = \"1e6 N·s/m\"\nramp_start = -1\nramp_end = 0\nspeed = 20\n"
    );
    let run = planar(&scene, &[]);
    // Slips begin where the speed comes up through 5 mm/s.
    let rows = columns(&run, ["t (s)", "block.vx (m/s)"]);
    let begins: Vec<f64> = rows
        .windows(2)
        .filter(|two| two[0][1] < 5e-3 && two[1][1] >= 5e-3)
        .map(|two| two[0][0] + 1e-3 * (5e-3 - two[0][1]) / (two[1][1] - two[0][1]))
        .collect();
    assert!(begins.len() >= 8, "{begins:?}");
    (begins[begins.len() - 1] - begins[1]) / (begins.len() - 2) as f64
}

#[test]
fn a_block_on_a_spring_sticks_and_slips_with_its_textbook_period() {
    let (omega, v) = (10.0f64, 0.02);
    let drop = (0.3 - 0.2) * 9.81 / 100.0;
    let expected = 2.0 * drop / v + 2.0 / omega * (PI - libm::atan(drop * omega / v));
    for (friction, within) in [
        ("law = \"exact\"\ncoefficient = 0.2\nstatic_coefficient = 0.3", 0.002),
        (
            "law = \"regularised\"\ncoefficient = 0.2\nstatic_coefficient = 0.3\nstribeck_speed = 0.05\nstick_band = 0.002",
            0.002,
        ),
    ] {
        let found = stick_slip(friction);
        assert!((found / expected - 1.0).abs() < within, "{friction}: {found} {expected}");
    }
}

/// A block of 100 g between lines that are 20 mm apart, 1.2 mm wider on either side, and lean in by `slope`; pushed with 3 N at a standstill.
fn wedge(slope: f64, friction: f64, drive: &str) -> String {
    format!(
        "[run]\nduration = 3000\nerror = 1e-7\n[contact]\nstiffness = \"1e6 N/m\"\nexponent = 1\ndamping = \"200 N·s/m\"\ndepth = 0.001\n\
         [friction]\nlaw = \"regularised\"\ncoefficient = {friction}\nstick_band = 0.001\n\
         [[body]]\nname = \"stage\"\nmass = 100\ninertia = \"3e-5 kg·m²\"\ncentre = [0, 0]\n\
         [[joint]]\nname = \"guide\"\nkind = \"prismatic\"\nbetween = [\"stage\", \"frame\"]\nat = [0, 0]\naxis = [1, 0]\n\
         length = 40\nwidth = 20\nclearance = [1.2, 0]\nslope = {slope}\n\
         [[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = \"60 N·s/m\"\n{drive}"
    )
}

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

#[test]
fn an_ideal_joint_may_have_friction_of_its_own() {
    // Thrown, each slows down evenly and by its viscous part: v = (v₀ + c/d)·exp(−d·t/m) − c/d until it is at rest.
    let body = |what: &str, three: bool, start: &str| {
        let list = |x: &str| if three { format!("[{x}, {x}, {x}]") } else { x.to_owned() };
        let centre = if three { "[0, 0, 0]" } else { "[0, 0]" };
        format!(
            "[[body]]\nname = \"{what}\"\nmass = 2000\ninertia = {}\ncentre = {centre}\n{start}\n",
            list("\"1e-3 kg·m²\"")
        )
    };
    let joint = |kind: &str, three: bool, axis: &str, between: &str, friction: &str| {
        let at = if three { "[0, 0, 0]" } else { "[0, 0]" };
        format!(
            "[[joint]]\nname = \"joint\"\nkind = \"{kind}\"\nbetween = [{between}]\nat = {at}\n{axis}\n{friction}\n"
        )
    };
    let slides = "coulomb = [1.5, 9]\nviscous = \"4 N·s/m\"\nstick_band = 0.001";
    let turns = "coulomb = \"2 N·mm\"\nviscous = \"4e-3 N·m·s/rad\"\nstick_band = 1e-4";
    for (scene, column, [start, inertia, coulomb, viscous]) in [
        (
            body("stage", false, "speed = 300")
                + &joint("prismatic", false, "axis = [1, 0]", "\"stage\", \"frame\"", slides),
            "stage.vx (m/s)",
            [0.3, 2.0, 1.5, 4.0],
        ),
        (
            body("stage", true, "speed = 300")
                + &joint("prismatic", true, "axis = [0, 1, 0]", "\"frame\", \"stage\"", slides),
            "stage.vy (m/s)",
            [0.3, 2.0, 1.5, 4.0],
        ),
        (
            body("wheel", false, "spin = 0.5") + &joint("revolute", false, "", "\"frame\", \"wheel\"", turns),
            "wheel.spin (rad/s)",
            [0.5, 1e-3, 2e-3, 4e-3],
        ),
        (
            body("wheel", true, "spin = 0.5")
                + &joint("revolute", true, "axis = [0, 0, 1]", "\"frame\", \"wheel\"", turns),
            "wheel.wz (rad/s)",
            [0.5, 1e-3, 2e-3, 4e-3],
        ),
    ] {
        let space = if column.contains("vy") || column.contains("wz") { "space" } else { "plane" };
        let run = ran(
            &format!("mechanism = {{ space = \"{space}\" }}\nrun = {{ duration = 500, error = 1e-7 }}\n{scene}"),
            &[],
        );
        let (rate, held) = (viscous / inertia, coulomb / viscous);
        let rest = libm::log(start / held + 1.0) / rate;
        for [t, speed] in columns(&run, ["t (s)", column]) {
            let expected = if t < rest { (start + held) * libm::exp(-rate * t) - held } else { 0.0 };
            assert!((speed - expected).abs() < 3e-5 * start.max(expected), "{column} {t}: {speed} {expected}");
        }
    }
}

#[test]
fn a_drive_controls_the_speed_of_its_point_unless_the_centres_is_stated() {
    // A lever of I = 4e-4 kg·m² about its pivot, its centre 20 mm and its point 50 mm from it: I·θ″ = K·(V − a·cos θ·θ′)·r·cos θ.
    for (controls, arm) in [("", 0.05), ("controls = \"point\"\n", 0.05), ("controls = \"centre\"\n", 0.02)] {
        for space in ["plane", "space"] {
            let three =
                |x: f64, y: f64| if space == "plane" { format!("[{x}, {y}]") } else { format!("[{x}, {y}, 0]") };
            let (inertia, axis) = match space {
                "plane" => ("\"3.6e-4 kg·m²\"", ""),
                _ => ("[\"3.6e-4 kg·m²\", \"3.6e-4 kg·m²\", \"3.6e-4 kg·m²\"]", "axis = [0, 0, 1]\n"),
            };
            let scene = format!(
                "mechanism = {{ space = \"{space}\" }}\nrun = {{ duration = 300, error = 1e-7 }}\n\
                 [[body]]\nname = \"lever\"\nmass = 100\ninertia = {inertia}\ncentre = {}\n\
                 [[joint]]\nname = \"pivot\"\nkind = \"revolute\"\nbetween = [\"frame\", \"lever\"]\nat = {}\n{axis}\
                 [[drive]]\nname = \"rod\"\npushes = \"lever\"\naxis = {}\npoint = {}\n{controls}gain = \"5 N·s/m\"\n\
                 segment = [{{ kind = \"ramp\", speed = 50, acceleration = 1 }}]\n",
                three(20.0, 0.0),
                three(0.0, 0.0),
                three(0.0, 1.0),
                three(30.0, 0.0),
            );
            let run = ran(&scene, &[]);
            let rows = columns(
                &run,
                ["rod.force (N)", if space == "plane" { "lever.spin (rad/s)" } else { "lever.wz (rad/s)" }],
            );
            let effort = |t: f64, [angle, spin]: [f64; 2]| 5.0 * (t.min(0.05) - arm * libm::cos(angle) * spin);
            let slope =
                |t: f64, [angle, spin]: [f64; 2]| [spin, effort(t, [angle, spin]) * 0.05 * libm::cos(angle) / 4e-4];
            let (h, mut state) = (1e-5, [0.0; 2]);
            for k in 0..30_000u32 {
                let t = h * f64::from(k);
                if k.is_multiple_of(100) {
                    let [force, spin] = rows[k as usize / 100];
                    assert!(
                        (spin - state[1]).abs() < 2e-6 && (force - effort(t, state)).abs() < 1e-5,
                        "{space} {controls} {t}"
                    );
                }
                let at = |by: f64, of: [f64; 2]| [state[0] + by * of[0], state[1] + by * of[1]];
                let a = slope(t, state);
                let b = slope(t + 0.5 * h, at(0.5 * h, a));
                let c = slope(t + 0.5 * h, at(0.5 * h, b));
                let d = slope(t + h, at(h, c));
                for (of, sum) in state.iter_mut().zip([0, 1].map(|i| a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i])) {
                    *of += h / 6.0 * sum;
                }
            }
        }
    }
}

/// A slide on pins that states what its own types do not have is computed as a mechanism. With a limit that it never comes to, it moves as
/// the slide's own solver has it.
#[test]
fn a_slide_moves_alike_as_a_mechanism() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |set: &[&str], names: [&str; 3]| {
        let mut arguments = vec!["simulate", "cd-rom-slide", "--set", "run.duration=1500", "--csv", "run.csv"];
        arguments.extend(set);
        stdout(&slipfit(folder.path(), &arguments));
        let mut file = csv::Reader::from_path(folder.path().join("run.csv")).unwrap();
        let heads = file.headers().unwrap().clone();
        let at = names.map(|name| heads.iter().position(|head| head == name).unwrap_or_else(|| panic!("{name}")));
        let row = |row: csv::StringRecord| at.map(|k| row[k].parse::<f64>().unwrap());
        file.records().map(|record| row(record.unwrap())).collect::<Vec<_>>()
    };
    for n in ["-2", "0", "2"] {
        let slide = rows(&["--n", n], ["force (N)", "x (m)", "z (m)"]);
        let written = rows(&["--n", n, "--set", "drive.limit=1000"], ["drive.force (N)", "slide.x (m)", "slide.z (m)"]);
        assert_eq!(slide.len(), written.len());
        let peak = slide.iter().map(|row| row[0].abs()).fold(0.0, f64::max);
        for (one, other) in slide.iter().zip(&written) {
            assert!((one[0] - other[0]).abs() < 5e-5 * peak, "{n}: {one:?} {other:?}");
            assert!((one[1] - other[1]).abs() < 1e-8 && (one[2] - other[2]).abs() < 1e-8, "{n}: {one:?} {other:?}");
        }
    }
}

/// The verdict of the stage that a finer run confirms, and whether there is one at all.
fn confirmed_verdict(drive: &str, set: &[&str]) -> String {
    let scene = format!(
        "mechanism = {{ space = \"plane\" }}\n{STAGE}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\n{drive}"
    );
    let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    let mechanism =
        SceneFile::parse("scene.toml", &scene, &set).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap();
    confirmed(&mechanism, &[], 1e-3).unwrap()[0].outcomes[0].verdict.to_string()
}

#[test]
fn a_motion_that_ends_at_rest_or_where_it_began_has_a_verdict() {
    let there = "segment = [{ kind = \"ramp\", speed = 100, acceleration = 2 }, { kind = \"hold\", duration = 0.2 },\n\
                 { kind = \"ramp\", speed = 0, acceleration = 2 }]\n";
    let and_back = "segment = [{ kind = \"ramp\", speed = 100, acceleration = 2 }, { kind = \"hold\", duration = 0.2 },\n\
                    { kind = \"ramp\", speed = -100, acceleration = 2 }, { kind = \"hold\", duration = 0.2 },\n\
                    { kind = \"ramp\", speed = 0, acceleration = 2 }]\n";
    for (segments, length) in [(there, 300.0), (and_back, 600.0)] {
        for duration in [length, length + 1.0, length + 20.0, 1000.0, 3000.0] {
            let drive = format!("gain = 1\n{segments}");
            let verdict = confirmed_verdict(&drive, &[&format!("run.duration={duration}")]);
            assert_eq!(verdict, "runs", "{duration}: {segments}");
        }
    }
    // What does not come back is jammed, and so is what never moved, whenever the run ends after it should have.
    let sticks = |coulomb: &str| format!("gain = 0.2\nlimit = 5\ncoulomb = {coulomb}\nstick_band = 0.1\n{and_back}");
    assert_eq!(confirmed_verdict(&sticks("[0.5, 6]"), &["run.duration=1500"]), "jammed");
    for duration in [260, 400, 550, 700] {
        assert_eq!(confirmed_verdict(&sticks("6"), &[&format!("run.duration={duration}")]), "jammed", "{duration}");
    }
    // A wave about zero commands no speed to be judged by.
    let wave = "gain = 1\nsegment = [{ kind = \"sine\", amplitude = 50, frequency = 5, duration = 1 }]\n";
    assert_eq!(confirmed_verdict(wave, &[]), "undecided");
    assert_eq!(confirmed_verdict(&format!("cycles = 2\n{wave}"), &["run.duration=2000"]), "undecided");
}

#[test]
fn what_friction_differs_by_is_the_motion_not_the_order_of_the_bodies() {
    // Turned from x to y at 10 rad/s the motor gives the first number.
    for (space, axis, angle) in [("plane", "", "1e-3"), ("space", "axis = [0, 0, 1]\n", "1e-3")] {
        for between in ["\"frame\", \"wheel\"", "\"wheel\", \"frame\""] {
            let (at, inertia) = match space {
                "plane" => ("[0, 0]", format!("\"{angle} kg·m²\"")),
                _ => ("[0, 0, 0]", format!("[\"{angle} kg·m²\", \"{angle} kg·m²\", \"{angle} kg·m²\"]")),
            };
            let scene = format!(
                "mechanism = {{ space = \"{space}\" }}\nrun = {{ duration = 400 }}\n\
                 [[body]]\nname = \"wheel\"\nmass = 100\ninertia = {inertia}\ncentre = {at}\n\
                 [[joint]]\nname = \"axle\"\nkind = \"revolute\"\nbetween = [{between}]\nat = {at}\n{axis}\
                 coulomb = [0.02, 0.05]\nstick_band = 0.1\n\
                 [[drive]]\nname = \"motor\"\nturns = \"wheel\"\n{axis}gain = 5\nramp_start = 0\nramp_end = 0.1\nspeed = 10\n"
            ).replace("coulomb = [0.02, 0.05]", "coulomb = [\"0.02 N·m\", \"0.05 N·m\"]");
            let torque = columns(&ran(&scene, &[]), ["motor.torque (N·m)"]).last().unwrap()[0];
            assert!((torque - 0.02).abs() < 1e-6, "{space} {between}: {torque}");
        }
    }
}

/// What is wrong with a scene, with the place that the message shows.
fn refused(scene: &str) -> String {
    match SceneFile::parse("scene.toml", scene, &[]) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("accepted:\n{scene}"),
    }
}

#[test]
fn what_makes_no_sense_is_refused_at_its_place() {
    let drive = |rest: &str| {
        format!(
            "mechanism = {{ space = \"plane\" }}\n{STAGE}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = 1\n{rest}"
        )
    };
    let ramp = "ramp_start = 0\nramp_end = 1\nspeed = 10\n";
    for (scene, needle) in [
        (drive("segment = [{ kind = \"jump\" }]\n"), "ramp, hold, sine, chirp"),
        (drive("segment = [{ kind = \"ramp\", speed = 1 }]\n"), "duration, or acceleration"),
        (drive("segment = [{ kind = \"ramp\", speed = 1, duration = 1, acceleration = 1 }]\n"), "beside `duration`"),
        (drive("segment = [{ kind = \"hold\", duration = 1 }]\n"), "a speed other than 0"),
        (
            drive(
                "segment = [{ kind = \"hold\", duration = 1, speed = 3 }, { kind = \"ramp\", speed = 1, duration = 1 }]\n",
            ),
            "has no effect",
        ),
        (drive("segment = [{ kind = \"sine\", amplitude = 1, frequency = 1000, duration = 1 }]\n"), "pieces"),
        (drive("segment = [{ kind = \"ramp\", speed = 1, duration = 1 }]\ncycles = 2\n"), "end at rest"),
        (drive("segment = [{ kind = \"ramp\", speed = 1, duration = 1 }]\nspeed = 3\n"), "beside segments"),
        (drive(&format!("{ramp}cycles = 2\n")), "without segments"),
        (drive(&format!("{ramp}limit = -1\n")), "drive.limit"),
        (drive(&format!("{ramp}limit = \"1 N·m\"\n")), "unit"),
        (drive(&format!("{ramp}coulomb = 1\n")), "drive.stick_band"),
        (drive(&format!("{ramp}stick_band = 1\n")), "has no effect"),
        (drive(&format!("{ramp}rotor = 100\n")), "drive.travel"),
        (drive(&format!("{ramp}gear = 3\n")), "without `rotor`"),
        (
            drive(&format!("{ramp}rotor = 100\ntravel = 8\n")).replace("axis = [1, 0]\ngain", "axis = [0, 1]\ngain"),
            "a rotor that moves",
        ),
        (
            drive(&format!(
                "{ramp}[[spring]]\nname = \"s\"\nbetween = [\"stage\", \"frame\"]\nends = [[0, 0], [0, 0]]\nstiffness = 1\n"
            )),
            "1 µm apart",
        ),
        (
            drive(&format!(
                "{ramp}[[spring]]\nname = \"s\"\nbetween = [\"stage\", \"frame\"]\nstiffness = 0\npreload = 1\n"
            )),
            "without stiffness",
        ),
        (
            drive(&format!(
                "{ramp}[[spring]]\nname = \"s\"\nbetween = [\"stage\", \"frame\"]\nstiffness = 1\nfree_length = 1\n"
            )),
            "has no effect",
        ),
        (drive(ramp).replace("[[drive]]", "slope = 0.1\n[[drive]]"), "`joint.slope`"),
        (wedge(0.01, 0.2, ramp).replace("slope = 0.01", "slope = [0.1, 0.2, 0.3]"), "a list of 2"),
        (wedge(0.01, 0.2, ramp).replace("slope = 0.01", "bow = 0.1"), "over a length"),
        // At ± 20 mm the lines have come together by 4 mm on either side, of a gap of 1.2 mm.
        (wedge(0.2, 0.2, ramp), "tears `guide` open"),
        (wedge(0.0, 0.2, ramp).replace("slope = 0", "bow = [-100, 100]"), "tears `guide` open"),
        (wedge(0.01, 0.2, ramp).replace("stick_band = 0.001", "stick_band = 0.001\nstatic_coefficient = 0.1"), "0.2"),
        (
            wedge(0.01, 0.2, ramp).replace("stick_band = 0.001", "stick_band = 0.001\nstatic_coefficient = 0.3"),
            "stribeck_speed",
        ),
        (
            wedge(0.01, 0.2, ramp).replace("stick_band = 0.001", "stick_band = 0.001\nstribeck_speed = 0.3"),
            "has no effect",
        ),
        (wedge(0.01, 0.2, ramp).replace("\"regularised\"", "\"exact\"\nviscous = 1"), "has no effect"),
    ] {
        let scene =
            if scene.contains("mechanism =") { scene } else { format!("mechanism = {{ space = \"plane\" }}\n{scene}") };
        let message = refused(&scene);
        assert!(message.contains(needle) && message.contains("scene.toml:"), "{needle} in\n{message}");
    }
}
