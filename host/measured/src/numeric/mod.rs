//! Distributions of what a normal sample gives, a minimiser, and samples of any density.

pub mod importance;
pub mod minimum;
pub mod noncentral_t;
pub mod scale;
pub mod tails;
