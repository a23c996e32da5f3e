//! Tolerance analysis: how the measures of an assembled product vary over the production.
//!
//! A [`model::Model`] turns random contributors into measures; it does not know how they are drawn. What draws them
//! and makes statistics of the measures does not know what they mean.
//!
//! Drawing goes [`sampler`] (random numbers of a unit) → [`draw`] (its variables) → the model → [`tally`] (counts and
//! sums) → [`forest`] (joined in a fixed shape).

pub mod allocate;
pub mod analysis;
mod beta;
pub mod binomial;
pub mod copula;
pub mod correlation;
#[cfg(test)]
mod coverage_tests;
mod cumulative;
pub mod derivative;
mod distribution;
#[cfg(test)]
mod distribution_tests;
pub mod draw;
pub mod estimate;
#[cfg(test)]
mod examples;
pub mod experiment;
mod extreme;
mod extremes;
pub mod failure;
pub mod file;
pub mod forest;
pub mod importance;
pub mod indices;
pub mod interval;
pub mod lanes;
pub mod linear;
pub mod loss;
mod mixture;
pub mod model;
pub mod moments;
pub mod nested;
pub mod normal;
pub mod pairs;
mod permutation;
pub mod picture;
pub mod quadrature;
mod regions;
pub mod report;
mod root;
pub mod rss;
pub mod run;
pub mod sampler;
pub mod shape;
pub mod shard;
pub mod sobol;
mod streams;
pub mod study;
pub mod subset;
pub mod tail;
#[cfg(test)]
mod tail_tests;
pub mod tally;
pub mod tensor;
#[cfg(test)]
mod tests;
pub mod widening;
pub mod worst_case;
