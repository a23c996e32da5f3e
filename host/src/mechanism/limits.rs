//! What a step of the desk may err by.

use slipfit_desk::{error_control::greater, plant::Reported};

use super::{Action, Mechanism, Start};

/// How long (s) an error of speed may last: what makes an error of place of it.
const LASTING: f64 = 1.2e-3;

/// Stick bands in the error of speed that a step may make.
const STICK_BANDS: f64 = 4.0;

/// The speed (m/s) of a mechanism that neither a drive nor its start nor gravity moves.
const SLOWEST: f64 = 1e-3;

/// What a step may err by.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Speed (m/s).
    pub speed: f64,
}

impl Limits {
    /// A share of how fast the mechanism goes by itself; `lever` (m) of a body makes a speed of its angular one.
    pub fn of(mechanism: &Mechanism, lever: impl Fn(usize) -> f64) -> Self {
        let driven = mechanism.drives.iter().filter(|named| named.drive.gain > 0.0).map(|named| match named.action {
            Action::Pushes { .. } => named.drive.speed.abs(),
            Action::Turns { .. } => named.drive.speed.abs() * lever(named.body),
        });
        let thrown = mechanism.bodies.iter().enumerate().map(|(i, body)| {
            let Start { spin, speed, thrown, .. } = body.start;
            let length = |of: [f64; 3]| libm::sqrt(of.iter().map(|x| x * x).sum());
            let [free, turning] = thrown.map_or([0.0; 2], |thrown| [thrown.velocity, thrown.spin].map(length));
            speed.abs().max(free).max(spin.abs().max(turning) * lever(i))
        });
        let longest = (0..mechanism.bodies.len()).map(&lever).fold(0.0, f64::max);
        let gravity = libm::sqrt(mechanism.gravity.iter().map(|g| g * g).sum());
        let greatest = driven.chain(thrown).fold(0.0, f64::max);
        let own = if greatest > 0.0 { greatest } else { libm::sqrt(gravity * longest).max(SLOWEST) };
        Self { speed: mechanism.run.error * own }
    }

    /// The error of place (m) that a step may make.
    pub fn place(&self) -> f64 {
        self.speed * LASTING
    }

    /// The stick band (m/s) that stands for true stick.
    pub fn stick_band(&self) -> f64 {
        (STICK_BANDS * self.speed).clamp(1e-9, 1e-4)
    }

    /// The error of a `step` of `length` (s) that moves at least the mass `least_mass` (kg); 1 is allowed.
    pub fn error(&self, step: &Reported, length: f64, least_mass: f64) -> f64 {
        let speed = greater(step.error, step.residual) / (least_mass * self.speed);
        let place = greater(step.drift, step.residual * length) / (least_mass * self.place());
        greater(speed, place)
    }
}
