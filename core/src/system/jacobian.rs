//! What derivatives of forces by velocities or places add up in, and how it is solved with.

use super::Lu;
use crate::{SMatrix, SVector, Scalar, linear::inverse, product::applied};

/// A matrix of `D` rows and columns, stored as suits the bodies.
pub trait Jacobian<S: Scalar, const D: usize>: Copy {
    /// What solving takes.
    type Factors: Copy + Default;

    /// No entries but zero.
    fn zero() -> Self;

    /// `self` + `weight`·`other`.
    #[must_use]
    fn plus(&self, other: &Self, weight: S) -> Self;

    /// `self`·`v`.
    fn times(&self, v: &SVector<S, D>) -> SVector<S, D>;

    /// The factors of this matrix. There is no pivoting, because the diagonal carries mass and positive contact terms.
    fn factorised(&self) -> Self::Factors;

    /// The solution x of matrix·x = `b`. What a singular matrix gives is not finite.
    fn solve(factors: &Self::Factors, b: &SVector<S, D>) -> SVector<S, D>;
}

impl<S: Scalar, const D: usize> Jacobian<S, D> for SMatrix<S, D, D> {
    type Factors = Lu<S, D>;

    #[inline(always)]
    fn zero() -> Self {
        Self::zeros()
    }

    #[inline(always)]
    fn plus(&self, other: &Self, weight: S) -> Self {
        self + other * weight
    }

    #[inline(always)]
    fn times(&self, v: &SVector<S, D>) -> SVector<S, D> {
        applied(self, v)
    }

    #[inline(always)]
    fn factorised(&self) -> Lu<S, D> {
        Lu::of(*self)
    }

    #[inline(always)]
    fn solve(factors: &Lu<S, D>, b: &SVector<S, D>) -> SVector<S, D> {
        factors.solve(b)
    }
}

/// A matrix of one body in its own axes, as a type apart, so that its links need no gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Own<S, const D: usize>(pub SMatrix<S, D, D>);

/// How an [`Own`] matrix is solved with, where `D` is small.
pub trait Small<S, const D: usize> {
    /// What [`solution`](Self::solution) takes.
    #[must_use]
    fn prepared(&self) -> Self;

    /// The solution x of matrix·x = `b`, of the matrix that was prepared.
    fn solution(&self, b: &SVector<S, D>) -> SVector<S, D>;
}

impl<S: Scalar> Small<S, 1> for Own<S, 1> {
    #[inline(always)]
    fn prepared(&self) -> Self {
        *self
    }

    #[inline(always)]
    fn solution(&self, b: &SVector<S, 1>) -> SVector<S, 1> {
        SVector::<S, 1>::new(b.x / self.0.x)
    }
}

/// By the inverse.
impl<S: Scalar> Small<S, 3> for Own<S, 3> {
    #[inline(always)]
    fn prepared(&self) -> Self {
        Self(inverse(&self.0))
    }

    #[inline(always)]
    fn solution(&self, b: &SVector<S, 3>) -> SVector<S, 3> {
        self.0 * b
    }
}

impl<S: Scalar, const D: usize> Default for Own<S, D> {
    #[inline(always)]
    fn default() -> Self {
        Self(SMatrix::zeros())
    }
}

impl<S: Scalar, const D: usize> Jacobian<S, D> for Own<S, D>
where
    Self: Small<S, D>,
{
    type Factors = Self;

    #[inline(always)]
    fn zero() -> Self {
        Self::default()
    }

    #[inline(always)]
    fn plus(&self, other: &Self, weight: S) -> Self {
        Self(self.0 + other.0 * weight)
    }

    #[inline(always)]
    fn times(&self, v: &SVector<S, D>) -> SVector<S, D> {
        self.0 * v
    }

    #[inline(always)]
    fn factorised(&self) -> Self {
        self.prepared()
    }

    #[inline(always)]
    fn solve(factors: &Self, b: &SVector<S, D>) -> SVector<S, D> {
        factors.solution(b)
    }
}
