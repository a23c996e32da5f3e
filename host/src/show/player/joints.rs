//! Joints with play for the player: pins in their gaps.

use nalgebra::{Rotation3, Vector2, Vector3};
use slipfit_core::law::Elastic;

use super::{AXES, Contact, Joint, MM, Series, rounded, series};
use crate::{
    dynamics::laws::AnyElastic,
    mechanism::{Joint as Joined, JointKind, Mechanism, Moment, Port},
};

/// Bodies with a place each, the pin's and then the gap's, at which they meet.
struct Meeting {
    pin: Port,
    gap: Port,
    /// In the drawn pose (m).
    at: Vector3<f64>,
}

impl Meeting {
    /// Where the pin is in the gap (m), in the axes of the gap's body.
    fn place(&self, mechanism: &Mechanism, moment: &Moment) -> Vector3<f64> {
        let [pin, gap] = [self.pin, self.gap].map(|port| place(mechanism, moment, port, self.at));
        turn(moment, self.gap).inverse() * (pin - gap)
    }
}

fn turn(moment: &Moment, port: Port) -> Rotation3<f64> {
    port.map_or(Rotation3::identity(), |body| moment.motions[body].orientation.to_rotation_matrix())
}

/// Where a point of a body that is `at` (m) in the drawn pose has come to.
fn place(mechanism: &Mechanism, moment: &Moment, port: Port, at: Vector3<f64>) -> Vector3<f64> {
    port.map_or(at, |body| {
        let centre = Vector3::from(mechanism.bodies[body].centre);
        centre + moment.motions[body].displacement + turn(moment, port) * (at - centre)
    })
}

/// What a joint with play shows: its pins in their gaps.
pub fn joints(mechanism: &Mechanism, joint: &Joined, gaps: &[f64], moments: &[Moment]) -> Vec<Joint> {
    let [first, second] = joint.between;
    let at = Vector3::from(joint.at);
    let [stiffness, exponent] = joint.laws.contact.spring();
    let elastic = AnyElastic::of(stiffness, exponent);
    let pressed = |depth: f64| elastic.as_ref().map_or(0.0, |elastic| elastic.force(depth.max(0.0)).0);
    let shown = Shown { mechanism, joint, moments };
    match joint.kind {
        JointKind::Journal { gap, .. } => {
            let meeting = Meeting { pin: second, gap: first, at };
            vec![shown.ring(joint.name.clone(), meeting, [0, 1], gaps[gap], pressed)]
        }
        JointKind::Bearing { gap, axis, length, .. } => {
            // One along another axis than the frame's would be seen as an ellipse.
            let Some(along) = (0..3).find(|k| axis[*k].abs() > 0.999) else { return Vec::new() };
            let across = [(along + 1) % 3, (along + 2) % 3];
            let end = |sign: f64| {
                let meeting = Meeting { pin: second, gap: first, at: at + Vector3::from(axis) * (0.5 * length * sign) };
                let toward = if sign * axis[along] > 0.0 { "+" } else { "−" };
                let name = format!("{}, {toward}{} end", joint.name, AXES[along]);
                shown.ring(name, meeting, [across[0].min(across[1]), across[0].max(across[1])], gaps[gap], pressed)
            };
            [-1.0, 1.0].map(end).into()
        }
        JointKind::Guide { gap, axis, edges: [long, wide] } => {
            let angle = libm::atan2(axis[1], axis[0]);
            let up = Vector3::new(-axis[1], axis[0], 0.0);
            let end = |sign: f64| {
                let along = Vector3::from(axis) * (0.5 * long * sign);
                let middle = Meeting { pin: first, gap: second, at: at + along };
                let across = |moment: &Moment| up.dot(&middle.place(mechanism, moment));
                let corner = |side: f64| {
                    let corner = Meeting { pin: first, gap: second, at: at + along + up * (0.5 * wide * side) };
                    series(moments, 3, |moment| pressed(side * up.dot(&corner.place(mechanism, moment)) - gaps[gap]))
                };
                let contact = |side, force| Contact { side, name: side, force };
                let toward = if sign > 0.0 { "front" } else { "back" };
                Joint {
                    name: format!("{}, {toward} end", joint.name),
                    limits: [None, None, Some(-gaps[gap] * MM), Some(gaps[gap] * MM)],
                    pin: [Series(vec![0.0; moments.len()]), series(moments, 5, |moment| across(moment) * MM)],
                    contacts: vec![contact("low", corner(-1.0)), contact("high", corner(1.0))],
                    turn: angle,
                    ..shown.bare([0, 1], &middle)
                }
            };
            [-1.0, 1.0].map(end).into()
        }
        JointKind::Track { gaps: walls } => {
            let meeting = Meeting { pin: first, gap: second, at };
            let sides = [
                ("left", "left", 0, -1.0),
                ("right", "right", 0, 1.0),
                ("high", "rail", 1, 1.0),
                ("low", "wall", 1, -1.0),
            ];
            let open = walls.map(|gap| gap.map(|gap| gaps[gap]));
            let contact = |((side, name, axis, sign), gap): ((&'static str, &'static str, usize, f64), Option<f64>)| {
                let gap = gap?;
                let force = series(moments, 3, |moment| pressed(sign * meeting.place(mechanism, moment)[axis] - gap));
                Some(Contact { side, name, force })
            };
            let limit = |wall: usize, sign: f64| open[wall].map(|gap| rounded(sign * gap * MM, 5));
            vec![Joint {
                limits: [limit(0, -1.0), limit(1, 1.0), limit(3, -1.0), limit(2, 1.0)],
                contacts: sides.into_iter().zip(open).filter_map(contact).collect(),
                ..shown.bare([0, 1], &meeting)
            }]
        }
        JointKind::Stop { gap, normal } => {
            let meeting = Meeting { pin: first, gap: second, at };
            // The normal points at the pin: what it can go to is on the other side.
            let normal = Vector3::from(normal);
            let force =
                series(moments, 3, |moment| pressed(-normal.dot(&meeting.place(mechanism, moment)) - gaps[gap]));
            let limit = rounded(gaps[gap] * MM, 5);
            if mechanism.planar {
                // Its own axis is to the right, so that the wall is on the left.
                let turn = libm::atan2(normal.y, normal.x);
                let side = Vector2::new(-normal.y, normal.x);
                let along = |moment: &Moment| {
                    let place = meeting.place(mechanism, moment).xy();
                    [normal.xy().dot(&place), side.dot(&place)]
                };
                return vec![Joint {
                    limits: [Some(-limit), None, None, None],
                    contacts: vec![Contact { side: "left", name: "", force }],
                    pin: [0, 1].map(|k| series(moments, 5, |moment| along(moment)[k] * MM)),
                    turn,
                    ..shown.bare([0, 1], &meeting)
                }];
            }
            let along = (0..3).find(|k| normal[*k] != 0.0).unwrap_or(0);
            // Beside an axis that stands across it, whichever is seen from the same side.
            let axes = if along == 2 { [2, 1] } else { [0, 1] };
            let (at_limit, side) = match (along == axes[1], normal[along] > 0.0) {
                (false, true) => (0, "left"),
                (false, false) => (1, "right"),
                (true, true) => (2, "low"),
                (true, false) => (3, "high"),
            };
            let mut limits = [None; 4];
            limits[at_limit] = Some(-normal[along].signum() * limit);
            vec![Joint { limits, contacts: vec![Contact { side, name: "", force }], ..shown.bare(axes, &meeting) }]
        }
        // Without play there is nothing to see.
        JointKind::Fixed | JointKind::Revolute { .. } | JointKind::Prismatic { .. } => Vec::new(),
        JointKind::PinSlot { .. } | JointKind::Cylindrical { .. } | JointKind::Spherical => Vec::new(),
    }
}

/// A joint and how it moves.
struct Shown<'a> {
    mechanism: &'a Mechanism,
    joint: &'a Joined,
    moments: &'a [Moment],
}

impl Shown<'_> {
    /// Without limits, in the plane of these axes.
    fn bare(&self, axes: [usize; 2], meeting: &Meeting) -> Joint {
        let pin = |k: usize| series(self.moments, 5, |moment| meeting.place(self.mechanism, moment)[axes[k]] * MM);
        Joint {
            name: self.joint.name.clone(),
            at: std::array::from_fn(|k| meeting.at[k] * MM),
            between: [meeting.pin, meeting.gap].map(|port| self.mechanism.name_of(port).to_owned()),
            axes: axes.map(|k| AXES[k]),
            limits: [None; 4],
            round: false,
            turn: 0.0,
            pin: [pin(0), pin(1)],
            contacts: Vec::new(),
        }
    }

    /// A pin in a hole with this `clearance` (m), which presses by its depth (m).
    fn ring(
        &self,
        name: String,
        meeting: Meeting,
        axes: [usize; 2],
        clearance: f64,
        pressed: impl Fn(f64) -> f64,
    ) -> Joint {
        let limit = rounded(clearance * MM, 5);
        let force = series(self.moments, 3, |moment| {
            let place = meeting.place(self.mechanism, moment);
            pressed(libm::hypot(place[axes[0]], place[axes[1]]) - clearance)
        });
        Joint {
            name,
            limits: [Some(-limit), Some(limit), Some(-limit), Some(limit)],
            round: true,
            contacts: vec![Contact { side: "around", name: "", force }],
            ..self.bare(axes, &meeting)
        }
    }
}
