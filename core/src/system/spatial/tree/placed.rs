//! Bodies on joints at a pose and motion.

use super::numbers::pair;
use crate::{SMatrix, Scalar, Vector3, system::spatial::Placed as PlacedBodies};

/// A joint at a pose and motion, in the axes of the frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedJoint<S> {
    /// From the centre of mass of what it hangs on to the joint, and from there to its own body's (m).
    pub arms: [Vector3<S>; 2],
    /// How fast it slides (m/s).
    pub sliding: Vector3<S>,
    /// How fast it turns (rad/s).
    pub turning: Vector3<S>,
}

/// The bodies at a pose and motion.
#[derive(Clone, Copy, Debug)]
pub struct Placed<S, const N: usize, const W: usize, const D: usize> {
    /// The bodies, as free ones.
    pub free: PlacedBodies<S, N>,
    /// The joints, mount by mount.
    pub(super) joints: [PlacedJoint<S>; N],
    /// The axis of each coordinate.
    pub(super) axes: [Vector3<S>; D],
    /// J: the velocities (m/s, rad/s) of the free bodies, body by body, by those of the coordinates; in the axes of the frame.
    pub transform: SMatrix<S, W, D>,
}

impl<S: Scalar, const N: usize, const W: usize, const D: usize> Placed<S, N, W, D> {
    /// How body `body` moves by the coordinate `k`: its centre of mass, and its turning.
    #[inline(always)]
    pub(super) fn column(&self, k: usize, body: usize) -> [Vector3<S>; 2] {
        self.transform.data.0.get(k).map_or([Vector3::zeros(); 2], |column| pair(column, body))
    }
}
