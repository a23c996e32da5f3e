//! From the index of a unit to the values of its variables: random numbers, then what makes them correlated.

pub mod copula;
pub mod correlation;
pub mod draw;
mod error;
mod permutation;
pub mod sampler;
pub mod sobol;
pub(crate) mod streams;
