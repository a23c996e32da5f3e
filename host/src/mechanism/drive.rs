//! Drives of a mechanism: what they act on, what they are commanded, and the friction of their drive trains.

use nalgebra::Vector3;
use slipfit_core::{
    ParameterError,
    drive::{Commanded, Drive, Push, TrainData},
};
use slipfit_desk::drive::AnyDrive;

use super::{Command, Mechanism, Sampling};
use crate::dynamics::{confirm::LEAST_TRAVEL, setpoint::Setpoint};

/// The limit (N, N·m) of a motor for which none is stated.
pub const UNLIMITED: f64 = 1e12;

/// Time (s) by which a prescribed motion follows its command: mass over gain.
pub const PRESCRIBED: f64 = 1e-7;

/// A drive with its name: a P-velocity controller behind a ramp (eq. 12), or behind any commanded speed.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedDrive {
    /// Name.
    pub name: String,
    /// The body that it drives, from the frame.
    pub body: usize,
    /// The controller. For a torque gain and speed are in N·m·s/rad and rad/s, and the point counts for nothing. With a `command` the
    /// ramp spans its segments, and the speed is the fastest that is commanded.
    pub drive: Drive<f64>,
    /// How it acts.
    pub action: Action,
    /// What is commanded in place of the ramp, if anything is.
    pub command: Option<Command>,
    /// How its controller samples; `None` of one that acts continuously.
    pub sampling: Option<Sampling>,
    /// Whether the body moves as commanded, whatever force that takes: the gain is so high then that the body
    /// follows within 0.1 µs.
    pub is_prescribed: bool,
    /// The limit of its motor and the friction of its drive train, if any is stated.
    pub train: Option<TrainData<f64>>,
    /// Whether it controls the speed of the centre of mass, not that of its point.
    pub at_centre: bool,
    /// Inertia of what turns with its motor, as the body feels it (kg, kg·m²).
    pub rotor: f64,
}

/// How a drive acts on its body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// As a force along an axis of the frame, at the drive's point.
    Pushes {
        /// Direction, of unit length.
        axis: [f64; 3],
    },
    /// As a torque about an axis of the frame; it controls the angular velocity.
    Turns {
        /// Direction, of unit length; in a plane it is the plane's normal.
        axis: [f64; 3],
    },
}

impl Action {
    /// Direction of the force, or of the torque's axis.
    pub fn axis(self) -> [f64; 3] {
        match self {
            Self::Pushes { axis } | Self::Turns { axis } => axis,
        }
    }
}

impl NamedDrive {
    /// What it is commanded.
    pub fn setpoint(&self) -> Setpoint {
        Setpoint::new(self.drive, self.command.clone())
    }

    /// The commanded speed (m/s, rad/s) at time `t` (s).
    pub fn commanded(&self, t: f64) -> f64 {
        self.setpoint().at(t)
    }

    /// The speed and the travel (m/s and m, rad/s and rad) that figures at the end `t` (s) of a run are compared with. What is at rest there
    /// by its command, or back where it began, is compared with a thousandth of how fast it went and how far that may be.
    pub fn scale(&self, t: f64) -> [f64; 2] {
        let command = self.commanded(t).abs();
        match self.command {
            None => [command, LEAST_TRAVEL],
            Some(_) => {
                let least = 1e-3 * self.drive.speed.abs();
                [command.max(least), LEAST_TRAVEL.max(least * t)]
            }
        }
    }

    /// The same drive with another greatest `speed` (m/s, rad/s): what is commanded is scaled.
    pub fn set_speed(&mut self, speed: f64) {
        if let Some(command) = &mut self.command {
            *command = command.scaled(speed / self.drive.speed);
        }
        self.drive.speed = speed;
    }

    /// The drive as core computes with it, in the mechanism that it is of.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn law(&self, mechanism: &Mechanism) -> Result<AnyDrive, ParameterError<f64>> {
        let train = self.train_in(mechanism);
        match &self.sampling {
            Some(sampling) => AnyDrive::held(sampling.held.clone(), train),
            None => AnyDrive::new(self.drive, self.command.as_ref().map(|command| &command.pieces), train),
        }
    }

    /// Its drive train in `mechanism`, with what lifts the weight that a rotor does not have: bodies carry the rotor's inertia as mass.
    pub fn train_in(&self, mechanism: &Mechanism) -> Option<TrainData<f64>> {
        let weight = self.rotor_weight(mechanism);
        let free = TrainData { limit: UNLIMITED, coulomb: [0.0; 2], stick_band: 1.0, viscous: 0.0, offset: 0.0 };
        let train = if weight == 0.0 { self.train } else { Some(self.train.unwrap_or(free)) };
        train.map(|train| TrainData { offset: train.offset + weight, ..train })
    }

    /// The weight (N) along the axis that the rotor would have as a mass.
    pub fn rotor_weight(&self, mechanism: &Mechanism) -> f64 {
        match self.action {
            Action::Pushes { axis } => {
                self.rotor * mechanism.gravity.iter().zip(axis).map(|(gravity, axis)| gravity * axis).sum::<f64>()
            }
            Action::Turns { .. } => 0.0,
        }
    }

    /// From the centre of mass of its body to the point whose speed it controls (m): in the drawn pose, and as `turned` turns it.
    pub fn arms(&self, turned: impl Fn(Vector3<f64>) -> Vector3<f64>) -> [Vector3<f64>; 2] {
        let lever = if self.at_centre { Vector3::zeros() } else { self.drive.point_b };
        [lever, turned(lever)]
    }

    /// Speed and place along its axis (m/s and m, rad/s and rad), where its body has these velocities, of its centre of mass and of its
    /// turning, and has moved by `displacement` (m) and turned by `turned` (rad).
    pub fn measured_motion(
        &self,
        [velocity, spin]: [Vector3<f64>; 2],
        displacement: Vector3<f64>,
        [lever, arm]: [Vector3<f64>; 2],
        turned: impl FnOnce() -> Vector3<f64>,
    ) -> [f64; 2] {
        let axis = Vector3::from(self.action.axis());
        match self.action {
            Action::Pushes { .. } => {
                [(velocity + spin.cross(&arm)).dot(&axis), (displacement + (arm - lever)).dot(&axis)]
            }
            Action::Turns { .. } => [spin.dot(&axis), turned().dot(&axis)],
        }
    }

    /// Acceleration (m/s², rad/s²) along its axis, for the accelerations of its body likewise.
    pub fn measured_acceleration(
        &self,
        centre: impl FnOnce() -> Vector3<f64>,
        turning: Vector3<f64>,
        spin: Vector3<f64>,
        arm: Vector3<f64>,
    ) -> f64 {
        let axis = Vector3::from(self.action.axis());
        match self.action {
            Action::Pushes { .. } => (centre() + turning.cross(&arm) + spin.cross(&spin.cross(&arm))).dot(&axis),
            Action::Turns { .. } => turning.dot(&axis),
        }
    }

    /// How much faster (m/s) the point where it acts goes along its axis than the one whose speed it controls.
    pub fn point_excess(&self, spin: Vector3<f64>, turned: impl Fn(Vector3<f64>) -> Vector3<f64>) -> f64 {
        match self.action {
            Action::Pushes { axis } if self.at_centre => {
                spin.cross(&turned(self.drive.point_b)).dot(&Vector3::from(axis))
            }
            _ => 0.0,
        }
    }

    /// What its motor gives (N, N·m) of the `effort` that its controller asks for.
    pub fn limited(&self, effort: f64) -> f64 {
        self.train.map_or(effort, |train| train.limited(effort))
    }

    /// What its motor gives (N, N·m) at time `t` (s) and `speed` (m/s, rad/s), if its controller does not sample.
    pub fn effort(&self, t: f64, speed: f64) -> f64 {
        let asked = match &self.command {
            None => self.drive.force(t, speed),
            Some(command) => Commanded { gain: self.drive.gain, command: command.pieces.clone() }.effort(t, speed),
        };
        self.limited(asked)
    }
}

impl Mechanism {
    /// Gives drives of a prescribed motion their gain.
    pub fn set_prescribed_gains(&mut self) {
        let gain = |named: &NamedDrive| named.is_prescribed.then(|| self.least_inertia(named) / PRESCRIBED);
        let gains: Vec<_> = self.drives.iter().map(gain).collect();
        for (named, gain) in self.drives.iter_mut().zip(gains) {
            named.drive.gain = gain.unwrap_or(named.drive.gain);
        }
    }

    /// What moves with a body: its mass (kg) and moments of inertia (kg·m²), each with what its drives turn or push beside it.
    pub fn moved_with(&self, body: usize) -> (f64, [f64; 3]) {
        let (mut mass, mut inertia) = (self.bodies[body].mass, self.bodies[body].inertia);
        for drive in self.drives.iter().filter(|drive| drive.body == body && drive.rotor != 0.0) {
            match drive.action {
                Action::Pushes { .. } => mass += drive.rotor,
                Action::Turns { axis } => {
                    for (inertia, axis) in inertia.iter_mut().zip(axis) {
                        *inertia += drive.rotor * axis * axis;
                    }
                }
            }
        }
        (mass, inertia)
    }
}
