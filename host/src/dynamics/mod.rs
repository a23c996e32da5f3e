//! What one unit does when it is driven: its run by the desk and by the controller, and sweeps over tolerance levels.

#[cfg(target_arch = "x86_64")]
pub mod abreast;
pub mod answer;
pub mod audit;
pub mod confirm;
pub mod controller;
pub mod desk;
pub mod deviation;
pub mod driven;
pub mod error_control;
#[cfg(test)]
pub(crate) mod example;
pub mod film;
pub(crate) mod laws;
pub(crate) mod looks;
pub mod out_of_line;
pub mod outcome;
pub mod pack;
pub mod scheme;
pub mod simulate;
pub mod sweep;
pub mod tipping;
pub mod trajectory;
pub mod trust;
pub mod wide;
