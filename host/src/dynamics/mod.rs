//! What one unit does when it is driven: its run by the desk and by the controller, and sweeps over tolerance levels.

pub mod answer;
pub mod audit;
pub mod command;
pub mod confirm;
pub mod controller;
pub mod desk;
pub mod deviation;
pub mod driven;
pub mod effort;
#[cfg(test)]
pub(crate) mod example;
pub mod film;
pub mod level;
pub(crate) mod looks;
pub mod observer;
pub mod outcome;
pub mod run;
pub mod setpoint;
pub mod settings;
pub mod simulate;
pub mod slide;
pub mod sweep;
pub mod tipping;
pub mod tolerance;
pub mod trajectory;
pub mod trust;

pub(crate) use slipfit_desk::laws;
pub use slipfit_desk::{error_control, out_of_line, scheme};
