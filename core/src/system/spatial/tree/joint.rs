//! Ideal joints in space, and the coordinates that they leave.

use crate::{ParameterError, Scalar, Vector3, error::bounded};

/// What holds a body to another one, or to the frame, without play. Places and axes are those of the nominal pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Joint<S> {
    /// Both move as one.
    Fixed,
    /// It turns about an axis.
    Revolute {
        /// A point of the axis (m).
        at: Vector3<S>,
        /// Its direction, of unit length.
        axis: Vector3<S>,
    },
    /// It slides along an axis.
    Prismatic {
        /// Its direction, of unit length.
        axis: Vector3<S>,
    },
    /// It slides along an axis and turns about it.
    Cylindrical {
        /// A point of the axis (m).
        at: Vector3<S>,
        /// Its direction, of unit length.
        axis: Vector3<S>,
    },
    /// It turns about a point.
    Spherical {
        /// The point (m).
        at: Vector3<S>,
    },
    /// Nothing holds it.
    Free,
}

/// A body and what it hangs on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount<S> {
    /// Which body.
    pub body: usize,
    /// What the joint holds it to; `None` for the frame.
    pub on: Option<usize>,
    /// The joint.
    pub joint: Joint<S>,
}

/// What a coordinate does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It belongs to no joint and stands still.
    Still,
    /// A displacement along an axis.
    Slide,
    /// An angle about an axis.
    Turn,
    /// The first of three that turn about a point: angular velocities in the axes of the body.
    Ball,
    /// The second or third of these.
    OfBall,
}

impl Kind {
    /// Whether it turns bodies.
    pub fn turns(self) -> bool {
        matches!(self, Self::Turn | Self::Ball | Self::OfBall)
    }
}

impl<S: Scalar + PartialOrd> Joint<S> {
    /// The joint, if its axis is of unit length and its place within bounds.
    ///
    /// # Errors
    /// [`ParameterError`] names what is not.
    pub(super) fn checked(self) -> Result<Self, ParameterError<S>> {
        let axis = match &self {
            Self::Revolute { axis, .. } | Self::Prismatic { axis } | Self::Cylindrical { axis, .. } => Some(axis),
            Self::Fixed | Self::Spherical { .. } | Self::Free => None,
        };
        if let Some(axis) = axis {
            bounded("axis", axis.dot(axis).sqrt(), [0.999, 1.001])?;
        }
        for component in self.place().iter().flat_map(|at| at.iter()) {
            bounded("at", *component, [-1e3, 1e3])?;
        }
        Ok(self)
    }
}

impl<S: Scalar> Joint<S> {
    /// How many coordinates it leaves.
    pub fn freedoms(&self) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Revolute { .. } | Self::Prismatic { .. } => 1,
            Self::Cylindrical { .. } => 2,
            Self::Spherical { .. } => 3,
            Self::Free => 6,
        }
    }

    /// What turns pass through; `None` where that is the centre of mass, or nothing turns.
    pub(super) fn place(&self) -> Option<&Vector3<S>> {
        match self {
            Self::Revolute { at, .. } | Self::Cylindrical { at, .. } | Self::Spherical { at } => Some(at),
            Self::Fixed | Self::Prismatic { .. } | Self::Free => None,
        }
    }

    /// Its coordinates, slides first, each with its axis: of what it slides on or turns against, of a ball of the body.
    pub(super) fn coordinates(&self) -> [(Kind, Vector3<S>); 6] {
        let still = (Kind::Still, Vector3::zeros());
        let unit = [Vector3::x(), Vector3::y(), Vector3::z()];
        let [ball, second, third] = [(Kind::Ball, unit[0]), (Kind::OfBall, unit[1]), (Kind::OfBall, unit[2])];
        let [x, y, z] = unit.map(|axis| (Kind::Slide, axis));
        match self {
            Self::Fixed => [still; 6],
            Self::Revolute { axis, .. } => [(Kind::Turn, *axis), still, still, still, still, still],
            Self::Prismatic { axis } => [(Kind::Slide, *axis), still, still, still, still, still],
            Self::Cylindrical { axis, .. } => [(Kind::Slide, *axis), (Kind::Turn, *axis), still, still, still, still],
            Self::Spherical { .. } => [ball, second, third, still, still, still],
            Self::Free => [x, y, z, ball, second, third],
        }
    }
}
