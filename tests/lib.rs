//! What tests and benches share.

pub mod cross;
pub mod drive_table;
pub mod guide;
pub mod known_runs;
