//! Solving with small matrices: straight-line, without pivots.

use crate::{SMatrix, SVector, Scalar};

/// The triangular factors of a matrix.
///
/// There is no pivoting, because the diagonal carries mass and positive contact terms. What a singular matrix gives is not
/// finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lu<S, const D: usize> {
    /// Below the diagonal the lower factor, above it the upper one; on it the inverse of the upper one's.
    factors: SMatrix<S, D, D>,
}

impl<S: Scalar, const D: usize> Default for Lu<S, D> {
    #[inline(always)]
    fn default() -> Self {
        Self { factors: SMatrix::zeros() }
    }
}

impl<S: Scalar, const D: usize> Lu<S, D> {
    /// The factors of `matrix`.
    #[inline(always)]
    pub fn of(matrix: SMatrix<S, D, D>) -> Self {
        let mut m = matrix;
        for k in 0..D {
            let inverse = S::one() / m[(k, k)];
            m[(k, k)] = inverse;
            for j in k + 1..D {
                let upper = m[(k, j)] * inverse;
                for i in k + 1..D {
                    let lower = m[(i, k)];
                    m[(i, j)] -= lower * upper;
                }
            }
            for i in k + 1..D {
                m[(i, k)] *= inverse;
            }
        }
        Self { factors: m }
    }

    /// The solution x of matrix·x = `b`.
    #[inline(always)]
    pub fn solve(&self, b: &SVector<S, D>) -> SVector<S, D> {
        let (m, mut x) = (&self.factors, *b);
        for k in 0..D {
            let value = x[k];
            for i in k + 1..D {
                x[i] -= m[(i, k)] * value;
            }
        }
        for k in (0..D).rev() {
            let value = x[k] * m[(k, k)];
            x[k] = value;
            for i in 0..k {
                x[i] -= m[(i, k)] * value;
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::Lu;
    use crate::{SMatrix, SVector};

    #[test]
    fn solves() {
        let mut seed = 1u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed) / 4_294_967_296.0 - 0.5
        };
        for _ in 0..if cfg!(miri) { 3 } else { 100 } {
            let m = SMatrix::<f64, 7, 7>::from_fn(|i, j| next() + if i == j { 4.0 } else { 0.0 });
            let b = SVector::<f64, 7>::from_fn(|_, _| next());
            assert!((m * Lu::of(m).solve(&b) - b).norm() < 1e-13);
        }
    }
}
