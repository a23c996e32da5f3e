//! Rigid bodies on clearance joints, stepped in bounded time with the same bits on every machine.
//!
//! Units are SI throughout (m, kg, s, N, rad). Suffixes name the frame: `_w` the fixed frame, `_b` the moving body.
//! A gap is the signed distance between the two surfaces of a contact, negative when they penetrate.
//!
//! *The paper* is Makkonen, Kuosmanen, Münster, Mäkeläinen, Ramseier: "Quality management by concurrent computer
//! aided tolerance analysis and functional prototyping"; equation and table numbers are its own.
//!
//! Where to look: [`law`] holds one force law a file, [`slide`] the mechanism of the paper, [`integrator`] the
//! fixed-step schemes, [`kernel`] what a controller calls once a step, [`table`] the flash table it may look up instead,
//! [`monitor`] what tells a tight or jammed drive from a free one, [`production`] what a controller knows of its own unit.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(any(test, feature = "std"))]
extern crate std;

pub mod ahead;
mod cast;
pub mod clearance;
pub mod deadline;
pub mod drive;
mod error;
pub mod integrator;
pub mod kernel;
pub mod law;
mod linear;
pub mod mechanism;
pub mod menu;
pub mod monitor;
pub mod observer;
pub mod pose;
pub mod power;
mod product;
pub mod production;
#[cfg(feature = "sampling")]
pub mod sampling;
mod scalar;
pub mod scene;
pub mod slide;
pub mod system;
pub mod table;

pub use cast::Cast;
pub use error::ParameterError;
pub use nalgebra::{SMatrix, SVector, Vector2, Vector3};
pub use scalar::Scalar;
