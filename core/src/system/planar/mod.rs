//! Bodies in a plane on ideal joints: trees of turning and sliding coordinates.
//!
//! x and y span the plane, angles turn from x to y. Angles are those of bodies in the frame, not between bodies, so that a
//! point's place is a sum of turned arms and its second derivatives are those arms again.

mod across;
mod along;
mod between;
mod coordinate;
#[cfg(test)]
pub(crate) mod example;
mod floating;
mod masses;
mod pair;
mod point;
mod topology;
mod tree;
mod turning;

pub use across::Across;
pub use along::Along;
pub use between::Between;
pub use coordinate::{Coordinate, Placed};
pub use floating::{Floating, Hole, Pin, PlanarPose, Pull};
pub use masses::Rigid;
pub use point::{At, Point};
pub use topology::{Carrier, Chain, Frame, Kind, Path, STRAIGHT, Topology, Turns};
pub use tree::PlanarTree;
pub use turning::Turning;

use crate::{Scalar, Vector2};

/// `p` turned by a right angle from x to y.
#[inline(always)]
pub(crate) fn left<S: Scalar>(p: &Vector2<S>) -> Vector2<S> {
    Vector2::new(-p.y, p.x)
}

/// `p` turned by the angle whose cosine and sine `by` holds.
#[inline(always)]
fn turned<S: Scalar>(by: &Vector2<S>, p: &Vector2<S>) -> Vector2<S> {
    p * by.x + left(p) * by.y
}
