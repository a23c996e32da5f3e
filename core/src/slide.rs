//! The paper's sliding mechanism: a slide that hangs on four pins by sixteen clearance contacts.
//!
//! The frame carries the pins; the slide carries rails and walls. x is across, y is up, z is the opening direction.
//! Each pin P_j meets four unbounded planes of the slide, in the order of Table 2: left (outward normal N = +x), right
//! (−x), rail (−y, it lies on the pin) and wall (+y). With the pose (r, R) the gap of a plane is
//! g = (R N)·(P − r − R A), A = P − q·N. Seen from the slide, the pin is displaced by d = (Rᵀ − I)P − Rᵀr, normals stand
//! still along the axes, and the gaps are q + d·N: a difference of small numbers, not of positions, so that f32 keeps
//! its digits. Opposing planes of a pin form a slot.

mod abreast;
mod contacts;
mod energy;
mod mechanics;

use crate::{
    ParameterError, SVector, Scalar, Vector3,
    drive::Drive,
    error::bounded,
    law::{Elastic, Friction, Impact},
    pose::Pose,
};

pub use abreast::{Abreast, Lanes, abreast};
pub use energy::{Energy, Power};

/// Pins of the slide.
pub const PINS: usize = 4;

/// Contacts of the slide: left, right, rail, wall of each pin in turn.
pub const CONTACTS: usize = 4 * PINS;

/// Slots of the slide, each two opposing contacts: across, then up and down, of each pin in turn.
pub const SLOTS: usize = 2 * PINS;

/// A gap (m) that never closes: what a contact that the scene leaves out has.
pub const ABSENT: f64 = 1e6;

/// Everything about a slide but its laws, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<S> {
    /// Mass (kg).
    pub mass: S,
    /// Principal moments of inertia about the centre of mass (kg·m²), along the body's axes.
    pub inertia_b: Vector3<S>,
    /// Gravity (m/s²).
    pub gravity_w: Vector3<S>,
    /// Pins, from the centre of mass at the nominal pose (m).
    pub pins_w: [Vector3<S>; PINS],
    /// Gaps at the nominal pose (m): left, right, rail, wall of each pin; [`ABSENT`] for none.
    pub gaps: [S; CONTACTS],
}

/// The moments of inertia (kg·m²) of a uniform box with edges `x`, `y`, `z` (m) about its centre.
pub fn box_inertia<S: Scalar>(mass: S, [x, y, z]: [S; 3]) -> Vector3<S> {
    let twelfth = mass / S::from_f64(12.0);
    Vector3::new((y * y + z * z) * twelfth, (x * x + z * z) * twelfth, (x * x + y * y) * twelfth)
}

/// A slide with its normal law, friction law and drive.
///
/// Generalised velocities are the velocity of the centre of mass in the frame (m/s) and the angular velocity in the
/// body (rad/s), so that the mass matrix is constant and free flight is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slide<S, E, F> {
    body: Body<S>,
    contact: Impact<S, E>,
    friction: F,
    drive: Drive<S>,
    /// 1/m: the inverse of the farthest pin's distance.
    per_lever: S,
}

impl<S: Scalar + PartialOrd, E: Elastic<S>, F: Friction<S>> Slide<S, E, F> {
    /// A slide of parameters that can be stepped without failing.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter of `body` or `drive` that is not finite or out of bounds.
    /// The laws are validated where they are made, see [`menu`](crate::menu).
    pub fn new(body: Body<S>, contact: Impact<S, E>, friction: F, drive: Drive<S>) -> Result<Self, ParameterError<S>> {
        bounded("slide.mass", body.mass, [1e-6, 1e6])?;
        for moment in body.inertia_b.iter() {
            bounded("slide.inertia", *moment, [1e-12, 1e9])?;
        }
        for component in body.gravity_w.iter() {
            bounded("slide.gravity", *component, [-1e4, 1e4])?;
        }
        let mut farthest = S::from_f64(1e-6);
        for pin in &body.pins_w {
            for component in pin.iter() {
                bounded("pin.position", *component, [-1e3, 1e3])?;
            }
            farthest = farthest.max_of(pin.dot(pin).sqrt());
        }
        for gap in body.gaps {
            bounded("gap", gap, [-1.0, ABSENT])?;
        }
        let drive = drive.checked()?;
        Ok(Self { body, contact, friction, drive, per_lever: S::one() / farthest })
    }
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S>> Slide<S, E, F> {
    /// The drive.
    pub fn drive(&self) -> &Drive<S> {
        &self.drive
    }

    /// The sixteen gaps (m) at `pose`, in the order of [`Body::gaps`]; negative where parts penetrate.
    #[inline(always)]
    pub fn gaps(&self, pose: &Pose<S>) -> [S; CONTACTS] {
        let to_body = pose.to_body();
        let shift = to_body.apply(pose.displacement_w);
        let mut gaps = self.body.gaps;
        for (quad, pin) in gaps.as_chunks_mut::<4>().0.iter_mut().zip(&self.body.pins_w) {
            let d = to_body.change(*pin) - shift;
            let [left, right, rail, wall] = *quad;
            *quad = [left + d.x, right - d.x, rail - d.y, wall + d.y];
        }
        gaps
    }
}

#[inline(always)]
fn split<S: Scalar>(v: &SVector<S, 6>) -> (Vector3<S>, Vector3<S>) {
    let [a, b, c, d, e, f] = v.data.0[0];
    (Vector3::new(a, b, c), Vector3::new(d, e, f))
}

#[inline(always)]
fn join<S: Scalar>(a: Vector3<S>, b: Vector3<S>) -> SVector<S, 6> {
    SVector::<S, 6>::new(a.x, a.y, a.z, b.x, b.y, b.z)
}
