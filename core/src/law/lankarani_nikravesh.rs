//! Lankarani and Nikravesh's contact: Hunt and Crossley's force, its damping from the energy that a bounce loses.
//!
//! F = k·δ^e·(1 + a·δ̇), a = 3(1 − r²)/(4v) for a restitution r at the speed v of approach (Lankarani and Nikravesh, Journal of
//! Mechanical Design 112, 1990). The energy ½m·v²(1 − r²) is taken for lost along the way of an undamped bounce, so that the promise
//! holds where little is lost: a bounce is livelier, by about 1.4·(1 − r)²: 0.004 at r = 0.95, 0.013 at 0.9, 0.047 at 0.8, 0.23
//! at 0.5, and at r = 0 it keeps 0.66. It is a law for restitutions near 1; see [`hunt_crossley`](super::hunt_crossley) for the
//! bounce's closed form.

use super::{Elastic, HuntCrossley, Normal, NormalResponse, hunt_crossley::checked};
use crate::{ParameterError, Scalar};

/// A one-sided contact. Its restitution goes by the speed of approach: slower impacts lose less, faster ones more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LankaraniNikravesh<S, E>(HuntCrossley<S, E>);

crate::cast::cast!([E] [] LankaraniNikravesh: LankaraniNikravesh<f64, E> => T LankaraniNikravesh<T, E::Of<T>> { 0 });

impl<S: Scalar + PartialOrd, E: Elastic<S>> LankaraniNikravesh<S, E> {
    /// A contact with the spring `elastic` that keeps the share `restitution` r of a `speed` v (m/s) of approach.
    ///
    /// # Errors
    /// If r is outside 0…1 or v outside 1e-6…1e4, or either not finite.
    pub fn new(elastic: E, restitution: S, speed: S) -> Result<Self, ParameterError<S>> {
        let [restitution, speed] = checked(restitution, speed)?;
        let lost = S::one() - restitution * restitution;
        Ok(Self(HuntCrossley::with_hysteresis(elastic, S::from_f64(0.75) * lost / speed)))
    }
}

impl<S: Scalar, E: Elastic<S>> Normal<S> for LankaraniNikravesh<S, E> {
    #[inline(always)]
    fn response(&self, penetration: S, rate: S) -> NormalResponse<S> {
        self.0.response(penetration, rate)
    }

    fn energy(&self, penetration: S) -> S {
        self.0.energy(penetration)
    }
}

#[cfg(test)]
mod tests {
    use super::LankaraniNikravesh;
    use crate::law::{Linear, Normal};

    #[test]
    fn damps_as_the_lost_energy_asks() {
        let law = LankaraniNikravesh::new(Linear::new(1e6f64).unwrap(), 0.5, 2.0).unwrap();
        let response = law.response(1e-3, 0.4);
        // 1e6·1e-3·(1 + ¾·(1 − ¼)/2·0.4)
        assert!(libm::fabs(response.force - 1112.5) < 1e-9, "{}", response.force);
        assert!(libm::fabs(response.impedance(None) - 281.25) < 1e-9);
        assert!(libm::fabs(law.energy(1e-3) - 0.5) < 1e-12);
    }
}
