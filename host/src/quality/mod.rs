//! How far the solvers can be believed: error against run time, and where fixed steps stop holding.

pub mod precision;
pub mod stability;
