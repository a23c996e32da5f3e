//! What the controller gets: force tables in flash, kernels as source text, and as units for other simulators.

mod c_border;
pub mod flash;
pub mod fmu;
pub mod force_table;
mod guard;
pub mod kernel_crate;
pub mod kernel_source;
pub mod production_table;
