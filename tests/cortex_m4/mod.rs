//! Cycles of a Cortex-M4F by its published timings: from the instructions that are executed, one after the other.

mod instruction;
mod timings;

use std::ops::AddAssign;

pub use instruction::Instruction;
use instruction::PC;
use timings::{ADDRESS, Kind, LITERAL, REFILL};

/// Cycles, as far as the published timings say: between these bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cycles {
    /// Loads and stores pair and instructions fold wherever they may, refills are the shortest. A division never goes on beside
    /// instructions of the core, which is a few cycles too many.
    pub least: u32,
    /// Nothing pairs or folds, refills are the longest.
    pub greatest: u32,
}

impl Cycles {
    const fn exactly(cycles: u32) -> Self {
        Self { least: cycles, greatest: cycles }
    }
}

impl AddAssign for Cycles {
    fn add_assign(&mut self, more: Self) {
        self.least += more.least;
        self.greatest += more.greatest;
    }
}

impl Instruction {
    /// Whether it loads one word or less.
    pub fn loads(&self) -> bool {
        self.timing.kind == Kind::Load
    }

    /// The cycles that it takes after `previous`, the instruction executed before it. It `diverts` where the next one executed
    /// is not the one that stands behind it.
    pub fn cycles(&self, previous: Option<&Self>, diverts: bool) -> Cycles {
        let mut cycles = self.timing.cycles;
        cycles += Cycles::exactly(self.words);
        match self.timing.kind {
            Kind::Load if self.base == PC => cycles += LITERAL,
            // Only a store to an address with a constant offset never waits.
            Kind::Store if self.base.count_ones() > 1 => cycles.least = cycles.greatest,
            _ => {}
        }
        if diverts {
            cycles += REFILL;
        }
        if let Some(previous) = previous {
            let depends = previous.writes & self.base != 0;
            match (previous.timing.kind, self.timing.kind) {
                (Kind::Compute, _) if depends => cycles += ADDRESS,
                (Kind::Load, Kind::Load | Kind::Store) if !depends => cycles.least = (cycles.least - 1).max(1),
                (_, Kind::IfThen) if previous.length == 2 => cycles.least = 0,
                _ => {}
            }
            if previous.writes & self.reads != 0 {
                cycles += previous.timing.late;
            }
        }
        // Whether its condition held is not known.
        if self.is_conditional && !diverts {
            cycles.least = cycles.least.min(1);
        }
        cycles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The least and the greatest cycles of `lines` of a disassembly, executed one after the other.
    fn of(lines: &[&str]) -> [u32; 2] {
        let (mut sum, mut previous) = (Cycles::default(), None);
        for line in lines {
            let instruction = Instruction::parse(&format!("    1000:\t{line}")).expect(line);
            sum += instruction.cycles(previous.as_ref(), false);
            previous = Some(instruction);
        }
        [sum.least, sum.greatest]
    }

    #[test]
    fn loads_and_stores_pair_as_in_the_manual() {
        // Its four examples, normally three, three, three and four cycles.
        assert_eq!(of(&["6808      \tldr\tr0, [r1, #0]", "6811      \tldr\tr1, [r2, #0]"]), [3, 4]);
        assert_eq!(of(&["5888      \tldr\tr0, [r1, r2]", "6158      \tstr\tr0, [r3, #20]"]), [3, 4]);
        assert_eq!(of(&["5888      \tldr\tr0, [r1, r2]", "5099      \tstr\tr1, [r3, r2]"]), [3, 4]);
        let three = ["5948      \tldr\tr0, [r1, r5]", "6811      \tldr\tr1, [r2, #0]", "685a      \tldr\tr2, [r3, #4]"];
        assert_eq!(of(&three), [4, 6]);
        // Not where the address is what was loaded, nor after a store.
        assert_eq!(of(&["6808      \tldr\tr0, [r1, #0]", "6801      \tldr\tr1, [r0, #0]"]), [4, 4]);
        assert_eq!(of(&["5099      \tstr\tr1, [r3, r2]", "6808      \tldr\tr0, [r1, #0]"]), [4, 4]);
        // Numbers of the FPU.
        assert_eq!(of(&["ed90 0a00 \tvldr\ts0, [r0]", "edc0 0a01 \tvstr\ts1, [r0, #4]"]), [3, 4]);
    }

    #[test]
    fn several_words_take_a_cycle_each() {
        assert_eq!(of(&["b5f0      \tpush\t{r4, r5, r6, r7, lr}"]), [6, 6]);
        assert_eq!(of(&["e8b0 00ff \tldmia.w\tr0!, {r0, r1, r2, r3, r4, r5, r6, r7}"]), [9, 9]);
        assert_eq!(of(&["e9d0 1200 \tldrd\tr1, r2, [r0]"]), [3, 3]);
        assert_eq!(of(&["ed2d 8b10 \tvpush\t{d8-d15}"]), [17, 17]);
        assert_eq!(of(&["ecb0 0a04 \tvldmia\tr0!, {s0-s3}"]), [5, 5]);
        assert_eq!(of(&["ed90 0b00 \tvldr\td0, [r0]"]), [3, 3]);
    }

    #[test]
    fn a_result_that_is_consumed_at_once_comes_late() {
        let add = "ee30 0a81 \tvadd.f32\ts0, s1, s2";
        assert_eq!(of(&[add, "ee21 1a81 \tvmul.f32\ts2, s3, s2"]), [2, 2]);
        assert_eq!(of(&[add, "ee20 1a01 \tvmul.f32\ts2, s0, s2"]), [3, 3]);
        assert_eq!(of(&[add, "ed80 0a00 \tvstr\ts0, [r0]"]), [3, 4]);
        assert_eq!(of(&[add, "ed2d 0b02 \tvpush\t{d0}"]), [5, 5]);
        // A sum is consumed a cycle later.
        assert_eq!(of(&[add, "ee01 0a81 \tvmla.f32\ts0, s3, s2"]), [4, 4]);
        assert_eq!(of(&[add, "ee00 1a01 \tvmla.f32\ts2, s0, s2"]), [5, 5]);
        // Moves are no arithmetic.
        assert_eq!(of(&["eeb0 0a60 \tvmov.f32\ts0, s1", "ee20 1a01 \tvmul.f32\ts2, s0, s2"]), [2, 2]);
        assert_eq!(of(&["eeb4 0a60 \tvcmp.f32\ts0, s1", "eef1 fa10 \tvmrs\tAPSR_nzcv, fpscr"]), [2, 3]);
        assert_eq!(of(&["ee80 0a81 \tvdiv.f32\ts0, s1, s2", "eeb1 0a40 \tvneg.f32\ts0, s0"]), [16, 16]);
    }

    #[test]
    fn moves_between_core_and_fpu_have_timings_of_their_own() {
        assert_eq!(of(&["ee00 0a10 \tvmov\ts0, r0"]), [1, 2]);
        assert_eq!(of(&["ec41 0b10 \tvmov\td0, r0, r1"]), [2, 2]);
        assert_eq!(of(&["eeb7 0a00 \tvmov.f32\ts0, #112\t@ 0x3f800000  1.0"]), [1, 1]);
    }

    #[test]
    fn an_address_must_have_been_computed() {
        assert_eq!(of(&["1840      \tadds\tr0, r0, r1", "6801      \tldr\tr1, [r0, #0]"]), [4, 4]);
        assert_eq!(of(&["1840      \tadds\tr0, r0, r1", "6011      \tstr\tr1, [r2, #0]"]), [2, 3]);
        assert_eq!(of(&["b082      \tsub\tsp, #8", "b5f0      \tpush\t{r4, r5, r6, r7, lr}"]), [8, 8]);
        assert_eq!(of(&["4288      \tcmp\tr0, r1", "6801      \tldr\tr1, [r0, #0]"]), [3, 3]);
    }

    #[test]
    fn conditions_and_widths_change_no_operation() {
        assert_eq!(of(&["4288      \tcmp\tr0, r1", "bfc8      \tit\tgt", "eeb0 0a60 \tvmovgt.f32\ts0, s1"]), [2, 3]);
        assert_eq!(
            of(&["ea80 0001 \teor.w\tr0, r0, r1", "bfc8      \tit\tgt", "6808      \tldrgt\tr0, [r1, #0]"]),
            [3, 4]
        );
        for one in ["0040      \tlsls\tr0, r0, #1", "4348      \tmuls\tr0, r1", "438b      \tbics\tr3, r1"] {
            assert_eq!(of(&[one]), [1, 1], "{one}");
        }
        assert_eq!(of(&["fbb0 f0f1 \tudiv\tr0, r0, r1"]), [2, 12]);
        assert!(Instruction::parse("    1000:\tbe00      \tbkpt\t0x0000").is_none());
        assert!(Instruction::parse("    1000:\t12345678 \t.word\t0x12345678").is_none());
    }

    #[test]
    fn what_goes_on_elsewhere_refills() {
        let cycles = |line: &str, diverts| {
            let Cycles { least, greatest } =
                Instruction::parse(&format!("    1000:\t{line}")).expect(line).cycles(None, diverts);
            [least, greatest]
        };
        let branch = "d1fe      \tbne.n\t1000 <step>";
        assert_eq!((cycles(branch, false), cycles(branch, true)), ([1, 1], [2, 4]));
        assert_eq!(cycles("f000 f800 \tbl\t1004 <step>", true), [2, 4]);
        // Its place is no register.
        assert_eq!(of(&["ee30 ea20 \tvadd.f32\ts28, s0, s1", "e7fe      \tb.n\td14 <step>"]), [2, 2]);
        assert_eq!(cycles("bdf0      \tpop\t{r4, r5, r6, r7, pc}", true), [7, 9]);
        assert_eq!(cycles("e8df f000 \ttbb\t[pc, r0]", true), [3, 6]);
        assert_eq!(cycles("4801      \tldr\tr0, [pc, #4]\t@ (1008 <step+0x8>)", false), [2, 3]);
    }
}
