//! `slipfit fmu` as other simulators meet it: FMPy and the crate `fmi` read and step what is made, and have the kernel's bits.

mod common;
#[path = "common/fields.rs"]
mod fields;

use std::{
    fs,
    io::Read,
    path::{Path, PathBuf},
    process::{Command, Output},
    sync::LazyLock,
};

use common::{json, slipfit, stdout};
use fields::{check_object, guide};
use serde_json::{Value, json};

/// The program that looks at a unit with the crate `fmi`. Its versions are those of its own lock file, and once they are
/// downloaded it is built without a network.
static FMI_RS: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fmi-rs");
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/fmi-rs/Cargo.toml");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--locked", "--quiet", "--manifest-path", manifest, "--target-dir"]).arg(&folder);
    let output = cargo.env_remove("CARGO_BUILD_TARGET").output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    let hint = "where libclang is what is missing, to install it: apt-get install clang";
    assert!(output.status.success(), "{errors}\n{hint}");
    folder.join("debug").join(format!("slipfit-fmi-rs{}", std::env::consts::EXE_SUFFIX))
});

/// Has FMPy and the crate `fmi` look at `unit` beside what is expected of it.
#[track_caller]
fn check(unit: &Path, expected: &Value) {
    let python = |arguments: &[&str]| Command::new("python3").args(arguments).output().unwrap();
    let has_fmpy = python(&["-c", "import fmpy"]).status.success();
    assert!(has_fmpy, "python3 has no FMPy, to install it: python3 -m pip install fmpy");
    let file = unit.with_extension("json");
    fs::write(&file, expected.to_string()).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fmu/check.py");
    let output = python(&[script, unit.to_str().unwrap(), file.to_str().unwrap()]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = Command::new(&*FMI_RS).args([unit, &file]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Names of the files in the archive, in their order, and the description.
fn opened(unit: &Path) -> (Vec<String>, String) {
    let mut archive = zip::ZipArchive::new(fs::File::open(unit).unwrap()).unwrap();
    let names = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    let mut description = String::new();
    archive.by_name("modelDescription.xml").unwrap().read_to_string(&mut description).unwrap();
    (names, description)
}

/// What the controller's run of the slide is, with the `settings` of the scene or of the unit.
fn slide_rows(folder: &Path, settings: &[&str], set: &Value, first: &Value) -> Value {
    let run = json(folder, &[&["simulate", "--step", "1ms", "--json"], settings].concat());
    let columns = [("speed", "vz"), ("force", "force"), ("x", "x"), ("y", "y"), ("travel", "z")];
    // Numbers of 32 bits, which the reader of JSON misses by the last place of 64 at most.
    let sample = |column: &str, i: usize| f64::from(run["samples"][column][i].as_f64().unwrap() as f32);
    let row = |i: usize| columns.map(|(_, column)| sample(column, i));
    let rows: Vec<_> = (0..run["samples"]["t"].as_array().unwrap().len()).map(row).collect();
    assert_eq!(rows.len(), 201);
    json!({
        "step": 1e-3,
        "set": set,
        "columns": columns.map(|(name, _)| name),
        "rows": rows,
        "first": first,
        "refused": [["n", 1.0], ["command", 1e9], ["drive.gain", -1.0], ["load.x", 1e9], ["friction.coefficient", -0.1]],
    })
}

/// A command of 20,000 periods, arcs of parabolas there and back, and what the kernel of level `n` makes of it.
fn commanded(n: f32) -> Value {
    use slipfit::{firmware::kernel_source::scene_data, scene::CD_ROM_SLIDE, setup::Scene};
    use slipfit_core::{drive::Commandable as _, integrator::ImplicitEuler, kernel::Kernel, pose::Pose};
    let scene = Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).unwrap();
    let slide = slipfit_problems::cd_rom::from_data(&scene_data(&scene).at(n).unwrap());
    let mut kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(slide, 1e-3).unwrap();
    let mut state = kernel.at_rest(Pose::nominal());
    let (mut speeds, mut rows) = (Vec::new(), Vec::new());
    for period in 0..20_000 {
        let speed = slipfit_problems::arcs(0.08, period, 800);
        kernel.mechanism_mut().drive_mut().set_command(speed);
        let _ = kernel.step(&mut state);
        let (velocity, place) = (state.motion.velocity, state.motion.pose.displacement_w);
        let force = kernel.mechanism().drive().force(kernel.time(state.steps), velocity.z);
        speeds.push(f64::from(speed));
        rows.push([velocity.z, force, place.x, place.y, place.z].map(f64::from));
    }
    json!({ "name": "command", "speeds": speeds, "rows": rows })
}

#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn a_slide_has_the_controllers_bits() {
    let folder = tempfile::tempdir().unwrap();
    let made = json(folder.path(), &["fmu", "-o", "my slide.fmu", "--json"]);
    check_object(&guide(), &made, "fmu", "fmu");
    let unit = folder.path().join("my slide.fmu");
    let (names, description) = opened(&unit);
    let library = format!(
        "binaries/{}-{}/my_slide{}",
        std::env::consts::ARCH,
        std::env::consts::OS,
        std::env::consts::DLL_SUFFIX
    );
    assert_eq!(names, ["modelDescription.xml", &library, "resources/scene.toml", "documentation/index.html"]);
    let token = made["token"].as_str().unwrap();
    let hash = json(folder.path(), &["kernel", "-o", "scene.rs", "--json"])["scene_hash"].clone();
    assert!(token.contains(hash.as_str().unwrap()) && description.contains(&format!("instantiationToken=\"{token}\"")));
    assert!(description.contains("fixedInternalStepSize=\"0.001\""));
    let tight = ["--n", "2.5"];
    let first = json!({ "distance.left back left": 6.4e-6 - 2.5 * 4.04e-5, "distance.right front wall": 5.778e-4 - 2.5 * 5.79e-5 });
    let mut expected = slide_rows(folder.path(), &tight, &json!({ "n": 2.5 }), &first);
    expected["commanded"] = commanded(2.5);
    check(&unit, &expected);
    // What a scene may say the importer may say too. A force at the centre of mass is as much more gravity.
    let scene = [
        "--set=friction.coefficient=0.2",
        "--set=drive.gain=0.03",
        "--set=drive.speed=80",
        "--set=pin.left back.left=[0.05, 0.0404]",
        "--set=slide.gravity=[0, -9.81, 2]",
        "--n=-1.5",
    ];
    let set = json!({
        "n": -1.5,
        "friction.coefficient": 0.2,
        "drive.gain": 30.0,
        "command": 0.08,
        "gap.left back left": 5e-5,
        "load.z": 2.0 * 0.0818,
    });
    check(&unit, &slide_rows(folder.path(), &scene, &set, &json!({})));
}

#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn a_mechanism_has_its_kernels_bits_in_version_2_too() {
    use slipfit_problems::mechanisms::slider_crank::{STEP, drive_motor, predictor};
    let folder = tempfile::tempdir().unwrap();
    stdout(&slipfit(folder.path(), &["fmu", "slider-crank", "--fmi", "2", "-o", "crank.fmu"]));
    let (names, description) = opened(&folder.path().join("crank.fmu"));
    assert!(names[1].starts_with("binaries/") && names[1].contains("64/crank."), "{names:?}");
    assert!(description.contains("fmiVersion=\"2.0\""));
    let (kernel, mut state) = predictor(1.5).unwrap();
    let mut rows = Vec::new();
    for _ in 0..=1000 {
        let motion = &state.motion;
        let now = drive_motor(kernel.mechanism(), kernel.time(state.steps), &motion.pose, &motion.velocity);
        rows.push([now.effort, now.speed].map(f64::from));
        let _ = kernel.step(&mut state);
    }
    assert_eq!(STEP, 1e-4);
    let expected = json!({
        "step": 1e-4,
        "set": { "n": 1.5 },
        "columns": ["torque.motor", "speed.motor"],
        "rows": rows,
        "first": { "distance.big end": 2e-4 - 1.5 * 2e-5, "angle.motor": 0.0 },
        "refused": [["gap.big end", 1e-4], ["command.motor", 1e9], ["gain.motor", -1.0]],
    });
    check(&folder.path().join("crank.fmu"), &expected);
}

/// Bodies on ideal joints in space.
#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn a_mechanism_on_joints_in_space_has_its_kernels_bits() {
    use slipfit_core::system::Bodies;
    use slipfit_problems::mechanisms::ball_rod::{STEP, drive_motor, predictor};
    let folder = tempfile::tempdir().unwrap();
    stdout(&slipfit(folder.path(), &["fmu", "ball-rod", "-o", "rod.fmu"]));
    let (kernel, mut state) = predictor(1.5).unwrap();
    let mut rows = Vec::new();
    for _ in 0..=1000 {
        let (unit, motion) = (kernel.mechanism(), &state.motion);
        let now = drive_motor(unit, kernel.time(state.steps), &motion.pose, &motion.velocity);
        let [_, rod, slide] = unit.bodies().placed(&motion.pose, &motion.velocity).free.bodies;
        rows.push([now.effort, now.speed, rod.displacement_w.z, slide.displacement_w.y].map(f64::from));
        let _ = kernel.step(&mut state);
    }
    assert!(rows[1000].iter().all(|number| number.abs() > 1e-4), "it moves: {:?}", rows[1000]);
    assert_eq!(STEP, 1e-4);
    let expected = json!({
        "step": 1e-4,
        "set": { "n": 1.5 },
        "columns": ["torque.motor", "speed.motor", "z.rod", "y.slide"],
        "rows": rows,
        "first": { "distance.upper ball left": 5e-5 - 1.5 * 1e-5, "distance.front": 5e-5 - 1.5 * 1e-5, "angle.motor": 0.0 },
        "refused": [["gap.front", 1e-4], ["command.motor", 1e9], ["gain.motor", -1.0]],
    });
    check(&folder.path().join("rod.fmu"), &expected);
}

#[track_caller]
fn refused(output: &Output, code: i32, why: &str, unit: &Path) {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{errors}");
    assert!(errors.contains(why), "{errors}");
    assert!(!unit.exists(), "{errors}");
}

#[test]
fn what_cannot_be_made_is_not_begun() {
    let folder = tempfile::tempdir().unwrap();
    let unit = folder.path().join("x.fmu");
    let run = |options: &[&str]| slipfit(folder.path(), &[&["fmu", "-o", "x.fmu"], options].concat());
    refused(&run(&["--set", "controller.scalar=f64"]), 2, "controller.scalar is f64", &unit);
    refused(&run(&["--scalar", "f32"]), 2, "unexpected argument '--scalar'", &unit);
    refused(&run(&["--core", "nowhere"]), 2, "--core: nowhere is not slipfit-core's folder", &unit);
    refused(&run(&["three-part-stack"]), 2, "the scene has neither a slide", &unit);
    refused(&run(&["--fmi", "1"]), 2, "--fmi", &unit);
    refused(&slipfit(folder.path(), &["fmu", "-o", "nowhere/x.fmu"]), 2, "cannot write", &unit);
    let mut without_cargo = Command::new(env!("CARGO_BIN_EXE_slipfit"));
    let output =
        without_cargo.current_dir(folder.path()).env("PATH", folder.path()).args(["fmu", "-o", "x.fmu"]).output();
    refused(&output.unwrap(), 1, "there is no cargo on the PATH", &unit);
    // A core that does not compile.
    fs::create_dir_all(folder.path().join("core/src")).unwrap();
    let manifest = "[package]\nname = \"slipfit-core\"\nversion = \"0.1.0\"\nedition = \"2024\"\n[workspace]\n";
    fs::write(folder.path().join("core/Cargo.toml"), manifest).unwrap();
    fs::write(folder.path().join("core/src/lib.rs"), "compile_error!(\"not today\");\n").unwrap();
    refused(&run(&["--core", "core"]), 1, "not today", &unit);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left behind");
}
