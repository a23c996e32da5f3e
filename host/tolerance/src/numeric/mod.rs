//! Numbers alone: lanes of them, the normal distribution's functions, Gauss's points, roots, and the shape that moments give.

pub mod gauss;
pub mod lanes;
pub mod normal;
pub mod root;
pub mod shape;
