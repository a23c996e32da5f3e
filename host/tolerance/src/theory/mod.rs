//! What follows from a model without drawing units: worst case, RSS, moments, shares of contributors.

pub mod derivative;
pub mod experiment;
pub(crate) mod extremes;
pub mod indices;
pub mod moments;
pub mod rss;
pub mod tensor;
pub mod worst_case;
