//! The drawer effect: whether a slide driven off its guide line locks.
//!
//! A moment that is carried by two contacts a length L apart, driven at distance b from the line through them, locks
//! at μ ≥ L/(2b): each contact carries N = F·b/L and rubs with μN. With the other resistances acting at distance b0,
//! it locks only if the drive passes beyond their line; on it, the slide is on the edge; short of it, the slide turns
//! the other way and never locks.

use serde::Serialize;

use nalgebra::Vector3;
use slipfit_core::slide::ABSENT;

use super::{Action, JointKind, Mechanism};
use crate::scene::{PinSpec, Scene};

/// Where the drive passes, seen from the guide line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum DriveSide {
    /// Beyond the line of the other resistances: locks above the critical friction.
    Beyond,
    /// On that line: nothing turns the slide, the least disturbance does.
    Edge,
    /// Short of it: never locks.
    Short,
}

/// The guide of a scene and what it means for its drive. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Guide {
    /// Distance L of the two guiding contacts along the travel (m).
    pub length: f64,
    /// x of the guide line (m).
    pub line_x: f64,
    /// Distance b of the drive from the guide line (m).
    pub drive_distance: f64,
    /// Distance b0 of the other resistances, which act at the centre of mass, from the guide line (m).
    pub resistance_distance: f64,
    /// Which of the three cases it is.
    pub side: DriveSide,
    /// Critical coefficient of friction L/(2b); `None` where the drive is on the guide line.
    pub critical_friction: Option<f64>,
    /// The scene's coefficient of friction.
    pub friction: f64,
    /// Whether the scene should be warned about: friction at or above the critical one, and not short.
    pub warn: bool,
}

/// Critical coefficient of friction L/(2b) of a guide of a `length` L, driven at a `distance` b beside it (m).
fn critical(length: f64, distance: f64) -> f64 {
    length / (2.0 * distance)
}

/// Finds the guide of `scene` at tolerance level `n`: the two pins, apart along the travel, whose slots across have
/// the least clearance. `None` if there are no two such slots.
pub fn guide(scene: &Scene, n: f64) -> Option<Guide> {
    let mut slots: Vec<(f64, &PinSpec)> = scene
        .pins
        .iter()
        .filter_map(|pin| Some((pin.gaps[0]?.at(n) + pin.gaps[1]?.at(n), pin)))
        .filter(|(clearance, _)| *clearance < ABSENT)
        .collect();
    slots.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (_, first) = slots.first()?;
    let second = slots.iter().map(|(_, pin)| pin).find(|pin| (pin.position[2] - first.position[2]).abs() > 1e-9)?;

    let length = (second.position[2] - first.position[2]).abs();
    let line_x = (first.position[0] + second.position[0]) / 2.0;
    // Signed towards the resistances, so that a drive on the far side of the guide line counts as short.
    let towards = if line_x > 0.0 { -1.0 } else { 1.0 };
    let resistance_distance = -line_x * towards;
    let signed = (scene.drive.point_b.x - line_x) * towards;
    let drive_distance = signed.abs();
    let beyond = signed - resistance_distance;
    let side = if beyond.abs() <= 1e-9 * length {
        DriveSide::Edge
    } else if beyond > 0.0 {
        DriveSide::Beyond
    } else {
        DriveSide::Short
    };
    let friction = scene.friction.coefficient();
    let critical_friction = (drive_distance > 1e-9 * length).then(|| critical(length, drive_distance));
    let warn = side != DriveSide::Short && critical_friction.is_some_and(|critical| friction >= critical);
    Some(Guide { length, line_x, drive_distance, resistance_distance, side, critical_friction, friction, warn })
}

/// A drive that pushes a body along joints with play, but beside them, and locks it.
#[derive(Clone, Debug, PartialEq)]
pub struct Locked<'a> {
    /// The drive.
    pub drive: &'a str,
    /// How far its line passes beside the middle of the joints (m).
    pub distance: f64,
    /// How long the joints guide the body along the travel, from the first end to the last (m).
    pub length: f64,
    /// Critical coefficient of friction L/(2b).
    pub critical_friction: f64,
    /// The least coefficient of friction of the joints.
    pub friction: f64,
}

/// The drives of `mechanism` that lock their body in joints with play to the frame, all along the drive's axis. The joints
/// carry the drive's moment at their two ends, wherever beside each other they are, and rub about their middle.
pub fn locked(mechanism: &Mechanism) -> Vec<Locked<'_>> {
    let locked = mechanism.drives.iter().filter_map(|driven| {
        let Action::Pushes { axis } = driven.action else { return None };
        let axis = Vector3::from(axis);
        let (mut ends, mut middle, mut friction, mut count) =
            ([f64::INFINITY, f64::NEG_INFINITY], Vector3::zeros(), f64::INFINITY, 0);
        for joint in mechanism.joints.iter().filter(|joint| joint.between.contains(&Some(driven.body))) {
            let (along, length) = match joint.kind {
                JointKind::Bearing { axis, length, .. } => (axis, length),
                JointKind::Guide { axis, edges, .. } => (axis, edges[0]),
                _ => return None,
            };
            if !joint.between.contains(&None) || Vector3::from(along).cross(&axis).norm() > 1e-9 {
                return None;
            }
            let at = Vector3::from(joint.at);
            let place = at.dot(&axis);
            ends = [ends[0].min(place - length / 2.0), ends[1].max(place + length / 2.0)];
            middle += at;
            friction = friction.min(joint.laws.friction.coefficient());
            count += 1;
        }
        if count == 0 {
            return None;
        }
        let beside =
            Vector3::from(mechanism.bodies[driven.body].centre) + driven.drive.point_b - middle / f64::from(count);
        let (length, distance) = (ends[1] - ends[0], (beside - axis * beside.dot(&axis)).norm());
        let critical_friction = critical(length, distance);
        (friction >= critical_friction).then_some(Locked {
            drive: &driven.name,
            distance,
            length,
            critical_friction,
            friction,
        })
    });
    locked.collect()
}

#[cfg(test)]
mod tests {
    use super::locked;
    use crate::scene::{Override, SceneFile, shipped};

    /// The carriage on two rods guides itself over 80 mm: with friction 0.3 it locks from 80/(2·0.3) mm beside its middle on,
    /// the 10 mm by which it is driven above the rods included.
    #[test]
    fn a_carriage_locks_where_its_drive_is_far_beside_it() {
        for (x, locks) in [("10", false), ("132", false), ("134", true), ("-134", true)] {
            let point = Override::set(&format!("drive.motor.point=[{x}, 0, 0]"));
            let file = SceneFile::parse("linear-guide", shipped("linear-guide").unwrap(), &[point]).unwrap();
            let found = file.mechanism.as_ref().map(locked).unwrap();
            assert_eq!(found.len(), usize::from(locks), "{x}");
            assert!(
                found.iter().all(|locked| (locked.length - 0.08).abs() < 1e-12 && locked.friction == 0.3),
                "{found:?}"
            );
        }
    }
}
