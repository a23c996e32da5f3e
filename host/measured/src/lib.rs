//! Measured parts.
//!
//! A [`table::MeasuredTable`] holds one value per part and characteristic, with nominal values, limits and subgroups.
#![forbid(unsafe_code)]

pub mod table;
