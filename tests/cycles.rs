//! Cycles on a Cortex-M4F by its published timings, from the instructions that the emulator executes: at zero wait states,
//! without interrupts.

use std::{fmt::Write, sync::LazyLock};

use slipfit_tests::{
    cortex_m4::Cycles,
    cross::{self, TARGET},
    drive_table,
    guide::{self, with_comma},
    trace::{Count, OF_TIMER, Trace},
};

const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");

/// Where the images for one core after another are.
const CORES_FOLDER: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/cores");

/// Cycles of a period of 1 ms at 168 MHz.
const PERIOD: u32 = 168_000;

/// What takes cycles, and how many.
struct Work {
    name: String,
    instructions: [u32; 2],
    cycles: Cycles,
}

/// Steps of the ladder's scene types and mechanisms, and a period ahead of the clock.
static LADDER: LazyLock<Vec<Work>> = LazyLock::new(|| {
    let trace = Trace::of(&cross::built(FOLDER, "slipfit-ladder"), None);
    let counted = |line: &str| {
        let (name, count) = line.strip_prefix("instructions of ")?.split_once(": ")?;
        let instructions: u32 = count.strip_suffix(", the same every time")?.parse().ok()?;
        let Count { instructions: traced, cycles, .. } = trace.count(&format!("slipfit_ladder::program::{name}"));
        assert_eq!(traced, [instructions + OF_TIMER; 2], "{name}");
        Some(Work { name: name.to_owned(), instructions: [instructions; 2], cycles })
    };
    trace.text.lines().filter_map(counted).collect()
});

/// The slide's step in an image of its own: for the processor, and for any of its architecture.
static SLIDE: LazyLock<[Work; 2]> = LazyLock::new(|| {
    [Some("cortex-m4"), None].map(|cpu| {
        let trace = Trace::of(&cross::image_for(CORES_FOLDER, TARGET, cpu), None);
        let Count { instructions, cycles, .. } = trace.count("slipfit_firmware::slide::step");
        let instructions = instructions.map(|count| count - OF_TIMER);
        let [least, greatest] = instructions;
        assert!(trace.text.starts_with(&format!("{least} {greatest} ")), "{instructions:?} {}", trace.text);
        Work { name: format!("target-cpu {}", cpu.unwrap_or("none")), instructions, cycles }
    })
});

/// All periods of the drive, in three strokes.
static DRIVE: LazyLock<Work> = LazyLock::new(|| {
    let trace = Trace::of(&cross::built(FOLDER, "slipfit-drive"), Some(&drive_table::written(FOLDER)));
    let Count { instructions, cycles, .. } = trace.count("slipfit_drive::control::step");
    let text = trace.text.lines().find_map(|line| line.strip_prefix("instructions of a period: "));
    let counted = text.and_then(|text| text.split_once(" to ")).expect("the image counts");
    // Its timer counts five instructions at a time.
    for (traced, counted) in instructions.into_iter().zip([counted.0, counted.1]) {
        assert!(traced.abs_diff(counted.parse().expect("a number")) <= 5, "{instructions:?} {text:?}");
    }
    Work { name: "period of the drive".to_owned(), instructions, cycles }
});

impl Work {
    /// Of a period (%).
    fn share(&self) -> [f32; 2] {
        [self.cycles.least, self.cycles.greatest].map(|cycles| cycles as f32 / PERIOD as f32 * 100.0)
    }

    fn cycles(&self) -> String {
        format!("{} to {}", with_comma(self.cycles.least), with_comma(self.cycles.greatest))
    }
}

/// Of `works`, a line each.
fn table<'a>(works: impl IntoIterator<Item = &'a Work>) -> String {
    let mut table =
        String::from("                                    instructions            cycles  % of 1 ms at 168 MHz\n");
    for work in works {
        let Work { name, instructions: [fewest, most], cycles: Cycles { least, greatest } } = work;
        let instructions = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
        let [low, high] = work.share();
        let cycles = format!("{least} to {greatest}");
        let _ = writeln!(table, "{name:32}{instructions:>16}{cycles:>18}{:>22}", format!("{low:.1} to {high:.1}"));
    }
    table
}

#[test]
fn steps_take_the_recorded_cycles() {
    insta::assert_snapshot!("ladder", table(&*LADDER));
}

/// More instructions, but fewer cycles: no multiplication with addition, which takes three.
#[test]
fn the_processor_of_the_repository_saves_cycles() {
    let [processor, any] = &*SLIDE;
    assert!(processor.instructions[0] > any.instructions[0]);
    assert!(processor.cycles.greatest < any.cycles.greatest && processor.cycles.least < any.cycles.least);
    insta::assert_snapshot!("slide", table(&*SLIDE));
}

#[test]
fn the_drive_takes_the_recorded_cycles() {
    insta::assert_snapshot!("drive", table([&*DRIVE]));
}

#[test]
fn the_guide_has_these_cycles() {
    let [firmware, accuracy] = ["firmware", "accuracy"].map(guide::page);
    let of = |name: &str| LADDER.iter().find(|work| work.name == name).expect("it has been counted");
    for work in &*LADDER {
        let Work { name, instructions: [instructions, _], .. } = work;
        let is_there = match name.as_str() {
            "hatch" | "linear_guide" | "telescopic_drawer" | "ball_rod" => {
                let [low, high] = work.share().map(|percent| percent / 100.0);
                guide::prose("firmware").contains(&format!("{low:.2} to {high:.2}"))
            }
            "slide_ahead" => {
                let fixed = of("slide_regularised").cycles();
                firmware.contains(&format!("| cycles a period | not counted | {fixed} | {} |", work.cycles()))
            }
            _ => {
                let [instructions, cycles] =
                    [with_comma(*instructions), work.cycles()].map(|cell| format!("| {cell} |"));
                firmware.lines().any(|line| line.contains(&instructions) && line.ends_with(&cycles))
            }
        };
        assert!(is_there, "{name}: {}, {:?} %", work.cycles(), work.share());
    }
    let [processor, any] = &*SLIDE;
    let builds = format!("{} instead of {}", processor.cycles(), any.cycles());
    let [low, high] = DRIVE.share();
    for text in [builds, with_comma(DRIVE.cycles.greatest) + " cycles", format!("{high:.1} % of a millisecond")] {
        assert!(firmware.contains(&text), "{text}");
    }
    for work in [of("slide_regularised"), of("slide_exact"), of("slide_ahead"), &*DRIVE] {
        assert!(accuracy.contains(&format!("| {} |", work.cycles())), "{}", work.name);
    }
    assert!(accuracy.contains(&format!("| {low:.1} to {high:.1} % |")));
}
