//! The kernel of a scene as a co-simulation unit (FMU) for other simulators, by the Functional Mock-up Interface 3.0 or 2.0.
//!
//! A unit is the same kernel that `slipfit kernel --crate` writes, compiled for this machine behind the functions of the
//! standard, whose source is in `template`. Parameters are replaced in copies of the kernel's, so that the unit as it is has the
//! kernel's bits.

mod archive;
mod compile;
mod description;
mod mechanism;
mod model;
mod slide;
mod variable;

#[cfg(test)]
#[path = "template/clock.rs"]
mod clock;

use std::path::PathBuf;

pub use archive::archive;
pub use compile::{CompileError, Sources, compile, library_path};
pub use description::{Fmi, description, identifier};
pub use mechanism::mechanism_unit;
pub use slide::slide_unit;
pub use variable::{Causality, UNITS, Variable};

use crate::{firmware::kernel_crate::CrateFiles, setup::ControllerSpec};
use variable::Variables;

/// A scene as a unit before it is compiled.
#[derive(Clone, Debug)]
pub struct Unit {
    /// The scene's title.
    pub title: String,
    /// What library and description both carry.
    pub token: String,
    /// The kernel's step (s).
    pub step: f64,
    /// Duration of the scene's run (s).
    pub duration: f64,
    /// Fixed parameters, tunable ones, inputs, outputs, in this order.
    pub variables: Vec<Variable>,
    kernel: CrateFiles,
    model: String,
}

/// What the tolerance level is.
const LEVEL: &str = "tolerance level: every gap is narrower by n times its standard deviation";

/// What ties a description to its library: the scene's hash and what computes it.
fn token(hash: u64, controller: &ControllerSpec) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!("slipfit {version} {hash:016x} {} {} s", controller.integrator.name(), controller.step)
}

/// Adds what the last step says about itself.
fn add_report(variables: &mut Variables, outputs: &mut String) {
    variables.output("residual", "N.s", "imbalance of momentum that the last step of the kernel left");
    variables.output("error", "N.s", "estimate of the momentum's error that the last step of the kernel made");
    outputs.push_str("            f64::from(report.residual),\n            f64::from(report.error),\n");
}

/// A file of a unit's archive and its bytes.
pub type Entry = (PathBuf, Vec<u8>);
