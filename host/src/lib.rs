//! Tolerance analysis, dynamics and flash tables of sliding mechanisms.
//!
//! The command line is in [`cli`], one file a command; everything it prints is computed by the modules beside it.
#![forbid(unsafe_code)]

pub mod answer;
pub mod audit;
mod chart;
pub mod cli;
pub mod confirm;
pub mod controller;
pub mod desk;
pub mod deviation;
pub mod driven;
pub mod error_control;
#[cfg(test)]
mod example;
pub mod export;
pub mod figure;
pub mod files;
pub mod flash;
pub mod force_table;
pub mod interrupt;
pub mod kernel_crate;
pub mod kernel_source;
mod laws;
mod layout;
mod looks;
mod markup;
pub mod mechanism;
pub mod mobility;
pub mod number;
pub mod out_of_line;
pub mod outcome;
mod palette;
pub mod plot;
pub mod population;
pub mod precision;
pub mod product;
#[cfg(test)]
mod reference;
pub mod report;
pub mod scene;
pub mod scheme;
pub mod self_locking;
pub mod simulate;
pub mod stability;
pub mod strips;
mod svg;
pub mod sweep;
pub mod table2;
pub mod tolerance;
pub mod trust;
