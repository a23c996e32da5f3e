//! Where the slide's energy is and where it goes. For audits on the host; no step computes any of it.

use super::Slide;
use crate::{
    Scalar,
    integrator::MotionOf,
    law::{
        Elastic, Friction, Normal,
        fit::{Fit, SlotForce},
        friction::SlidingContact,
    },
    mechanism::Mechanism,
    system::{Bodies, spatial::split},
};

/// Energy of a slide at one motion (J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy<S> {
    /// Of motion, ≥ 0.
    pub kinetic: S,
    /// Of height against gravity, 0 at the nominal pose.
    pub gravity: S,
    /// Of compressed contacts, ≥ 0.
    pub elastic: S,
}

/// Power into and out of a slide at one motion (W).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power<S> {
    /// What the drive does on the slide.
    pub drive: S,
    /// What contacts lose, ≥ 0: to their dampers, and where the force is held at zero while surfaces part.
    pub damping: S,
    /// What friction takes, ≥ 0 where its force opposes the sliding.
    pub friction: S,
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S>, G: Fit<Number = S>> Slide<S, E, F, G> {
    /// The energy at `motion`.
    pub fn energy(&self, motion: &MotionOf<S, Self, 6>) -> Energy<S> {
        let momentum = self.momentum(&motion.pose, &motion.velocity);
        let gaps = self.gaps(&motion.pose);
        Energy {
            kinetic: motion.velocity.dot(&momentum) / S::from_f64(2.0),
            gravity: -self.bodies().gravity_w().dot(&motion.pose.displacement_w) * self.bodies().least_mass(),
            elastic: gaps.iter().fold(S::zero(), |sum, gap| sum + self.contact().normal.energy(-*gap)),
        }
    }

    /// The powers at `motion` and time `t` (s). Friction with internal variables acts with the force that they hold, as far as the
    /// normal force of the motion carries it.
    pub fn power(&self, t: S, motion: &MotionOf<S, Self, 6>) -> Power<S> {
        let (v_w, w_b) = split(&motion.velocity);
        let to_body = motion.pose.to_body();
        let v_b = to_body.apply(v_w);
        let zero = S::zero();
        let gaps = self.gaps(&motion.pose);
        let (mut damping, mut friction) = (zero, zero);
        let contact = self.contact();
        let pins = gaps.as_chunks::<4>().0.iter().zip(&self.elements().0.each);
        for (([left, right, rail, wall], (pin, _)), internal) in pins.zip(&motion.internal.0) {
            let lever = pin.place_w + to_body.change(pin.place_w) - to_body.apply(motion.pose.displacement_w);
            let u = v_b + w_b.cross(&lever);
            let slots = [([left, right], [u.x, u.y, u.z]), ([wall, rail], [u.y, u.x, u.z])];
            for ((gaps, [along, sliding_0, sliding_1]), internal) in slots.into_iter().zip(internal) {
                // The gaps of this pose, so that the slot stands at offset 0.
                let slot = contact.normal.slot(*gaps[0], *gaps[1], zero, along);
                let touching = SlidingContact {
                    sliding: [sliding_0, sliding_1],
                    normal: slot.normal(),
                    // With a penalty of zero the trial force is the internal one, so that this stands.
                    mass_rate: zero,
                    tangent_share: zero,
                };
                let (traction, _) = contact.friction.traction(internal, &touching);
                friction -= traction.force[0] * sliding_0 + traction.force[1] * sliding_1;
                damping += contact.normal.loss(-*gaps[0], along) + contact.normal.loss(-*gaps[1], -along);
            }
        }
        let point_speed = v_w.z + to_body.apply_inverse(w_b.cross(&self.drive().point_b)).z;
        Power { drive: self.drive().force(t, v_w.z) * point_speed, damping, friction }
    }
}
