//! Springs of a mechanism.

use nalgebra::Vector3;

use super::{BodyMotion, Mechanism, Port};

/// A spring with a damper between two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Name.
    pub name: String,
    /// The bodies.
    pub between: [Port; 2],
    /// Stiffness (N·m/rad, N/m).
    pub stiffness: f64,
    /// Damping (N·m·s/rad, N·s/m).
    pub damping: f64,
    /// What it acts along or about.
    pub kind: SpringKind,
}

/// What a spring acts along or about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpringKind {
    /// In a plane, about its normal.
    Torsion {
        /// How much the first body is turned against the second, from the drawn pose, where it is relaxed (rad).
        rest: f64,
    },
    /// Along the line between a point of either body.
    Line {
        /// The points in the drawn pose (m).
        ends: [[f64; 3]; 2],
        /// Distance of the points where it is relaxed (m).
        free_length: f64,
    },
}

impl Spring {
    /// Its ends in the drawn pose (m), if it acts along a line.
    pub fn ends(&self) -> Option<[[f64; 3]; 2]> {
        match self.kind {
            SpringKind::Torsion { .. } => None,
            SpringKind::Line { ends, .. } => Some(ends),
        }
    }

    /// The energy (J) that it stores where the bodies of `mechanism` have moved by `motions`.
    pub fn energy(&self, mechanism: &Mechanism, motions: &[BodyMotion]) -> f64 {
        let stretch = match self.kind {
            SpringKind::Torsion { rest } => {
                let [first, second] = self.between.map(|port| port.map_or(0.0, |body| motions[body].turned.z));
                first - second - rest
            }
            SpringKind::Line { ends, free_length } => {
                let at = |port: Port, end: [f64; 3]| match port {
                    None => Vector3::from(end),
                    Some(body) => {
                        let (centre, motion) = (Vector3::from(mechanism.bodies[body].centre), &motions[body]);
                        centre + motion.displacement + motion.orientation * (Vector3::from(end) - centre)
                    }
                };
                let [first, second] = self.between;
                (at(first, ends[0]) - at(second, ends[1])).norm() - free_length
            }
        };
        0.5 * self.stiffness * stretch * stretch
    }
}
