//! Numbers of bodies and joints in long vectors, read and written without a panic; sums over them in order.

use crate::{SMatrix, SVector, Scalar, Vector3};

/// The three numbers of a ball from `k` on.
#[inline(always)]
pub(super) fn three<S: Scalar, const D: usize>(of: &SVector<S, D>, k: usize) -> Vector3<S> {
    let numbers = of.data.0[0].get(k..).and_then(|rest| rest.first_chunk::<3>());
    numbers.map_or(Vector3::zeros(), |numbers| Vector3::from(*numbers))
}

/// The two vectors of a body among numbers in sixes.
#[inline(always)]
pub(super) fn pair<S: Scalar>(numbers: &[S], body: usize) -> [Vector3<S>; 2] {
    let [x, y, z, a, b, c] = numbers.as_chunks::<6>().0.get(body).copied().unwrap_or([S::zero(); 6]);
    [Vector3::new(x, y, z), Vector3::new(a, b, c)]
}

/// `matrix`·`v`, summed in order.
#[inline(always)]
pub(super) fn times<S: Scalar, const R: usize, const C: usize>(
    matrix: &SMatrix<S, R, C>,
    v: &SVector<S, C>,
) -> SVector<S, R> {
    let mut result = SVector::<S, R>::zeros();
    for (column, x) in matrix.data.0.iter().zip(&v.data.0[0]) {
        for (sum, entry) in result.data.0[0].iter_mut().zip(column) {
            *sum += *entry * *x;
        }
    }
    result
}

/// The length of `v`, summed in order.
#[inline(always)]
pub(super) fn length<S: Scalar, const D: usize>(v: &SVector<S, D>) -> S {
    v.data.0[0].iter().fold(S::zero(), |sum, x| sum + *x * *x).sqrt()
}

/// Writes `value` to its place in `all`.
#[inline(always)]
pub(super) fn set<T>(all: &mut [T], i: usize, value: T) {
    if let Some(place) = all.get_mut(i) {
        *place = value;
    }
}
