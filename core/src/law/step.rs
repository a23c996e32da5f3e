//! STEP: a cubic rise between two levels.

use crate::Scalar;

/// S(s) = s²(3 − 2s) with s clamped to [0, 1], and a sixth of its slope dS/ds = 6s(1 − s).
#[inline(always)]
pub fn cubic<S: Scalar>(s: S) -> (S, S) {
    risen(s.max_of(S::zero()))
}

/// The same for an s that is not negative.
#[inline(always)]
pub fn risen<S: Scalar>(s: S) -> (S, S) {
    let s = s.at_most(S::one());
    let square = s * s;
    (square * (S::from_f64(3.0) - (s + s)), s - square)
}

/// STEP(x, x0, h0, x1, h1): `h0` up to `x0`, `h1` from `x1` on, the cubic between. Needs x1 > x0.
#[inline(always)]
pub fn step<S: Scalar>(x: S, x0: S, h0: S, x1: S, h1: S) -> S {
    h0 + (h1 - h0) * cubic((x - x0) / (x1 - x0)).0
}

#[cfg(test)]
mod tests {
    use super::{cubic, step};

    #[test]
    fn ends_middle_and_slope() {
        assert_eq!(step(0.0, 0.05, 0.0, 1.0, 0.1), 0.0);
        assert_eq!(step(2.0, 0.05, 0.0, 1.0, 0.1), 0.1);
        assert_eq!(step(0.5f64, 0.0, -1.0, 1.0, 1.0), 0.0);
        let (h, x) = (1e-6, 0.3f64);
        let difference = (cubic(x + h).0 - cubic(x - h).0) / (2.0 * h);
        assert!(libm::fabs(6.0 * cubic(x).1 - difference) < 1e-9);
        assert_eq!(cubic(-1.0).1, 0.0);
        assert_eq!(cubic(3.0f32).1, 0.0);
    }
}
