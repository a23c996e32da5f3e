//! Regularised Coulomb friction: what multibody solvers use.

use super::{Friction, SlidingContact, Traction};
use crate::{ParameterError, Scalar, error::bounded};

/// Coulomb friction smoothed by STEP over the stick band: μ(s) = μ·w(3 − w²)/2 with w = s/v_s up to v_s, then μ.
///
/// A loaded body at rest creeps at a fraction of the stick band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regularised<S> {
    coefficient: S,
    /// v_s² (m²/s²).
    stick_band_squared: S,
}

crate::cast::cast!([] [] Regularised: Regularised<f64> => T Regularised<T> { coefficient, stick_band_squared });

impl<S: Scalar + PartialOrd> Regularised<S> {
    /// Friction with `coefficient` μ and `stick_band` v_s (m/s).
    ///
    /// # Errors
    /// If μ is negative or v_s not positive, or either out of bounds or not finite.
    pub fn new(coefficient: S, stick_band: S) -> Result<Self, ParameterError<S>> {
        let coefficient = bounded("friction.coefficient", coefficient, [0.0, 100.0])?;
        let stick_band = bounded("friction.stick_band", stick_band, [1e-10, 1e3])?;
        Ok(Self { coefficient, stick_band_squared: stick_band * stick_band })
    }
}

impl<S: Scalar> Regularised<S> {
    /// μ(s)/s and d(μ(s)/s)/d(s²), from the sliding speed squared s² (m²/s²).
    ///
    /// With i = 1/max(s, v_s) and w = s·i both branches are one formula: ½μ·i·(3 − w²) and −½μ·i³.
    #[inline(always)]
    pub fn per_speed(&self, speed_squared: S) -> (S, S) {
        let inverse = speed_squared.max_of(self.stick_band_squared).rsqrt();
        let inverse_squared = inverse * inverse;
        let half = S::from_f64(0.5) * self.coefficient * inverse;
        (half * (S::from_f64(3.0) - speed_squared * inverse_squared), -half * inverse_squared)
    }
}

impl<S: Scalar> Friction<S> for Regularised<S> {
    type Internal = ();

    const STICKS: bool = false;

    #[inline(always)]
    fn fresh() {}

    #[inline(always)]
    fn traction(&self, (): &(), contact: &SlidingContact<S>) -> (Traction<S>, ()) {
        let [x, y] = contact.sliding;
        (contact.along_the_motion(self.per_speed(x * x + y * y)), ())
    }

    #[inline(always)]
    fn shifted((): &(), (): &(), (): &(), _: S) {}

    #[inline(always)]
    fn or_old((): &(), _: S, (): &()) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHARE: f64 = 0.9;

    fn traction(normal: f64, sliding: [f64; 2]) -> Traction<f64> {
        let contact = SlidingContact { sliding, normal, mass_rate: 80.0, tangent_share: SHARE };
        Regularised::new(0.3, 1e-4).unwrap().traction(&(), &contact).0
    }

    #[test]
    fn follows_the_band_and_then_slides() {
        for w in [0.0, 0.25, 0.5, 1.0] {
            let force = traction(2.0, [1e-4 * w, 0.0]).force[0];
            assert!(libm::fabs(force + 0.6 * w * (3.0 - w * w) / 2.0) < 1e-15);
        }
        let sliding = traction(2.0, [3.0, -4.0]).force;
        assert!(libm::fabs(sliding[0] + 0.36) < 1e-15 && libm::fabs(sliding[1] - 0.48) < 1e-15);
    }

    #[test]
    fn impedance_is_between_the_derivative_and_the_secant() {
        let normal = 2.0;
        for sliding in [[3e-5, -2e-5], [0.02, 0.01], [0.0, 2e-4]] {
            let at = traction(normal, sliding);
            let [x, y] = sliding;
            let secant = Regularised::new(0.3, 1e-4).unwrap().per_speed(x * x + y * y).0 * normal;
            let h = 1e-9;
            for (row, column, found) in
                [(0, 0, at.impedance[0]), (0, 1, at.impedance[1]), (1, 0, at.impedance[1]), (1, 1, at.impedance[2])]
            {
                let (mut up, mut down) = (sliding, sliding);
                up[column] += h;
                down[column] -= h;
                let tangent = -(traction(normal, up).force[row] - traction(normal, down).force[row]) / (2.0 * h);
                let slope = SHARE * tangent + (1.0 - SHARE) * if row == column { secant } else { 0.0 };
                assert!(libm::fabs(found - slope) <= 1e-5 * (1.0 + libm::fabs(slope)), "{row}{column} {found} {slope}");
            }
            for (per_normal, force) in at.per_normal.into_iter().zip(at.force) {
                assert!(libm::fabs(per_normal * normal + force) <= 1e-15);
            }
        }
    }

    #[test]
    fn opposes_sliding_and_stays_in_the_cone() {
        for k in 0..1000u16 {
            let angle = f64::from(k) * 0.1;
            let speed = 1e-6 * f64::from(u32::from(k) * u32::from(k) % 997);
            let (x, y) = (speed * libm::cos(angle), speed * libm::sin(angle));
            let force = traction(2.0, [x, y]).force;
            assert!(force[0] * x + force[1] * y <= 0.0);
            assert!(libm::hypot(force[0], force[1]) <= 0.6 * (1.0 + 1e-15));
        }
    }
}
