//! Regularised Coulomb friction: what multibody solvers use.

use super::{Contact, Friction, Rubbing};
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
    type Memory = ();

    const STICKS: bool = false;

    #[inline(always)]
    fn fresh() {}

    #[inline(always)]
    fn add(&self, (): &(), rubbing: &Rubbing<S>, contact: &mut Contact<S>) {
        let Rubbing { sliding: [x, y], normal, normal_slope, tangent_share, .. } = *rubbing;
        let (ratio, ratio_slope) = self.per_speed(x * x + y * y);
        let along = ratio * normal;
        let turn = (tangent_share + tangent_share) * ratio_slope * normal;
        let grip = ratio * normal_slope;
        contact.force[1] = -along * x;
        contact.force[2] = -along * y;
        contact.impedance[1] = [grip * x, along + turn * x * x, turn * x * y];
        contact.impedance[2] = [grip * y, turn * x * y, along + turn * y * y];
    }

    #[inline(always)]
    fn shifted((): &(), (): &(), (): &(), _: S) {}

    #[inline(always)]
    fn selected(_: S, (): &(), (): &()) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHARE: f64 = 0.9;

    fn traction(velocity: [f64; 3]) -> Contact<f64> {
        let mut contact = Contact { force: [0.0; 3], impedance: [[0.0; 3]; 3] };
        let rubbing = Rubbing {
            sliding: [velocity[1], velocity[2]],
            // A normal force of 2 N that grows by 5 N·s/m.
            normal: 2.0 + 5.0 * velocity[0],
            normal_slope: 5.0,
            mass_rate: 80.0,
            tangent_share: SHARE,
        };
        Regularised::new(0.3, 1e-4).unwrap().add(&(), &rubbing, &mut contact);
        contact
    }

    #[test]
    fn follows_the_band_and_then_slides() {
        for w in [0.0, 0.25, 0.5, 1.0] {
            let force = traction([0.0, 1e-4 * w, 0.0]).force[1];
            assert!(libm::fabs(force + 0.6 * w * (3.0 - w * w) / 2.0) < 1e-15);
        }
        let sliding = traction([0.0, 3.0, -4.0]).force;
        assert!(libm::fabs(sliding[1] + 0.36) < 1e-15 && libm::fabs(sliding[2] - 0.48) < 1e-15);
    }

    #[test]
    fn impedance_is_between_the_derivative_and_the_secant() {
        for velocity in [[1e-3, 3e-5, -2e-5], [0.0, 0.02, 0.01], [1e-3, 0.0, 2e-4]] {
            let at = traction(velocity);
            let secant =
                Regularised::new(0.3, 1e-4).unwrap().per_speed(velocity[1] * velocity[1] + velocity[2] * velocity[2]).0
                    * (2.0 + 5.0 * velocity[0]);
            for column in 0..3 {
                let h = 1e-9;
                let (mut up, mut down) = (velocity, velocity);
                up[column] += h;
                down[column] -= h;
                for row in 1..3 {
                    let slope = -(traction(up).force[row] - traction(down).force[row]) / (2.0 * h);
                    let secant = if row == column { secant } else { 0.0 };
                    // The share acts on tangential velocities only; the normal force's part is exact.
                    let slope = if column == 0 { slope } else { SHARE * slope + (1.0 - SHARE) * secant };
                    let found = at.impedance[row][column];
                    assert!(
                        libm::fabs(found - slope) <= 1e-5 * (1.0 + libm::fabs(slope)),
                        "{row}{column} {found} {slope}"
                    );
                }
            }
        }
    }

    #[test]
    fn opposes_sliding_and_stays_in_the_cone() {
        for k in 0..1000u16 {
            let angle = f64::from(k) * 0.1;
            let speed = 1e-6 * f64::from(k * k % 997);
            let (x, y) = (speed * libm::cos(angle), speed * libm::sin(angle));
            let force = traction([0.0, x, y]).force;
            assert!(force[1] * x + force[2] * y <= 0.0);
            assert!(libm::hypot(force[1], force[2]) <= 0.6 * (1.0 + 1e-15));
        }
    }
}
