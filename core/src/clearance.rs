//! Clearance at a tolerance level (eq. 9) and its class.

use crate::{ParameterError, Scalar, error::bounded};

/// The greatest tolerance level of a unit, either sign: far beyond what any production makes, and soon a gap far from the drawing's.
pub const LEVEL_MOST: f64 = 20.0;

/// `n` if it is a unit's tolerance level, at most [`LEVEL_MOST`] either sign.
///
/// # Errors
/// If it is not, or NaN.
pub fn checked_level<S: Scalar + PartialOrd>(n: S) -> Result<S, ParameterError<S>> {
    bounded("n", n, [-LEVEL_MOST, LEVEL_MOST])
}

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
    /// If it is, or above 1 km, or not finite, or the level exceeds [`LEVEL_MOST`].
    pub fn checked_at(&self, n: S, least: f64) -> Result<S, ParameterError<S>> {
        bounded("gap", self.at(checked_level(n)?), [least, 1e3])
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
    use super::{GapClass, GapStatistics, LEVEL_MOST};

    #[test]
    fn refuses_what_a_joint_does_not_allow() {
        let gap = GapStatistics { mean: 2e-4f32, deviation: 1e-4 };
        assert_eq!(gap.checked_at(1.5, 0.0), Ok(gap.at(1.5)));
        for n in [2.5, 1e12, -1e12, f32::NAN, f32::INFINITY] {
            assert!(gap.checked_at(n, 0.0).is_err(), "{n}");
        }
        assert!(gap.checked_at(2.5, -0.1).is_ok());
        for n in [-1000.0, -50.0, -20.001, 20.001, 50.0] {
            let error = gap.checked_at(n, -0.1).unwrap_err();
            assert_eq!((error.parameter, error.value, f64::from(error.greatest)), ("n", n, LEVEL_MOST));
        }
        assert!(gap.checked_at(-20.0, -0.1).is_ok() && gap.checked_at(20.0, -0.1).is_ok());
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
