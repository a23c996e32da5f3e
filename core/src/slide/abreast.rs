//! The four pins side by side. The bits are those of one pin after the other.

use super::{PINS, Slide};
use crate::{
    Scalar, Vector3,
    law::{Elastic, Friction, Impact},
    menu::SlideData,
    system::{
        Element, Lanes, System, everywhere,
        law::{Contact, Pin},
        spatial::{Floating, PinOfFrame},
    },
};

/// Pins side by side, in numbers `L`, with their contact laws.
pub type AbreastPins<L, E, F> = System<Floating<L>, Element<PinOfFrame<L>, Pin<L, Impact<L, E>, F>, 3>>;

/// What a slide of lanes is to be made of for [`abreast_pins`]: the parameters of `slide` in every lane, and in place of each pin all
/// of them, each in its lane.
pub fn abreast<S: Scalar, L: Lanes<S>>(slide: &SlideData<S>) -> SlideData<L> {
    let mut lanes = slide.cast(everywhere);
    let [a, b, c, d] = slide.body.pins_w;
    let place = Vector3::new(L::of([a.x, b.x, c.x, d.x]), L::of([a.y, b.y, c.y, d.y]), L::of([a.z, b.z, c.z, d.z]));
    lanes.body.pins_w = [place; PINS];
    #[rustfmt::skip]
    let [
        left_a, right_a, rail_a, wall_a,
        left_b, right_b, rail_b, wall_b,
        left_c, right_c, rail_c, wall_c,
        left_d, right_d, rail_d, wall_d,
    ] = slide.body.gaps;
    let [left, right, rail, wall] = [
        [left_a, left_b, left_c, left_d],
        [right_a, right_b, right_c, right_d],
        [rail_a, rail_b, rail_c, rail_d],
        [wall_a, wall_b, wall_c, wall_d],
    ]
    .map(L::of);
    lanes.body.gaps =
        [left, right, rail, wall, left, right, rail, wall, left, right, rail, wall, left, right, rail, wall];
    lanes
}

/// The pins of the slide whose parameters are those of [`abreast`]: any of them stands for all.
pub fn abreast_pins<L: Scalar, E: Elastic<L>, F: Friction<L>>(lanes: &Slide<L, E, F>) -> AbreastPins<L, E, F> {
    let pins = &lanes.elements().0;
    let [(link, gaps), ..] = pins.each;
    let law = Pin { gaps, contact: Contact { ..pins.contact } };
    System::new(*lanes.bodies(), Element { link, law })
}
