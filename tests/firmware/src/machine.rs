//! What programs need of the machine they run on.

use core::fmt::{Arguments, Write};

use heapless::String;

/// A machine: the board, or the desk.
pub trait Machine {
    /// Prints `line`, which ends in a newline.
    fn print(&mut self, line: &str);

    /// Does `work` and says how many instructions it took, if the machine can tell.
    fn instructions(&mut self, work: impl FnOnce()) -> Option<u32>;

    /// Does `work` and says how many bytes of stack it took, if the machine can tell.
    fn stack(&mut self, work: impl FnOnce()) -> Option<u32>;
}

/// Prints one line in one go, because every write stops the machine for its debugger.
pub fn print(machine: &mut impl Machine, text: Arguments<'_>) {
    let mut line = String::<128>::new();
    writeln!(line, "{text}").expect("a line fits its buffer");
    machine.print(&line);
}
