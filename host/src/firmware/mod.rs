//! What the controller gets: force tables in flash, and kernels as source text.

pub mod flash;
pub mod force_table;
pub mod kernel_crate;
pub mod kernel_source;
