//! Blocks of vectors and matrices that belong to bodies.

use nalgebra::Matrix3;

use crate::{SMatrix, SVector, Scalar, Vector3};

/// Adds a force (N) and a torque (N·m) on a body to `sum`; those on one that is not there are left out.
#[inline(always)]
pub(super) fn add_wrench<S: Scalar, const D: usize>(
    sum: &mut SVector<S, D>,
    body: usize,
    [force, torque]: [&Vector3<S>; 2],
) {
    if let Some([x, y, z, a, b, c]) = sum.data.0[0].as_chunks_mut::<6>().0.get_mut(body) {
        (*x, *y, *z) = (*x + force.x, *y + force.y, *z + force.z);
        (*a, *b, *c) = (*a + torque.x, *b + torque.y, *c + torque.z);
    }
}

/// Does `change` to each entry of a block of `matrix` that begins `at` a row and a column, with that of `block`; what of it lies
/// outside is left out.
#[inline(always)]
pub(super) fn change<S: Scalar, const R: usize, const D: usize, const H: usize, const W: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    block: &SMatrix<S, H, W>,
    change: impl Fn(&mut S, S),
) {
    for (column, from) in matrix.data.0.iter_mut().skip(at.1).zip(&block.data.0) {
        for (entry, from) in column.iter_mut().skip(at.0).zip(from) {
            change(entry, *from);
        }
    }
}

#[inline(always)]
pub(super) fn put<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    block: &Matrix3<S>,
) {
    change(matrix, at, block, |entry, from| *entry = from);
}

#[inline(always)]
pub(super) fn put_row<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    row: &Vector3<S>,
) {
    change(matrix, at, &row.transpose(), |entry, from| *entry = from);
}

#[inline(always)]
pub(super) fn add<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    block: &Matrix3<S>,
) {
    change(matrix, at, block, |entry, from| *entry += from);
}

#[inline(always)]
pub(super) fn sub<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    at: (usize, usize),
    block: &Matrix3<S>,
) {
    change(matrix, at, block, |entry, from| *entry -= from);
}

/// Subtracts `rows` from those of `matrix` from `first` on.
#[inline(always)]
pub(super) fn sub_rows<S: Scalar, const R: usize, const D: usize>(
    matrix: &mut SMatrix<S, R, D>,
    first: usize,
    rows: &SMatrix<S, 3, D>,
) {
    change(matrix, (first, 0), rows, |entry, from| *entry -= from);
}
