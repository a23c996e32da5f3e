//! The desk: moves one mechanism, or thousands of units on lanes, by error-controlled steps or by a controller's.
//!
//! The only crate with hot generic code: what stands on it calls functions whose types are settled here, so that no edit there
//! compiles a step again. [`plant`] moves bodies with elements chosen at run time, [`slide`] one body on four pins by its fast
//! types, [`population`] thousands of such slides on the lanes of a register.
#![deny(unsafe_code)]
#![cfg_attr(
    not(target_arch = "x86_64"),
    allow(dead_code, unused_variables, reason = "only x86-64 has lanes; elsewhere units are simulated one by one")
)]

mod cast;
pub mod closing;
pub mod contact;
pub mod drive;
pub mod element;
pub mod error_control;
pub mod laws;
pub mod out_of_line;
pub mod pack;
pub mod plant;
pub mod population;
pub mod real;
pub mod scheme;
pub mod settled;
pub mod side_by_side;
pub mod slide;
mod step_control;
pub mod units;
