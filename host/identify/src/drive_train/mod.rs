//! A drive train by its effort along the measured motion: force = mass·acceleration + viscous·speed + Coulomb·sign(speed) + offset.
//!
//! As the motion is measured, no controller has to be modelled and the model is linear in its parameters.

mod law;
mod motion;
#[cfg(test)]
mod tests;

pub use self::law::{DriveTrain, LAWS, Term};
pub use self::motion::{ComparedSamples, Filtered, Options, Signal, Smoothed, filtered, smoothed};
