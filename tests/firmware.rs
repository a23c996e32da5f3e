//! The firmware image on the emulated Cortex-M4F: the same text, and so the same bits, as on the host, and as many
//! instructions as recorded.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use slipfit::{
    firmware::{
        flash,
        force_table::{self, Demand},
    },
    scene::CD_ROM_SLIDE,
    setup::Scene,
};
use slipfit_tests::cross::{self, TARGET, cargo, printed, whole_program};

const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");

static TABLE: LazyLock<PathBuf> = LazyLock::new(|| {
    let file = Path::new(FOLDER).join("firmware.bin");
    fs::write(&file, table(Demand::Full)).expect("the test's folder takes files");
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
    for block in ON_TARGET.split("\n\n").filter(|block| block.starts_with("n = ") && block.contains("all lookups")) {
        // Beyond the table's last level it holds what it has there.
        let clamped = block.starts_with("n = 6\n");
        for line in block.lines().skip(2) {
            if let [_, kernel, table] = line.split_whitespace().flat_map(str::parse).collect::<Vec<f64>>()[..] {
                assert!(clamped || (kernel - table).abs() < 0.01, "{block}");
                forces += 1;
            }
        }
        assert!(block.contains(if clamped { " 200 clamped" } else { " 0 clamped" }), "{block}");
    }
    assert_eq!(forces, 70);
}

#[test]
fn every_step_takes_the_recorded_instructions() {
    let counts: String = ON_TARGET.lines().filter(|line| is_count(line)).flat_map(|line| [line, "\n"]).collect();
    let steps: Vec<_> = counts.lines().filter(|line| line.starts_with("instructions of a step, ")).collect();
    assert_eq!(steps.len(), 2, "{counts}");
    assert!(steps.iter().all(|step| step.ends_with(", the same every time")), "{counts}");
    insta::assert_snapshot!("counts", counts);
}

#[test]
fn a_lookup_of_integers_takes_the_recorded_instructions() {
    let file = Path::new(FOLDER).join("firmware-i16.bin");
    fs::write(&file, table(Demand::MaxError(0.01))).expect("the test's folder takes files");
    let printed = on_target(Some(&file));
    let mut counts = printed.lines().filter(|line| line.starts_with("instructions of a lookup"));
    insta::assert_snapshot!("integers", counts.next().expect("the image counts"));
}

/// From its first instruction to its return, whatever the way: nothing is called, and no branch leads back.
#[test]
fn a_lookup_has_at_most_160_instructions() {
    assert!(!ON_TARGET.is_empty(), "it has been built");
    let lookups = cross::code(&cross::image(FOLDER, "slipfit-firmware"), "program::lookup");
    assert_eq!(lookups.len(), 2, "in f32 and in i16");
    for code in lookups {
        // Behind the last return there is only what the linker fills up with.
        let (code, rest) = code.rsplit_once("\tpop\t").expect("a return");
        let instructions = code.lines().count();
        assert!(instructions <= 160 && rest.lines().count() <= 2, "{instructions}\n{code}\n{rest}");
        let address = |word: &str| u32::from_str_radix(word, 16).ok();
        let last = code.lines().last().and_then(|line| address(line.trim().split(':').next()?)).expect("an address");
        for line in code.lines() {
            let mut columns = line.split('\t');
            let at = columns.next().and_then(|at| address(at.trim().trim_end_matches(':')));
            let operation = columns.next().and_then(|operation| operation.split('.').next()).unwrap_or_default();
            assert!(!["bl", "blx", "bx"].contains(&operation), "{line}");
            // Only branches have an address.
            let to =
                columns.next().filter(|_| operation.starts_with('b')).and_then(|to| address(to.split(' ').next()?));
            assert!(to.is_none_or(|to| Some(to) > at && to <= last), "{line}");
        }
    }
}

#[test]
fn the_image_has_no_double_precision() {
    assert!(!ON_TARGET.is_empty(), "it has been built");
    cross::assert_single_precision(&cross::image(FOLDER, "slipfit-firmware"));
}

/// memory.x is the only place that decides; what repeats its numbers is held against it.
#[test]
fn everything_agrees_with_memory_x() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |file: &str| fs::read_to_string(root.join(file)).expect("a file of the repository");
    let memory = read("memory.x");
    let line = memory.lines().find(|line| line.trim_start().starts_with("TABLE")).expect("a TABLE region");
    let address = format!("{:#010x}", flash::TABLE_ADDRESS);
    let length = format!("{}K", flash::TABLE_REGION / 1024);
    assert!(line.to_lowercase().contains(&address) && line.contains(&length), "{line}");
    let runner = read(".cargo/qemu");
    assert!(runner.contains(&format!("addr={:#x}", flash::TABLE_ADDRESS)), "{runner}");
}

/// A line that only the image has.
fn is_count(line: &str) -> bool {
    line.starts_with("instructions ") || line.starts_with("stack ")
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
    printed(
        whole_program(FOLDER)
            .args(["run", "--release", "-p", "slipfit-firmware", "--target", TARGET, "--"])
            .args(table),
    )
}

/// The table of the paper's slide over n from −3 to 5, with [`Demand::Full`] the one that `slipfit run` makes.
fn table(demand: Demand) -> Vec<u8> {
    let scene = Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).expect("the shipped scene");
    let (table, _) = force_table::make(&scene, demand, || ()).expect("its table");
    table.bytes
}
