//! Motions of one coordinate against closed forms and against an integration written here: classical Runge–Kutta in steps far shorter
//! than any contact.

use super::{Mechanism, MechanismRun, confirmed, contact_tests::ball, finer, run};
use crate::{
    dynamics::outcome::Verdict,
    scene::{Override, SceneFile, shipped},
};

pub(super) fn scene(text: &str) -> Mechanism {
    match SceneFile::parse("test", text, &[]) {
        Ok(file) => file.mechanism.expect("a mechanism"),
        Err(errors) => panic!("{errors:?}"),
    }
}

pub(super) fn simulated(mechanism: &Mechanism, every: f64) -> MechanismRun {
    run(mechanism, &mechanism.gaps_at(&[0.0]).unwrap(), every).unwrap()
}

/// All values of a column.
pub(super) fn column(run: &MechanismRun, name: &str) -> Vec<f64> {
    let k = run.samples.columns.iter().position(|column| column == name).unwrap();
    run.samples.rows.iter().map(|row| row[k]).collect()
}

pub(super) fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, x| if x.abs() > most || x.is_nan() { x.abs() } else { most })
}

/// Displacements and speeds every `every` (s) of a body with this `acceleration` at a place and speed, thrown at `speed`.
pub(super) fn independent(
    acceleration: impl Fn(f64, f64) -> f64,
    speed: f64,
    every: f64,
    count: usize,
) -> Vec<[f64; 2]> {
    let steps = (every / 2e-7).round();
    let h = every / steps;
    let mut state = [0.0, speed];
    let mut all = vec![state];
    for _ in 0..count {
        for _ in 0..steps as u32 {
            let rate = |[x, v]: [f64; 2]| [v, acceleration(x, v)];
            let add = |a: [f64; 2], b: [f64; 2], w: f64| [a[0] + w * b[0], a[1] + w * b[1]];
            let k1 = rate(state);
            let k2 = rate(add(state, k1, h / 2.0));
            let k3 = rate(add(state, k2, h / 2.0));
            let k4 = rate(add(state, k3, h));
            for i in 0..2 {
                state[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        all.push(state);
    }
    all
}

/// Progressive contacts, far into which a long step's trial stages reach: no result is NaN.
#[test]
fn what_is_not_a_number_is_no_result() {
    for exponent in [1.5, 2.5, 3.0, 4.0] {
        for speed in [0.5, 5.0, 30.0] {
            // 500 N at 0.1 mm.
            let stiffness = 500.0 / libm::pow(1e-4, exponent);
            let mechanism = ball([1, 0], speed, [30.0, 40.0], exponent, stiffness, 3e-7);
            let run = simulated(&mechanism, 1e-3);
            let force = |depth: f64| if depth > 0.0 { stiffness * libm::pow(depth, exponent) } else { 0.0 };
            let acceleration = |x: f64, _: f64| (force(-0.04 - x) - force(x - 0.03)) / 0.1;
            let expected = independent(acceleration, speed, 1e-3, 200);
            let speeds = column(&run, "ball.vx (m/s)");
            let kept = (speeds.last().unwrap().abs() - speed).abs();
            assert!(kept < 2e-3 * speed, "e = {exponent}, {speed} m/s: {kept}");
            let worst = column(&run, "ball.x (m)").iter().zip(&expected).fold(0.0f64, |most, (x, state)| {
                let off = (x - state[0]).abs();
                if off > most || off.is_nan() { off } else { most }
            });
            assert!(worst < 2e-4, "e = {exponent}, {speed} m/s: {worst} m");
        }
    }
}

/// A lever that a drive pushes at x = `point` (mm) from its pivot; the centre of mass is at x = `centre` (mm).
fn lever(centre: f64, point: f64, y: f64) -> Mechanism {
    scene(&format!(
        r#"
title = "Pushed lever"
[mechanism]
space = "plane"
gravity = [0, 0]
[contact]
stiffness = "1e8 N/m^1.5"
exponent = 1.5
damping = 0
depth = 0.1
[friction]
law = "none"
[[body]]
name = "lever"
mass = 100
inertia = "1e-4 kg·m²"
centre = [{centre}, 0]
[[joint]]
name = "pivot"
kind = "revolute"
between = ["frame", "lever"]
at = [0, 0]
[[drive]]
name = "rod"
pushes = "lever"
axis = [0, 1]
point = [{}, {y}]
controls = "centre"
gain = 0.04
ramp_start = 0.01
ramp_end = 0.02
speed = 50
[run]
duration = 60
"#,
        point - centre
    ))
}

#[test]
fn a_drive_that_runs_away_does_not_complete_its_motion() {
    let confirmed = |mechanism: &Mechanism| confirmed(mechanism, &[], 1e-3).unwrap()[0].outcomes[0];
    let near = confirmed(&lever(30.0, 40.0, 0.0));
    assert_eq!(near.verdict, Verdict::Runs);
    let far = confirmed(&lever(30.0, -40.0, 0.0));
    assert_eq!(far.verdict, Verdict::Overruns, "{far:?}");
    let found =
        super::feedback::reversals(&lever(30.0, -40.0, 0.0)).iter().map(|found| found.angle).collect::<Vec<_>>();
    assert_eq!(found, [0.0]);
    assert!(super::feedback::reversals(&lever(30.0, 40.0, 0.0)).is_empty());
    assert_eq!(super::feedback::reversals(&lever(30.0, 40.0, 20.0)).len(), 1);
}

/// However fast a drive runs away, the unit overruns: the run ends where no step is short enough, and does not fail.
#[test]
fn a_drive_that_runs_away_beyond_all_numbers_overruns() {
    for gain in [40.0, 100.0, 1e3, 1e4] {
        for duration in [0.06, 0.3, 3.0] {
            let mut mechanism = lever(30.0, -40.0, 0.0);
            mechanism.drives[0].drive.gain = gain;
            mechanism.run.duration = duration;
            let [one, finer] = confirmed(&mechanism, &[], 1e-3).unwrap();
            assert_eq!(one.outcomes[0].verdict, Verdict::Overruns, "{gain} {duration}: {:?}", one.outcomes[0]);
            assert!(one.agreement(&finer, &mechanism).share.is_finite());
        }
    }
}

/// A lid that falls from where it is drawn: height becomes motion, the sum stays 0.
fn lid(gain: f64, duration: f64) -> Mechanism {
    scene(&format!(
        r#"
[mechanism]
space = "plane"
gravity = [0, -9.81]
[[body]]
name = "lid"
mass = 500
inertia = "1e-3 kg·m²"
centre = [100, 0]
[[joint]]
name = "hinge"
kind = "revolute"
between = ["frame", "lid"]
at = [0, 0]
[[drive]]
name = "motor"
turns = "lid"
gain = {gain}
ramp_start = 0.05
ramp_end = 0.3
speed = 2
[run]
duration = {duration}
"#
    ))
}

#[test]
fn what_falls_from_rest_has_no_energy_too_much() {
    for duration in [0.5, 200.0, 300.0, 500.0, 800.0] {
        for gain in [0.0, 1e-6, 1.0] {
            let lid = lid(gain, duration);
            let [one, finer] = confirmed(&lid, &[], 1e-3).unwrap();
            assert!(one.energy_excess < 1e-3, "{gain} {duration}: {}", one.energy_excess);
            // Half a millisecond has one sample, of a body at rest: nothing differs.
            let share = one.agreement(&finer, &lid).share;
            assert!(share < 1e-3 && (duration > 1.0 || share == 0.0), "{gain} {duration}: {share}");
        }
    }
}

/// At any gain the drive of a slider-crank holds its speed, and gives what masses and contacts ask for.
#[test]
fn peaks_of_stiff_drives_are_those_of_the_load() {
    for (name, peak) in [("slider-crank", 1.056), ("hatch", 3.3187), ("four-bar", 0.5194)] {
        let text = shipped(name).unwrap();
        for gain in [1e3, 1e4, 1e6, 1e8] {
            let set = [Override::option("--set", "drive.motor.gain", &gain.to_string())];
            let mechanism = SceneFile::parse(name, text, &set).unwrap().mechanism.unwrap();
            let run = simulated(&mechanism, 1e-4);
            let found = run.outcomes[0].peak_force.unwrap();
            assert!((found - peak).abs() < 5e-3 * peak, "{name}, {gain}: {found}, not {peak}");
            let ramp = mechanism.drives[0].drive.ramp_start;
            let late = column(&run, "t (s)").iter().filter(|t| **t < ramp).count();
            assert!(greatest(&column(&run, "motor.torque (N·m)")[late..]) <= 1.005 * found, "{name}, {gain}");
        }
    }
}

/// A drive gives what its command says, also against joints that hold its body, whatever the steps are.
#[test]
fn the_effort_of_a_drive_that_is_held_follows_its_command() {
    for (start, end) in [(0.1, 0.101), (0.0995, 0.1), (0.01, 0.02), (0.05, 0.3)] {
        for (space, inertia, axis, held) in [
            ("plane", "\"1e-4 kg·m²\"".to_owned(), "[1, 0]", ""),
            ("space", format!("[{}]", ["\"1e-4 kg·m²\""; 3].join(", ")), "[1, 0, 0]", "axis = [0, 0, 1]"),
        ] {
            let zero = if space == "plane" { "[0, 0]" } else { "[0, 0, 0]" };
            let text = format!(
                "[mechanism]\nspace = \"{space}\"\n[[body]]\nname = \"b\"\nmass = 100\ninertia = {inertia}\ncentre = {zero}\n\
                 [[joint]]\nname = \"j\"\nkind = \"prismatic\"\nbetween = [\"b\", \"frame\"]\nat = {zero}\naxis = {axis}\n\
                 [[drive]]\nname = \"d\"\nturns = \"b\"\n{held}\ngain = 10\nramp_start = {start}\nramp_end = {end}\nspeed = 5\n\
                 [run]\nduration = 300\n"
            );
            let mechanism = SceneFile::parse("held", &text, &[]).unwrap().mechanism.unwrap();
            let run = simulated(&mechanism, 1e-3);
            let drive = mechanism.drives[0].drive;
            for (t, torque) in column(&run, "t (s)").iter().zip(column(&run, "d.torque (N·m)")) {
                let expected = drive.force(*t, 0.0);
                assert!((torque - expected).abs() < 1e-9, "{space} {start} {t}: {torque}, not {expected}");
            }
        }
    }
}

/// What is said of a run bounds its error in each column, here against a run at a thousandth of its tolerance.
#[test]
fn a_run_at_a_tenth_tells_how_far_every_column_is_off() {
    for name in ["slider-crank", "slider-crank-guide", "four-bar", "hatch", "woodpecker-toy"] {
        let mut mechanism = SceneFile::parse(name, shipped(name).unwrap(), &[]).unwrap().mechanism.unwrap();
        let gaps = mechanism.gaps_at(&[0.0]).unwrap();
        for error in [1e-4, 1e-5] {
            mechanism.run.error = error;
            let one = run(&mechanism, &gaps, 1e-3).unwrap();
            let said = one.agreement(&finer(&mechanism, &gaps, 1e-3).unwrap(), &mechanism);
            mechanism.run.error = error / 1e3;
            let truth = one.agreement(&run(&mechanism, &gaps, 1e-3).unwrap(), &mechanism);
            assert!(said.share > 0.5 * truth.share, "{name} {error}: {said:?}, but {truth:?}");
            assert!(one.energy_excess < 2e-3, "{name} {error}: {}", one.energy_excess);
        }
    }
}
