//! Mechanisms from their shipped scenes against reference runs: adaptive Radau in f64 at rtol 1e-10, written independently of
//! this project, which a second formulation with its own contact geometry agrees with to 6e-7 of the peaks.

mod energy;
mod random;

use slipfit::{
    mechanism::{Mechanism, MechanismRun, run},
    scene::{Override, SceneFile, shipped},
};
use slipfit_tests::known_runs::mechanism_rows;

/// A reference run, and the scene with the changes that lead to it.
struct Case {
    file: &'static str,
    scene: &'static str,
    set: &'static [&'static str],
    every: f64,
    /// Our column for each of the file's, and what the file's is at our zero.
    columns: &'static [(&'static str, f64)],
}

const MOTOR: &str = "motor.torque (N·m)";

/// Columns of a crank, a rod and a slider.
const CRANK: &[(&str, f64)] = &[
    (MOTOR, 0.0),
    ("crank.spin (rad/s)", 0.0),
    ("crank.angle (rad)", 0.0),
    ("rod.angle (rad)", 0.0),
    ("slider.x (m)", 0.17),
    ("rod.spin (rad/s)", 0.0),
    ("slider.vx (m/s)", 0.0),
];
const GUIDE: &[(&str, f64)] = &[
    (MOTOR, 0.0),
    ("crank.spin (rad/s)", 0.0),
    ("crank.angle (rad)", 0.0),
    ("rod.angle (rad)", 0.0),
    ("slider.angle (rad)", 0.0),
    ("rod.spin (rad/s)", 0.0),
    ("slider.spin (rad/s)", 0.0),
];
const FOUR_BAR: &[(&str, f64)] = &[
    (MOTOR, 0.0),
    ("crank.spin (rad/s)", 0.0),
    ("crank.angle (rad)", 0.5),
    ("coupler.angle (rad)", 0.5934207680504567),
    ("rocker.angle (rad)", 1.6976808802901244),
    ("coupler.spin (rad/s)", 0.0),
    ("rocker.spin (rad/s)", 0.0),
];
const BIRD: &[(&str, f64)] = &[
    ("sleeve.y (m)", 0.0),
    ("sleeve.vy (m/s)", 0.0),
    ("sleeve.angle (rad)", 0.0),
    ("sleeve.spin (rad/s)", 0.0),
    ("bird.angle (rad)", 0.0),
    ("bird.spin (rad/s)", 0.0),
];
const CARRIAGE: &[(&str, f64)] = &[
    ("motor.force (N)", 0.0),
    ("carriage.vz (m/s)", 0.0),
    ("carriage.x (m)", 0.0),
    ("carriage.y (m)", 0.0),
    ("carriage.z (m)", 0.0),
    ("carriage.ax (rad)", 0.0),
    ("carriage.ay (rad)", 0.0),
    ("carriage.az (rad)", 0.0),
];
const DRAWER: &[(&str, f64)] = &[
    ("motor.force (N)", 0.0),
    ("drawer.vz (m/s)", 0.0),
    ("intermediate.x (m)", 0.0),
    ("intermediate.y (m)", 0.0),
    ("intermediate.z (m)", 0.0),
    ("intermediate.ax (rad)", 0.0),
    ("intermediate.ay (rad)", 0.0),
    ("intermediate.az (rad)", 0.0),
    ("drawer.x (m)", 0.0),
    ("drawer.y (m)", 0.0),
    ("drawer.z (m)", 0.0),
    ("drawer.ax (rad)", 0.0),
    ("drawer.ay (rad)", 0.0),
    ("drawer.az (rad)", 0.0),
];

const CASES: [Case; 12] = [
    Case { file: "P1-slow", scene: "slider-crank", set: &[], every: 1e-3, columns: CRANK },
    Case {
        file: "P1-fast",
        scene: "slider-crank",
        set: &[
            "contact.stiffness=1e9 N/m^1.5",
            "friction.coefficient=0.05",
            "joint.big end.clearance=[0.5, 0]",
            "drive.motor.gain=0.5",
            "drive.motor.speed=100",
            "run.duration=200",
        ],
        every: 1e-4,
        columns: CRANK,
    },
    Case { file: "P2-driven", scene: "slider-crank-guide", set: &[], every: 1e-3, columns: GUIDE },
    Case {
        file: "P2-free",
        scene: "slider-crank-guide",
        set: &[
            "contact.stiffness=1e8 N/m^1.5",
            "contact.damping=600 N·s/m",
            "contact.depth=0.01",
            "friction.coefficient=0.01",
            "joint.guide.clearance=[1, 0]",
            "drive.motor.gain=0",
            "body.crank.spin=150",
            "body.rod.spin=-75",
            "body.slider.spin=-0.01",
            "body.slider.angle=0",
            "body.slider.inertia=2.7e-6 kg·m²",
            "run.duration=20",
            // The slider tilts by 26 µrad at most: a thousandth of that needs a finer run.
            "run.error=1e-8",
        ],
        every: 1e-4,
        columns: GUIDE,
    },
    Case { file: "P3-slow", scene: "four-bar", set: &[], every: 1e-3, columns: FOUR_BAR },
    Case {
        file: "P3-fast",
        scene: "four-bar",
        set: &[
            "contact.stiffness=1e9 N/m^1.5",
            "contact.damping=300 N·s/m",
            "friction.coefficient=0.05",
            "joint.rocker pin.clearance=[0.5, 0]",
            "drive.motor.gain=0.5",
            "drive.motor.speed=80",
            "run.duration=200",
        ],
        every: 1e-4,
        columns: FOUR_BAR,
    },
    Case { file: "S3-ticks", scene: "woodpecker-toy", set: &[], every: 1e-3, columns: BIRD },
    Case {
        file: "S3-soft",
        scene: "woodpecker-toy",
        set: &[
            "contact.stiffness=1e6 N/m^1.5",
            "contact.damping=3 N·s/m",
            "joint.beak.contact.stiffness=1e6 N/m^1.5",
            "joint.beak.contact.damping=1 N·s/m",
            "friction.stick_band=1",
        ],
        every: 1e-3,
        columns: BIRD,
    },
    Case { file: "S1-runs", scene: "linear-guide", set: &[], every: 1e-3, columns: CARRIAGE },
    Case {
        file: "S1-jams",
        scene: "linear-guide",
        set: &["drive.motor.point=[150, 0, 0]"],
        every: 1e-3,
        columns: CARRIAGE,
    },
    Case { file: "S2-first", scene: "telescopic-drawer", set: &["run.stroke=1000"], every: 1e-3, columns: DRAWER },
    Case { file: "S2-carried", scene: "telescopic-drawer", set: CARRIED, every: 1e-3, columns: DRAWER },
];

/// Preload of the inner stage carries the intermediate along.
const CARRIED: &[&str] = &[
    "run.stroke=1000",
    "friction.coefficient=0.15",
    "drive.motor.point=[-20, 0, 50]",
    "joint.outer left back.rail=[0.1, 0]",
    "joint.outer right back.rail=[0.1, 0]",
    "joint.outer left front.rail=[0.1, 0]",
    "joint.outer right front.rail=[0.1, 0]",
    "joint.outer left back.wall=[0.3, 0]",
    "joint.outer right back.wall=[0.3, 0]",
    "joint.outer left front.wall=[0.3, 0]",
    "joint.outer right front.wall=[0.3, 0]",
    "joint.inner left back.left=[-0.04, 0]",
    "joint.inner right back.left=[-0.04, 0]",
    "joint.inner left front.left=[-0.04, 0]",
    "joint.inner right front.left=[-0.04, 0]",
    "joint.inner left back.right=[-0.03, 0]",
    "joint.inner right back.right=[-0.03, 0]",
    "joint.inner left front.right=[-0.03, 0]",
    "joint.inner right front.right=[-0.03, 0]",
    "joint.inner left back.rail=[-0.03, 0]",
    "joint.inner right back.rail=[-0.03, 0]",
    "joint.inner left front.rail=[-0.03, 0]",
    "joint.inner right front.rail=[-0.03, 0]",
    "joint.inner left back.wall=[-0.02, 0]",
    "joint.inner right back.wall=[-0.02, 0]",
    "joint.inner left front.wall=[-0.02, 0]",
    "joint.inner right front.wall=[-0.02, 0]",
];

fn mechanism(scene: &str, set: &[&str]) -> Mechanism {
    let overrides: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    let file = SceneFile::parse(scene, shipped(scene).unwrap(), &overrides).unwrap_or_else(|error| panic!("{error}"));
    file.mechanism.unwrap()
}

/// The unit with its mean gaps.
fn mean_unit(mechanism: &Mechanism, every: f64) -> MechanismRun {
    run(mechanism, &mechanism.gaps_at(&[0.0]).unwrap(), every).unwrap()
}

/// The greatest errors of each column, as a share of its peak. In space displacements and rotations count against the
/// greatest of the body's three.
fn errors(case: &Case, run: &MechanismRun) -> Vec<f64> {
    let expected = mechanism_rows(case.file);
    assert_eq!(expected.len(), run.samples.rows.len(), "{}", case.file);
    let column =
        |name: &str| run.samples.columns.iter().position(|one| one == name).unwrap_or_else(|| panic!("{name}"));
    let spatial = case.columns.len() == CARRIAGE.len() || case.columns.len() == DRAWER.len();
    let peak = |k: usize| expected.iter().fold(0.0, |peak: f64, row| peak.max(row[k].abs()));
    case.columns
        .iter()
        .enumerate()
        .map(|(k, (name, zero))| {
            let j = column(name);
            let error = expected.iter().zip(&run.samples.rows).map(|(row, found)| (row[k] - zero - found[j]).abs());
            let error = error.fold(0.0, f64::max);
            let first = 2 + (k.max(2) - 2) / 3 * 3;
            let peak = if spatial && k >= 2 { (first..first + 3).map(peak).fold(0.0, f64::max) } else { peak(k) };
            if peak > 0.0 { error / peak } else { error }
        })
        .collect()
}

#[test]
fn every_reference_run_is_met_within_a_thousandth_of_each_peak() {
    for case in &CASES {
        let mechanism = mechanism(case.scene, case.set);
        let run = mean_unit(&mechanism, case.every);
        let errors = errors(case, &run);
        let worst = errors.iter().fold(0.0, |worst: f64, error| worst.max(*error));
        println!("{:10} {worst:9.1e} {:?} {:?}", case.file, run.effort, run.integration);
        assert!(worst <= 1e-3, "{}: {errors:?}", case.file);
    }
}

/// The published free flight: no contact until 2.69 ms.
#[test]
fn a_thrown_slider_crank_flies_as_published() {
    let case = CASES.iter().find(|case| case.file == "P2-free").unwrap();
    let run = mean_unit(&mechanism(case.scene, case.set), 1e-3);
    let at = |name: &str| {
        let column = run.samples.columns.iter().position(|one| one == name).unwrap();
        run.samples.rows[1][column]
    };
    assert!((at("crank.angle (rad)") - 0.146090844).abs() < 1e-8);
    let spin = at("crank.spin (rad/s)");
    assert!((spin / 139.115876 - 1.0).abs() < 2e-7, "{spin}");
}
