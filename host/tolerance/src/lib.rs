//! Tolerance analysis: how the measures of an assembled product vary over the production.
//!
//! A [`model::Model`] turns random contributors, each with its distribution, into measures; it does not know how they
//! are drawn. What draws them ([`sampling`]) and makes statistics of the measures ([`counting`], [`statistics`]) does not
//! know what they mean. [`theory`] finds figures without drawing, [`failure`] the probability of what is too rare to be
//! counted, [`allocate`] the cheapest tolerances. What a model is of may be a [`product`]: parts, features, tolerances and mates.
//! [`mod@unit`] and [`number`] are how quantities are written.
#![forbid(unsafe_code)]

pub mod allocate;
pub mod analysis;
pub mod counting;
#[cfg(test)]
mod coverage_tests;
pub mod distribution;
#[cfg(test)]
mod examples;
pub mod failure;
pub mod model;
pub mod number;
pub mod numeric;
pub mod product;
pub mod report;
pub mod sampling;
pub mod statistics;
#[cfg(test)]
mod tests;
pub mod theory;
pub mod unit;
