//! Drives: what a controller commands, what it gives, and what its drive train takes.

mod command;
mod ramp;
mod setpoints;
mod train;

pub use command::{Command, Commanded, Piece, check_pieces};
pub use ramp::{Drive, checked_command};
pub use setpoints::SetpointDrive;
pub(crate) use setpoints::catmull_rom;
pub use train::{Train, TrainData};

use crate::{ParameterError, Scalar};

/// The force of a drive on its body and its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pushed<S> {
    /// Force (N) or torque (N·m).
    pub force: S,
    /// −∂force/∂speed (N·s/m, N·m·s/rad).
    pub per_speed: S,
    /// ∂force/∂t (N/s, N·m/s) at constant speed.
    pub per_time: S,
}

/// What drives a body along or about an axis, as a menu of types so that a scene without a drive pays nothing.
pub trait Push<S>: Clone {
    /// This drive, if it can be stepped without failing.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    fn checked(self) -> Result<Self, ParameterError<S>>
    where
        S: PartialOrd;

    /// The force (N) or torque (N·m) that the controller commands at time `t` (s) and speed `v` (m/s, rad/s).
    fn effort(&self, t: S, v: S) -> S;

    /// The force on the body at time `t` (s) and speed `v` (m/s, rad/s): the effort, less what the drive train takes.
    fn pushed(&self, t: S, v: S) -> Pushed<S>;
}

/// A drive whose command may be told while it is stepped.
pub trait Commandable<S> {
    /// From now on the commanded speed is `v` (m/s, rad/s) at any time, until another one is set.
    fn set_command(&mut self, v: S);
}

/// No drive.
impl<S: Scalar> Push<S> for () {
    fn checked(self) -> Result<Self, ParameterError<S>> {
        Ok(())
    }

    #[inline(always)]
    fn effort(&self, _: S, _: S) -> S {
        S::zero()
    }

    #[inline(always)]
    fn pushed(&self, _: S, _: S) -> Pushed<S> {
        Pushed { force: S::zero(), per_speed: S::zero(), per_time: S::zero() }
    }
}
