//! A mechanism in a plane as source text.

use std::fmt::Write;

use slipfit_core::{
    Vector2,
    system::planar::{Across, Between, Chain, Kind, Point, Rigid},
};

use super::{
    expression::{Typed, contour, contoured, driving, element, grouped, line_spring, nested, numbers, typed, vector},
    laws::Contacts,
    parts::Parts,
};
use crate::mechanism::{
    JointKind, Mechanism, Mounts, Rest, RunError, element::PlanarElement, joint_elements::joints_of_elements, planar,
    state::half_angle,
};

/// The parts of `mechanism`.
pub(super) fn parts(mechanism: &Mechanism, contacts: &mut Contacts) -> Result<Parts, RunError> {
    let mounts = Mounts::of(mechanism)?;
    match mounts.coordinates().len() {
        1 => of::<1>(mechanism, &mounts, contacts),
        2 => of::<2>(mechanism, &mounts, contacts),
        3 => of::<3>(mechanism, &mounts, contacts),
        4 => of::<4>(mechanism, &mounts, contacts),
        5 => of::<5>(mechanism, &mounts, contacts),
        _ => of::<6>(mechanism, &mounts, contacts),
    }
}

/// The type of what moves a body.
fn carrier<const D: usize>(chain: &Chain<D>) -> String {
    let bits: String = chain.moves.iter().rev().map(|moves| if *moves { '1' } else { '0' }).collect();
    match chain.turn {
        _ if !bits.contains('1') => "Frame".into(),
        Some(turn) => format!("Path<0b{bits}, {turn}>"),
        None => format!("Path<0b{bits}>"),
    }
}

/// A point whose carrier is a type.
fn point<const D: usize>(point: &Point<f64, D>) -> String {
    carried(point, "Path")
}

fn carried<const D: usize>(point: &Point<f64, D>, carrier: &str) -> String {
    let arms: Vec<_> = point.arms.iter().map(|arm| vector(arm.as_slice())).collect();
    format!("Point {{ carrier: {carrier}, base: {}, arms: [{}] }}", vector(point.base.as_slice()), arms.join(", "))
}

fn rigid<const D: usize>(body: &Rigid<f64, D>) -> String {
    let Rigid { mass, inertia, centre } = body;
    let centre = carried(centre, &format!("{:?}", centre.carrier));
    format!("Rigid {{ mass: s({mass:?}), inertia: s({inertia:?}), centre: {centre} }}")
}

fn of<const D: usize>(mechanism: &Mechanism, mounts: &Mounts, contacts: &mut Contacts) -> Result<Parts, RunError> {
    let tree = planar::bodies::<D>(mechanism, mounts)?;
    let mut head = format!(
        "/// What the coordinates are.\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct Joints;\n\n\
         impl Topology<{D}> for Joints {{\n    #[inline(always)]\n"
    );
    let slides: Vec<_> = tree.topology().iter().enumerate().filter(|(_, kind)| **kind != Kind::Turn).collect();
    if slides.is_empty() {
        head.push_str("    fn kind(&self, _: usize) -> Kind {\n        Kind::Turn\n    }\n}\n\n");
    } else {
        head.push_str("    fn kind(&self, k: usize) -> Kind {\n        match k {\n");
        for (k, kind) in slides {
            let _ = writeln!(head, "            {k} => Kind::{kind:?},");
        }
        head.push_str("            _ => Kind::Turn,\n        }\n    }\n}\n\n");
    }
    let rigid: Vec<_> = planar::rigid::<D>(mechanism, mounts).iter().map(rigid).collect();
    let axes: Vec<_> = tree.axes().iter().map(|axis| vector(axis.as_slice())).collect();
    let gravity = mechanism.gravity;
    let bodies = Typed {
        of: format!("PlanarTree<S, {D}, Joints>"),
        value: format!(
            "PlanarTree::of(Joints, [{}], &[{}], {})?",
            axes.join(", "),
            rigid.join(", "),
            vector(&[gravity[0], gravity[1]])
        ),
    };
    let mut names = vec!["Chain", "Kind", "PlanarTree", "Point", "Rigid", "Topology"];
    let (mut laws, mut drives) = (Vec::new(), Vec::new());
    let elements = elements::<D>(mechanism, mounts, contacts, (&mut laws, &mut names, &mut drives))?;
    let all = nested(grouped(&elements));
    if all.value.contains("Path") {
        names.push("Path");
    }
    if all.of.contains("Frame") {
        names.push("Frame");
    }
    let Rest { places, rates } = Rest::<D>::of(mechanism, mounts);
    let pose = tree.pose(places, half_angle);
    let pose: Vec<_> = pose.iter().map(|pair| format!("[{}]", numbers(pair))).collect();
    let pose = Typed { of: format!("[[S; 2]; {D}]"), value: format!("[{}]", pose.join(", ")) };
    Ok(Parts {
        head,
        dimension: D,
        bodies,
        elements,
        through_joints: None,
        laws,
        module: "planar",
        names,
        drives,
        pose,
        rates: rates.into(),
    })
}

fn elements<const D: usize>(
    mechanism: &Mechanism,
    mounts: &Mounts,
    contacts: &mut Contacts,
    (laws, names, used): (&mut Vec<&'static str>, &mut Vec<&'static str>, &mut Vec<&'static str>),
) -> Result<Vec<Typed>, RunError> {
    let mut drive = driving(mechanism, used);
    let open = vec![0.0; mechanism.gaps.len()];
    let mut joints = joints_of_elements(mechanism);
    let turning =
        |turn: Option<usize>| turn.map_or("Frame".into(), |turn| carrier(&chain_of::<D>(mechanism, mounts, turn)));
    let (mut written, mut corner) = (Vec::new(), 0);
    for found in planar::elements::<D>(mechanism, mounts, &open, 1.0)? {
        let joint = joints.next().flatten();
        let (contact, gap) = joint.map_or((Typed::default(), 0), |joint| {
            let gap = match joint.kind {
                JointKind::Journal { gap, .. } | JointKind::Guide { gap, .. } | JointKind::Stop { gap, .. } => gap,
                _ => 0,
            };
            (contacts.of(&joint.laws), gap)
        });
        written.push(match found {
            PlanarElement::Journal(one) => {
                names.push("Between");
                laws.push("Journal");
                element(
                    between(&one.link),
                    typed(
                        format!("Journal<S, {}>", contact.of),
                        format!(
                            "Journal {{ clearance: gaps[{gap}], radius: s({:?}), contact: {} }}",
                            one.law.radius, contact.value
                        ),
                    ),
                    4,
                )
            }
            PlanarElement::Pad(one) => {
                names.push("Across");
                laws.push("Pad");
                element(across(&one.link), pad(gap, &contact), 2)
            }
            PlanarElement::Contour(one) => {
                names.push("Across");
                laws.extend(["Axis", "Contour", "Contoured", "Pad"]);
                // The first two of a guide's four corners run along its first line.
                let (line, sense) = if corner % 4 < 2 { (0, 1.0) } else { (1, -1.0) };
                corner += 1;
                let contour =
                    joint.map_or_else(String::new, |joint| contour(&joint.walls, line, sense, &one.law.contour));
                element(across(&one.link), contoured(pad(gap, &contact), one.law.along, &contour), 2)
            }
            PlanarElement::Line(one) => {
                names.push("Between");
                laws.push("LineSpring");
                element(between(&one.link), line_spring(&one.law), 4)
            }
            PlanarElement::Spring((one, _)) => {
                names.push("Turning");
                laws.push("Spring");
                let law = one.law;
                element(
                    typed(
                        format!("Turning<{}, {}>", turning(one.link.body), turning(one.link.against)),
                        "Turning { body: Path, against: Path }",
                    ),
                    typed(
                        "Spring<S>",
                        format!(
                            "Spring {{ stiffness: s({:?}), damping: s({:?}), rest: s({:?}), start: s({:?}) }}",
                            law.stiffness, law.damping, law.rest, law.start
                        ),
                    ),
                    1,
                )
            }
            PlanarElement::Motor(one) => {
                names.push("Turning");
                laws.push("Motor");
                element(
                    typed(
                        format!("Turning<{}, {}>", turning(one.link.body), turning(one.link.against)),
                        "Turning { body: Path, against: Path }",
                    ),
                    drive("Motor"),
                    1,
                )
            }
            PlanarElement::Pusher(one) => {
                names.push("Along");
                laws.push("Pusher");
                let (at, sensor, axis) = (&one.link.point, &one.link.sensor, one.link.axis);
                element(
                    typed(
                        format!("Along<S, {D}, {}>", carrier(&at.carrier)),
                        format!(
                            "Along {{ point: {}, sensor: {}, axis: {} }}",
                            point(at),
                            point(sensor),
                            vector(axis.as_slice())
                        ),
                    ),
                    drive("Pusher"),
                    2,
                )
            }
        });
    }
    Ok(written)
}

/// The two points that a link is between.
fn between<const D: usize>(Between { hole, pin }: &Between<f64, D>) -> Typed {
    typed(
        format!("Between<S, {D}, {}, {}>", carrier(&hole.carrier), carrier(&pin.carrier)),
        format!("Between {{ hole: {}, pin: {} }}", point(hole), point(pin)),
    )
}

/// The point that a link looks at from its seat.
fn across<const D: usize>(link: &Across<f64, D>) -> Typed {
    let (at, seat) = (&link.point, &link.seat);
    typed(
        format!("Across<S, {D}, {}, {}>", carrier(&at.carrier), carrier(&seat.carrier)),
        format!("Across {{ point: {}, seat: {}, normal: {} }}", point(at), point(seat), vector(link.normal.as_slice())),
    )
}

/// A pad with the gap of that number.
fn pad(gap: usize, contact: &Typed) -> Typed {
    typed(format!("Pad<S, {}>", contact.of), format!("Pad {{ gap: gaps[{gap}], contact: {} }}", contact.value))
}

/// What moves the body that the coordinate `turn` turns.
fn chain_of<const D: usize>(mechanism: &Mechanism, mounts: &Mounts, turn: usize) -> Chain<D> {
    let body = (0..mechanism.bodies.len()).find(|body| mounts.turn(Some(*body)) == Some(turn));
    mounts.point::<D>(body, Vector2::zeros()).carrier
}
