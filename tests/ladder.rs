//! What a scene does not need is left out: a ladder of scene types on the emulated Cortex-M4F, each cheaper than the one
//! above.

use std::{collections::BTreeMap, fmt::Write, process::Command, sync::LazyLock};

use slipfit_tests::{
    cross::{self, TARGET, printed, whole_program},
    guide::{self, with_comma},
};

const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");

/// Scene types, from the dearest to the cheapest.
const RUNGS: [&str; 8] = [
    "slide_general_exponent",
    "slide_exact",
    "slide_regularised",
    "slide_frictionless",
    "planar_regularised",
    "planar_journal",
    "axis_slot_driven",
    "axis_pad_linear",
];

/// The slide whose pins fit with clearance, and the rung that does not know that they do.
const WITH_CLEARANCE: [(&str, &str); 2] =
    [("slide_exact_with_clearance", "slide_exact"), ("slide_regularised_with_clearance", "slide_regularised")];

/// Shipped mechanisms in a plane, each with the step of its scene, by implicit Euler. The step of one in space is no function by itself.
const MECHANISMS: [&str; 4] = ["slider_crank", "slider_crank_guide", "four_bar", "woodpecker_toy"];

/// Shipped mechanisms in space, by implicit Euler.
const IN_SPACE: [&str; 4] = ["hatch", "linear_guide", "telescopic_drawer", "ball_rod"];

/// What the image printed.
static ON_TARGET: LazyLock<String> = LazyLock::new(|| {
    cross::require_target();
    cross::require_emulator();
    printed(ladder().args(["--release", "--target", TARGET]))
});

fn ladder() -> Command {
    let mut cargo = whole_program(FOLDER);
    cargo.args(["run", "-p", "slipfit-firmware", "--bin", "slipfit-ladder"]);
    cargo
}

/// The machine code of every rung's step, a line an instruction.
static CODE: LazyLock<BTreeMap<&str, String>> = LazyLock::new(|| {
    // It has been built.
    assert!(!ON_TARGET.is_empty());
    let image = cross::image(FOLDER, "slipfit-ladder");
    RUNGS
        .iter()
        .chain(&MECHANISMS)
        .chain(&["slide_ahead"])
        .chain(&WITH_CLEARANCE.map(|(rung, _)| rung))
        .map(|rung| (*rung, without_padding(cross::code(&image, rung).remove(0))))
        .collect()
});

/// The `code` of a function up to its last return: the linker fills what is left up to the next with bytes that read as a branch.
fn without_padding(mut code: String) -> String {
    let padding = code.strip_suffix('\n').and_then(|code| code.rsplit_once('\n')).filter(|(before, last)| {
        let returns = before.lines().next_back().is_some_and(|line| line.contains("\tpop") && line.contains("pc}"));
        returns && last.contains("\tbmi.n\t")
    });
    if let Some((before, _)) = padding {
        code.truncate(before.len() + 1);
    }
    code
}

/// A rung's costs.
#[derive(Clone, Copy, Debug)]
struct Costs {
    instructions: u32,
    code: u32,
    stack: u32,
    state: u32,
    parameters: u32,
}

/// The number that the image printed between `before` and `after`.
fn number(before: &str, after: &str) -> u32 {
    let mut found = ON_TARGET.lines().filter_map(|line| line.split_once(before)?.1.split_once(after)?.0.parse().ok());
    found.next().unwrap_or_else(|| panic!("no number after {before}:\n{}", *ON_TARGET))
}

/// What a step of `rung` takes.
fn instructions(rung: &str) -> u32 {
    number(&format!("instructions of {rung}: "), ", the same every time")
}

fn costs(rung: &str) -> Costs {
    let address = |line: &str| u32::from_str_radix(line.split_once(':')?.0.trim(), 16).ok();
    let mut addresses = CODE[rung].lines().map(|line| address(line).expect("an address"));
    let (first, last) = (addresses.next().expect("code"), addresses.next_back().expect("code"));
    Costs {
        instructions: instructions(rung),
        code: last + 4 - first,
        stack: number(&format!("stack of {rung}: "), " bytes"),
        state: {
            let line = ON_TARGET.lines().find(|line| line.starts_with(&format!("{rung}: "))).expect("a line");
            let state = line.split_once("state ").and_then(|(_, rest)| rest.split(' ').next()?.parse().ok());
            state.expect("its bytes")
        },
        parameters: number(&format!("{rung}: parameters "), " bytes"),
    }
}

/// The costs of `rungs`, a line each.
fn table(rungs: &[&str]) -> String {
    let mut table =
        String::from("scene type                      instructions   code B   stack B   state B   parameters B\n");
    for rung in rungs {
        let Costs { instructions, code, stack, state, parameters } = costs(rung);
        let _ = writeln!(table, "{rung:32}{instructions:12}{code:9}{stack:10}{state:10}{parameters:15}");
    }
    table
}

#[test]
fn mechanisms_cost_as_recorded() {
    assert!(costs("slider_crank").instructions <= 6000);
    insta::assert_snapshot!("mechanisms", table(&MECHANISMS));
}

/// A mechanism in a plane with a command of segments, a limit and friction of its drive train and of a joint, springs along a line and about
/// an axis, Stribeck friction, lines that converge and bow. Its step is no function by itself, but takes the same instructions every time.
#[test]
fn what_motion_can_have_costs_no_more_than_recorded() {
    assert!(instructions("motion_plane") <= 17_000, "{}", instructions("motion_plane"));
}

#[test]
fn mechanisms_in_space_cost_as_recorded() {
    let rows: String = IN_SPACE.iter().map(|rung| format!("{rung:24}{:12}\n", instructions(rung))).collect();
    insta::assert_snapshot!("mechanisms_in_space", format!("scene type              instructions\n{rows}"));
}

#[test]
fn each_rung_is_cheaper_than_the_one_above() {
    let table = table(&RUNGS);
    for pair in RUNGS.windows(2) {
        let (above, below) = (costs(pair[0]), costs(pair[1]));
        assert!(below.instructions < above.instructions && below.code < above.code, "{pair:?}\n{table}");
        assert!(below.stack < above.stack && below.state <= above.state, "{pair:?}\n{table}");
    }
    insta::assert_snapshot!("costs", table);
}

/// The last part of the line that the image printed on `rung`: all velocities of its run.
fn velocities(rung: &str) -> &'static str {
    let line = ON_TARGET.lines().find(|line| line.starts_with(&format!("{rung}: "))).expect("a line");
    line.rsplit(' ').next().expect("a number")
}

/// And moves the same, bit for bit.
#[test]
fn a_clearance_makes_a_step_cheaper() {
    for (rung, any) in WITH_CLEARANCE {
        let (with, without) = (costs(rung), costs(any));
        assert!(with.instructions < without.instructions * 93 / 100, "{with:?} {without:?}");
        assert!(with.code < without.code && with.stack <= without.stack && with.state == without.state, "{rung}");
        assert_eq!(velocities(rung), velocities(any));
    }
    insta::assert_snapshot!("with_clearance", table(&WITH_CLEARANCE.map(|(rung, _)| rung)));
}

#[test]
fn the_guide_has_these_costs() {
    let page = guide::page("firmware");
    let has = |row: String| assert!(page.contains(&row), "{row}");
    for rung in RUNGS.into_iter().chain(MECHANISMS).chain(WITH_CLEARANCE.map(|(rung, _)| rung)) {
        let Costs { instructions, code, stack, state, .. } = costs(rung);
        has(format!("| {} | {} | {stack} | {state} |", with_comma(instructions), with_comma(code)));
    }
    for rung in IN_SPACE {
        let thousands = with_comma((instructions(rung) + 500) / 1000 * 1000);
        assert!(guide::prose("firmware").contains(&format!(" {thousands}")), "{rung}: {thousands}");
    }
    // The kernel beside the prediction ahead of the clock.
    let [kernel, ahead] = ["slide_regularised", "slide_ahead"].map(costs);
    let both = |of: fn(&Costs) -> u32| [&kernel, &ahead].map(|costs| with_comma(of(costs)));
    let [one, other] = both(|costs| costs.instructions);
    has(format!("| instructions a period | 128 at most | {one} | {other} |"));
    let [one, other] = both(|costs| costs.code);
    has(format!("| {one} bytes of code | {other} bytes of code |"));
    let [one, other] = both(|costs| costs.state + costs.parameters);
    has(format!("| RAM of parameters and state in Rust | not counted | {one} bytes | {other} bytes |"));
    let Costs { stack, parameters, state, code, .. } = ahead;
    has(format!("| {stack}; {parameters}; {}; {} bytes |", with_comma(state), with_comma(code)));
}

/// What a drive controller can spare at 1 kHz: a seventh of 168 MHz, whose cycles `cycles.rs` counts, and a stack of 512 bytes, or
/// 640 with exact friction, which remembers.
#[test]
fn the_full_slide_keeps_its_budget() {
    assert!(costs("slide_regularised").stack <= 512 && costs("slide_exact").stack <= 640);
    assert!(costs("slide_exact").instructions <= 16_000);
    let [pass, with_clearance] = ["", " with clearance"].map(|which| {
        let of = |line: &str| line.strip_prefix(&format!("instructions of a pass{which}: "))?.parse::<u32>().ok();
        ON_TARGET.lines().find_map(of).expect("the image says so")
    });
    assert!(pass <= 3_600 && with_clearance <= 3_200, "{pass} {with_clearance}");
    insta::assert_snapshot!("pass", format!("{pass}, with clearance {with_clearance}"));
}

/// One attempt a period, what decides over it and what is read from the ring included.
#[test]
fn a_period_ahead_of_the_clock_keeps_its_budget() {
    let Costs { instructions, stack, .. } = costs("slide_ahead");
    assert!(instructions <= 11_000 && stack <= 768, "{instructions} {stack}");
    let (_, of_numbers) = branches(&CODE["slide_ahead"]);
    assert_eq!(of_numbers, None);
    let following = ON_TARGET.lines().find_map(|line| line.strip_prefix("instructions of following a command: "));
    let following = following.and_then(|count| count.parse::<u32>().ok()).expect("a line of the image");
    insta::assert_snapshot!("ahead", table(&["slide_ahead"]) + &format!("following a command {following:24}\n"));
}

/// A step is one function that calls none but to copy memory, so that its constants tell what is in it.
#[test]
fn what_is_left_out_is_not_there() {
    // High halves of the first guess of a reciprocal root and of √½, from which logarithms start.
    let has = |rung: &str, constant: u32| {
        let (half, word) = (format!("#{}", constant >> 16), format!("{constant:#010x}"));
        CODE[rung].lines().any(|line| line.contains("movt") && line.contains(&half) || line.contains(&word))
    };
    let (root, logarithm) = (0x5f0b_3880, 0x3f35_04f3);
    for rung in RUNGS {
        for call in CODE[rung].lines().filter(|line| line.contains("\tbl\t") || line.contains("\tblx\t")) {
            assert!(call.contains("<__aeabi_mem"), "{rung}: {call}");
        }
        assert_eq!(has(rung, logarithm), rung == "slide_general_exponent", "logarithm in {rung}");
        assert_eq!(has(rung, root), rung != "axis_pad_linear", "root in {rung}");
    }
    // Exact friction remembers two forces a slot, other laws nothing.
    assert_eq!(costs("slide_exact").state - costs("slide_regularised").state, 8 * 2 * 4);
    assert_eq!(costs("slide_regularised").state, costs("slide_frictionless").state);
}

/// What sets the integer flags, so that they are not those of numbers any more.
const SETS_FLAGS: [&str; 22] = [
    "cmp", "cmn", "tst", "teq", "adds", "adcs", "subs", "sbcs", "rsbs", "muls", "movs", "mvns", "ands", "orrs", "orns",
    "eors", "bics", "lsls", "lsrs", "asrs", "rors", "rrxs",
];

/// Conditional branches of machine code (a line an instruction), and the first that follows from comparing floating-point
/// numbers, whose flags `vmrs` hands over.
fn branches(code: &str) -> (usize, Option<&str>) {
    let conditions = ["eq", "ne", "gt", "ge", "lt", "le", "mi", "pl", "hi", "hs", "lo", "ls", "cs", "cc", "vs", "vc"];
    let (mut of_numbers, mut count, mut first) = (false, 0, None);
    for line in code.lines() {
        let operation = line.split('\t').nth(1).unwrap_or_default().split('.').next().unwrap_or_default();
        if operation.strip_prefix('b').is_some_and(|condition| conditions.contains(&condition)) {
            count += 1;
            first = first.or(of_numbers.then_some(line));
        } else if operation == "vmrs" {
            of_numbers = true;
        } else if SETS_FLAGS.contains(&operation) {
            of_numbers = false;
        }
    }
    (count, first)
}

/// Branches count passes and pins.
#[test]
fn no_branch_depends_on_the_state() {
    for rung in RUNGS.iter().chain(&MECHANISMS).chain(&WITH_CLEARANCE.map(|(rung, _)| rung)) {
        let (count, of_numbers) = branches(&CODE[rung]);
        assert_eq!(of_numbers, None, "{rung}");
        assert!(count > 0, "{rung} has loops");
    }
}

#[test]
fn a_branch_on_numbers_is_found() {
    let line = |operation: &str| format!("  1000:\t{operation}\t0x2000 <step>\n");
    let code = |operations: &[&str]| operations.iter().map(|operation| line(operation)).collect::<String>();
    let conditions = ["eq", "ne", "gt", "ge", "lt", "le", "mi", "pl", "hi", "hs", "lo", "ls", "cs", "cc", "vs", "vc"];
    for branch in conditions.map(|condition| format!("b{condition}")) {
        for branch in [branch.clone(), format!("{branch}.n"), format!("{branch}.w")] {
            assert_eq!(branches(&code(&["subs", &branch])), (1, None), "{branch}");
            // What is done where numbers compared so, in an IT block, sets no flags.
            for between in [&["vadd.f32"][..], &["it", "movls"], &["strcs"], &["vmovvs.f32"], &["mrs"], &["b", "bl"]] {
                let text = code(&[&["vcmp.f32", "vmrs"], between, &[&branch]].concat());
                assert_eq!(branches(&text), (1, Some(line(&branch).trim_end_matches('\n'))), "{between:?}");
            }
            for between in ["cmp", "cmp.w", "subs", "lsls", "bics", "muls"] {
                assert_eq!(branches(&code(&["vmrs", between, &branch])), (1, None), "{between}");
            }
        }
    }
    assert_eq!(branches(&code(&["vmrs", "b", "bl", "blx", "bx", "bfi", "bic"])), (0, None));
}

#[test]
fn host_and_target_compute_the_same() {
    let on_host = printed(&mut ladder());
    let on_target = ON_TARGET.lines().filter(|line| !line.starts_with("instructions ") && !line.starts_with("stack "));
    // Parameters with indices, which are as wide as the machine's pointers, have another size.
    let computed =
        |line: &str| line.split(", ").filter(|part| !part.contains("parameters")).collect::<Vec<_>>().join(", ");
    let name = |line: &str| line.split(':').next().unwrap_or_default().to_owned();
    let both = |line: &str| (name(line), computed(line));
    assert_eq!(on_host.lines().map(both).collect::<Vec<_>>(), on_target.map(both).collect::<Vec<_>>());
}
