//! The elastic part of contact: k·δ^e, as a menu of types so that a linear contact pays for no root.

use crate::{ParameterError, Scalar, error::bounded};

const STIFFNESS: [f64; 2] = [0.0, 1e20];

/// A progressive spring.
pub trait Elastic<S>: Copy {
    /// Force (N) and stiffness dF/dδ (N/m) at a penetration `depth` ≥ 0 (m). Both vanish at depth 0.
    fn force(&self, depth: S) -> (S, S);

    /// Energy (J) stored at a penetration `depth` ≥ 0 (m): the integral of the force.
    fn energy(&self, depth: S) -> S;
}

/// F = k·δ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear<S> {
    stiffness: S,
}

crate::cast::cast!([] [] Linear: Linear<f64> => T Linear<T> { stiffness });

impl<S: Scalar + PartialOrd> Linear<S> {
    /// A spring of `stiffness` k (N/m).
    ///
    /// # Errors
    /// If it is negative, above 1e20 or not finite.
    pub fn new(stiffness: S) -> Result<Self, ParameterError<S>> {
        Ok(Self { stiffness: bounded("contact.stiffness", stiffness, STIFFNESS)? })
    }
}

impl<S: Scalar> Elastic<S> for Linear<S> {
    #[inline(always)]
    fn force(&self, depth: S) -> (S, S) {
        (self.stiffness * depth, depth.select_gt(S::zero(), self.stiffness, S::zero()))
    }

    fn energy(&self, depth: S) -> S {
        self.stiffness * depth * depth / S::from_f64(2.0)
    }
}

/// F = k·δ^(3/2): one square root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreeHalves<S> {
    stiffness: S,
}

crate::cast::cast!([] [] ThreeHalves: ThreeHalves<f64> => T ThreeHalves<T> { stiffness });

impl<S: Scalar + PartialOrd> ThreeHalves<S> {
    /// A spring of `stiffness` k (N/m^1.5).
    ///
    /// # Errors
    /// If it is negative, above 1e20 or not finite.
    pub fn new(stiffness: S) -> Result<Self, ParameterError<S>> {
        Ok(Self { stiffness: bounded("contact.stiffness", stiffness, STIFFNESS)? })
    }
}

impl<S: Scalar> Elastic<S> for ThreeHalves<S> {
    #[inline(always)]
    fn force(&self, depth: S) -> (S, S) {
        let slope = self.stiffness * depth.sqrt();
        (slope * depth, S::from_f64(1.5) * slope)
    }

    fn energy(&self, depth: S) -> S {
        self.force(depth).0 * depth / S::from_f64(2.5)
    }
}

/// F = k·δ^e for any e > 1; at e = 1 its slope at depth 0 is k, so that [`Linear`] is the type for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power<S> {
    stiffness: S,
    exponent: S,
}

crate::cast::cast!([] [] Power: Power<f64> => T Power<T> { stiffness, exponent });

impl<S: Scalar + PartialOrd> Power<S> {
    /// A spring of `stiffness` k (N/m^e) and `exponent` e.
    ///
    /// # Errors
    /// If the stiffness is negative, above 1e20 or not finite, or the exponent outside 1…4.
    pub fn new(stiffness: S, exponent: S) -> Result<Self, ParameterError<S>> {
        Ok(Self {
            stiffness: bounded("contact.stiffness", stiffness, STIFFNESS)?,
            exponent: bounded("contact.exponent", exponent, [1.0, 4.0])?,
        })
    }
}

impl<S: Scalar> Elastic<S> for Power<S> {
    #[inline(always)]
    fn force(&self, depth: S) -> (S, S) {
        let slope = self.stiffness * depth.pow(self.exponent - S::one());
        (slope * depth, self.exponent * slope)
    }

    fn energy(&self, depth: S) -> S {
        self.force(depth).0 * depth / (self.exponent + S::one())
    }
}

#[cfg(test)]
mod tests {
    use super::{Elastic, Linear, Power, ThreeHalves};

    #[test]
    fn special_exponents_agree_with_the_general_law() {
        for k in (0..1000u16).step_by(if cfg!(miri) { 50 } else { 1 }) {
            let depth = f64::from(k) * 1e-6;
            let (force, slope) = ThreeHalves::new(3e6).unwrap().force(depth);
            let (general, general_slope) = Power::new(3e6, 1.5).unwrap().force(depth);
            assert!(libm::fabs(force - general) <= 1e-13 * general);
            assert!(libm::fabs(slope - general_slope) <= 1e-13 * general_slope);
        }
        assert_eq!(Linear::new(2.0f32).unwrap().force(0.0), (0.0, 0.0));
        assert_eq!(Linear::new(2.0f32).unwrap().force(3.0), (6.0, 2.0));
    }

    #[test]
    fn energy_is_the_integral_of_the_force() {
        fn check(law: impl Elastic<f64>) {
            let (depth, h) = (3e-4, 1e-8);
            let slope = (law.energy(depth + h) - law.energy(depth - h)) / (2.0 * h);
            assert!(libm::fabs(slope / law.force(depth).0 - 1.0) < 1e-7, "{slope}");
            assert_eq!(law.energy(0.0), 0.0);
        }
        check(Linear::new(2e5).unwrap());
        check(ThreeHalves::new(3e6).unwrap());
        check(Power::new(3e6, 2.2).unwrap());
    }
}
