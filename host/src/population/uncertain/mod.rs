//! Populations with unknowns: parameters with one value in the whole production, but which?
//!
//! An outer loop tries values of what is unknown, an inner one counts units of each. What a figure of the whole production is, is then
//! a distribution: as probable as the values that lead to it.

pub mod answer;
pub mod design;
pub mod study;
pub mod unknown;
