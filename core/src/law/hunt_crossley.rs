//! Hunt and Crossley's contact: a progressive spring whose damper grows with its force.
//!
//! F = k·δ^e·(1 + a·δ̇), a = 3(1 − r)/(2v) for a restitution r at the speed v of approach (Hunt and Crossley, Journal of
//! Applied Mechanics 42, 1975). In a bounce it never pulls, and force and damping both begin and end at zero.
//!
//! A bounce from the speed u ends at the speed w with a·u − ln(1 + a·u) = −a·w − ln(1 − a·w), whatever the mass, stiffness and
//! exponent are. To first order w/u = 1 − ⅔a·u, which is the promise at u = v; what is left out makes the bounce
//! livelier, by about (1 − r)²: 0.002 at r = 0.95, 0.009 at 0.9, 0.033 at 0.8, 0.16 at 0.5. It is a law for restitutions near 1.

use super::{Elastic, Normal, NormalResponse};
use crate::{ParameterError, Scalar, error::bounded};

/// A one-sided contact. Its restitution goes by the speed of approach: slower impacts lose less, faster ones more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HuntCrossley<S, E> {
    elastic: E,
    /// a (s/m).
    hysteresis: S,
}

crate::cast::cast!([E] [] HuntCrossley: HuntCrossley<f64, E> => T HuntCrossley<T, E::Of<T>> { elastic, hysteresis });

impl<S: Scalar + PartialOrd, E: Elastic<S>> HuntCrossley<S, E> {
    /// A contact with the spring `elastic` that keeps the share `restitution` r of a `speed` v (m/s) of approach.
    ///
    /// # Errors
    /// If r is outside 0…1 or v outside 1e-6…1e4, or either not finite.
    pub fn new(elastic: E, restitution: S, speed: S) -> Result<Self, ParameterError<S>> {
        let [restitution, speed] = checked(restitution, speed)?;
        Ok(Self::with_hysteresis(elastic, S::from_f64(1.5) * (S::one() - restitution) / speed))
    }
}

/// A restitution and its speed (m/s), if both are in bounds.
pub(super) fn checked<S: Scalar + PartialOrd>(restitution: S, speed: S) -> Result<[S; 2], ParameterError<S>> {
    let restitution = bounded("contact.restitution", restitution, [0.0, 1.0])?;
    Ok([restitution, bounded("contact.speed", speed, [1e-6, 1e4])?])
}

impl<S: Scalar, E: Elastic<S>> HuntCrossley<S, E> {
    /// The law with the factor `hysteresis` a ≥ 0 (s/m).
    pub(super) fn with_hysteresis(elastic: E, hysteresis: S) -> Self {
        Self { elastic, hysteresis }
    }
}

impl<S: Scalar, E: Elastic<S>> Normal<S> for HuntCrossley<S, E> {
    #[inline(always)]
    fn response(&self, penetration: S, rate: S) -> NormalResponse<S> {
        let (spring, spring_slope) = self.elastic.force(penetration.max_of(S::zero()));
        let share = S::one() + self.hysteresis * rate;
        NormalResponse::new(spring * share, spring_slope * share, spring * self.hysteresis)
    }

    fn energy(&self, penetration: S) -> S {
        self.elastic.energy(penetration.max_of(S::zero()))
    }
}

#[cfg(test)]
mod tests {
    use super::HuntCrossley;
    use crate::law::{Normal, ThreeHalves};

    fn law(restitution: f64) -> HuntCrossley<f64, ThreeHalves<f64>> {
        HuntCrossley::new(ThreeHalves::new(3e6).unwrap(), restitution, 0.4).unwrap()
    }

    #[test]
    fn slopes_are_derivatives() {
        let law = law(0.6);
        for (depth, rate) in [(1e-4, 0.3), (3e-5, -0.2), (2e-4, -1.0), (-1e-5, 0.1)] {
            let at = |depth: f64, rate: f64| law.response(depth, rate).force;
            let response = law.response(depth, rate);
            let by_depth = (at(depth + 1e-9, rate) - at(depth - 1e-9, rate)) / 2e-9;
            let by_rate = (at(depth, rate + 1e-6) - at(depth, rate - 1e-6)) / 2e-6;
            assert!(libm::fabs(response.stiffness() - by_depth) <= 1e-6 * libm::fabs(by_depth), "{depth} {rate}");
            assert!(libm::fabs(response.impedance(None) - by_rate) <= 1e-6 * libm::fabs(by_rate), "{depth} {rate}");
        }
    }

    #[test]
    fn never_pulls() {
        // Parting at 1/a and faster the spring does not follow.
        let law = law(0.0);
        for rate in [-0.2666, -0.2667, -3.0] {
            assert_eq!(law.response(1e-4, rate).force > 0.0, rate > -0.4 / 1.5, "{rate}");
        }
        assert_eq!(law.response(-1e-4, 1.0).force, 0.0);
    }

    #[test]
    fn impossible_restitutions_are_refused() {
        let spring = ThreeHalves::new(3e6).unwrap();
        for (restitution, speed, parameter) in [
            (-0.1, 1.0, "contact.restitution"),
            (1.1, 1.0, "contact.restitution"),
            (f64::NAN, 1.0, "contact.restitution"),
            (0.5, 0.0, "contact.speed"),
            (0.5, f64::INFINITY, "contact.speed"),
        ] {
            assert_eq!(HuntCrossley::new(spring, restitution, speed).unwrap_err().parameter, parameter);
        }
    }
}
