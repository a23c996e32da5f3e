//! A RISC-V core under a debugger as a program's machine.

use core::panic::PanicInfo;

use riscv::register::minstret;
use semihosting::{
    io::{self, Stdout, Write as _},
    println, process,
};
use slipfit_firmware::machine::Machine;

/// The core.
pub struct Core {
    out: Stdout,
    /// Instructions of an empty measurement.
    overhead: u32,
}

impl Machine for Core {
    fn print(&mut self, line: &str) {
        self.out.write_all(line.as_bytes()).expect("a debugger listens");
    }

    #[inline(always)]
    fn instructions(&mut self, work: impl FnOnce()) -> Option<u32> {
        Some(instructions(work) - self.overhead)
    }

    fn stack(&mut self, work: impl FnOnce()) -> Option<u32> {
        work();
        None
    }
}

/// Instructions of `work` and of reading the counter, by its lower half.
#[inline(always)]
fn instructions(work: impl FnOnce()) -> u32 {
    let start = minstret::read();
    work();
    minstret::read().wrapping_sub(start) as u32
}

/// Runs `program`, then ends the emulation.
pub fn boot(program: impl FnOnce(&mut Core)) -> ! {
    let out = io::stdout().expect("a debugger listens");
    program(&mut Core { out, overhead: instructions(|| {}) });
    process::exit(0)
}

/// Prints why, and ends the emulation as failed: it must never hang.
#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    println!("{info}");
    process::exit(1)
}
