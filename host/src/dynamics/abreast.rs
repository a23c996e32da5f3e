//! The four pins of a slide in the four lanes of a register, where the desk spends most of its time. The bits are those of one
//! pin after the other.

use pulp::{NullaryFnOnce, x86::V3};
use slipfit_core::{
    SVector,
    law::{Elastic, Friction, Regularised, ThreeHalves},
    mechanism::{Differentiated, Mechanism},
    menu::SlideData,
    pose::Pose,
    slide::{Abreast, Lanes, SLOTS, Slide, abreast},
};

use super::{laws::SlidingSlide, out_of_line::Contacts, pack::Pack};

/// A number for each pin.
type Quad = Pack<V3, f64>;

/// Pins side by side, and the proof that the machine has the instructions for them.
pub struct SideBySide<E, F> {
    instructions: V3,
    pins: Abreast<Quad, E, F>,
}

impl SideBySide<ThreeHalves<Quad>, Regularised<Quad>> {
    /// The pins of the slide that `data` describes, true stick stood for by a `stick_band` (m/s). `None` where the machine has
    /// no such registers, or the laws are not the paper's.
    pub fn new(data: &SlideData<f64>, stick_band: f64) -> Option<Self> {
        let instructions = V3::try_new()?;
        match SlidingSlide::new(&abreast(data), Quad::splat(stick_band)) {
            Ok(SlidingSlide::Usual(lanes)) => Some(Self { instructions, pins: Abreast::new(lanes) }),
            _ => None,
        }
    }
}

impl<E, F, EL, FL> Contacts<f64, Slide<f64, E, F>, 6> for SideBySide<EL, FL>
where
    E: Elastic<f64>,
    F: Friction<f64, Memory = ()>,
    EL: Elastic<Quad>,
    FL: Friction<Quad, Memory = ()>,
{
    fn forces(
        &self,
        slide: &Slide<f64, E, F>,
        t: f64,
        pose: &Pose<f64>,
        _: &[(); SLOTS],
        velocity: &SVector<f64, 6>,
        _: f64,
        _: Option<&mut [(); SLOTS]>,
    ) -> SVector<f64, 6> {
        self.instructions.vectorize(Forces(Call { slide, pins: &self.pins, t, pose, velocity }))
    }

    fn forces_by(
        &self,
        slide: &Slide<f64, E, F>,
        _: &<Slide<f64, E, F> as Mechanism<f64, 6>>::Slopes,
        t: f64,
        pose: &Pose<f64>,
        memory: &[(); SLOTS],
        velocity: &SVector<f64, 6>,
        a: f64,
    ) -> SVector<f64, 6> {
        self.forces(slide, t, pose, memory, velocity, a, None)
    }

    fn differentiated(
        &self,
        slide: &Slide<f64, E, F>,
        t: f64,
        pose: &Pose<f64>,
        _: &[(); SLOTS],
        velocity: &SVector<f64, 6>,
    ) -> Differentiated<f64, <Slide<f64, E, F> as Mechanism<f64, 6>>::Slopes, 6> {
        self.instructions.vectorize(Slopes(Call { slide, pins: &self.pins, t, pose, velocity }))
    }
}

// Types of their own, not closures: those are not inlined here, and each number would be a call.

/// What forces are computed of.
struct Call<'a, E, F, L, EL, FL> {
    slide: &'a Slide<f64, E, F>,
    pins: &'a Abreast<L, EL, FL>,
    t: f64,
    pose: &'a Pose<f64>,
    velocity: &'a SVector<f64, 6>,
}

/// Forces, to be computed with wide instructions.
struct Forces<'a, E, F, L, EL, FL>(Call<'a, E, F, L, EL, FL>);

/// Forces and their derivatives, likewise.
struct Slopes<'a, E, F, L, EL, FL>(Call<'a, E, F, L, EL, FL>);

impl<E, F, L, EL, FL> NullaryFnOnce for Forces<'_, E, F, L, EL, FL>
where
    E: Elastic<f64>,
    F: Friction<f64>,
    L: Lanes<f64>,
    EL: Elastic<L>,
    FL: Friction<L, Memory = ()>,
{
    type Output = SVector<f64, 6>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Call { slide, pins, t, pose, velocity } = self.0;
        slide.forces_abreast(pins, t, pose, velocity)
    }
}

impl<E, F, L, EL, FL> NullaryFnOnce for Slopes<'_, E, F, L, EL, FL>
where
    E: Elastic<f64>,
    F: Friction<f64>,
    L: Lanes<f64>,
    EL: Elastic<L>,
    FL: Friction<L, Memory = ()>,
{
    type Output = Differentiated<f64, <Slide<f64, E, F> as Mechanism<f64, 6>>::Slopes, 6>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Call { slide, pins, t, pose, velocity } = self.0;
        slide.differentiated_abreast(pins, t, pose, velocity)
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
        slide::{CONTACTS, SLOTS, Slide},
    };

    use super::SideBySide;
    use crate::dynamics::{
        error_control::{Sensitivity, Tolerance, integrate},
        example, laws,
        out_of_line::{Contacts, InTurn, OutOfLine},
    };

    /// The motion at the end of every step, as bits.
    fn steps<M, C>(slide: M, contacts: C) -> Vec<[u64; 7]>
    where
        M: Mechanism<f64, 6, Pose = Pose<f64>, Memory = [(); SLOTS]>,
        C: Contacts<f64, M, 6>,
    {
        let zero = SVector::zeros();
        let rest = Motion { pose: Pose::nominal(), velocity: zero, acceleration: zero, memory: [(); SLOTS] };
        let sensitivity = Sensitivity { mass: 0.0818, gain: 40.0 };
        let error = |step: &_, length| sensitivity.error(Tolerance::of_force(1e-4), step, length);
        let mut steps = Vec::new();
        integrate::<Rodas4, _, 6>(&OutOfLine::by(slide, contacts), rest, 0.3, error, |t, motion| {
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
        let scene = example::cd_rom();
        for n in [-2.0, 0.0, 2.5, 4.0] {
            let data = scene.slide_data::<f64>(&scene.gaps_at(&[n; CONTACTS]));
            let slide: Slide<f64, _, _> = laws::usual(&data).expect("the paper's laws");
            let in_turn = steps(slide, InTurn);
            assert!(in_turn.len() > 50);
            if let Some(pins) = SideBySide::new(&data, 1e-4) {
                assert_eq!(in_turn, steps(slide, pins), "n = {n}");
            }
        }
    }
}
