//! The laws of slides that are simulated several at a time: without internal variables, because the integrator needs
//! derivatives.

use slipfit_core::{
    Scalar,
    law::{Regularised, ThreeHalves},
    menu::SlideData,
    slide::Slide,
};

use crate::dynamics::laws::{AnyElastic, AnySlide, AnySliding};

/// A slide with the paper's laws: exponent 3/2 and regularised Coulomb friction. `None` if `data` asks for others, or is out of
/// bounds.
pub fn usual<S: Scalar + PartialOrd>(data: &SlideData<S>) -> Option<Slide<S, ThreeHalves<S>, Regularised<S>>> {
    match AnySlide::new(data) {
        Ok(AnySlide::ThreeHalvesRegularised(slide)) => Some(slide),
        _ => None,
    }
}

/// A slide with any other exponent, or no friction: chosen in each contact, at more time. `None` if `data` asks for the
/// paper's laws or true stick, or is out of bounds.
pub fn chosen<S: Scalar + PartialOrd>(data: &SlideData<S>) -> Option<Slide<S, AnyElastic<S>, AnySliding<S>>> {
    match AnySlide::new(data) {
        Ok(AnySlide::Sliding(slide)) => Some(slide),
        _ => None,
    }
}
