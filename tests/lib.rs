//! Shared by the tests and benches.
#![forbid(unsafe_code)]

pub mod cross;
