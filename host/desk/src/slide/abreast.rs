//! The four pins of a slide in the four lanes of a register, where the desk spends most of its time. The bits are those of one
//! pin after the other.

use pulp::{NullaryFnOnce, x86::V3};
use slipfit_core::{
    SVector,
    law::{Regularised, ThreeHalves},
    mechanism::{Differentiated, Mechanism},
    menu::SlideData,
    pose::Pose,
    slide::{AbreastPins, Internal, Slide, abreast_pins},
    system::{AbreastBodies, Bodies, Element, Link, spatial::Floating},
};

use super::watch::{SlideMotion, Watch, approaches};
use crate::{closing::Gaps, laws::SlidingSlide, out_of_line::Contacts, pack::Pack};

/// A number for each pin.
type Quad = Pack<V3, f64>;

/// A slide with the paper's laws.
type Usual<S> = Slide<S, ThreeHalves<S>, Regularised<S>>;

/// Derivatives of its forces.
type Jacobians = <Usual<f64> as Mechanism<f64, 6>>::Jacobians;

/// Pins side by side, and the proof that the machine has the instructions for them.
pub struct SideBySide {
    instructions: V3,
    pins: AbreastPins<Quad, ThreeHalves<Quad>, Regularised<Quad>>,
}

impl SideBySide {
    /// The pins of the slide that `data` describes, true stick stood for by a `stick_band` (m/s). `None` where the machine has
    /// no such registers, or the laws are not the paper's.
    pub fn new(data: &SlideData<f64>, stick_band: f64) -> Option<Self> {
        let instructions = V3::try_new()?;
        match SlidingSlide::new(&data.abreast(), Quad::splat(stick_band)) {
            Ok(SlidingSlide::Usual(lanes)) => Some(Self { instructions, pins: abreast_pins(&lanes) }),
            _ => None,
        }
    }
}

impl Contacts<f64, Usual<f64>, 6> for SideBySide {
    fn forces_by(
        &self,
        slide: &Usual<f64>,
        _: &Jacobians,
        t: f64,
        pose: &Pose<f64>,
        _: &Internal<()>,
        velocity: &SVector<f64, 6>,
        _: f64,
    ) -> SVector<f64, 6> {
        self.instructions.vectorize(Forces(Call { slide, pins: self, t, pose, velocity }))
    }

    fn differentiated(
        &self,
        slide: &Usual<f64>,
        t: f64,
        pose: &Pose<f64>,
        _: &Internal<()>,
        velocity: &SVector<f64, 6>,
    ) -> Differentiated<f64, Jacobians, 6> {
        self.instructions.vectorize(Derivatives(Call { slide, pins: self, t, pose, velocity }))
    }
}

impl Watch<Usual<f64>> for SideBySide {
    fn watch(&self, slide: &Usual<f64>, SlideMotion { pose, velocity, .. }: &SlideMotion, speed: f64, gaps: &mut Gaps) {
        let placed = Bodies::<f64, 6>::placed(slide.bodies(), pose, velocity);
        self.instructions.vectorize(Watched { pins: self, placed: &placed, speed, gaps });
    }
}

/// What forces are computed of.
struct Call<'a> {
    slide: &'a Usual<f64>,
    pins: &'a SideBySide,
    t: f64,
    pose: &'a Pose<f64>,
    velocity: &'a SVector<f64, 6>,
}

/// Forces, to be computed with wide instructions. A type of its own, not a closure: that is not inlined here, and each number
/// would be a call.
struct Forces<'a>(Call<'a>);

/// Forces and their derivatives, likewise.
struct Derivatives<'a>(Call<'a>);

/// Contacts of a slide that is `placed`, likewise.
struct Watched<'a> {
    pins: &'a SideBySide,
    placed: &'a <Floating<f64> as Bodies<f64, 6>>::Placed,
    speed: f64,
    gaps: &'a mut Gaps,
}

impl NullaryFnOnce for Watched<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (body, Element { link, law }) = (self.pins.pins.bodies(), self.pins.pins.elements());
        let placed = Floating::everywhere(self.placed);
        let seen = link.seen((body, &placed), &link.view(body, &placed));
        for wall in approaches(&seen, law.gaps, Quad::splat(self.speed), &law.contact.normal) {
            self.gaps.add_four(wall.lanes());
        }
    }
}

impl NullaryFnOnce for Forces<'_> {
    type Output = SVector<f64, 6>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Call { slide, pins, t, pose, velocity } = self.0;
        slide.forces_abreast(&pins.pins, &slide.elements().1, t, pose, velocity)
    }
}

impl NullaryFnOnce for Derivatives<'_> {
    type Output = Differentiated<f64, Jacobians, 6>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Call { slide, pins, t, pose, velocity } = self.0;
        slide.differentiated_abreast(&pins.pins, &slide.elements().1, t, pose, velocity)
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use slipfit_core::{
        SVector,
        integrator::{Motion, Rodas4},
        mechanism::Mechanism,
        pose::Pose,
        slide::{Internal, NO_INTERNAL, Slide},
    };

    use super::SideBySide;
    use crate::{
        error_control::{Sensitivity, Tolerance, Watched, integrate},
        laws,
        out_of_line::{Contacts, InTurn, OutOfLine},
    };

    /// The motion at the end of every step, as bits.
    fn steps<M, C>(slide: M, contacts: C) -> Vec<[u64; 7]>
    where
        M: Mechanism<f64, 6, Pose = Pose<f64>, Internal = Internal<()>>,
        C: Contacts<f64, M, 6>,
    {
        let zero = SVector::zeros();
        let rest = Motion { pose: Pose::nominal(), velocity: zero, acceleration: zero, internal: NO_INTERNAL };
        let sensitivity = Sensitivity { mass: 0.0818, gain: 40.0 };
        let error = |step: &_, length| sensitivity.error(Tolerance::of_force(1e-4), step, length);
        let unwatched = Watched { gaps: |_: &_, _: &mut _| (), depth: 0.0, bends: &[] };
        let mut steps = Vec::new();
        integrate::<Rodas4, _, 6>(&OutOfLine::by(slide, contacts), rest, 0.3, error, unwatched, |t, motion, _, _| {
            let [a, b, c, d, e, f] = motion.velocity.data.0[0];
            steps.push([t, a, b, c, d, e, f].map(f64::to_bits));
            ControlFlow::Continue(())
        })
        .unwrap();
        steps
    }

    /// Loose, tipping and jammed units.
    #[test]
    fn side_by_side_the_bits_are_those_of_one_after_the_other() {
        for n in [-2.0, 0.0, 2.5, 4.0] {
            let data = slipfit_problems::cd_rom::data(n);
            let slide: Slide<f64, _, _> = laws::usual(&data).expect("the paper's laws");
            let in_turn = steps(slide, InTurn);
            assert!(in_turn.len() > 50);
            if let Some(pins) = SideBySide::new(&data, 1e-4) {
                assert_eq!(in_turn, steps(slide, pins), "n = {n}");
            }
        }
    }
}
