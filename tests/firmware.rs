//! The firmware image on the emulated Cortex-M4F: the same text, and so the same bits, as on the host, and as many
//! instructions as recorded.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    sync::LazyLock,
};

use slipfit::flash::{AxisSpec, ChannelSpec, TableSpec, encode};
use slipfit_core::{
    integrator::ImplicitEuler,
    kernel::Kernel,
    pose::Pose,
    table::{AxisKind, Encoding},
};
use slipfit_problems::cd_rom;
use slipfit_tests::cross::{self, TARGET, cargo, printed};

const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");

/// The compiler of the recorded counts. Another one's may differ by [`TOLERANCE`].
const RECORDED_WITH: &str = "rustc 1.95.";

/// How many times the recorded instructions another compiler's image may take.
const TOLERANCE: f64 = 1.1;

static TABLE: LazyLock<PathBuf> = LazyLock::new(|| {
    let file = Path::new(FOLDER).join("firmware.bin");
    fs::write(&file, table()).expect("the test's folder takes files");
    file
});

/// What the image printed with the table in its flash.
static ON_TARGET: LazyLock<String> = LazyLock::new(|| on_target(Some(&TABLE)));

#[test]
fn image_and_host_print_the_same() {
    same_text(&on_host(Some(&TABLE)), &ON_TARGET);
}

#[test]
fn without_a_table_both_say_so_and_go_on() {
    let target = on_target(None);
    assert!(target.contains("no table: ") && target.ends_with("done\n"), "{target}");
    same_text(&on_host(None), &target);
}

#[test]
fn the_table_agrees_with_the_kernel() {
    let mut forces = 0;
    for block in ON_TARGET.split("\n\n").filter(|block| block.starts_with("n = ")) {
        // Beyond the table's last level it holds what it has there.
        let clamped = block.starts_with("n = 5\n");
        for line in block.lines().skip(2) {
            if let [_, kernel, table] = line.split_whitespace().flat_map(str::parse).collect::<Vec<f64>>()[..] {
                assert!(clamped || (kernel - table).abs() < 0.01, "{block}");
                forces += 1;
            }
        }
        assert!(block.contains(if clamped { " 200 clamped" } else { " 0 clamped" }), "{block}");
    }
    assert_eq!(forces, 60);
}

#[test]
fn every_step_takes_the_recorded_instructions() {
    let counts: String = ON_TARGET.lines().filter(|line| is_count(line)).flat_map(|line| [line, "\n"]).collect();
    let step = counts.lines().find(|line| line.starts_with("instructions of a step: "));
    assert!(step.is_some_and(|step| step.ends_with(", the same every time")), "{counts}");

    let compiler = printed(Command::new("rustc").arg("--version"));
    if compiler.starts_with(RECORDED_WITH) {
        insta::assert_snapshot!("counts", counts);
    } else {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots/firmware__counts.snap");
        let recorded = fs::read_to_string(file).expect("the counts are recorded");
        let recorded: Vec<_> = recorded.lines().filter(|line| is_count(line)).flat_map(number).collect();
        let found: Vec<_> = counts.lines().flat_map(number).collect();
        assert_eq!(found.len(), recorded.len(), "{counts}");
        for (found, recorded) in found.into_iter().zip(recorded) {
            assert!(found <= recorded * TOLERANCE, "{compiler}{RECORDED_WITH}: {recorded}\n{counts}");
        }
    }
}

/// A line that only the image has.
fn is_count(line: &str) -> bool {
    line.starts_with("instructions ") || line.starts_with("stack ")
}

/// The first number of `line`.
fn number(line: &str) -> Option<f64> {
    line.split([' ', ',']).find_map(|word| word.parse().ok())
}

/// Fails at the first line that differs, leaving out those that only the image has.
fn same_text(host: &str, target: &str) {
    let mut target_lines = target.lines().filter(|line| !is_count(line));
    for line in host.lines() {
        assert_eq!(
            Some(line),
            target_lines.next(),
            "host on the left, image on the right; all of the image's:\n{target}"
        );
    }
    assert_eq!(None, target_lines.next());
}

/// What the program's host build prints.
fn on_host(table: Option<&Path>) -> String {
    printed(cargo(FOLDER).args(["run", "-p", "slipfit-firmware", "--"]).args(table))
}

/// What the image prints on the emulator.
fn on_target(table: Option<&Path>) -> String {
    cross::require_target();
    cross::require_emulator();
    printed(cargo(FOLDER).args(["run", "--release", "-p", "slipfit-firmware", "--target", TARGET, "--"]).args(table))
}

/// A table over n from −3 to 4 and the 200 ms of the opening.
fn table() -> Vec<u8> {
    const LEVELS: usize = 15;
    const STEPS: usize = 200;
    let (first, between, step) = (-3.0, 0.5, 1e-3);
    let (mut force, mut velocity) = (Vec::new(), Vec::new());
    for level in 0..LEVELS {
        let slide = cd_rom::slide(first + between * level as f32);
        let kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(slide, step).expect("the step is in bounds");
        let mut state = kernel.at_rest(Pose::nominal());
        for _ in 0..=STEPS {
            let v = state.motion.velocity.z;
            force.push(kernel.mechanism().drive().force(kernel.time(state.steps), v));
            velocity.push(v);
            kernel.step(&mut state);
        }
    }
    encode(&TableSpec {
        scene_hash: 0,
        axes: vec![
            AxisSpec { kind: AxisKind::Level, first, step: between, count: LEVELS },
            AxisSpec { kind: AxisKind::Time, first: 0.0, step, count: STEPS + 1 },
        ],
        force: ChannelSpec { values: force, encoding: Encoding::F32, worst_error: 0.0 },
        velocity: ChannelSpec { values: velocity, encoding: Encoding::I16, worst_error: 0.0 },
    })
    .expect("the table fits")
}
