//! Measured parts.
//!
//! A [`table::MeasuredTable`] holds one value per part and characteristic, with nominal values, limits and subgroups;
//! [`csv`] reads and writes it.
#![forbid(unsafe_code)]

pub mod capability;
pub mod csv;
#[cfg(test)]
mod examples;
pub mod families;
pub mod numeric;
pub mod production;
pub mod table;
pub mod unit;
