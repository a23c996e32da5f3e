//! A Cortex-M under a debugger as a program's machine. The one file of the images with unsafe code.
#![allow(unsafe_code, reason = "linker symbols, the painted stack and the fault handler")]

#[cfg(not(feature = "defmt"))]
use core::fmt::{Display, Write as _};
#[cfg(feature = "defmt")]
use core::sync::atomic::{AtomicBool, Ordering};
use core::{panic::PanicInfo, slice};

#[cfg(target_abi = "eabihf")]
use cortex_m::register::fpscr;
use cortex_m::{
    Peripherals,
    peripheral::{SCB, SYST, scb::SystemHandler, syst::SystClkSource},
    register::msp,
};
use cortex_m_rt::{ExceptionFrame, exception};
#[cfg(not(feature = "defmt"))]
use heapless::String;
use semihosting::{
    io::{self, Stdout, Write as _},
    process,
};

use crate::machine::Machine;

/// The processor's clock (MHz), which the system timer counts: of a Cortex-M0 on a micro:bit, of a Cortex-M33 on an
/// AN505, of all others on the boards of their kind.
const CLOCK: u32 = if cfg!(armv6m) {
    16
} else if cfg!(armv8m) {
    20
} else {
    25
};

/// Time of a tick of the system timer (ns), on the boards of 25 MHz.
pub const TICK: u32 = 1000 / CLOCK;

/// Time of 125 instructions (µs): what the emulator is told by `-icount shift=7`, 2^7 ns each. At more than twice a tick,
/// the difference of two readings, right to less than a tick, gives the exact number of instructions.
const INSTRUCTIONS_125: u32 = 16;

/// What unused stack is filled with.
const PAINT: u32 = 0x5a5a_5a5a;

/// What a fresh Cortex-M has of FPSCR's AHP, DN, FZ and RMode: half precision as in IEEE 754, NaNs and denormals kept,
/// rounding to nearest.
#[cfg(target_abi = "eabihf")]
const FPSCR_MODES: u32 = 0x07c0_0000;

unsafe extern "C" {
    /// From `memory.x`: ends of the flash table's region.
    static _table_start: u8;
    static _table_end: u8;
    /// From cortex-m-rt: end of the program's data, where the stack must not reach.
    static mut _stack_end: u32;
}

/// The board.
pub struct Board {
    out: Stdout,
    timer: SYST,
    system: SCB,
    /// Instructions of an empty measurement.
    overhead: u32,
    /// Words of stack that were free at the start.
    painted: usize,
    /// The deepest stack before the last painting (bytes).
    deepest: u32,
}

impl Board {
    fn new(mut timer: SYST, system: SCB) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(0x00ff_ffff);
        timer.clear_current();
        timer.enable_counter();
        let (overhead, painted) = (instructions(|| {}), paint());
        Self { out: io::stdout().expect("a debugger listens"), timer, system, overhead, painted, deepest: 0 }
    }
}

impl Board {
    /// Has the system timer's interrupt called every `period` of [`TICK`]s, with the lowest priority: after a reset it has the
    /// highest, so that every other interrupt would wait for what it does.
    pub fn tick_every(&mut self, period: u32) {
        // SAFETY: no critical section relies on priorities; those of critical-section mask all interrupts.
        unsafe { self.system.set_priority(SystemHandler::SysTick, 0xff) };
        self.timer.set_reload(period - 1);
        self.timer.clear_current();
        self.timer.enable_interrupt();
    }

    /// Ends what [`tick_every`](Self::tick_every) began.
    pub fn tick_no_more(&mut self) {
        self.timer.disable_interrupt();
    }

    /// The deepest stack since the start (bytes), interrupts with it.
    pub fn deepest_stack(&mut self) -> u32 {
        self.deepest = self.deepest.max(used(self.painted));
        self.deepest
    }
}

impl Machine for Board {
    fn print(&mut self, line: &str) {
        self.out.write_all(line.as_bytes()).expect("a debugger listens");
    }

    #[inline(always)]
    fn instructions(&mut self, work: impl FnOnce()) -> Option<u32> {
        Some(instructions(work).saturating_sub(self.overhead))
    }

    #[inline(never)]
    fn stack(&mut self, work: impl FnOnce()) -> Option<u32> {
        // What was used so far is painted over.
        self.deepest_stack();
        let painted = paint();
        work();
        Some(used(painted))
    }
}

/// Paints the unused stack; says how many words it has.
#[inline(always)]
fn paint() -> usize {
    let end = &raw mut _stack_end;
    let words = (msp::read() as usize - end.addr()) / size_of::<u32>();
    for i in 0..words {
        // SAFETY: RAM between the program's data and the stack pointer is nobody's; an interrupt that comes in between
        // has left before the next word is painted.
        unsafe { end.add(i).write_volatile(PAINT) };
    }
    words
}

/// Bytes of the `painted` words that are painted no more.
fn used(painted: usize) -> u32 {
    let end = &raw mut _stack_end;
    // SAFETY: as in `paint`; whatever ran has left what it put there.
    let unused = (0..painted).take_while(|i| unsafe { end.add(*i).read_volatile() } == PAINT).count();
    ((painted - unused) * size_of::<u32>()) as u32
}

/// Instructions of `work` and of reading the timer, which counts down, 24 bits wide.
#[inline(always)]
fn instructions(work: impl FnOnce()) -> u32 {
    let start = SYST::get_current();
    work();
    let ticks = start.wrapping_sub(SYST::get_current()) & 0x00ff_ffff;
    let of_125 = CLOCK * INSTRUCTIONS_125;
    (ticks * 125 + of_125 / 2) / of_125
}

/// The region of the flash table.
fn flash() -> &'static [u8] {
    let (start, end) = (&raw const _table_start, &raw const _table_end);
    // SAFETY: memory.x says that this is flash, which nothing writes while the program runs.
    unsafe { slice::from_raw_parts(start, end.addr() - start.addr()) }
}

/// Runs `program` with the flash table's region, then ends the emulation, as failed if it says so by `false`.
///
/// # Panics
/// If the processor rounds in another way than the host, or on a second call.
pub fn boot(program: impl FnOnce(&mut Board, &'static [u8]) -> bool) -> ! {
    let peripherals = Peripherals::take().expect("nobody has taken them before");
    #[cfg(target_abi = "eabihf")]
    assert_eq!(fpscr::read().bits() & FPSCR_MODES, 0, "FPSCR would give other bits than the host");
    let done = program(&mut Board::new(peripherals.SYST, peripherals.SCB), flash());
    process::exit(i32::from(!done))
}

/// Prints why, and ends the emulation as failed: it must never hang.
#[cfg(not(feature = "defmt"))]
fn fail(why: impl Display) -> ! {
    let mut line = String::<512>::new();
    // A text that is too long loses its end.
    let _ = writeln!(line, "{why}");
    if let Ok(mut out) = io::stdout() {
        let _ = out.write_all(line.as_bytes());
    }
    process::exit(1)
}

#[cfg(not(feature = "defmt"))]
#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    fail(info)
}

#[cfg(not(feature = "defmt"))]
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    fail(format_args!("hard fault at {:#010x}", frame.pc()))
}

/// Says where, for the desk to look up why. Once: it may be the log itself that panics.
#[cfg(feature = "defmt")]
#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    static PANICKED: AtomicBool = AtomicBool::new(false);
    if let Some(at) = info.location().filter(|_| !PANICKED.swap(true, Ordering::Relaxed)) {
        defmt::error!("panicked at {=str}:{=u32}", at.file(), at.line());
    }
    process::exit(1)
}

/// It may have come in the middle of a frame, so that it speaks on another stream.
#[cfg(feature = "defmt")]
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    if let Ok(mut errors) = io::stderr() {
        let _ = errors.write_all(b"hard fault\n");
    }
    process::exit(1)
}
