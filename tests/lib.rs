//! What tests and benches share.

pub mod cortex_m4;
pub mod cross;
pub mod drive_table;
pub mod guide;
pub mod known_runs;
pub mod trace;
