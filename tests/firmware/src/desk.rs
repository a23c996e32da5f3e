//! The host as a program's machine: the reference for the image.

use std::{env, fs, io, process::ExitCode};

use crate::machine::Machine;

/// Bytes of the TABLE region of `memory.x`.
const TABLE_LENGTH: usize = 256 * 1024;

/// The desk.
pub struct Desk;

impl Machine for Desk {
    fn print(&mut self, line: &str) {
        print!("{line}");
    }

    fn instructions(&mut self, work: impl FnOnce()) -> Option<u32> {
        work();
        None
    }

    fn stack(&mut self, work: impl FnOnce()) -> Option<u32> {
        work();
        None
    }
}

/// Runs `program` with the table in the file that the first argument names, if there is one. It fails by `false`.
///
/// # Errors
/// If the file cannot be read or is larger than the flash kept for it.
pub fn boot(program: impl FnOnce(&mut Desk, &'static [u8]) -> bool) -> io::Result<ExitCode> {
    let mut flash = match env::args_os().nth(1) {
        Some(file) => fs::read(&file).map_err(|error| io::Error::other(format!("{}: {error}", file.display())))?,
        None => Vec::new(),
    };
    if flash.len() > TABLE_LENGTH {
        return Err(io::Error::other("the table is larger than the flash that memory.x keeps for it"));
    }
    // As the emulator has it; an erased flash would read 0xff.
    flash.resize(TABLE_LENGTH, 0);
    let done = program(&mut Desk, flash.leak());
    Ok(if done { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
