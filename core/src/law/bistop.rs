//! BISTOP: a two-sided slot, the IMPACT law at both ends.
//!
//! Two opposing pads of one pin are a slot: they share the offset and the sliding velocity.

use super::{Elastic, Impact};
use crate::Scalar;

/// What a slot does to its pin's partner, along the slot's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlotResponse<S> {
    /// Force on the body that carries the slot, along the axis (N).
    pub force: S,
    /// Sum of the two normal forces (N), which friction acts upon.
    pub normal: S,
    /// −∂force/∂u (N·s/m), for a body velocity u along the axis that also moves the offset by −a·u.
    pub force_slope: S,
    /// ∂normal/∂u (N·s/m), likewise.
    pub normal_slope: S,
}

impl<S: Scalar, E: Elastic<S>> Impact<S, E> {
    /// A slot of this law with the gaps `lower` and `upper` (m) at offset 0.
    ///
    /// `offset` (m) is the pin's displacement along the slot's axis as seen from the body that carries the slot:
    /// the lower gap is `lower + offset`, the upper `upper − offset`. `speed` u (m/s) is that of the body's material at
    /// the pin, so the offset's rate is −u. `a` (s) is the part of a step over which u also moves the offset.
    #[inline(always)]
    pub fn slot(&self, lower: S, upper: S, offset: S, speed: S, a: S) -> SlotResponse<S> {
        let low = self.response(-(lower + offset), speed);
        let high = self.response(offset - upper, -speed);
        let (low_slope, high_slope) = (low.damping + a * low.stiffness, high.damping + a * high.stiffness);
        SlotResponse {
            force: high.force - low.force,
            normal: high.force + low.force,
            force_slope: high_slope + low_slope,
            normal_slope: low_slope - high_slope,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::law::{Impact, ThreeHalves};

    #[test]
    fn both_ends_are_the_one_sided_law_and_slopes_are_derivatives() {
        let law = Impact::new(ThreeHalves::new(3e6f64).unwrap(), 1000.0, 1e-4).unwrap();
        let (lower, upper, a) = (-1e-5, 1e-5, 1e-4);
        for (offset, speed) in [(3e-5, -0.01), (-2e-5, 0.004), (0.0, 0.02), (1.5e-5, 0.001)] {
            let at = |u: f64| law.slot(lower, upper, offset - a * (u - speed), u, a);
            let slot = at(speed);
            let low = law.response(-(lower + offset), speed).force;
            let high = law.response(offset - upper, -speed).force;
            assert_eq!((slot.force, slot.normal), (high - low, high + low));
            let h = 1e-7;
            let force_slope = -(at(speed + h).force - at(speed - h).force) / (2.0 * h);
            let normal_slope = (at(speed + h).normal - at(speed - h).normal) / (2.0 * h);
            assert!(libm::fabs(slot.force_slope - force_slope) < 1e-5 * (1.0 + force_slope));
            assert!(libm::fabs(slot.normal_slope - normal_slope) < 1e-5 * (1.0 + libm::fabs(normal_slope)));
        }
    }
}
