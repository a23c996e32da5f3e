//! Commands, limits, rotors and the controlled point of drives.

use std::f64::consts::TAU;

use super::common::{slipfit, stdout};
use super::{GAIN, MASS, STAGE, columns, follows, planar, ran, stage};

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
fn a_limited_motor_accelerates_evenly_until_it_is_near_its_command() {
    // 3 N at most, of the 10 N that the controller asks for at rest.
    let run = stage("ramp_start = -1\nramp_end = 0\nspeed = 200\nlimit = 3\n");
    let (a, tau, near) = (3.0 / MASS, MASS / GAIN, 3.0 / GAIN);
    let until = (0.2 - near) / a;
    let speed = |t: f64| if t < until { a * t } else { 0.2 - near * libm::exp(-(t - until) / tau) };
    follows(&run, [1e-6, 1e-4], speed, |_, v| (GAIN * (0.2 - v)).min(3.0));
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
