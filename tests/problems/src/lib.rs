//! Problems with known solutions: each a function that returns what to solve, beside what must come out.
#![no_std]
#![forbid(unsafe_code)]

mod arcs;
pub mod cd_rom;
pub mod first_order;
pub mod laws;
pub mod mechanisms;

pub use arcs::arcs;
