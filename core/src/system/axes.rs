//! The axes in which elements add up.

use crate::{SVector, Scalar};

/// Leads from the axes of the `D` generalised velocities to those in which elements add up; `()` where these are the same. The matrix
/// is orthogonal, so that forces go the same way as velocities.
pub trait Axes<S: Scalar, const D: usize>: Copy + Default {
    /// What is in the axes of the velocities (a velocity, a displacement, a momentum, a force) in those of the sum.
    fn to_sum(&self, v: &SVector<S, D>) -> SVector<S, D>;

    /// The way back.
    fn to_velocities(&self, v: &SVector<S, D>) -> SVector<S, D>;
}

impl<S: Scalar, const D: usize> Axes<S, D> for () {
    #[inline(always)]
    fn to_sum(&self, v: &SVector<S, D>) -> SVector<S, D> {
        *v
    }

    #[inline(always)]
    fn to_velocities(&self, v: &SVector<S, D>) -> SVector<S, D> {
        *v
    }
}
