//! Parameters from measured motion.
//!
//! A [`record::Record`] is read from a CSV file. A [`model::Model`] computes what its force should have been, for given parameters.
//! [`estimate::estimate`] fits the one to the other, checks before which combinations of parameters the record determines, and says
//! with intervals how well it does. [`drive_train`] is the model of a drive train by its effort along the measured motion.
#![forbid(unsafe_code)]

pub mod beforehand;
pub mod between;
pub mod compare;
pub mod doubt;
pub mod drive_train;
pub mod estimate;
pub mod fit;
pub mod model;
pub mod record;
pub mod signal;
