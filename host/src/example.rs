//! The paper's slide as a scene and really simulated sweeps of it, for the tests of plots and reports.

use slipfit_core::{
    Vector3,
    clearance::{GapClass, GapStatistics},
    drive::Drive,
    integrator::Sdirk2,
    kernel::Kernel,
    menu::{ContactData, FrictionData},
    pose::Pose,
};
use slipfit_problems::cd_rom;

use crate::{
    outcome::{Outcome, Trajectory, Verdict},
    scene::{IntegratorKind, LevelRange, PinSpec, RunSpec, Scene, SlideSpec},
    sweep::{Level, Sweep},
};

/// The scene of the paper.
pub fn cd_rom() -> Scene {
    let names = ["left back", "right back", "left front", "right front"];
    let gap = |i: usize| {
        let [mean, deviation] = cd_rom::TABLE_2[i];
        Some(GapStatistics { mean: mean / 1e3, deviation: deviation / 1e3 })
    };
    Scene {
        title: "CD-ROM slide".to_owned(),
        slide: SlideSpec { mass: 0.0818, inertia_box: [0.13, 0.012, 0.15], gravity: [0.0, -9.81, 0.0] },
        contact: ContactData { stiffness: cd_rom::STIFFNESS, exponent: 1.5, damping: 1e3, depth: 1e-4 },
        friction: FrictionData::Regularised { coefficient: 0.3, stick_band: cd_rom::STICK_BAND },
        drive: Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() },
        pins: [0, 1, 2, 3].map(|i| PinSpec {
            name: names[i].to_owned(),
            position: [[-0.062, 0.062][i % 2], 0.0, [-0.018, 0.018][i / 2]],
            gaps: [0, 1, 2, 3].map(|k| gap(4 * i + k)),
        }),
        nominal_clearance: Some([4e-4, 4e-4]),
        run: RunSpec { duration: 0.2, step: 1e-4, integrator: IntegratorKind::Sdirk2 },
        sweep: LevelRange { first: 0.0, step: 0.5, count: 11 },
    }
}

/// The paper's slide at `levels` for `duration` (s), the ramp ending at `ramp_end` (s).
pub fn sweep(levels: LevelRange, duration: f64, ramp_end: f64) -> Sweep {
    Sweep { levels: levels.levels().into_iter().map(|n| level(n, duration, ramp_end)).collect() }
}

fn level(n: f64, duration: f64, ramp_end: f64) -> Level {
    const STEP: f64 = 1e-4;
    let mut data = cd_rom::data(n);
    data.drive.ramp_end = ramp_end;
    let kernel = Kernel::<f64, _, Sdirk2<5>>::new(cd_rom::from_data(&data), STEP).unwrap();
    let mut state = kernel.at_rest(Pose::nominal());
    let mut trajectory = Trajectory::default();
    for i in 0..=(duration / STEP).round() as usize {
        if i % 10 == 0 {
            let (t, vz) = (kernel.time(state.steps), state.motion.velocity[2]);
            trajectory.t.push(t);
            trajectory.vz.push(vz);
            trajectory.force.push(data.drive.force(t, vz));
        }
        kernel.step(&mut state);
    }
    let outcome = outcome(&trajectory, data.drive.ramp_start, duration >= ramp_end);
    Level { n, trajectory, outcome, classes: data.body.gaps.map(|gap| Some(GapClass::of(gap))) }
}

/// As far as pictures need it.
fn outcome(run: &Trajectory, ramp_start: f64, ramp_over: bool) -> Outcome {
    let start = run.t.iter().position(|t| *t >= ramp_start).unwrap_or(0);
    let (vz, last) = (&run.vz, run.vz.len() - 1);
    let breakaway = (start + 1..=last).rev().find(|i| vz[*i] > 2e-4 && vz[i - 1] <= 2e-4).map(|i| run.t[i]);
    let verdict = match vz[last] {
        _ if !ramp_over => Verdict::Undecided,
        v if v >= 0.05 => Verdict::Runs,
        v if v >= 0.001 => Verdict::Crawls,
        _ => Verdict::Jammed,
    };
    let peak_force = run.force[start..].iter().fold(0.0, |peak: f64, force| peak.max(*force));
    let tail = &run.force[last.saturating_sub(20)..];
    let spread =
        tail.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)) - tail.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    let mean = tail.iter().sum::<f64>() / tail.len() as f64;
    let settled_force = (spread < 0.01 * mean).then_some(mean);
    Outcome { breakaway, peak_force, settled_force, final_velocity: vz[last], verdict }
}
