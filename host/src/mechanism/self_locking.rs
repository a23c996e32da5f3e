//! The drawer effect: whether a slide driven off its guide line locks.
//!
//! A moment that is carried by two contacts a length L apart, driven at distance b from the line through them, locks
//! at μ ≥ L/(2b): each contact carries N = F·b/L and rubs with μN. With the other resistances acting at distance b0,
//! it locks only if the drive passes beyond their line; on it, the slide is on the edge; short of it, the slide turns
//! the other way and never locks.

use serde::Serialize;

use crate::scene::{PinSpec, Scene};
use slipfit_core::slide::ABSENT;

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
    let critical_friction = (drive_distance > 1e-9 * length).then(|| length / (2.0 * drive_distance));
    let warn = side != DriveSide::Short && critical_friction.is_some_and(|critical| friction >= critical);
    Some(Guide { length, line_x, drive_distance, resistance_distance, side, critical_friction, friction, warn })
}
