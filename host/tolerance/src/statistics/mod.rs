//! What a sample says of the production it comes from, and how surely.

pub mod binomial;
pub mod decisive;
pub mod estimate;
pub mod interval;
pub mod mixture;
