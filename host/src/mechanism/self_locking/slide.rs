//! The guide of a slide on pins.

use nalgebra::Vector3;
use serde::Serialize;
use slipfit_core::slide::ABSENT;

use super::{Contact, DriveSide, Guided, Lever, SAME, direction, locking};
use crate::{
    mechanism::mobility::SURFACE_NORMALS,
    setup::{PinSpec, Scene},
};

/// The guide of a scene and what it means for its drive. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Guide {
    /// Distance L of the two guiding contacts along the travel (m).
    pub length: f64,
    /// x of the guide line, in the middle between the two contacts (m).
    pub line_x: f64,
    /// Distance b of the drive from the guide line (m).
    pub drive_distance: f64,
    /// Distance b0 of the other resistances, which act at the centre of mass, from the guide line (m).
    pub resistance_distance: f64,
    /// The same up and down; `None` where the drive is at the height of the contacts.
    pub height: Option<Lever>,
    /// Which of the three cases it is.
    pub side: DriveSide,
    /// Critical coefficient of friction 1/(2·Σ b/L); `None` where the drive is on the guide line.
    pub critical_friction: Option<f64>,
    /// The scene's coefficient of friction.
    pub friction: f64,
    /// Whether the scene should be warned about: friction at or above the critical one, and not short.
    pub warn: bool,
}
/// Finds the guide of `scene` at tolerance level `n`. `None` if no two pins, apart along the travel, guide it across.
pub fn guide(scene: &Scene, n: f64) -> Option<Guide> {
    let of_pin = |pin: &PinSpec| {
        let at = Vector3::from(pin.position);
        let gaps = pin.gaps.map(|gap| gap.map(|gap| gap.at(n)).filter(|gap| *gap < ABSENT));
        let surfaces = SURFACE_NORMALS.into_iter().zip(gaps);
        surfaces.filter_map(move |(normal, gap)| Some(Contact { at, push: -Vector3::from(normal), gap: gap? }))
    };
    let contacts: Vec<_> = scene.pins.iter().flat_map(of_pin).collect();
    let guided = Guided {
        contacts: &contacts,
        axis: Vector3::z() * direction(scene.drive.speed),
        point: scene.drive.point_b,
        centre: Vector3::zeros(),
        gravity: scene.slide.gravity.into(),
        planar: false,
    };
    let levers @ [across, height] = [Vector3::x(), Vector3::y()].map(|across| guided.lever(across));
    let across = across?;
    let (side, critical_friction) = locking(levers, false);
    let friction = scene.friction.coefficient();
    Some(Guide {
        length: across.length,
        line_x: across.middle,
        drive_distance: across.distance.abs(),
        resistance_distance: across.middle.abs(),
        height: height.filter(|lever| lever.distance.abs() > SAME),
        side,
        critical_friction,
        friction,
        warn: side != DriveSide::Short && critical_friction.is_some_and(|critical| friction >= critical),
    })
}
