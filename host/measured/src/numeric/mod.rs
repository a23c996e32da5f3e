//! Distributions of what a normal sample gives, and a minimiser.

pub mod minimum;
pub mod noncentral_t;
pub mod scale;
pub mod tails;
