//! Random units of a production: the same unit for the same seed and number, on every machine and in any order.
//!
//! [`stream`] gives every unit its own random numbers, [`normal`] turns one of them into one normal. Designs that need
//! tables or long integers (Sobol' points, Latin hypercubes) are the desk's.

pub mod normal;
pub mod stream;
