//! The drive at work on the emulated Cortex-M4F: what it says is what it says on the desk, and what it said before.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    sync::LazyLock,
};

use defmt_decoder::{DecodeError, Table};
use slipfit_tests::{
    cross::{self, TARGET, printed, whole_program},
    drive_table,
};

const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");

/// The file of the table that the drive works with.
static TABLE: LazyLock<PathBuf> = LazyLock::new(|| drive_table::written(FOLDER));

/// The drive with a table, its target folder in `folder`.
fn drive(folder: &str, options: &[&str], table: &Path) -> Command {
    let mut cargo = whole_program(folder);
    cargo.args(["run", "-p", "slipfit-firmware", "--bin", "slipfit-drive"]).args(options).arg("--").arg(table);
    cargo
}

#[test]
fn says_what_it_said_and_what_the_desk_says() {
    cross::require_target();
    cross::require_emulator();
    let on_target = printed(&mut drive(FOLDER, &["--release", "--target", TARGET], &TABLE));
    let counted = |line: &&str| line.starts_with("instructions ") || line.starts_with("stack ");
    let same: Vec<_> = on_target.lines().filter(|line| !counted(line)).collect();
    assert_eq!(same, printed(&mut drive(FOLDER, &[], &TABLE)).lines().collect::<Vec<_>>());
    insta::assert_snapshot!("log", on_target);

    // Free where the unit is what it is taken for, tight with more friction, a jam where it jams.
    let ends: Vec<_> = on_target.lines().filter(|line| line.starts_with("first tight")).collect();
    assert_eq!(ends[0], "first tight never, first jam never");
    assert!(ends[1].starts_with("first tight at ") && ends[1].ends_with(", first jam never"), "{}", ends[1]);
    assert!(ends[2].contains("first jam at "), "{}", ends[2]);
    cross::assert_single_precision(&cross::image(FOLDER, "slipfit-drive"));
    assert_eq!(on_target.matches("table damaged in 0 rounds").count(), 3);
    // No prediction is ever older than the clock.
    let leads =
        on_target.lines().filter_map(|line| line.strip_prefix("least lead: ")?.strip_suffix(" ms")?.parse().ok());
    let leads: Vec<f32> = leads.collect();
    assert!(leads.len() == 3 && leads.iter().all(|lead| *lead > 0.0), "{leads:?}");
}

#[test]
fn fails_without_its_table() {
    cross::require_target();
    cross::require_emulator();
    let other = Path::new(FOLDER).join("other.bin");
    fs::write(&other, b"SLFT").expect("the test's folder takes files");
    for options in [&["--release", "--target", TARGET][..], &[]] {
        let output = cross::finished(&mut drive(FOLDER, options, &other));
        assert!(!output.status.success() && output.stdout.starts_with(b"no table: "), "{output:?}");
    }
}

/// The log as frames, which only the image's own file can decode: of every period that the text shows the same numbers.
#[test]
fn says_the_same_in_frames() {
    cross::require_target();
    cross::require_emulator();
    let text = printed(&mut drive(FOLDER, &[], &TABLE));
    let folder = format!("{FOLDER}/defmt");
    let output =
        cross::finished(&mut drive(&folder, &["--release", "--target", TARGET, "--features", "defmt"], &TABLE));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    let image = fs::read(cross::image(&folder, "slipfit-drive")).expect("it has been built");
    let table = Table::parse(&image).expect("a file with defmt's symbols").expect("defmt's symbols");
    let mut decoder = table.new_stream_decoder();
    decoder.received(&output.stdout);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => lines.push(frame.display_message().to_string()),
            Err(DecodeError::UnexpectedEof) => break,
            Err(DecodeError::Malformed) => panic!("a frame that is none after\n{}", lines.join("\n")),
        }
    }
    let shown = |line: &&str| line.starts_with("   ");
    let mut periods = text.lines().filter(shown);
    for record in lines.iter().filter(|line| line.starts_with("Record ")) {
        let value = |name: &str| {
            let (_, value) = record.split_once(&format!("{name}: ")).expect("its name");
            value.split([',', ' ']).next().expect("its value")
        };
        let number = |name: &str| value(name).parse::<f32>().expect("a number");
        let [measured, predicted, expected, lead] = ["measured", "predicted", "expected", "lead"].map(number);
        let lead = lead * 1e3;
        let (periods_so_far, verdict) = (value("periods"), value("verdict"));
        let line = format!("{periods_so_far:>7}{measured:14.4}{predicted:15.4}{expected:12.4}{lead:11.1}  {verdict}");
        assert_eq!(periods.next(), Some(line.as_str()));
    }
    assert_eq!(periods.next(), None);
    insta::assert_snapshot!("frames", format!("{} bytes\n{}\n", output.stdout.len(), lines.join("\n")));
}
