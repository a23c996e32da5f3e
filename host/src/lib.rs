//! Tolerance analysis, dynamics and flash tables of sliding mechanisms.
#![forbid(unsafe_code)]

mod chart;
#[cfg(test)]
mod example;
pub mod figure;
mod layout;
mod markup;
pub mod number;
pub mod outcome;
pub mod plot;
pub mod report;
pub mod scene;
pub mod sweep;
pub mod table2;
