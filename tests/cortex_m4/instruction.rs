//! An instruction as a disassembly has it.

use super::timings::{Kind, TIMINGS, Timing};

/// An instruction, with what decides over its cycles. A set of registers has a bit for each.
#[derive(Clone, Copy, Debug)]
pub struct Instruction {
    /// Where it stands.
    pub address: u32,
    /// Bytes.
    pub length: u32,
    pub(super) timing: &'static Timing,
    /// Registers that it loads or stores, where these may be several.
    pub(super) words: u32,
    /// What it computes or loads.
    pub(super) writes: u64,
    /// What it consumes.
    pub(super) reads: u64,
    /// What the address depends on that it loads from or stores to.
    pub(super) base: u64,
    /// Whether it stands behind an `it`, or branches on a condition.
    pub(super) is_conditional: bool,
}

const CONDITIONS: [&str; 16] =
    ["eq", "ne", "cs", "hs", "cc", "lo", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le"];

/// The core's registers, the first ones of a set.
const CORE: [&str; 16] =
    ["r0", "r1", "r2", "r3", "r4", "r5", "r6", "r7", "r8", "r9", "sl", "fp", "ip", "sp", "lr", "pc"];
const OF_CORE: u64 = 0xffff;
const SP: u64 = 1 << 13;
pub(super) const PC: u64 = 1 << 15;
/// The FPU's flags.
const FLAGS: u64 = 1 << 48;

impl Instruction {
    /// Of a `line` of `arm-none-eabi-objdump -d`: address, code, operation and operands in columns. None where it is no
    /// instruction or has no timing.
    pub fn parse(line: &str) -> Option<Self> {
        let mut columns = line.split('\t');
        let address = u32::from_str_radix(columns.next()?.trim().strip_suffix(':')?, 16).ok()?;
        let length = columns.next()?.split_whitespace().map(|code| code.len() as u32 / 2).sum();
        let mnemonic = columns.next()?.trim().split('.').next()?;
        // Behind the operands there may be the name of a place, or a comment.
        let operands = columns.next().unwrap_or_default().split(['<', '@', ';']).next()?;
        let (timing, is_conditional) = timing(mnemonic, operands)?;

        let (first, rest) = operands.split_once(',').unwrap_or((operands, ""));
        let (before, brackets) = operands.split_once('[').unwrap_or((operands, ""));
        let list = operands.split_once('{').map(|(_, list)| list);
        let base = match list {
            Some(_) if first.starts_with('{') => SP,
            Some(_) => registers(first),
            None => registers(brackets),
        };
        let words = if timing.kind == Kind::Multiple { registers(list.unwrap_or(before)).count_ones() } else { 0 };
        let (writes, reads) = match timing.kind {
            Kind::Compute | Kind::Load => (registers(first), registers(rest)),
            Kind::Branch => (0, 0),
            _ => (0, registers(operands)),
        };
        let writes = if mnemonic.starts_with("vcmp") { FLAGS } else { writes };
        Some(Self { address, length, timing, words, writes, reads, base, is_conditional })
    }
}

/// The row of an operation, and whether it is one on a condition.
fn timing(mnemonic: &str, operands: &str) -> Option<(&'static Timing, bool)> {
    let row = |operation: &str| {
        let of_core = (registers(operands) & OF_CORE).count_ones();
        let row = match operation {
            "vmov" if of_core > 1 => "vmov.cores",
            "vmov" if of_core == 1 => "vmov.core",
            "vldr" | "vstr" if operands.starts_with('d') => "vldr.double",
            _ => operation,
        };
        TIMINGS.iter().find(|timing| timing.operations.split(' ').any(|operation| operation == row))
    };
    // An operation on a condition may set flags, too.
    let with_flags = |name: &str| row(name).or_else(|| row(name.strip_suffix('s')?));
    let on_condition = || CONDITIONS.iter().find_map(|condition| with_flags(mnemonic.strip_suffix(condition)?));
    let unconditional = row(mnemonic).map(|row| (row, false));
    let setting_flags = || Some((row(mnemonic.strip_suffix('s')?)?, false));
    unconditional.or_else(|| on_condition().map(|row| (row, true))).or_else(setting_flags)
}

/// The registers that `operands` name.
fn registers(operands: &str) -> u64 {
    let names = operands.split(|c: char| !c.is_ascii_alphanumeric() && c != '-');
    let of_names = names.filter_map(|names| {
        let (first, last) = names.split_once('-').unwrap_or((names, names));
        let (first, last) = (register(first)?, register(last)?);
        // From the lowest bit of the first to the highest of the last.
        Some((u64::MAX << first.trailing_zeros()) & (u64::MAX >> last.leading_zeros()))
    });
    of_names.fold(0, |all, registers| all | registers)
}

/// The register of that name; a double one of the FPU is two single ones.
fn register(name: &str) -> Option<u64> {
    if let Some(number) = CORE.iter().position(|core| *core == name) {
        return Some(1 << number);
    }
    let of_fpu = |letter, count| name.strip_prefix(letter)?.parse().ok().filter(|number: &u32| *number < count);
    match name {
        "fpscr" => Some(FLAGS),
        _ => of_fpu('s', 32).map(|s| 1 << (16 + s)).or_else(|| of_fpu('d', 16).map(|d| 3 << (16 + 2 * d))),
    }
}
