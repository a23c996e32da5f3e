//! Where the instructions of a Newton pass go: by what they are for, from the lines of source that they come from, and by what they do.

use std::{collections::BTreeMap, fmt::Write, path::Path, process::Command};

use slipfit_tests::{
    cross::{self, TARGET, printed, whole_program},
    trace::Trace,
};

const FOLDER: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/lines");

/// What a pass does, and what tells it: the beginning of the name, or a part of the file, of one of the functions that were inlined into
/// each other.
const PURPOSES: [(&str, &[&str]); 11] = [
    ("roots", &["src/power.rs"]),
    ("friction", &["law/friction/"]),
    (
        "forces along normals",
        &["law/impact.rs", "law/elastic.rs", "law/step.rs", "law/normal.rs", "law/bistop.rs", "law/fit.rs"],
    ),
    ("slots added up to pins", &["system/law/pin.rs"]),
    ("pins added up to the matrix", &["\nadd_at<", "\ncross_columns<", "\ncross_rows<"]),
    ("the drive", &["floating/pull.rs", "law/drive.rs", "drive/ramp.rs"]),
    ("where pins are, their forces", &["floating/pin.rs", "system/alike.rs", "system/element.rs"]),
    ("factors of the matrix", &["\nfactorised<"]),
    ("the solution", &["\nsolve<"]),
    ("the pose and its axes", &["src/pose.rs", "\nplaced<"]),
    ("an empty matrix", &["\ninertia<"]),
];

/// What is left: gravity, imbalance, what is kept of a pass.
const REST: &str = "the rest";

/// What instructions do.
const KINDS: [&str; 5] = ["arithmetic", "choices", "moves", "memory", "other"];

/// Which of [`KINDS`] an operation is.
fn kind(operation: &str) -> usize {
    let starts = |names: &[&str]| names.iter().any(|name| operation.starts_with(name));
    if starts(&["vadd", "vsub", "vmul", "vdiv", "vneg", "vnmul", "vabs"]) {
        0
    } else if starts(&["vcmp", "vmrs", "it"])
        || operation.starts_with("vmov") && operation[4..].starts_with(char::is_alphabetic)
    {
        1
    } else if operation.starts_with("vmov") {
        2
    } else if starts(&["vldr", "vldm", "vstr", "vstm", "vpush", "vpop", "ldr", "ldm", "str", "stm", "push", "pop"]) {
        3
    } else {
        4
    }
}

/// The operation at each address of an image.
fn operations(image: &Path) -> BTreeMap<u32, String> {
    let text = printed(Command::new("arm-none-eabi-objdump").args(["-d", "--no-show-raw-insn"]).arg(image));
    let operation = |line: &str| {
        let (address, rest) = line.split_once(":\t")?;
        let operation = rest.split_whitespace().next()?;
        Some((u32::from_str_radix(address.trim(), 16).ok()?, operation.to_owned()))
    };
    text.lines().filter_map(operation).collect()
}

/// What the instructions at these addresses of the image are for, an index of [`PURPOSES`] or one more.
fn purposes(image: &Path, addresses: impl Iterator<Item = u32>) -> BTreeMap<u32, usize> {
    let mut lines = Command::new("arm-none-eabi-addr2line");
    lines.args(["--addresses", "--functions", "--inlines", "--demangle", "--exe"]).arg(image);
    let text = printed(lines.args(addresses.map(|address| format!("{address:#x}"))));
    let mut purposes = BTreeMap::new();
    for of_one in text.split("\n0x") {
        let (address, calls) = of_one.trim_start_matches("0x").split_once('\n').expect("an address");
        let calls = format!("\n{calls}");
        let has = |parts: &[&str]| parts.iter().any(|part| calls.contains(part));
        let purpose = PURPOSES.iter().position(|(_, parts)| has(parts)).unwrap_or(PURPOSES.len());
        purposes.insert(u32::from_str_radix(address, 16).expect("an address"), purpose);
    }
    purposes
}

/// Instructions of a step by purpose and kind, less those of `fewer`.
fn table(image: &Path, trace: &Trace, [fewer, more]: [&str; 2]) -> String {
    let operations = operations(image);
    let mut counts = [[0i32; KINDS.len()]; PURPOSES.len() + 1];
    for (name, sign) in [(fewer, -1), (more, 1)] {
        let executed = trace.executed(&format!("slipfit_ladder::program::{name}"));
        let purposes = purposes(image, executed.keys().copied());
        for (address, count) in executed {
            counts[purposes[address]][kind(&operations[address])] += sign * *count as i32;
        }
    }
    let mut table = format!("{more:32}");
    let row = |table: &mut String, name: &str, counts: [i32; KINDS.len()]| {
        let _ = write!(table, "{name:32}");
        counts.iter().for_each(|count| _ = write!(table, "{count:12}"));
        let _ = writeln!(table, "{:12}", counts.iter().sum::<i32>());
    };
    KINDS.iter().chain(&["sum"]).for_each(|kind| _ = write!(table, "{kind:>12}"));
    table.push('\n');
    for (name, counts) in PURPOSES.iter().map(|(name, _)| *name).chain([REST]).zip(counts) {
        row(&mut table, name, counts);
    }
    row(&mut table, "sum", [0, 1, 2, 3, 4].map(|kind| counts.iter().map(|counts| counts[kind]).sum()));
    table
}

#[test]
fn a_pass_takes_the_recorded_instructions() {
    cross::require_target();
    cross::require_c_compiler();
    // The lines of source add nothing to the code.
    let mut build = whole_program(FOLDER);
    build.env("CARGO_PROFILE_RELEASE_DEBUG", "line-tables-only");
    printed(build.args([
        "build",
        "--quiet",
        "--release",
        "-p",
        "slipfit-firmware",
        "--bin",
        "slipfit-ladder",
        "--target",
        TARGET,
    ]));
    let image = cross::image(FOLDER, "slipfit-ladder");
    let trace = Trace::of(&image, None);
    let passes = [["one_pass", "two_passes"], ["one_pass_with_clearance", "two_passes_with_clearance"]];
    insta::assert_snapshot!("by_purpose", passes.map(|passes| table(&image, &trace, passes)).join("\n"));
}
