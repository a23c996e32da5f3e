//! The coordinates of a tree, and these at a pose and motion.

use crate::{SVector, Vector2};

/// A generalised coordinate of ideal joints in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinate<S> {
    /// An angle in the frame.
    Turn,
    /// A displacement along `axis`, of unit length, fixed in the axes of the turning coordinate `on`, or of the frame.
    Slide {
        /// Which coordinate, a turning one, turns the axis.
        on: Option<usize>,
        /// Direction.
        axis: Vector2<S>,
    },
}

/// The tree at a pose and motion.
#[derive(Clone, Copy, Debug)]
pub struct Placed<S, const D: usize> {
    /// Cosine and sine of turning coordinates; of sliding ones the axis in the frame.
    pub axes: [Vector2<S>; D],
    /// Displacements of sliding coordinates (m).
    pub places: [S; D],
    /// Generalised velocities.
    pub rates: SVector<S, D>,
}
