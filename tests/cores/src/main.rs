//! Prints what a step of the shipped slide takes on this core, the fingerprint of what it computes, and what a lookup takes.
#![no_std]
#![no_main]

#[cfg(target_arch = "riscv32")]
mod riscv;

use slipfit_firmware::{
    lookups::Lookups,
    machine::{Machine, print},
    slide::Steps,
};

fn run(machine: &mut impl Machine) {
    let (steps, lookups) = (Steps::on(machine), Lookups::on(machine));
    print(machine, format_args!("{steps} {lookups}"));
}

#[cfg(target_arch = "arm")]
#[cortex_m_rt::entry]
fn main() -> ! {
    slipfit_firmware::board::boot(|board, _| {
        run(board);
        true
    })
}

#[cfg(target_arch = "riscv32")]
#[riscv_rt::entry]
fn main() -> ! {
    riscv::boot(run)
}
