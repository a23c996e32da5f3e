//! A commanded speed by one setpoint per period, interpolated by cubics.

use super::{Commanded, Piece};
use crate::Scalar;

/// A P-velocity drive whose command covers three periods of setpoints; it is set before every step.
pub type SetpointDrive<S> = Commanded<S, [Piece<S>; 3]>;

impl<S: Scalar> SetpointDrive<S> {
    /// A drive of the `gain` (N·s/m, N·m·s/rad), whose command is zero until it is given.
    pub fn new(gain: S) -> Self {
        let zero = S::zero();
        Self { gain, command: [Piece { start: zero, coefficients: [zero; 4] }; 3] }
    }
}

/// The Catmull–Rom cubic from the second to the third of four setpoints (m/s, rad/s), from `start` (s) on, at `rate` (1/s) setpoints per
/// second. Its slope at either end is that of the chord between the neighbours (Catmull and Rom 1974), so that the command is
/// continuously differentiable.
#[inline(always)]
pub(crate) fn catmull_rom<S: Scalar>([before, from, to, after]: [S; 4], start: S, rate: S) -> Piece<S> {
    let half = S::from_f64(0.5);
    let slope = (to - before) * half;
    let end_slope = (after - from) * half;
    let rise = to - from;
    let third = slope + end_slope - (rise + rise);
    let second = rise - slope - third;
    let square = rate * rate;
    Piece { start, coefficients: [from, slope * rate, second * square, third * (square * rate)] }
}

#[cfg(test)]
mod tests {
    use super::catmull_rom;

    #[test]
    fn parabolas_are_met_exactly() {
        let y = |t: f64| 0.03 + t * (2.0 - 30.0 * t);
        let piece = catmull_rom([-1.0, 0.0, 1.0, 2.0].map(|i| y(0.2 + 1e-3 * i)), 0.2, 1e3);
        for t in [0.2, 0.2003, 0.201] {
            assert!(libm::fabs(piece.speed(t) - y(t)) < 1e-14 && libm::fabs(piece.rate(t) - (2.0 - 60.0 * t)) < 1e-10);
        }
    }

    #[test]
    fn goes_over_smoothly() {
        let setpoints = [0.0, 0.1, 0.05, 0.2, -0.1f64];
        let [one, next] = [0, 1].map(|i| catmull_rom([0, 1, 2, 3].map(|k| setpoints[i + k]), 1e-3 * i as f64, 1e3));
        assert!(libm::fabs(one.speed(1e-3) - 0.05) < 1e-15 && next.speed(1e-3) == 0.05);
        assert!(libm::fabs(one.rate(1e-3) - next.rate(1e-3)) < 1e-10);
    }
}
