//! Tolerance analysis, dynamics and flash tables of sliding mechanisms.
#![forbid(unsafe_code)]

pub mod flash;
pub mod outcome;
pub mod scene;
pub mod sweep;
