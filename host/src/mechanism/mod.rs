//! Mechanisms of any make: bodies, joints with or without play, springs and drives, as one value.
//!
//! Everything is described in one drawn pose, in which all axes are those of the frame. In a mechanism that lies in a plane
//! x and y span the plane and angles turn from x to y; the others are in space.

pub mod agreement;
mod bends;
pub mod closing;
pub mod columns;
#[cfg(test)]
mod contact_tests;
mod doubt;
mod drive;
mod driven;
mod energy;
pub mod feedback;
mod freedom;
mod gaps;
mod hanging;
mod hash;
mod joint_elements;
mod kinematics;
mod limits;
mod many;
pub mod mobility;
#[cfg(test)]
mod motion_tests;
mod mounts;
mod parameter;
pub mod planar;
mod record;
mod recorder;
mod run;
mod run_error;
mod sampler;
mod sampling;
pub mod self_locking;
#[cfg(test)]
mod side_by_side_tests;
mod source;
pub mod spatial;
mod spring;
mod start;
mod state;
mod sunk;
mod torn;
mod walls;

pub use columns::BodyMotion;
pub use doubt::doubts;
pub use drive::{Action, NamedDrive, UNLIMITED};
pub use driven::{ByDrive, confirmed, finer};
pub use energy::ENERGY;
pub use freedom::Freedom;
pub use gaps::{GapError, Gaps, STOP_MOST, level_of};
pub use hanging::MountError;
pub use many::{ProductionUnit, batch_size, run_units};
pub use mounts::Mounts;
pub use parameter::{Parameter, Uncertain, Varied};
pub use record::{MechanismRun, Moment, SCHEME, Samples};
pub use run::{controller_run, film, run};
pub use run_error::RunError;
pub use sampling::Sampling;
pub(crate) use source::scheme;
pub use source::{command_name, dimension, drive_names, element_paths, rust_source};
pub use spring::{Spring, SpringKind};
pub use start::Rest;
pub use sunk::Sunk;
pub use torn::{Torn, torn};
pub use walls::{OfGap, Walls, through};

use std::sync::Arc;

pub use slipfit_core::system::law::Contour;
use slipfit_core::{clearance::GapStatistics, drive::TrainData};
pub use slipfit_desk::{
    contact::{Laws, NormalData, Rebound, SlidingData},
    element,
};

pub use crate::dynamics::command::Command;
use crate::setup::{ControllerSpec, LevelRange, Measured, RunSpec};

/// Which bodies there are, what joins them, and what is to be simulated. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// Title, for plots and reports.
    pub title: String,
    /// Whether it lies in a plane.
    pub planar: bool,
    /// Gravity (m/s²).
    pub gravity: [f64; 3],
    /// Moving bodies.
    pub bodies: Vec<Body>,
    /// Joints.
    pub joints: Vec<Joint>,
    /// Springs.
    pub springs: Vec<Spring>,
    /// Drives.
    pub drives: Vec<NamedDrive>,
    /// Gaps of the joints with play, over the production.
    pub gaps: Vec<Gap>,
    /// Parameters that vary over the production, beside the gaps.
    pub vary: Vec<Varied>,
    /// Parameters with one unknown value in the whole production.
    pub uncertain: Vec<Uncertain>,
    /// What is simulated: the stroke (m) is the first drive's, and the error a share of the mechanism's own speed.
    pub run: RunSpec,
    /// How a controller computes it.
    pub controller: ControllerSpec,
    /// Tolerance levels of a sweep.
    pub sweep: LevelRange,
    /// Dimensions and gaps whose distribution is that of measured parts, if any is.
    pub measured: Option<Arc<Measured>>,
    /// What the user should know of the scene file: what is possible but implausible, each with its place.
    pub warnings: Vec<String>,
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Name.
    pub name: String,
    /// Mass (kg).
    pub mass: f64,
    /// Principal moments of inertia about the centre of mass (kg·m²); in a plane the last alone counts.
    pub inertia: [f64; 3],
    /// Centre of mass in the drawn pose (m).
    pub centre: [f64; 3],
    /// How it starts.
    pub start: Start,
}

/// How a body starts, as far as its own ideal joint lets it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// Angle from the drawn pose (rad).
    pub angle: f64,
    /// Angular velocity (rad/s).
    pub spin: f64,
    /// Speed along the joint's axis (m/s).
    pub speed: f64,
    /// How it starts if no ideal joint holds it, where that is stated; in a plane by its velocity alone.
    pub thrown: Option<Thrown>,
}

/// How a body starts that no ideal joint holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Thrown {
    /// Displacement of the centre of mass from the drawn pose (m).
    pub displacement: [f64; 3],
    /// Rotation vector from the drawn pose (rad), about the axes of the frame.
    pub turned: [f64; 3],
    /// Velocity of the centre of mass (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity about the axes of the frame (rad/s).
    pub spin: [f64; 3],
}

/// A body, or the frame where there is none.
pub type Port = Option<usize>;

/// A joint of two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name.
    pub name: String,
    /// The bodies that it joins.
    pub between: [Port; 2],
    /// Where it is in the drawn pose (m).
    pub at: [f64; 3],
    /// What it is.
    pub kind: JointKind,
    /// Laws of its contacts.
    pub laws: Laws,
    /// How its walls run along the travel.
    pub walls: Walls,
    /// Friction of an ideal joint against its one motion, whatever it carries.
    pub drag: Option<TrainData<f64>>,
}

/// What a joint is. Axes and normals are of unit length, in the drawn pose.
#[derive(Clone, Debug, PartialEq)]
pub enum JointKind {
    /// The bodies are one.
    Fixed,
    /// They turn about an axis through the place; in a plane that is its normal.
    Revolute {
        /// Direction.
        axis: [f64; 3],
    },
    /// They slide along an axis.
    Prismatic {
        /// Direction.
        axis: [f64; 3],
    },
    /// In a plane: they slide along an axis of the first body and turn about the place.
    PinSlot {
        /// Direction.
        axis: [f64; 3],
    },
    /// In space: they slide along an axis through the place and turn about it.
    Cylindrical {
        /// Direction.
        axis: [f64; 3],
    },
    /// In space: they turn about the place.
    Spherical,
    /// A revolute joint with play, in a plane: a hole of the first body around a pin of the second.
    Journal {
        /// Its gap: the radial clearance.
        gap: usize,
        /// Radius of the pin (m).
        radius: f64,
    },
    /// A prismatic joint with play, in a plane: a rectangle of the first body between two parallel lines of the second.
    Guide {
        /// Its gap, on either side.
        gap: usize,
        /// Direction of the lines.
        axis: [f64; 3],
        /// Edges of the rectangle along and across the axis (m).
        edges: [f64; 2],
    },
    /// A cylindrical joint with play, in space: a plain bearing of the first body around a rod of the second.
    Bearing {
        /// Its gap: the radial clearance.
        gap: usize,
        /// Direction of the rod.
        axis: [f64; 3],
        /// Length of the bearing (m).
        length: f64,
        /// Radius of the rod (m).
        radius: f64,
    },
    /// A pin of the first body between walls of the second, in space: to the left (normal +x), right (−x), rail (−y) and
    /// wall (+y).
    Track {
        /// Their gaps; `None` where there is no such wall.
        gaps: [Option<usize>; 4],
    },
    /// A point of the first body before a wall of the second.
    Stop {
        /// Its gap.
        gap: usize,
        /// The wall's outward normal, towards the point.
        normal: [f64; 3],
    },
}

impl JointKind {
    /// Whether it leaves no play.
    pub fn is_ideal(&self) -> bool {
        use JointKind::{Cylindrical, Fixed, PinSlot, Prismatic, Revolute, Spherical};
        matches!(self, Fixed | Revolute { .. } | Prismatic { .. } | PinSlot { .. } | Cylindrical { .. } | Spherical)
    }

    /// The gaps at its place, by their numbers.
    pub fn gaps(&self) -> impl Iterator<Item = usize> + use<> {
        let gaps = match *self {
            Self::Journal { gap, .. }
            | Self::Guide { gap, .. }
            | Self::Bearing { gap, .. }
            | Self::Stop { gap, .. } => [Some(gap), None, None, None],
            Self::Track { gaps } => gaps,
            Self::Fixed | Self::Revolute { .. } | Self::Prismatic { .. } | Self::PinSlot { .. } => [None; 4],
            Self::Cylindrical { .. } | Self::Spherical => [None; 4],
        };
        gaps.into_iter().flatten()
    }

    /// Whether it ends a travel.
    pub fn is_stop(&self) -> bool {
        matches!(self, Self::Stop { .. })
    }

    /// What scene files call it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Revolute { .. } | Self::Journal { .. } => "revolute",
            Self::Prismatic { .. } | Self::Guide { .. } => "prismatic",
            Self::PinSlot { .. } => "pin-slot",
            Self::Cylindrical { .. } | Self::Bearing { .. } => "cylindrical",
            Self::Spherical => "spherical",
            Self::Track { .. } => "track",
            Self::Stop { .. } => "stop",
        }
    }
}

/// A gap over the production.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Name: the joint's, and where it has several the wall's.
    pub name: String,
    /// Mean and standard deviation (m).
    pub statistics: GapStatistics<f64>,
    /// The measure of the product that it is, if it is one.
    pub measure: Option<usize>,
}

impl Mechanism {
    /// Whether it is in space and has joints without play.
    pub fn has_ideal_joints_in_space(&self) -> bool {
        !self.planar && self.joints.iter().any(|joint| joint.kind.is_ideal())
    }

    /// The name of a body or of the frame.
    pub fn name_of(&self, port: Port) -> &str {
        port.and_then(|body| self.bodies.get(body)).map_or("frame", |body| &body.name)
    }
}
