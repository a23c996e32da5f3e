//! What tests and benches share.

pub mod cross;
pub mod known_runs;
