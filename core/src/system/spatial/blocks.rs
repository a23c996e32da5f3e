//! Blocks of vectors and matrices that belong to bodies.

use crate::{SMatrix, SVector, Scalar, Vector3, linear::Blocks};

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

/// Adds the `blocks` of a force and a torque by a velocity and an angular velocity to `matrix`, those on body `of` by the motion of
/// body `by`; of bodies that are not there they are left out.
#[inline(always)]
pub(super) fn add_blocks<S: Scalar, const D: usize>(
    matrix: &mut SMatrix<S, D, D>,
    [of, by]: [usize; 2],
    blocks: &Blocks<S>,
) {
    let Some(columns) = matrix.data.0.as_chunks_mut::<6>().0.get_mut(by) else { return };
    let halves = [[&blocks.a, &blocks.c], [&blocks.b, &blocks.d]];
    for (columns, [forces, torques]) in columns.as_chunks_mut::<3>().0.iter_mut().zip(halves) {
        for ((column, force), torque) in columns.iter_mut().zip(&forces.data.0).zip(&torques.data.0) {
            if let Some([x, y, z, a, b, c]) = column.as_chunks_mut::<6>().0.get_mut(of) {
                (*x, *y, *z) = (*x + force[0], *y + force[1], *z + force[2]);
                (*a, *b, *c) = (*a + torque[0], *b + torque[1], *c + torque[2]);
            }
        }
    }
}
