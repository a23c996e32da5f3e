//! What a watch by a table of a production takes on a Cortex-M4F: instructions, stack and state.
//!
//! `cargo qemu-production table.bin` runs the image with a table that `slipfit table --production` made.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod program;

#[cfg(all(feature = "defmt", target_os = "none"))]
compile_error!("this image prints text, which must not share a stream with frames: only slipfit-drive logs by defmt");

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    slipfit_firmware::board::boot(program::run)
}

#[cfg(not(target_os = "none"))]
fn main() -> std::io::Result<std::process::ExitCode> {
    slipfit_firmware::desk::boot(program::run)
}
