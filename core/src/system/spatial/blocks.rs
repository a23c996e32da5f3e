//! Blocks of vectors and matrices that belong to bodies.

use nalgebra::Matrix3;

use crate::{SMatrix, SVector, Scalar, Vector3, linear::Blocks, pose::turned_over};

/// Adds a force (N) and a torque (N·m) on a body to `sum`; those on one that is not there are left out.
#[inline(always)]
pub(super) fn add_wrench<S: Scalar, const D: usize>(sum: &mut SVector<S, D>, body: usize, wrench: [&Vector3<S>; 2]) {
    add_pair(&mut sum.data.0[0], body, wrench);
}

/// Adds the two vectors of a body to numbers in sixes; those of one that is not there are left out.
#[inline(always)]
pub(super) fn add_pair<S: Scalar>(numbers: &mut [S], body: usize, [first, second]: [&Vector3<S>; 2]) {
    if let Some([x, y, z, a, b, c]) = numbers.as_chunks_mut::<6>().0.get_mut(body) {
        (*x, *y, *z) = (*x + first.x, *y + first.y, *z + first.z);
        (*a, *b, *c) = (*a + second.x, *b + second.y, *c + second.z);
    }
}

/// The first three numbers of a body: velocity or displacement, force.
pub(super) const VELOCITY: usize = 0;

/// The last three: angular velocity or turn, torque.
pub(super) const TURNING: usize = 1;

/// Adds `block` to the rows and columns of `matrix` that belong to a body, and to [`VELOCITY`] or [`TURNING`]; what belongs to a body
/// that is not there is left out.
#[inline(always)]
pub(super) fn add_block<S: Scalar, const D: usize>(
    matrix: &mut SMatrix<S, D, D>,
    [rows, columns]: [[usize; 2]; 2],
    block: &Matrix3<S>,
) {
    let columns = matrix.data.0.as_chunks_mut::<3>().0.get_mut(2 * columns[0] + columns[1]);
    for (column, from) in columns.into_iter().flatten().zip(&block.data.0) {
        if let Some([x, y, z]) = column.as_chunks_mut::<3>().0.get_mut(2 * rows[0] + rows[1]) {
            (*x, *y, *z) = (*x + from[0], *y + from[1], *z + from[2]);
        }
    }
}

/// Adds the `blocks` of a force and a torque on `body` by its own velocity and angular velocity to `matrix`.
#[inline(always)]
pub(super) fn add_blocks<S: Scalar, const D: usize>(matrix: &mut SMatrix<S, D, D>, body: usize, blocks: &Blocks<S>) {
    let Blocks { a, b, c, d } = blocks;
    add_block(matrix, [[body, VELOCITY], [body, VELOCITY]], a);
    add_block(matrix, [[body, VELOCITY], [body, TURNING]], b);
    add_block(matrix, [[body, TURNING], [body, VELOCITY]], c);
    add_block(matrix, [[body, TURNING], [body, TURNING]], d);
}

/// Adds the column `k` of `stiffness` times `a` to `matrix`.
#[inline(always)]
pub(super) fn add_column<S: Scalar, const D: usize>(
    matrix: &mut SMatrix<S, D, D>,
    stiffness: &SMatrix<S, D, D>,
    k: usize,
    a: S,
) {
    for (entry, by_place) in
        matrix.data.0.iter_mut().zip(&stiffness.data.0).skip(k).take(1).flat_map(|(to, from)| to.iter_mut().zip(from))
    {
        *entry += *by_place * a;
    }
}

/// Adds what three columns from `k` on of `stiffness`, for the turn of a body with the angular velocity `spin` (rad/s), make of an
/// angular velocity over the time `a` (s).
#[inline(always)]
pub(super) fn add_turned<S: Scalar, const D: usize>(
    matrix: &mut SMatrix<S, D, D>,
    stiffness: &SMatrix<S, D, D>,
    (k, spin): (usize, &Vector3<S>),
    a: S,
) {
    let Some([x, y, z]) = stiffness.data.0.get(k..).and_then(|rest| rest.first_chunk::<3>()) else { return };
    for (column, unit) in matrix.data.0.iter_mut().skip(k).zip([Vector3::x(), Vector3::y(), Vector3::z()]) {
        let turned = turned_over(spin, &unit, a);
        for (((entry, x), y), z) in column.iter_mut().zip(x).zip(y).zip(z) {
            *entry += *x * turned.x + *y * turned.y + *z * turned.z;
        }
    }
}
