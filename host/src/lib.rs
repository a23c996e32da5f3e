//! Tolerance analysis, dynamics and flash tables of mechanisms with clearance joints.
//!
//! What a designer writes is read by [`scene`]; it becomes a [`product`] (parts, tolerances, measures), a slide as [`setup`] has it, or a
//! [`mechanism`] (bodies, joints, drives). [`tolerance`] says how the measures vary, [`dynamics`] what one unit
//! does, [`population`] what every unit of a production does, [`quality`] how far the solvers can be believed. [`firmware`]
//! is what the controller gets, [`show`] what people look at. The command line is in [`cli`], one file a command.
#![deny(unsafe_code)]

pub mod cli;
pub mod dynamics;
pub mod firmware;
pub mod identify;
pub mod mechanism;
pub mod population;
pub mod possible;
pub mod quality;
#[cfg(test)]
mod reference;
pub mod scene;
pub mod setup;
pub mod show;
pub(crate) mod xml;

pub use slipfit_system as system;
pub use slipfit_tolerance as tolerance;
pub use slipfit_tolerance::product;
