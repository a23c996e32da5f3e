//! The axes in which elements add up.

use crate::{SVector, Scalar};

/// Leads from the axes of the frame, in which `D` generalised velocities are, to those in which elements add up; `()` where these
/// are the same.
pub trait Axes<S: Scalar, const D: usize>: Copy + Default {
    /// A velocity, a displacement or a momentum of the frame's axes in these.
    fn to_own(&self, v: &SVector<S, D>) -> SVector<S, D>;

    /// The way back.
    fn to_frame(&self, v: &SVector<S, D>) -> SVector<S, D>;
}

impl<S: Scalar, const D: usize> Axes<S, D> for () {
    #[inline(always)]
    fn to_own(&self, v: &SVector<S, D>) -> SVector<S, D> {
        *v
    }

    #[inline(always)]
    fn to_frame(&self, v: &SVector<S, D>) -> SVector<S, D> {
        *v
    }
}
