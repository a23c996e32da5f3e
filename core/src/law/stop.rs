//! What stands in the way along one axis, as a menu of types: a pad on one side or a slot, so that a pad pays for no
//! other end.

use super::{Elastic, Impact, Normal, NormalResponse, bistop::SlotResponse, fit::SlotForce};
use crate::{ParameterError, Scalar, error::bounded};

/// Bounds of a gap (m).
const GAP: [f64; 2] = [-1.0, 1e6];

/// What a stop does to the body at one instant, along the axis.
pub trait Resistance<S> {
    /// Force on the body (N) along the axis.
    fn force(&self) -> S;

    /// −∂force/∂u (N·s/m) by the body's speed u, which also moves it `over` a time (s) if one is given.
    fn impedance(&self, over: Option<S>) -> S;

    /// −∂force/∂x (N/m) by the body's displacement x.
    fn stiffness(&self) -> S;
}

/// Something fixed that the body meets along one axis.
pub trait Stop<S>: Copy {
    /// What it does at one instant.
    type Resistance: Resistance<S>;

    /// What it does by `law` while the fixed part is displaced by `offset` (m) as seen from the body, which moves with
    /// `speed` (m/s).
    fn resistance<E: Elastic<S>>(&self, law: &Impact<S, E>, offset: S, speed: S) -> Self::Resistance;
}

/// A pad that pushes along the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pad<S> {
    gap: S,
}

impl<S: Scalar + PartialOrd> Pad<S> {
    /// A pad behind a `gap` (m), negative where it penetrates.
    ///
    /// # Errors
    /// If the gap is not finite or out of bounds.
    pub fn new(gap: S) -> Result<Self, ParameterError<S>> {
        Ok(Self { gap: bounded("gap", gap, GAP)? })
    }
}

impl<S: Scalar> Stop<S> for Pad<S> {
    type Resistance = NormalResponse<S>;

    #[inline(always)]
    fn resistance<E: Elastic<S>>(&self, law: &Impact<S, E>, offset: S, speed: S) -> NormalResponse<S> {
        law.response(offset - self.gap, -speed)
    }
}

impl<S: Scalar> Resistance<S> for NormalResponse<S> {
    #[inline(always)]
    fn force(&self) -> S {
        self.force
    }

    #[inline(always)]
    fn impedance(&self, over: Option<S>) -> S {
        self.impedance(over)
    }

    #[inline(always)]
    fn stiffness(&self) -> S {
        self.stiffness()
    }
}

/// A slot: one element that pushes from either end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slot<S> {
    lower: S,
    upper: S,
}

impl<S: Scalar + PartialOrd> Slot<S> {
    /// A slot with gaps (m) to the end that pushes against the axis and to the one that pushes along it.
    ///
    /// # Errors
    /// If a gap is not finite or out of bounds.
    pub fn new(lower: S, upper: S) -> Result<Self, ParameterError<S>> {
        Ok(Self { lower: bounded("gap", lower, GAP)?, upper: bounded("gap", upper, GAP)? })
    }
}

impl<S: Scalar> Stop<S> for Slot<S> {
    type Resistance = SlotResponse<S>;

    #[inline(always)]
    fn resistance<E: Elastic<S>>(&self, law: &Impact<S, E>, offset: S, speed: S) -> SlotResponse<S> {
        law.slot(self.lower, self.upper, offset, speed)
    }
}

impl<S: Scalar> Resistance<S> for SlotResponse<S> {
    #[inline(always)]
    fn force(&self) -> S {
        SlotForce::force(self)
    }

    #[inline(always)]
    fn impedance(&self, over: Option<S>) -> S {
        let [own, _] = self.impedances(over);
        own
    }

    #[inline(always)]
    fn stiffness(&self) -> S {
        let [own, _] = self.stiffnesses();
        own
    }
}

#[cfg(test)]
mod tests {
    use super::{Pad, Resistance, Slot, Stop};
    use crate::{
        law::{Impact, ThreeHalves, fit::SlotForce},
        slide::ABSENT,
    };

    #[test]
    fn a_slot_without_its_lower_end_is_a_pad() {
        let law = Impact::new(ThreeHalves::new(3e6f64).unwrap(), 1000.0, 1e-4).unwrap();
        for (offset, speed) in [(2e-5, 0.001), (3e-5, -0.02), (0.5e-5, 0.1)] {
            let pad = Pad::new(1e-5).unwrap().resistance(&law, offset, speed);
            let slot = Slot::new(ABSENT, 1e-5).unwrap().resistance(&law, offset, speed);
            assert_eq!((pad.force, pad.force), (SlotForce::force(&slot), slot.normal()));
            let (impedance, stiffness) = (pad.impedance(Some(1e-3)), pad.stiffness());
            assert_eq!(slot.impedances(Some(1e-3)), [impedance, -impedance]);
            assert_eq!(slot.stiffnesses(), [stiffness, -stiffness]);
            assert_eq!(Resistance::impedance(&slot, Some(1e-3)), impedance);
            assert_eq!(Resistance::stiffness(&slot), stiffness);
            assert_eq!(pad.force > 0.0, offset > 1e-5);
        }
        assert!(Pad::new(f64::NAN).is_err() && Slot::new(0.0, -2.0f32).is_err());
    }
}
