//! Regularised friction with a static and a kinetic coefficient and a viscous part.

use super::{Friction, Regularised, SlidingContact, Traction};
use crate::{ParameterError, Scalar, error::bounded};

/// μ(s) = (μ_k + (μ_s − μ_k)/(1 + (s/v_S)²))·w(3 − w²)/2 + μ_v·s with w = s/v_s up to the stick band v_s, then 1.
///
/// Hess and Soom's form of Stribeck's curve ("Friction at a lubricated line contact operating at oscillating sliding velocities",
/// Journal of Tribology 112, 1990), which needs no exponential.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stribeck<S> {
    /// μ_k.
    kinetic: S,
    /// μ_s − μ_k.
    excess: S,
    /// 1/v_S² (s²/m²).
    per_speed_squared: S,
    /// μ_v (s/m).
    viscous: S,
    /// Friction with a coefficient of 1.
    band: Regularised<S>,
}

crate::cast::cast!([] [] Stribeck: Stribeck<f64> => T Stribeck<T> { kinetic, excess, per_speed_squared, viscous, band });

/// Parameters of [`Stribeck`], SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StribeckData<S> {
    /// Static coefficient μ_s.
    pub at_rest: S,
    /// Kinetic coefficient μ_k ≤ μ_s.
    pub kinetic: S,
    /// Stribeck speed v_S (m/s): there the coefficient is midway between static and kinetic. Not below the stick band.
    pub stribeck_speed: S,
    /// By how much the coefficient grows with the speed, μ_v (s/m).
    pub viscous: S,
    /// Stick band v_s (m/s).
    pub stick_band: S,
}

impl<S: Scalar + PartialOrd> Stribeck<S> {
    /// Friction with these parameters.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(data: StribeckData<S>) -> Result<Self, ParameterError<S>> {
        let at_rest = bounded("friction.static_coefficient", data.at_rest, [0.0, 100.0])?;
        let kinetic = bounded("friction.coefficient", data.kinetic, [0.0, at_rest.to_f64()])?;
        let band = Regularised::new(S::one(), data.stick_band)?;
        let speed = bounded("friction.stribeck_speed", data.stribeck_speed, [data.stick_band.to_f64(), 1e3])?;
        let viscous = bounded("friction.viscous", data.viscous, [0.0, 1e6])?;
        Ok(Self { kinetic, excess: at_rest - kinetic, per_speed_squared: S::one() / (speed * speed), viscous, band })
    }
}

impl<S: Scalar> Stribeck<S> {
    /// μ(s)/s and d(μ(s)/s)/d(s²), from the sliding speed squared s² (m²/s²).
    #[inline(always)]
    pub fn per_speed(&self, speed_squared: S) -> (S, S) {
        let (ratio, ratio_slope) = self.band.per_speed(speed_squared);
        let share = S::one() / (S::one() + speed_squared * self.per_speed_squared);
        let excess = self.excess * share;
        let coefficient = self.kinetic + excess;
        let slope = -(excess * share * self.per_speed_squared);
        (coefficient * ratio + self.viscous, slope * ratio + coefficient * ratio_slope)
    }
}

impl<S: Scalar> Friction<S> for Stribeck<S> {
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

    const DATA: StribeckData<f64> =
        StribeckData { at_rest: 0.4, kinetic: 0.25, stribeck_speed: 0.01, viscous: 0.5, stick_band: 1e-4 };

    fn traction(data: StribeckData<f64>, sliding: [f64; 2]) -> Traction<f64> {
        let contact = SlidingContact { sliding, normal: 2.0, mass_rate: 80.0, tangent_share: 1.0 };
        Stribeck::new(data).unwrap().traction(&(), &contact).0
    }

    #[test]
    fn follows_the_curve_from_rest_to_viscous_sliding() {
        for (speed, coefficient) in [
            (0.0, 0.0),
            (1e-4, 0.25 + 0.15 / 1.0001 + 5e-5),
            (0.01, 0.25 + 0.075 + 0.005),
            (0.1, 0.25 + 0.15 / 101.0 + 0.05),
            (10.0, 0.25 + 0.15 / 1_000_001.0 + 5.0),
        ] {
            let [x, y] = traction(DATA, [0.6 * speed, -0.8 * speed]).force;
            assert!(libm::fabs(x + 1.2 * coefficient) < 1e-12 && libm::fabs(y - 1.6 * coefficient) < 1e-12, "{speed}");
        }
    }

    #[test]
    fn without_excess_and_viscous_part_it_is_regularised_friction() {
        let plain = StribeckData { at_rest: 0.25, viscous: 0.0, ..DATA };
        let coulomb = Regularised::new(0.25, 1e-4).unwrap();
        for sliding in [[3e-5, 1e-5], [0.2, -0.3]] {
            let contact = SlidingContact { sliding, normal: 2.0, mass_rate: 80.0, tangent_share: 1.0 };
            let [one, other] = [traction(plain, sliding), coulomb.traction(&(), &contact).0];
            for (one, other) in one.force.iter().chain(&one.impedance).zip(other.force.iter().chain(&other.impedance)) {
                assert!(libm::fabs(one - other) <= 1e-12 * libm::fabs(*other).max(1.0));
            }
        }
    }

    #[test]
    fn impedance_is_the_derivative() {
        let h = 1e-9;
        for sliding in [[3e-5, -2e-5], [0.002, 0.001], [0.0, 0.03], [0.5, 0.1]] {
            let [xx, xy, yy] = traction(DATA, sliding).impedance;
            for (row, column, found) in [(0, 0, xx), (0, 1, xy), (1, 0, xy), (1, 1, yy)] {
                let moved = |h: f64| {
                    let mut sliding = sliding;
                    sliding[column] += h;
                    traction(DATA, sliding).force[row]
                };
                let slope = (moved(-h) - moved(h)) / (2.0 * h);
                assert!(libm::fabs(found - slope) <= 1e-5 * (10.0 + libm::fabs(slope)), "{sliding:?} {found} {slope}");
            }
        }
    }

    #[test]
    fn bad_parameters_are_refused() {
        for (data, name) in [
            (StribeckData { at_rest: f64::NAN, ..DATA }, "friction.static_coefficient"),
            (StribeckData { kinetic: 0.41, ..DATA }, "friction.coefficient"),
            (StribeckData { stribeck_speed: 5e-5, ..DATA }, "friction.stribeck_speed"),
            (StribeckData { viscous: -1.0, ..DATA }, "friction.viscous"),
            (StribeckData { stick_band: 0.0, ..DATA }, "friction.stick_band"),
        ] {
            assert_eq!(Stribeck::new(data).unwrap_err().parameter, name);
        }
    }
}
