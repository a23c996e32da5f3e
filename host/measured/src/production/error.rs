//! Why measured parts have no distribution.

use crate::families::FitError;

/// Parts without which nothing is smoothed: intervals by weighting the parts anew are too narrow for fewer.
pub const LEAST_TO_SMOOTH: usize = 50;

/// Why a characteristic has no distribution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProductionError {
    /// Too few parts to smooth.
    #[error(
        "smoothing takes {LEAST_TO_SMOOTH} measured parts, but there are {0}; `distribution = \"normal\"` assumes a family, \
         whose parameters fewer parts determine"
    )]
    FewParts(usize),
    /// A family that does not fit.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A measured value that no part can have.
    #[error("one part has {value}, which is beyond the bounds")]
    Bounds {
        /// The value (SI).
        value: f64,
    },
}
