//! Clearance at a tolerance level (eq. 9) and its class.

use crate::{ParameterError, Scalar, error::bounded};

/// A gap over the production: mean and standard deviation (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapStatistics<S> {
    /// Mean x (m).
    pub mean: S,
    /// Standard deviation σ (m).
    pub deviation: S,
}

impl<S: Scalar + PartialOrd> GapStatistics<S> {
    /// The gap [`at`](Self::at) level `n`, if it is not below `least` (m).
    ///
    /// # Errors
    /// If it is, or above 1 km, or not finite.
    pub fn checked_at(&self, n: S, least: f64) -> Result<S, ParameterError<S>> {
        bounded("gap", self.at(n), [least, 1e3])
    }
}

impl<S: Scalar> GapStatistics<S> {
    /// The gap at tolerance level `n`: x − n·σ (m, eq. 9). n > 0 tightens, n < 0 loosens.
    #[inline(always)]
    pub fn at(&self, n: S) -> S {
        self.mean - n * self.deviation
    }

    /// The tolerance level at which the gap is `gap` (m): (x − q)/σ, eq. 9 the other way round. Not finite where the gap
    /// does not vary.
    #[inline(always)]
    pub fn level(&self, gap: S) -> S {
        (self.mean - gap) / self.deviation
    }
}

/// The paper's three classes of a gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum GapClass {
    /// Negative: the parts are pressed together.
    Compressed,
    /// Zero.
    Zero,
    /// Positive.
    Free,
}

impl GapClass {
    /// The class of a `gap` (m); what is within a picometre of zero is zero, so that rounding of eq. 9 does not decide.
    pub fn of<S: Scalar + PartialOrd>(gap: S) -> Self {
        let zero = S::from_f64(1e-12);
        if gap < -zero {
            Self::Compressed
        } else if gap > zero {
            Self::Free
        } else {
            Self::Zero
        }
    }
}

impl core::fmt::Display for GapClass {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.pad(match self {
            Self::Compressed => "compressed",
            Self::Zero => "zero",
            Self::Free => "free",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{GapClass, GapStatistics};

    #[test]
    fn refuses_what_a_joint_does_not_allow() {
        let gap = GapStatistics { mean: 2e-4f32, deviation: 1e-4 };
        assert_eq!(gap.checked_at(1.5, 0.0), Ok(gap.at(1.5)));
        for n in [2.5, 1e12, -1e12, f32::NAN, f32::INFINITY] {
            assert!(gap.checked_at(n, 0.0).is_err(), "{n}");
        }
        assert!(gap.checked_at(2.5, -0.1).is_ok());
    }

    #[test]
    fn tightens_with_n_and_classifies() {
        let gap = GapStatistics { mean: 0.5, deviation: 0.25 };
        assert_eq!((gap.at(0.0), gap.at(2.0), gap.at(-2.0)), (0.5, 0.0, 1.0));
        assert_eq!(GapClass::of(gap.at(2.0)), GapClass::Zero);
        assert_eq!(GapClass::of(gap.at(3.0)), GapClass::Compressed);
        assert_eq!(GapClass::of(gap.at(0.0)), GapClass::Free);
        // 0.03 mm − 3·0.01 mm is not quite zero in binary.
        assert_eq!(GapClass::of(GapStatistics { mean: 3e-5f64, deviation: 1e-5 }.at(3.0)), GapClass::Zero);
    }
}
