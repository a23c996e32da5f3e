//! Controllers that sample, with and without a position loop, against their difference equations.

use super::common::{slipfit, stdout};
use super::{MASS, STAGE, columns, planar};

/// The stage under a controller with these lines.
fn sampled(drive: &str) -> slipfit::mechanism::MechanismRun {
    planar(&format!("{STAGE}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\n{drive}"), &[])
}

/// A double integrator under a sampling controller: position (m), speed (m/s) and force (N) at each sample.
fn iterated(period: f64, samples: usize, mut force: impl FnMut(f64, f64, f64) -> f64) -> Vec<[f64; 3]> {
    let (mut x, mut v) = (0.0, 0.0);
    let step = |k: usize| {
        let f = force(period * k as f64, x, v);
        let now = [x, v, f];
        x += period * (v + 0.5 * period * f / MASS);
        v += period * f / MASS;
        now
    };
    (0..samples).map(step).collect()
}

/// Compares a run with its difference equation at every sample; every sample is a row or every so many rows are a sample.
fn compare(run: &slipfit::mechanism::MechanismRun, expected: &[[f64; 3]], rows: usize, gain: f64) {
    let names = ["t (s)", "stage.x (m)", "stage.vx (m/s)", "motor.force (N)"];
    for (k, [t, x, v, force]) in columns(run, names).into_iter().step_by(rows).enumerate().take(expected.len()) {
        let [position, speed, effort] = expected[k];
        assert!((x - position).abs() < 1e-7, "{t}: {x} {position}");
        assert!((v - speed).abs() < 1e-6, "{t}: {v} {speed}");
        // The error of a speed times the gain.
        assert!((force - effort).abs() < 2e-5 * gain, "{t}: {force} {effort}");
    }
}

/// K·T/m = 2.2: every sample overshoots by more than the error, until the limit alone acts: a speed that swings by L·T/m each period.
#[test]
fn a_sampled_speed_loop_with_too_much_gain_swings_within_its_limit() {
    let (gain, limit, period, speed) = (440.0, 25.0, 0.01, 0.05);
    let run = sampled(&format!(
        "gain = \"{gain} N·s/m\"\nramp_start = -1\nramp_end = 0\nspeed = {}\nlimit = {limit}\nsampling = {period}\n",
        1e3 * speed
    ));
    let expected = iterated(period, 100, |_, _, v| (gain * (speed - v)).clamp(-limit, limit));
    compare(&run, &expected, 10, gain);
    let speeds: Vec<f64> = columns(&run, ["stage.vx (m/s)"]).into_iter().map(|[v]| v).skip(500).step_by(10).collect();
    let swing = limit * period / MASS;
    assert!(speeds.windows(2).all(|two| ((two[1] - two[0]).abs() - swing).abs() < 1e-6), "{speeds:?}");
}

#[test]
fn a_position_loop_follows_its_command_as_its_difference_equation_does() {
    let (gain, position_gain, period) = (100.0, 20.0, 0.002);
    for (measures, differentiates, limit) in
        [("", false, 1e12), ("measures = \"position\"\n", true, 1e12), ("", false, 2.0)]
    {
        let limited = if limit < 1e9 { format!("limit = {limit}\n") } else { String::new() };
        let run = sampled(&format!(
            "gain = \"{gain} N·s/m\"\nposition_gain = {position_gain}\nsampling = {period}\n{measures}{limited}\
             segment = [{{ kind = \"ramp\", speed = 100, duration = 0.2 }}, {{ kind = \"hold\", duration = 0.3 }},\n\
             {{ kind = \"ramp\", speed = 0, acceleration = 1 }}]\n"
        ));
        // The commanded distance: the cubic STEP's integral is V·T·(s³ − s⁴/2).
        let travel = |t: f64| {
            let (rise, fall) = (0.2, 0.1);
            let s = (t / rise).min(1.0);
            let held = (t - rise).clamp(0.0, 0.3);
            let down = (t - 0.5).clamp(0.0, fall);
            0.1 * rise * (s * s * s - 0.5 * s * s * s * s) + 0.1 * held + 0.1 * down - 0.5 * down * down
        };
        let mut last: Option<f64> = None;
        let expected = iterated(period, 450, |t, x, v| {
            let speed = match last.filter(|_| differentiates) {
                Some(last) => (x - last) / period,
                None => v,
            };
            last = Some(x);
            (gain * (position_gain * (travel(t) - x) - speed)).clamp(-limit, limit)
        });
        compare(&run, &expected, 2, gain);
    }
}

/// The force of a limited position loop with too much gain swings between its limits: a double integrator that is pushed to and fro.
#[test]
fn a_position_loop_that_is_too_stiff_comes_to_a_saturated_limit_cycle() {
    let (gain, position_gain, period, limit) = (400.0, 200.0, 0.005, 8.0);
    let run = sampled(&format!(
        "gain = \"{gain} N·s/m\"\nposition_gain = {position_gain}\nsampling = {period}\nmeasures = \"position\"\nlimit = {limit}\n\
         ramp_start = 0\nramp_end = 0.05\nspeed = 10\n"
    ));
    let (mut last, mut swings) = (None, Vec::new());
    let ramp = |t: f64| {
        let s = (t / 0.05).min(1.0);
        0.01 * (0.05 * (s * s * s - 0.5 * s * s * s * s) + (t - 0.05).max(0.0))
    };
    let expected = iterated(period, 200, |t, x, v| {
        let speed = last.map_or(v, |last| (x - last) / period);
        last = Some(x);
        let force = (gain * (position_gain * (ramp(t) - x) - speed)).clamp(-limit, limit);
        swings.push(force);
        force
    });
    compare(&run, &expected, 5, gain);
    let saturated = swings[100..].iter().filter(|force| force.abs() == limit).count();
    assert!(saturated > 60, "{saturated} of 100 samples at the limit");
    // Neither is a motion that nothing supplied the energy for.
    assert!(run.energy_excess < 1e-3, "{}", run.energy_excess);
}

#[test]
fn a_prescribed_motion_tells_the_force_that_it_takes() {
    let scene = |space: &str, three: &str| {
        format!(
            "mechanism = {{ space = \"{space}\" }}\n{}[[spring]]\nname = \"return\"\nbetween = [\"frame\", \"stage\"]\n\
             ends = [[-200, 0{three}], [0, 0{three}]]\nstiffness = \"40 N/m\"\nfree_length = 200\n\
             [[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0{three}]\nmotion = \"prescribed\"\nviscous = \"3 N·s/m\"\n\
             segment = [{{ kind = \"sine\", amplitude = 80, frequency = 2, duration = 1 }}]\n",
            STAGE
                .replace("centre = [0, 0]", &format!("centre = [0, 0{three}]"))
                .replace("at = [0, 0]", &format!("at = [0, 0{three}]"))
                .replace("axis = [1, 0]", &format!("axis = [1, 0{three}]"))
                .replace("inertia = 1e6", if three.is_empty() { "inertia = 1e6" } else { "inertia = [1e6, 1e6, 1e6]" })
        )
    };
    for (space, three) in [("plane", ""), ("space", ", 0")] {
        let run = super::ran(&scene(space, three), &[]);
        let omega = 4.0 * std::f64::consts::PI;
        for [t, x, v, force] in columns(&run, ["t (s)", "stage.x (m)", "stage.vx (m/s)", "motor.force (N)"]) {
            let (place, speed) = (0.08 / omega * (1.0 - libm::cos(omega * t)), 0.08 * libm::sin(omega * t));
            let expected = MASS * 0.08 * omega * libm::cos(omega * t) + 3.0 * speed + 40.0 * place;
            assert!((x - place).abs() < 1e-6 && (v - speed).abs() < 2e-6, "{space} {t}: {x} {place} {v} {speed}");
            // Its first instants start from rest.
            assert!(t < 0.002 || (force - expected).abs() < 2e-3, "{space} {t}: {force} {expected}");
        }
    }
}

#[test]
fn a_recorded_command_is_commanded_as_stated() {
    let folder = tempfile::tempdir().unwrap();
    let omega = 10.0;
    let rows = (0..=500).map(|k| {
        let t = 0.002 * f64::from(k);
        format!("{t},{},{}\n", 3.0 + 50.0 / omega * (1.0 - libm::cos(omega * t)), 50.0 * libm::sin(omega * t))
    });
    let text = "time (s),place (mm),rate (mm/s)\n".to_owned() + &rows.collect::<String>();
    std::fs::write(folder.path().join("run.csv"), text).unwrap();
    let scene = |drive: &str| {
        format!(
            "mechanism = {{ space = \"plane\" }}\n{STAGE}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\n{drive}\n"
        )
    };
    let acceleration = |t: f64| MASS * 0.05 * omega * libm::cos(omega * t);
    let place = |k: f64| 0.05 / omega * (1.0 - libm::cos(omega * 0.002 * k));
    // A position loop and a held speed answer to the steps and bends of their records as well.
    let looped = |gain: f64, position_gain: f64, held: bool| {
        let all = iterated(0.0005, 2000, |t, x, v| {
            let at = t / 0.002 + 1e-9;
            let (k, share) = (libm::floor(at), if held { 0.0 } else { at - libm::floor(at) });
            let position = place(k) + share * (place(k + 1.0) - place(k));
            gain * (position_gain * (position - x) - v)
        });
        all.into_iter().step_by(4).map(|[_, _, force]| force).collect::<Vec<_>>()
    };
    let stepped = |gain: f64| {
        let (mut v, decay) = (0.0, libm::exp(-gain * 0.002 / MASS));
        let force = |k: u32| {
            let command = 0.05 * libm::sin(omega * 0.002 * f64::from(k));
            let force = gain * (command - v);
            v = command + (v - command) * decay;
            force
        };
        (0..500).map(force).collect::<Vec<_>>()
    };
    let smooth = (0..500).map(|k| acceleration(0.002 * f64::from(k))).collect::<Vec<_>>();
    for (record, motion, expected, most) in [
        ("position = \"place\"", "motion = \"prescribed\"", &smooth, 1e-3),
        ("speed = \"rate\", interpolation = \"cubic\"", "motion = \"prescribed\"", &smooth, 1e-3),
        ("speed = \"rate\", interpolation = \"linear\"", "motion = \"prescribed\"", &smooth, 1e-2),
        (
            "position = \"place\"",
            "gain = \"400 N·s/m\"\nposition_gain = 20\nsampling = 0.0005",
            &looped(400.0, 20.0, false),
            1e-3,
        ),
        (
            "position = \"place\", interpolation = \"held\"",
            "gain = \"400 N·s/m\"\nposition_gain = 20\nsampling = 0.0005",
            &looped(400.0, 20.0, true),
            1e-3,
        ),
        ("speed = \"rate\", interpolation = \"held\"", "gain = \"400 N·s/m\"", &stepped(400.0), 1e-3),
    ] {
        let scene = scene(&format!("record = {{ file = \"run.csv\", {record} }}\n{motion}"));
        std::fs::write(folder.path().join("stage.toml"), scene).unwrap();
        stdout(&slipfit(folder.path(), &["simulate", "stage.toml", "--csv", "out.csv", "--every", "2"]));
        let written = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
        let forces = written.lines().skip(1).map(|row| row.split(',').nth(1).unwrap().parse::<f64>().unwrap());
        let (mut squares, mut count) = (0.0, 0.0);
        for (force, expected) in forces.zip(expected).skip(50).take(430) {
            squares += (force - expected) * (force - expected);
            count += 1.0;
        }
        let rms = libm::sqrt(squares / count);
        assert!(count == 430.0 && rms < most, "{record} {motion}: {rms} N of {} N", acceleration(0.0));
    }
}

#[test]
fn what_cannot_be_prescribed_or_recorded_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |speed: fn(f64) -> f64| {
        let row = |k: u32| format!("{},{},0\n", 0.01 * f64::from(k), speed(0.01 * f64::from(k)));
        "t (s),speed (mm/s),current (A)\n".to_owned() + &(0..50).map(row).collect::<String>()
    };
    std::fs::write(folder.path().join("moving.csv"), rows(|t| 50.0 + t)).unwrap();
    std::fs::write(folder.path().join("resting.csv"), rows(|t| 50.0 * t)).unwrap();
    for (drive, expected) in [
        ("motion = \"prescribed\"\nrecord = { file = \"moving.csv\", speed = \"speed\" }", "it begins in motion"),
        ("motion = \"prescribed\"\nramp_start = -1\nramp_end = 0.1\nspeed = 10", "has begun before the run"),
        (
            "motion = \"prescribed\"\nramp_start = 0\nramp_end = 0.1\nspeed = 10\nlimit = 3",
            "`drive.limit` has no effect",
        ),
        ("gain = 1\nrecord = { file = \"resting.csv\", position = \"speed\" }", "is in \"mm/s\""),
        (
            "gain = 1\nsampling = 0.001\nramp_start = 0\nramp_end = 1\nspeed = 10\nmeasures = \"force\"",
            "speed, position",
        ),
        ("gain = 1\nrecord = { file = \"resting.csv\", speed = \"speed\" }\nspeed = 10", "`drive.speed` has no effect"),
        ("motion = \"prescribed\"\nrecord = { file = \"resting.csv\", speed = \"speed\" }", ""),
    ] {
        let scene = format!(
            "mechanism = {{ space = \"plane\" }}\n{STAGE}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\n{drive}\n"
        );
        std::fs::write(folder.path().join("stage.toml"), scene).unwrap();
        let output = slipfit(folder.path(), &["simulate", "stage.toml"]);
        let errors = String::from_utf8(output.stderr).unwrap();
        let is_right = if expected.is_empty() { output.status.success() } else { output.status.code() == Some(2) };
        assert!(is_right && errors.contains(expected), "{drive}: {errors}");
    }
}
