//! From places (m) to places on the picture (px).

use crate::mechanism::{Action, JointKind, Mechanism, Spring};

/// Room for symbols and labels around everything (px).
const MARGIN: f64 = 56.0;

/// The least size (m) that fills a view, so that what lies in one place can be drawn.
const LEAST: f64 = 1e-3;

/// Greatest and least height of a view (px).
const HEIGHTS: [f64; 2] = [380.0, 150.0];

/// A mechanism seen along one axis.
pub struct View {
    axes: [usize; 2],
    /// What is drawn in the middle.
    middle: [f64; 2],
    /// Where the middle is (px).
    centre: [f64; 2],
    /// Pixels per metre.
    scale: f64,
}

/// Least and greatest of all places (m) along each axis.
pub struct Extent([[f64; 2]; 3]);

impl Extent {
    /// Of all bodies, joints and forces.
    pub fn of(mechanism: &Mechanism) -> Self {
        let centres = mechanism.bodies.iter().map(|body| body.centre);
        let pushing = mechanism.drives.iter().filter(|drive| matches!(drive.action, Action::Pushes { .. }));
        let forces = pushing.map(|drive| mechanism.drive_point(drive));
        let springs = mechanism.springs.iter().filter_map(Spring::ends).flatten();
        let joints = mechanism.joints.iter().flat_map(ends);
        let places: Vec<[f64; 3]> = centres.chain(joints).chain(forces).chain(springs).collect();
        Self(std::array::from_fn(|k| {
            let values = || places.iter().map(|place| place[k]);
            [values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max)]
        }))
    }

    fn size(&self, k: usize) -> f64 {
        (self.0[k][1] - self.0[k][0]).max(LEAST)
    }

    /// The height (px) that a view with the given axes takes whose `width` (px) is filled.
    pub fn height(&self, [right, up]: [usize; 2], width: f64) -> f64 {
        let [most, least] = HEIGHTS;
        ((width - 2.0 * MARGIN) / self.size(right) * self.size(up) + 2.0 * MARGIN).clamp(least, most)
    }
}

impl View {
    /// The view with the given axes to the right and up, in a frame: left, top, width, height (px).
    pub fn of(extent: &Extent, axes: [usize; 2], [left, top, width, height]: [f64; 4]) -> Self {
        let size = axes.map(|k| extent.size(k));
        let room = [width - 2.0 * MARGIN, height - 2.0 * MARGIN];
        Self {
            axes,
            middle: axes.map(|k| 0.5 * (extent.0[k][0] + extent.0[k][1])),
            centre: [left + 0.5 * width, top + 0.5 * height],
            scale: (room[0] / size[0]).min(room[1] / size[1]),
        }
    }

    /// A place (m) on the picture (px).
    pub fn at(&self, place: [f64; 3]) -> [f64; 2] {
        let [right, up] = [0, 1].map(|k| (place[self.axes[k]] - self.middle[k]) * self.scale);
        [self.centre[0] + right, self.centre[1] - up]
    }

    /// A length (m) on the picture (px).
    pub fn length(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// A direction on the picture, of unit length; `None` if it points at the viewer.
    pub fn direction(&self, axis: [f64; 3]) -> Option<[f64; 2]> {
        let [right, up] = self.axes.map(|k| axis[k]);
        let length = right.hypot(up);
        (length > 0.1).then(|| [right / length, -up / length])
    }

    /// Whether an axis points at the viewer, out of the picture: 1, or −1 into it, or 0.
    pub fn towards(&self, axis: [f64; 3]) -> f64 {
        let [right, up] = self.axes;
        // The axis that is to the left of up and below right, right-handed.
        let sign = if (right + 1) % 3 == up { 1.0 } else { -1.0 };
        let along = axis[3 - right - up] * sign;
        if along.abs() > 0.9 { along.signum() } else { 0.0 }
    }
}

/// The ends of a joint along its axis, or its place.
fn ends(joint: &crate::mechanism::Joint) -> Vec<[f64; 3]> {
    let along =
        |axis: [f64; 3], half: f64| [-half, half].map(|s| std::array::from_fn(|k| joint.at[k] + s * axis[k])).to_vec();
    match joint.kind {
        // A wide one also by its width.
        JointKind::Guide { axis, edges: [long, wide], .. } if wide > long => {
            let across = along([-axis[1], axis[0], 0.0], 0.5 * wide);
            along(axis, 0.5 * long).into_iter().chain(across).collect()
        }
        JointKind::Guide { axis, edges, .. } => along(axis, 0.5 * edges[0]),
        JointKind::Bearing { axis, length, .. } => along(axis, 0.5 * length),
        _ => vec![joint.at],
    }
}
