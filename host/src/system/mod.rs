//! Files that are whole or not there, and Ctrl-C.

pub mod files;
pub mod interrupt;
