//! A mechanism of bodies and joints for the player: bodies at true scale, pins enlarged in their gaps.

use nalgebra::{Rotation3, Vector2, Vector3};
use slipfit_core::law::Elastic;

use super::{Body, Contact, Event, Joint, Motion, Plot, Run, Series, View, hull::hull, rounded};
use crate::{
    dynamics::{driven::Driven, laws::AnyElastic},
    mechanism::{
        Body as Drawn, BodyMotion, ByDrive, Joint as Joined, JointKind, Mechanism, MechanismRun, Moment, Port,
    },
};

const MM: f64 = 1e3;
/// How far a body is drawn beyond its joints, as a share of the mechanism's size.
const RIM: f64 = 0.025;
/// Letters of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// A `run` of the unit of a `mechanism` with these `gaps` (m), `driven` by one of its drives if it has any; its `label` tells it
/// from other runs.
pub fn run(mechanism: &Mechanism, driven: Option<&ByDrive>, gaps: &[f64], label: String, run: &MechanismRun) -> Run {
    let moments = &run.film[..];
    let views = match mechanism.planar {
        true => vec![View { name: "in its plane", axes: ["x", "y"] }],
        false => {
            vec![View { name: "from the front", axes: ["x", "y"] }, View { name: "from the side", axes: ["z", "y"] }]
        }
    };
    let rim = RIM * size(mechanism);
    let bodies = mechanism.bodies.iter().enumerate();
    let (plots, events) = driven.map(|driven| of_drive(driven, run)).unwrap_or_default();
    Run {
        title: mechanism.title.clone(),
        label,
        t: series(moments, 3, |moment| moment.t * MM),
        bodies: bodies.map(|(i, body)| drawn(mechanism, i, body, moments, &views, rim)).collect(),
        views,
        joints: mechanism.joints.iter().flat_map(|joint| joints(mechanism, joint, gaps, moments)).collect(),
        plots,
        events,
    }
}

/// What a drive does, and when.
fn of_drive(driven: &ByDrive, run: &MechanismRun) -> (Vec<Plot>, Vec<Event>) {
    let (mechanism, moments) = (driven.mechanism(), &run.film[..]);
    let outcome = &run.outcomes[driven.index()];
    let kind = driven.kind();
    let event = |moment: Option<f64>, name| Some(Event { t: rounded(moment? * MM, 1), name });
    let events = [
        event(outcome.breakaway, "breaks away"),
        event(outcome.tips.map(|tips| tips.t), "tips"),
        event(outcome.stops.map(|stops| stops.t), "stops"),
    ];
    let sign = if driven.drive().speed < 0.0 { -1.0 } else { 1.0 };
    let at_drive = |of: &dyn Fn(f64, f64) -> f64, digits| {
        series(moments, digits, |moment| {
            let at = mechanism.drives_at(moment.t, &moment.motions).nth(driven.index());
            at.map_or(0.0, |at| sign * of(at.force, at.vz))
        })
    };
    let force = Plot {
        name: kind.choose("drive force", "drive torque"),
        unit: kind.effort_unit(),
        values: at_drive(&|force, _| force, 4),
    };
    let speed = Plot { name: "speed", unit: kind.speed_unit(), values: at_drive(&|_, speed| kind.speed(speed), 3) };
    (vec![force, speed], events.into_iter().flatten().collect())
}

fn series(moments: &[Moment], digits: i32, of: impl Fn(&Moment) -> f64) -> Series {
    Series(moments.iter().map(|moment| rounded(of(moment), digits)).collect())
}

/// The longest edge (m) of the box around all bodies and joints.
fn size(mechanism: &Mechanism) -> f64 {
    let places =
        || mechanism.bodies.iter().map(|body| body.centre).chain(mechanism.joints.iter().map(|joint| joint.at));
    let edge = |k: usize| {
        let [low, high] = places().fold([f64::MAX, f64::MIN], |[low, high], at| [low.min(at[k]), high.max(at[k])]);
        high - low
    };
    (0..3).map(edge).fold(1e-3, f64::max)
}

/// Body `i`: what encloses its centre and its joints in every view.
fn drawn(mechanism: &Mechanism, i: usize, body: &Drawn, moments: &[Moment], views: &[View], rim: f64) -> Body {
    let own = mechanism.joints.iter().filter(|joint| joint.between.contains(&Some(i)));
    let mut places: Vec<[f64; 3]> = vec![body.centre];
    for joint in own {
        places.push(joint.at);
        // What the joint itself says of the body's shape.
        let extended =
            |axis: [f64; 3], half: f64| [-half, half].map(|by| std::array::from_fn(|k| joint.at[k] + by * axis[k]));
        match joint.kind {
            JointKind::Guide { axis, edges, .. } if joint.between[0] == Some(i) => {
                places.extend(extended(axis, edges[0] / 2.0))
            }
            JointKind::Bearing { axis, length, .. } if joint.between[0] == Some(i) => {
                places.extend(extended(axis, length / 2.0))
            }
            _ => {}
        }
    }
    let outline = |view: &View| {
        let axes = view.axes.map(|letter| AXES.iter().position(|axis| *axis == letter).unwrap_or(0));
        let seen: Vec<[f64; 2]> = places.iter().map(|place| axes.map(|k| place[k])).collect();
        let corner = |[right, up]: [f64; 2]| {
            let mut place = body.centre;
            (place[axes[0]], place[axes[1]]) = (right, up);
            place.map(|x| rounded(x * MM, 2))
        };
        hull(&seen, rim).into_iter().map(corner).collect()
    };
    let part = |of: &dyn Fn(&BodyMotion) -> f64, digits| Some(series(moments, digits, |moment| of(&moment.motions[i])));
    Body {
        name: body.name.clone(),
        at: body.centre.map(|x| x * MM),
        outline: views.iter().map(outline).collect(),
        travel: Motion {
            x: part(&|motion| motion.displacement.x * MM, 4),
            y: part(&|motion| motion.displacement.y * MM, 4),
            z: part(&|motion| motion.displacement.z * MM, 4),
            ax: part(&|motion| motion.turn.x, 6),
            ay: part(&|motion| motion.turn.y, 6),
            az: part(&|motion| motion.turn.z, 6),
        },
        ..Body::default()
    }
}

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
    port.map_or(Rotation3::identity(), |body| Rotation3::from_scaled_axis(moment.motions[body].turn))
}

/// Where a point of a body that is `at` (m) in the drawn pose has come to.
fn place(mechanism: &Mechanism, moment: &Moment, port: Port, at: Vector3<f64>) -> Vector3<f64> {
    port.map_or(at, |body| {
        let centre = Vector3::from(mechanism.bodies[body].centre);
        centre + moment.motions[body].displacement + turn(moment, port) * (at - centre)
    })
}

/// What a joint with play shows: its pins in their gaps.
fn joints(mechanism: &Mechanism, joint: &Joined, gaps: &[f64], moments: &[Moment]) -> Vec<Joint> {
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
        JointKind::Fixed | JointKind::Revolute | JointKind::Prismatic { .. } | JointKind::PinSlot { .. } => Vec::new(),
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

#[cfg(test)]
mod tests {
    use super::{MM, run};
    use crate::{
        mechanism::{ByDrive, film},
        scene::{SHIPPED, SceneFile},
        show::player::{Run, figure},
    };

    fn played(name: &str, ending: f64) -> (Run, f64) {
        let text = SHIPPED.iter().find(|(own, _)| *own == name).unwrap().1;
        let mut mechanism = SceneFile::parse(name, text, &[]).unwrap().mechanism.unwrap();
        mechanism.run.duration = ending;
        let gaps = mechanism.stated_gaps_at(&[0.0]);
        let driven = ByDrive::new(&mechanism, 0).unwrap();
        let weight = mechanism.bodies.iter().map(|body| body.mass).sum::<f64>() * 9.81;
        (run(&mechanism, Some(&driven), &gaps, "n = 0".into(), &film(&mechanism, &gaps, 200).unwrap()), weight)
    }

    /// Every pin is where its gap lets it be, as far as its force presses it in.
    #[test]
    fn pins_stay_in_their_gaps() {
        for (name, joints) in [("slider-crank", 1), ("slider-crank-guide", 2), ("hatch", 6), ("telescopic-drawer", 12)]
        {
            let (run, _) = played(name, 0.3);
            assert!(run.joints.len() >= joints, "{name}: {}", run.joints.len());
            for joint in &run.joints {
                for frame in 0..run.t.0.len() {
                    let pin = [0, 1].map(|k| joint.pin[k].0[frame]);
                    let force = joint.contacts.iter().map(|contact| contact.force.0[frame]).fold(0.0, f64::max);
                    let outside = match joint.round {
                        true => libm::hypot(pin[0], pin[1]) - joint.limits[1].unwrap(),
                        false => (0..4)
                            .filter_map(|k| Some((joint.limits[k]?, if k % 2 == 0 { -1.0 } else { 1.0 }, pin[k / 2])))
                            .map(|(limit, sign, pin)| sign * (pin - limit))
                            .fold(0.0, f64::max),
                    };
                    assert!(outside < 0.1, "{name}, {}: {outside} mm", joint.name);
                    assert!(outside < 2e-4 || force > 0.0, "{name}, {}: {outside} mm without force", joint.name);
                }
            }
            figure(&[run], "Caption").unwrap();
        }
    }

    /// What carries the bodies is their weight.
    #[test]
    fn forces_carry_the_weight() {
        let (run, weight) = played("telescopic-drawer", 1.0);
        let last = run.t.0.len() - 1;
        let upwards = |side: &str| {
            let outer = run.joints.iter().filter(|joint| joint.name.starts_with("outer") && joint.limits[3].is_some());
            let contacts = outer.flat_map(|joint| &joint.contacts).filter(|contact| contact.side == side);
            contacts.map(|contact| contact.force.0[last]).sum::<f64>()
        };
        let carried = upwards("high") - upwards("low");
        assert!((carried / weight - 1.0).abs() < 0.03, "{carried} {weight} at {} ms", run.t.0[last] / MM * MM);
    }
}
