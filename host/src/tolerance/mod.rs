//! Tolerance analysis: how the measures of an assembled product vary over the production.
//!
//! A [`model::Model`] turns random contributors into measures; it does not know how they are drawn. What draws them
//! and makes statistics of the measures does not know what they mean.

pub mod lanes;
pub mod model;
