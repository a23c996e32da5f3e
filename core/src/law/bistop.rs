//! BISTOP: a two-sided slot, one law at both ends.
//!
//! Two opposing pads of one pin are a slot: they share the offset and the sliding velocity.

use super::response::NormalResponse;
use crate::Scalar;

/// What a slot does along its axis to the body that carries it.
pub trait SlotForce<S> {
    /// Force on the body (N).
    fn force(&self) -> S;

    /// Sum of the two normal forces (N), which friction acts upon.
    fn normal(&self) -> S;

    /// −∂force/∂u and ∂normal/∂u (N·s/m), for a body velocity u along the axis that also moves the offset, by −u times
    /// the time `over` which it does (s), if one is given.
    fn impedances(&self, over: Option<S>) -> [S; 2];

    /// −∂force/∂x and ∂normal/∂x (N/m), for a displacement x of the body along the axis, which moves the offset by −x.
    fn stiffnesses(&self) -> [S; 2];
}

/// What a slot does to its pin's partner, along the slot's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlotResponse<S> {
    /// The pad whose gap grows with the offset.
    low: NormalResponse<S>,
    /// The pad whose gap shrinks with the offset.
    high: NormalResponse<S>,
}

impl<S: Scalar> SlotResponse<S> {
    /// What the pads at the `low` and the `high` end do together.
    #[inline(always)]
    pub fn new(low: NormalResponse<S>, high: NormalResponse<S>) -> Self {
        Self { low, high }
    }
}

impl<S: Scalar> SlotForce<S> for SlotResponse<S> {
    #[inline(always)]
    fn force(&self) -> S {
        self.high.force - self.low.force
    }

    #[inline(always)]
    fn normal(&self) -> S {
        self.high.force + self.low.force
    }

    #[inline(always)]
    fn impedances(&self, over: Option<S>) -> [S; 2] {
        let (low, high) = (self.low.impedance(over), self.high.impedance(over));
        [high + low, low - high]
    }

    #[inline(always)]
    fn stiffnesses(&self) -> [S; 2] {
        [self.high.stiffness() + self.low.stiffness(), self.low.stiffness() - self.high.stiffness()]
    }
}

#[cfg(test)]
mod tests {
    use super::SlotForce;
    use crate::law::{Impact, Normal, ThreeHalves};

    #[test]
    fn both_ends_are_the_one_sided_law_and_slopes_are_derivatives() {
        let law = Impact::new(ThreeHalves::new(3e6f64).unwrap(), 1000.0, 1e-4).unwrap();
        let (lower, upper, a) = (-1e-5, 1e-5, 1e-4);
        for (offset, speed) in [(3e-5, -0.01), (-2e-5, 0.004), (0.0, 0.02), (1.5e-5, 0.001)] {
            let at = |u: f64| law.slot(lower, upper, offset - a * (u - speed), u);
            let slot = at(speed);
            let low = law.response(-(lower + offset), speed).force;
            let high = law.response(offset - upper, -speed).force;
            assert_eq!((slot.force(), slot.normal()), (high - low, high + low));
            let h = 1e-7;
            let force_slope = -(at(speed + h).force() - at(speed - h).force()) / (2.0 * h);
            let normal_slope = (at(speed + h).normal() - at(speed - h).normal()) / (2.0 * h);
            let [impedance, normal_impedance] = slot.impedances(Some(a));
            assert!(libm::fabs(impedance - force_slope) < 1e-5 * (1.0 + force_slope));
            assert!(libm::fabs(normal_impedance - normal_slope) < 1e-5 * (1.0 + libm::fabs(normal_slope)));
            let [stiffness, normal_stiffness] = slot.stiffnesses();
            let [damping, normal_damping] = slot.impedances(None);
            assert!(libm::fabs(damping + a * stiffness - impedance) <= 1e-12 * impedance);
            assert!(libm::fabs(normal_damping + a * normal_stiffness - normal_impedance) <= 1e-12 * impedance);
        }
    }
}
