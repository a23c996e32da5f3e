//! The published timings, at zero wait states: tables 3-1, 3-2 (instruction set) and 7-1 (FPU) of the Cortex-M4 Technical
//! Reference Manual, ARM DDI 0439D, later ARM 100166, and the notes beside them.

use super::Cycles;

/// What decides over an instruction's cycles beside its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Writes its first operand.
    Compute,
    /// Writes flags, or nothing.
    Compare,
    /// Goes on elsewhere.
    Branch,
    /// Loads one word or less.
    Load,
    /// Stores one word or less.
    Store,
    /// Loads or stores words, each for a cycle more.
    Multiple,
    /// Makes what follows conditional.
    IfThen,
}

/// A row of the tables.
#[derive(Debug)]
pub struct Timing {
    /// Operations, without what sets flags, conditions and widths.
    pub operations: &'static str,
    pub kind: Kind,
    /// Its own cycles, without those of words and of a pipeline's refill.
    pub cycles: Cycles,
    /// Further ones if the next instruction consumes the result.
    pub late: Cycles,
}

/// Cycles of a pipeline's refill after whatever goes on elsewhere.
pub const REFILL: Cycles = Cycles { least: 1, greatest: 3 };

/// Cycles until data processing has updated the register that the next instruction's address depends on.
pub const ADDRESS: Cycles = Cycles::exactly(1);

/// Cycles of contention with the fetch unit, where a load is relative to the program counter.
pub const LITERAL: Cycles = Cycles { least: 0, greatest: 1 };

/// A row of the integer table.
const fn row(operations: &'static str, kind: Kind, least: u32, greatest: u32) -> Timing {
    Timing { operations, kind, cycles: Cycles { least, greatest }, late: Cycles::exactly(0) }
}

/// The tables. Where the notes differ, the least is theirs and the greatest the tables': a store takes one cycle or two. The
/// notes do not speak of the FPU's loads and stores; at the least these are like the core's.
pub const TIMINGS: [Timing; 25] = [
    row("mov movw movt mvn add addw adc adr sub subw sbc rsb neg and eor orr orn bic", Kind::Compute, 1, 1),
    row("lsl lsr asr ror rrx clz rbit rev rev16 revsh bfc bfi ubfx sbfx sxtb sxth uxtb uxth", Kind::Compute, 1, 1),
    row("mul mla mls smull umull smlal umlal umaal smmul smmla smmls", Kind::Compute, 1, 1),
    row("sxtab sxtah uxtab uxtah pkhbt pkhtb sel ssat usat", Kind::Compute, 1, 1),
    row("smulbb smulbt smultb smultt smlabb smlabt smlatb smlatt smulwb smulwt smlawb smlawt", Kind::Compute, 1, 1),
    row("sdiv udiv", Kind::Compute, 2, 12),
    row("mrs", Kind::Compute, 1, 2),
    row("cmp cmn tst teq nop sev clrex", Kind::Compare, 1, 1),
    row("msr cpsid cpsie", Kind::Compare, 1, 2),
    row("b bl bx blx cbz cbnz", Kind::Branch, 1, 1),
    // A cycle for the addition, by the notes.
    row("tbb tbh", Kind::Branch, 2, 3),
    row("it itt ite ittt itte itet itee itttt ittte ittet ittee itett itete iteet iteee", Kind::IfThen, 1, 1),
    row("ldr ldrb ldrh ldrsb ldrsh ldrex ldrexb ldrexh", Kind::Load, 2, 2),
    row("str strb strh", Kind::Store, 1, 2),
    row("ldrd strd ldm ldmia ldmdb stm stmia stmdb push pop", Kind::Multiple, 1, 1),
    row("vldr", Kind::Load, 2, 2),
    row("vstr", Kind::Store, 1, 2),
    row("vldm vldmia vldmdb vstm vstmia vstmdb vpush vpop vldr.double", Kind::Multiple, 1, 1),
    // Between registers of the FPU, with one of the core, for which the table has two rows, and with two of them.
    row("vmov vmrs vmsr vabs vneg", Kind::Compute, 1, 1),
    row("vmov.core", Kind::Compute, 1, 2),
    row("vmov.cores", Kind::Compute, 2, 2),
    Timing { late: Cycles { least: 0, greatest: 1 }, ..row("vcmp vcmpe", Kind::Compare, 1, 1) },
    Timing { late: Cycles::exactly(1), ..row("vadd vsub vmul vnmul vcvt vcvtr vcvtb vcvtt", Kind::Compute, 1, 1) },
    Timing { late: Cycles::exactly(1), ..row("vdiv vsqrt", Kind::Compute, 14, 14) },
    Timing { late: Cycles::exactly(1), ..row("vmla vmls vnmla vnmls vfma vfms vfnma vfnms", Kind::Compute, 3, 3) },
];
