//! The four pins side by side. The bits are those of one pin after the other.

use super::Slide;
use crate::{
    Scalar,
    law::{Elastic, Friction, Impact},
    system::{
        Element, System,
        law::{Contact, Pin},
        spatial::{Floating, PinOfFrame},
    },
};

/// Pins side by side, in numbers `L`, with their contact laws.
pub type AbreastPins<L, E, F> = System<Floating<L>, Element<PinOfFrame<L>, Pin<L, Impact<L, E>, F>, 3>>;

/// The pins of the slide whose parameters are those of [`SlideData::abreast`](crate::menu::SlideData::abreast): any of them stands for all.
pub fn abreast_pins<L: Scalar, E: Elastic<L>, F: Friction<L>>(lanes: &Slide<L, E, F>) -> AbreastPins<L, E, F> {
    let pins = &lanes.elements().0;
    let [(link, gaps), ..] = pins.each;
    let law = Pin { gaps, contact: Contact { ..pins.contact } };
    System::new(*lanes.bodies(), Element { link, law })
}
