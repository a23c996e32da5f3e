//! A body in a plane on pins: what is left of the slide where it neither lifts, pitches nor rolls, or what swings on
//! journals.
//!
//! x is across, z the opening direction, the angle turns about y = z × x. The frame carries the pins, each meets a
//! [`Joint`] of the body: a stop [`Across`], or a [`Journal`]; see [`slide`](crate::slide) for gaps and offsets.

mod contacts;
mod joint;
mod journal;
mod mechanics;
mod turn;

use nalgebra::Vector2;

use crate::{
    ParameterError, Scalar,
    drive::Drive,
    error::bounded,
    law::{Elastic, Friction, Impact},
};

pub use joint::{Across, Joint, JointForce, Moment, SeenPin};
pub use journal::Journal;

/// Everything about a planar body but its laws, SI units. Vectors are (x, z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarBody<S, C, const PINS: usize> {
    /// Mass (kg).
    pub mass: S,
    /// Moment of inertia about the centre of mass (kg·m²).
    pub inertia: S,
    /// Gravity (m/s²).
    pub gravity_w: Vector2<S>,
    /// Pins, from the centre of mass at the nominal pose (m).
    pub pins_w: [Vector2<S>; PINS],
    /// What each pin meets.
    pub joints: [C; PINS],
}

/// A planar body with its normal law, friction law and drive.
///
/// The three generalised velocities are the velocity of the centre of mass in the frame, (x, z) in m/s, and the angular
/// velocity (rad/s). `S` is the number type, `C` the [`Joint`], `E` the normal law, `F` the friction law. A drive of gain 0
/// is none; its point counts by its x and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planar<S, C, E, F, const PINS: usize> {
    body: PlanarBody<S, C, PINS>,
    contact: Impact<S, E>,
    friction: F,
    drive: Drive<S>,
    /// 1/m: the inverse of the farthest pin's distance.
    per_lever: S,
}

/// Displacement from the nominal pose. The body has turned by twice the angle whose cosine and sine `half_turn` holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarPose<S> {
    /// Displacement of the centre of mass (m), (x, z).
    pub displacement_w: Vector2<S>,
    /// Cosine and sine of half the angle. Kept near unit length, never assumed to have it exactly.
    pub half_turn: [S; 2],
}

impl<S: Scalar> PlanarPose<S> {
    /// The nominal pose.
    pub fn nominal() -> Self {
        Self { displacement_w: Vector2::zeros(), half_turn: [S::one(), S::zero()] }
    }
}

impl<S: Scalar + PartialOrd, C: Joint<S>, E: Elastic<S>, F: Friction<S>, const PINS: usize> Planar<S, C, E, F, PINS> {
    /// A planar body of parameters that can be stepped without failing.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter of `body` or `drive` that is not finite or out of bounds. Joints
    /// and laws are validated where they are made.
    pub fn new(
        body: PlanarBody<S, C, PINS>,
        contact: Impact<S, E>,
        friction: F,
        drive: Drive<S>,
    ) -> Result<Self, ParameterError<S>> {
        bounded("mass", body.mass, [1e-6, 1e6])?;
        bounded("inertia", body.inertia, [1e-12, 1e9])?;
        for component in body.gravity_w.iter() {
            bounded("gravity", *component, [-1e4, 1e4])?;
        }
        let mut farthest = S::from_f64(1e-6);
        for pin in &body.pins_w {
            for component in pin.iter() {
                bounded("pin.position", *component, [-1e3, 1e3])?;
            }
            farthest = farthest.max_of(pin.dot(pin).sqrt());
        }
        let drive = drive.checked()?;
        Ok(Self { body, contact, friction, drive, per_lever: S::one() / farthest })
    }
}

impl<S: Scalar, C: Joint<S>, E: Elastic<S>, F: Friction<S>, const PINS: usize> Planar<S, C, E, F, PINS> {
    /// The drive.
    pub fn drive(&self) -> &Drive<S> {
        &self.drive
    }
}

#[cfg(test)]
mod tests;
