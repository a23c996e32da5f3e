//! What an image executes on the emulator, from one reading of the system timer to the next: just what the image counts.

use std::{
    collections::{BTreeMap, HashMap},
    io::{BufRead, BufReader, Read},
    mem,
    path::Path,
    process::{Command, Stdio},
};

use crate::{
    cortex_m4::{Cycles, Instruction},
    cross,
};

/// Instructions of reading the timer, which the image does not count.
pub const OF_TIMER: u32 = 2;

/// What a work took that was done many times.
#[derive(Clone, Copy, Debug)]
pub struct Count {
    /// The least and the greatest number of instructions, with [`OF_TIMER`].
    pub instructions: [u32; 2],
    /// The least that any took and the greatest that any took.
    pub cycles: Cycles,
    /// Where it executed an instruction that has no timing.
    untimed: Option<u32>,
}

/// A run of an image.
#[derive(Clone, Debug)]
pub struct Trace {
    /// What the image printed.
    pub text: String,
    counts: BTreeMap<String, Count>,
    executed: BTreeMap<String, BTreeMap<u32, u32>>,
}

impl Trace {
    /// Runs `image`, with a `table` in its flash if there is one.
    ///
    /// # Panics
    /// If that fails.
    pub fn of(image: &Path, table: Option<&Path>) -> Self {
        cross::require_emulator();
        cross::require_c_compiler();
        let mut objdump = Command::new("arm-none-eabi-objdump");
        let code = Code::of(&cross::printed(objdump.args(["-d", "--demangle"]).arg(image)));
        let mut emulator = Command::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.cargo/qemu"));
        emulator.arg(image).args(table).env("QEMU_OPTIONS", "-d in_asm,exec,nochain");
        let running = emulator.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let mut running = running.unwrap_or_else(|error| panic!("{emulator:?}: {error}"));
        let mut way = Way::through(&code);
        for line in BufReader::new(running.stderr.take().expect("its log")).lines() {
            way.follow(&line.expect("text"));
        }
        // Little enough to wait in the pipe.
        let mut text = String::new();
        running.stdout.take().expect("what it prints").read_to_string(&mut text).expect("text");
        let status = running.wait().expect("it has ended");
        assert!(status.success(), "{emulator:?}: {status}\n{text}");
        Self { text, counts: way.counts, executed: way.executed }
    }

    /// What a `work` took: all that calls this function first between two readings of the timer.
    ///
    /// # Panics
    /// If there is none, or one of its instructions has no timing.
    pub fn count(&self, work: &str) -> Count {
        let count = self.counts.get(work).unwrap_or_else(|| panic!("no {work} between two readings of the timer"));
        assert_eq!(count.untimed, None, "an instruction of {work} has no timing");
        *count
    }

    /// How often a `work` executed the instruction at each address, when it was done for the first time.
    ///
    /// # Panics
    /// If it never was.
    pub fn executed(&self, work: &str) -> &BTreeMap<u32, u32> {
        self.executed.get(work).unwrap_or_else(|| panic!("no {work} between two readings of the timer"))
    }
}

/// An image's machine code.
struct Code {
    instructions: HashMap<u32, Instruction>,
    /// Functions by where they begin.
    functions: HashMap<u32, String>,
}

impl Code {
    /// Of a disassembly.
    fn of(text: &str) -> Self {
        let function = |line: &str| {
            let (address, name) = line.strip_suffix(">:")?.split_once(" <")?;
            Some((u32::from_str_radix(address, 16).ok()?, name.to_owned()))
        };
        let instructions = text.lines().filter_map(Instruction::parse);
        Self {
            instructions: instructions.map(|instruction| (instruction.address, instruction)).collect(),
            functions: text.lines().filter_map(function).collect(),
        }
    }
}

/// What is executed between two readings of the timer.
#[derive(Default)]
struct Span {
    /// Where the function begins that is called first.
    called: Option<u32>,
    instructions: u32,
    cycles: Cycles,
    untimed: Option<u32>,
    /// How often each address was executed.
    executed: HashMap<u32, u32>,
}

/// The processor's way through the code.
struct Way<'a> {
    code: &'a Code,
    /// The instruction that the log has listed last.
    listed: Option<u32>,
    /// Last instructions of the blocks that the emulator has translated, by what it calls these.
    blocks: HashMap<String, u32>,
    /// First and last instruction of the block that is executed at present.
    block: Option<[u32; 2]>,
    previous: Option<Instruction>,
    span: Span,
    counts: BTreeMap<String, Count>,
    executed: BTreeMap<String, BTreeMap<u32, u32>>,
}

impl<'a> Way<'a> {
    fn through(code: &'a Code) -> Self {
        let (blocks, span, counts, executed) = Default::default();
        Self { code, listed: None, blocks, block: None, previous: None, span, counts, executed }
    }

    /// Follows a line of the emulator's log.
    fn follow(&mut self, line: &str) {
        let hexadecimal = |text: &str| u32::from_str_radix(text, 16).ok();
        if let Some(listed) = line.strip_prefix("0x") {
            // Each instruction of a block, before the block is executed for the first time.
            self.listed = listed.split(':').next().and_then(hexadecimal);
        } else if let Some(executed) = line.strip_prefix("Trace ") {
            // What the block is called, and its address among flags.
            let name = executed.split(' ').nth(1).expect("a block's name");
            let first = executed.split('/').nth(1).and_then(hexadecimal).expect("an address");
            if let Some([first_before, last]) = self.block.take() {
                let length = self.code.instructions.get(&last).map_or(0, |last| last.length);
                self.execute(first_before, last + length, first);
            }
            if let Some(last) = self.listed.take() {
                self.blocks.insert(name.to_owned(), last);
            }
            self.block = Some([first, self.blocks[name]]);
        } else if line.starts_with("Stopped execution ") {
            // The block has not begun.
            self.block = None;
        } else if let Some(address) = line.strip_prefix("cpu_io_recompile: rewound execution of TB to ") {
            // What accesses a device becomes a block of its own.
            let address = hexadecimal(address.trim()).expect("an address");
            if let Some([first, _]) = self.block.take() {
                self.execute(first, address, address);
            }
            if self.code.instructions.get(&address).is_some_and(Instruction::loads) {
                self.end_span();
            }
        }
    }

    /// Executes one instruction after the other from `address` up to `end`, then goes on at `next`.
    fn execute(&mut self, mut address: u32, end: u32, next: u32) {
        while address < end {
            let Some(instruction) = self.code.instructions.get(&address) else {
                self.span.untimed = Some(address);
                return;
            };
            *self.span.executed.entry(address).or_default() += 1;
            address += instruction.length;
            let diverts = address == end && end != next;
            self.span.cycles += instruction.cycles(self.previous.as_ref(), diverts);
            self.span.instructions += 1;
            self.previous = Some(*instruction);
        }
        if end != next && self.code.functions.contains_key(&next) {
            self.span.called.get_or_insert(next);
        }
    }

    fn end_span(&mut self) {
        let Span { called, instructions, cycles, untimed, executed } = mem::take(&mut self.span);
        let Some(name) = called.and_then(|function| self.code.functions.get(&function)) else { return };
        self.executed.entry(name.clone()).or_insert_with(|| executed.into_iter().collect());
        let first = Count { instructions: [instructions; 2], cycles, untimed };
        let count = self.counts.entry(name.clone()).or_insert(first);
        let [least, greatest] = count.instructions;
        count.instructions = [least.min(instructions), greatest.max(instructions)];
        count.cycles.least = count.cycles.least.min(cycles.least);
        count.cycles.greatest = count.cycles.greatest.max(cycles.greatest);
        count.untimed = count.untimed.or(untimed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CODE: &str = "
00001000 <count>:
    1000:\t6808      \tldr\tr0, [r1, #0]
    1002:\tf000 f803 \tbl\t100c <work>
    1006:\t680a      \tldr\tr2, [r1, #0]
    1008:\t4770      \tbx\tlr

0000100c <work>:
    100c:\t2003      \tmovs\tr0, #3
    100e:\t3801      \tsubs\tr0, #1
    1010:\td1fd      \tbne.n\t100e <work+0x2>
    1012:\t4770      \tbx\tlr
";

    /// The timer is read, a function counts down from three, the timer is read again.
    const LOG: &str = "
0x00001000:  6808       ldr
0x00001002:  f000 f803  bl
Trace 0: 0x7f00 [00/00001000/00/00] count
cpu_io_recompile: rewound execution of TB to 00001000
0x00001000:  6808       ldr
Trace 0: 0x7f01 [00/00001000/00/00] count
0x00001002:  f000 f803  bl
Trace 0: 0x7f02 [00/00001002/00/00] count
0x0000100c:  2003       movs
0x0000100e:  3801       subs
0x00001010:  d1fd       bne
Trace 0: 0x7f03 [00/0000100c/00/00] work
Stopped execution of TB chain before 0x7f03 [0000100c] work
Trace 0: 0x7f03 [00/0000100c/00/00] work
0x0000100e:  3801       subs
0x00001010:  d1fd       bne
Trace 0: 0x7f04 [00/0000100e/00/00] work
Trace 0: 0x7f04 [00/0000100e/00/00] work
0x00001012:  4770       bx
Trace 0: 0x7f05 [00/00001012/00/00] work
0x00001006:  680a       ldr
0x00001008:  4770       bx
Trace 0: 0x7f06 [00/00001006/00/00] count
cpu_io_recompile: rewound execution of TB to 00001006
";

    #[test]
    fn what_is_between_two_readings_is_counted() {
        let code = Code::of(CODE);
        let mut way = Way::through(&code);
        LOG.lines().for_each(|line| way.follow(line));
        let Count { instructions, cycles, untimed } = way.counts["work"];
        // Ten instructions, of which a load takes a cycle more, and four go on elsewhere.
        assert_eq!((instructions, untimed), ([10, 10], None));
        assert_eq!(cycles, Cycles { least: 15, greatest: 23 });
        assert_eq!(way.counts.len(), 1);
    }
}
