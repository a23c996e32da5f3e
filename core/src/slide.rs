//! The paper's sliding mechanism: a slide that hangs on four pins by sixteen clearance contacts.
//!
//! The frame carries the pins; the slide carries rails and walls. x is across, y is up, z is the opening direction.
//! Each pin P_j meets four unbounded planes of the slide, in the order of Table 2: left (outward normal N = +x), right
//! (−x), rail (−y, it lies on the pin) and wall (+y). With the pose (r, R) the gap of a plane is
//! g = (R N)·(P − r − R A), A = P − q·N. Seen from the slide, the pin is displaced by d = (Rᵀ − I)P − Rᵀr, normals stand
//! still along the axes, and the gaps are q + d·N: a difference of small numbers, not of positions, so that f32 keeps
//! its digits. Opposing planes of a pin form a slot.

mod abreast;
mod energy;

use crate::{
    ParameterError, SVector, Scalar, Vector3,
    drive::{Drive, Push, SetpointDrive},
    error::bounded,
    law::{ClearanceFit, Elastic, Fit, Friction, Impact},
    mechanism::Driven,
    pose::Pose,
    system::{
        Alike, Bodies, Element, Link, Seen, System,
        law::{Contact, Pusher},
        spatial::{Floating, PinOfFrame, Pull},
    },
};

pub use abreast::{AbreastPins, abreast_pins};
pub use energy::{Energy, Power};

/// Pins of the slide.
pub const PINS: usize = 4;

/// Contacts of the slide: left, right, rail, wall of each pin in turn.
pub const CONTACTS: usize = 4 * PINS;

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

/// Pins between their four walls, whose gaps (m) `G` are told.
pub type Pins<S, E, F, G> = Alike<Contact<Impact<S, E>, F>, PinOfFrame<S>, G, PINS, 3>;

/// A slide with its normal law `E`, friction law `F` and drive `P`; its pins [fit](Fit) somehow, or all with clearance.
pub type Slide<S, E, F, G = [S; 4], P = Drive<S>> =
    System<Floating<S>, (Pins<S, E, F, G>, Element<Pull<S>, Pusher<P>, 2>)>;

/// The internal variables of friction, `M` for a contact, on a slide.
pub type Internal<M> = ([[M; 2]; PINS], ());

/// The internal variables of a slide whose friction has none.
pub const NO_INTERNAL: Internal<()> = ([[(); 2]; PINS], ());

impl<S: Scalar + PartialOrd> Body<S> {
    /// The slide of this body with its laws and its drive, of parameters that can be stepped without failing.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter of the body or the `drive` that is not finite or out of bounds.
    /// The laws are validated where they are made, see [`menu`](crate::menu).
    pub fn slide<E: Elastic<S>, F: Friction<S>>(
        &self,
        contact: Impact<S, E>,
        friction: F,
        drive: Drive<S>,
    ) -> Result<Slide<S, E, F>, ParameterError<S>> {
        let body = Floating::new(self.mass, self.inertia_b, self.gravity_w, &self.pins_w)?;
        for gap in self.gaps {
            bounded("gap", gap, [-1.0, ABSENT])?;
        }
        let mut each = [(PinOfFrame { place_w: Vector3::zeros() }, [S::zero(); 4]); PINS];
        for ((pin, place_w), gaps) in each.iter_mut().zip(self.pins_w).zip(self.gaps.as_chunks::<4>().0) {
            *pin = (PinOfFrame { place_w }, *gaps);
        }
        let pins = Alike { contact: Contact { normal: contact, friction }, each };
        let drive = drive.checked()?;
        let pull = Element { link: Pull { point_b: drive.point_b }, law: Pusher(drive) };
        Ok(System::new(body, (pins, pull)))
    }
}

impl<S: Scalar + PartialOrd, E: Elastic<S>, F: Friction<S>> Slide<S, E, F> {
    /// The same slide, if all of its pins fit with clearance. It moves bit for bit the same, in fewer instructions: its type says that a
    /// slot pushes from one end at a time.
    ///
    /// # Errors
    /// If a slot is narrower than its pin.
    pub fn with_clearance(&self) -> Result<Slide<S, E, F, ClearanceFit<S>>, ParameterError<S>> {
        let (Alike { contact, each: [a, b, c, d] }, pull) = *self.elements();
        let fit = |(pin, gaps)| Ok((pin, ClearanceFit::new(gaps)?));
        let pins = Alike { contact, each: [fit(a)?, fit(b)?, fit(c)?, fit(d)?] };
        Ok(System::new(*self.bodies(), (pins, pull)))
    }
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S>, G: Fit<Number = S>, P: Push<S>> Slide<S, E, F, G, P> {
    /// The drive.
    pub fn drive(&self) -> &P {
        &self.elements().1.law.0
    }

    /// The drive, to be given another command.
    pub fn drive_mut(&mut self) -> &mut P {
        &mut self.elements_mut().1.law.0
    }

    /// The same slide with another drive at the same point.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter of the drive that is not finite or out of bounds.
    pub fn driven_by<Q: Push<S>>(&self, push: Q) -> Result<Slide<S, E, F, G, Q>, ParameterError<S>>
    where
        S: PartialOrd,
    {
        let (pins, pull) = self.elements();
        let pull = Element { link: pull.link, law: Pusher(push.checked()?) };
        Ok(System::new(*self.bodies(), (*pins, pull)))
    }

    /// The laws of its contacts.
    pub fn contact(&self) -> &Contact<Impact<S, E>, F> {
        &self.elements().0.contact
    }

    /// The sixteen gaps (m) at `pose`, in the order of [`Body::gaps`]; negative where parts penetrate.
    #[inline(always)]
    pub fn gaps(&self, pose: &Pose<S>) -> [S; CONTACTS] {
        let to_body = pose.to_body();
        let shift = to_body.apply(pose.displacement_w);
        let mut gaps = [S::zero(); CONTACTS];
        for (quad, (pin, fit)) in gaps.as_chunks_mut::<4>().0.iter_mut().zip(&self.elements().0.each) {
            *quad = to_walls(fit.gaps(), &(to_body.change(pin.place_w) - shift));
        }
        gaps
    }

    /// How far each pin is displaced (m) as the slide sees it at `pose`, and how fast (m/s) at this `velocity`, in the slide's axes.
    #[inline(always)]
    pub fn pins(&self, pose: &Pose<S>, velocity: &SVector<S, 6>) -> [Seen<S, 3>; PINS] {
        let body = self.bodies();
        let placed = body.placed(pose, velocity);
        let mut pins = [Seen { place: Vector3::zeros(), rate: Vector3::zeros() }; PINS];
        for (seen, (pin, _)) in pins.iter_mut().zip(&self.elements().0.each) {
            *seen = pin.seen((body, &placed), &pin.view(body, &placed));
        }
        pins
    }
}

/// The gaps (m) of a pin to its walls, left, right, rail and wall, after a displacement `d` (m) from where they are `nominal`; how fast
/// they open, of a velocity and 0.
#[inline(always)]
pub fn to_walls<S: Scalar>([left, right, rail, wall]: [S; 4], d: &Vector3<S>) -> [S; 4] {
    [left + d.x, right - d.x, rail - d.y, wall + d.y]
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S, Internal = ()>, G: Fit<Number = S>> Driven<S, 6>
    for Slide<S, E, F, G, SetpointDrive<S>>
{
    #[inline(always)]
    fn drive(&self) -> &SetpointDrive<S> {
        &self.elements().1.law.0
    }

    #[inline(always)]
    fn drive_mut(&mut self) -> &mut SetpointDrive<S> {
        &mut self.elements_mut().1.law.0
    }

    #[inline(always)]
    fn mass(&self) -> S {
        self.bodies().least_mass()
    }

    #[inline(always)]
    fn speed(&self, velocity: &SVector<S, 6>) -> S {
        velocity.z
    }

    #[inline(always)]
    fn position(&self, pose: &Pose<S>) -> S {
        pose.displacement_w.z
    }
}
