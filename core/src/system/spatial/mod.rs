//! Bodies in space: free ones, and such on ideal joints ([`tree`]).
//!
//! Generalised velocities of free bodies are, body by body, the velocity of the centre of mass in the frame (m/s) and the angular
//! velocity in the body (rad/s), so that the mass matrix is constant and free flight is exact.

mod blocks;
mod bodies;
mod driven;
mod floating;
mod pair;
mod port;
mod rim;
mod seat;
pub mod tree;

pub use bodies::{FreeBodies, InFrame, Placed, PlacedBody, Rigid};
pub use driven::{About, Along, AtPoint};
pub(crate) use floating::split;
pub use floating::{Floating, PinOfFrame, Pull};
pub use pair::Pair;
pub use port::{Port, Seat};
pub use rim::{Parallel, Rim, TurnedAxes};
