//! How the contacts of a slide are watched, so that no step passes one over.

use std::array;

use slipfit_core::{
    Scalar,
    integrator::Motion,
    law::{Elastic, Friction, Normal},
    pose::Pose,
    slide::{Internal, PINS, Slide, to_walls},
    system::Seen,
};

use crate::{
    closing::{Approach, Gaps},
    out_of_line::InTurn,
};

/// Where the slide is and how it moves.
pub type SlideMotion = Motion<f64, Pose<f64>, Internal<()>, 6>;

/// What sees the contacts of a slide `M`.
pub trait Watch<M> {
    /// Adds those of the `slide` at a `motion` to the `gaps`: of each pin the first wall, then of each the second. No point of the slide is
    /// faster at a pin than `speed` (m/s).
    fn watch(&self, slide: &M, motion: &SlideMotion, speed: f64, gaps: &mut Gaps);
}

impl<E: Elastic<f64>, F: Friction<f64, Internal = ()>> Watch<Slide<f64, E, F>> for InTurn {
    fn watch(&self, slide: &Slide<f64, E, F>, motion: &SlideMotion, speed: f64, gaps: &mut Gaps) {
        let (pins, each) = (slide.pins(&motion.pose, &motion.velocity), &slide.elements().0.each);
        let of_pin = |k: usize| approaches(&pins[k], each[k].1, speed, &slide.contact().normal);
        let of_pins: [_; PINS] = array::from_fn(of_pin);
        (0..4).for_each(|wall| of_pins.iter().for_each(|of_pin| gaps.add(of_pin[wall])));
    }
}

/// The contacts of a `pin` as the slide sees it with its walls, whose gaps (m) are `nominal` where it is drawn and whose law is `normal`. No
/// point of the slide is faster there than `speed` (m/s).
#[inline(always)]
pub fn approaches<S: Scalar + PartialOrd>(
    pin: &Seen<S, 3>,
    nominal: [S; 4],
    speed: S,
    normal: &impl Normal<S>,
) -> [Approach<S>; 4] {
    let (gaps, rates) = (to_walls(nominal, &pin.place), to_walls([S::zero(); 4], &pin.rate));
    array::from_fn(|k| Approach::new(gaps[k], rates[k], speed, normal))
}
