//! Drives, springs, friction and walls of scenes against closed forms.

#[path = "../common/mod.rs"]
mod common;
mod drives;
mod friction;
mod refused;
mod sampled;
mod springs;
mod verdicts;
mod walls;

use slipfit::{
    mechanism::{MechanismRun, run},
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

/// Whether the stage moves with the speed (m/s) that `speed` says at each time (s), and its motor gives `force` (N).
fn follows(run: &MechanismRun, most: [f64; 2], speed: impl Fn(f64) -> f64, force: impl Fn(f64, f64) -> f64) {
    for [t, vx, effort] in columns(run, ["t (s)", "stage.vx (m/s)", "motor.force (N)"]) {
        assert!((vx - speed(t)).abs() < most[0], "{t}: {vx} {}", speed(t));
        assert!((effort - force(t, vx)).abs() < most[1], "{t}: {effort} {}", force(t, vx));
    }
}
