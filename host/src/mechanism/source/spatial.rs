//! A mechanism in space as source text.

use std::collections::VecDeque;

use slipfit_core::{
    Vector3,
    pose::{Orientation, Pose},
    system::{
        law::Axis,
        spatial::{
            FreeBodies, Port, Rigid, Seat,
            tree::{Joint, Mount},
        },
    },
};

use super::{
    expression::{Typed, contour, contoured, driving, element, line_spring, numbers, typed, vector},
    laws::Contacts,
    parts::Parts,
};
use crate::mechanism::{
    JointKind, Mechanism, Rest, RunError,
    element::{SpatialContact, SpatialElement},
    joint_elements::joints_of_elements,
    spatial,
    start::thrown,
    state::half_angle,
};

/// The parts of `mechanism`.
pub(super) fn parts(mechanism: &Mechanism, contacts: &mut Contacts) -> Result<Parts, RunError> {
    let count = mechanism.bodies.len();
    if !(1..=spatial::MOST).contains(&count) {
        return Err(RunError::Bodies(count));
    }
    let (mut laws, mut names, mut drives) = (Vec::new(), vec!["FreeBodies", "Rigid"], Vec::new());
    let elements = elements(mechanism, contacts, (&mut laws, &mut names, &mut drives))?;
    let free = free(mechanism)?;
    let width = 6 * count;
    let parts = Parts {
        head: String::new(),
        dimension: width,
        bodies: typed(format!("FreeBodies<S, {count}, {width}>"), free.clone()),
        elements,
        through_joints: None,
        laws,
        module: "spatial",
        names,
        drives,
        pose: typed(format!("[Pose<S>; {count}]"), poses(mechanism)),
        rates: thrown(mechanism).into_iter().flat_map(|(_, velocity)| velocity).collect(),
    };
    let Some(mounts) = spatial::mounts(mechanism)? else { return Ok(parts) };
    let dimension = spatial::coordinates(&mounts);
    let mut names = parts.names;
    names.push("tree::{Joint, Mount, SpatialTree}");
    let hung: Vec<_> = mounts.iter().map(mount).collect();
    let tree = spatial::tree::<{ spatial::MOST }, { 6 * spatial::MOST }, { spatial::MOST_COORDINATES }>;
    let Rest { places, rates } = Rest::on_joints(mechanism, &mounts);
    let pose = tree(mechanism, &mounts)?.pose(places, half_angle);
    let pose: Vec<_> = pose[..dimension].iter().map(|pair| format!("[{}]", numbers(pair))).collect();
    Ok(Parts {
        dimension,
        bodies: typed(
            format!("SpatialTree<S, {count}, {width}, {dimension}>"),
            format!("SpatialTree::new({free}, &[\n        {},\n    ])?", hung.join(",\n        ")),
        ),
        through_joints: Some(width),
        names,
        pose: typed(format!("[[S; 2]; {dimension}]"), format!("[{}]", pose.join(", "))),
        rates: rates[..dimension].into(),
        ..parts
    })
}

/// The poses in which free bodies start.
fn poses(mechanism: &Mechanism) -> String {
    let count = mechanism.bodies.len();
    if mechanism.bodies.iter().all(|body| body.start.thrown.is_none()) {
        return format!("[Pose::nominal(); {count}]");
    }
    let pose = |(Pose { displacement_w, orientation: Orientation { w, v } }, _): &(Pose<f64>, _)| {
        format!(
            "Pose {{ displacement_w: {}, orientation: slipfit_core::pose::Orientation {{ w: s({w:?}), v: {} }} }}",
            vector(displacement_w.as_slice()),
            vector(v.as_slice())
        )
    };
    format!("[{}]", thrown(mechanism).iter().map(pose).collect::<Vec<_>>().join(", "))
}

/// The bodies, free.
fn free(mechanism: &Mechanism) -> Result<String, RunError> {
    let free: FreeBodies<f64, { spatial::MOST }, { 6 * spatial::MOST }> = spatial::bodies(mechanism)?;
    let rigid: Vec<_> = free.bodies().iter().take(mechanism.bodies.len()).map(rigid).collect();
    Ok(format!("FreeBodies::new([{}], {})?", rigid.join(", "), vector(&mechanism.gravity)))
}

fn mount(Mount { body, on, joint }: &Mount<f64>) -> String {
    let vector = |of: &slipfit_core::Vector3<f64>| vector(of.as_slice());
    let joint = match joint {
        Joint::Fixed => "Joint::Fixed".to_owned(),
        Joint::Revolute { at, axis } => format!("Joint::Revolute {{ at: {}, axis: {} }}", vector(at), vector(axis)),
        Joint::Prismatic { axis } => format!("Joint::Prismatic {{ axis: {} }}", vector(axis)),
        Joint::Cylindrical { at, axis } => {
            format!("Joint::Cylindrical {{ at: {}, axis: {} }}", vector(at), vector(axis))
        }
        Joint::Spherical { at } => format!("Joint::Spherical {{ at: {} }}", vector(at)),
        Joint::Free => "Joint::Free".to_owned(),
    };
    format!("Mount {{ body: {body}, on: {on:?}, joint: {joint} }}")
}

fn rigid(body: &Rigid<f64>) -> String {
    format!(
        "Rigid {{ mass: s({:?}), inertia_b: {}, centre_w: {} }}",
        body.mass,
        vector(body.inertia_b.as_slice()),
        vector(body.centre_w.as_slice())
    )
}

fn seat(seat: &Seat<f64>) -> String {
    let Seat { point: Port { body, lever }, from } = seat;
    format!("Seat {{ point: Port {{ body: {body:?}, lever: {} }}, from: {from:?} }}", vector(lever.as_slice()))
}

/// A link called `name` of a body that is pushed at a lever along an axis.
fn pushing(name: &str, body: usize, [lever, axis]: [&Vector3<f64>; 2]) -> Typed {
    let [lever, axis] = [lever, axis].map(|of| vector(of.as_slice()));
    typed(format!("{name}<S>"), format!("{name} {{ body: {body}, lever: {lever}, axis_w: {axis} }}"))
}

/// A wall with the gap of that number.
fn wall((axis, sign): (Axis, f64), gap: usize, contact: &Typed) -> Typed {
    typed(
        format!("Wall<S, {}>", contact.of),
        format!("Wall {{ axis: Axis::{axis:?}, sign: s({sign:?}), gap: gaps[{gap}], contact: {} }}", contact.value),
    )
}

fn elements(
    mechanism: &Mechanism,
    contacts: &mut Contacts,
    (laws, names, used): (&mut Vec<&'static str>, &mut Vec<&'static str>, &mut Vec<&'static str>),
) -> Result<Vec<Typed>, RunError> {
    let mut drive = driving(mechanism, used);
    // Gaps of the walls of one track that are still to come.
    let mut of_track = VecDeque::new();
    let open = vec![0.0; mechanism.gaps.len()];
    let mut joints = joints_of_elements(mechanism);
    let mut written = Vec::new();
    for found in spatial::elements(mechanism, &open, 1.0)? {
        let joint = joints.next().flatten();
        let contact = joint.map_or(Typed::default(), |joint| contacts.of(&joint.laws));
        let gap = joint.map_or(0, |joint| match joint.kind {
            JointKind::Bearing { gap, .. } | JointKind::Stop { gap, .. } => gap,
            _ => 0,
        });
        written.push(match found {
            SpatialElement::Contact(SpatialContact::Pin(one)) => {
                names.extend(["Port", "Seat"]);
                laws.push("Pin");
                let indices = match joint.map(|joint| &joint.kind) {
                    Some(JointKind::Track { gaps }) => *gaps,
                    _ => [None; 4],
                };
                let gaps = indices
                    .map(|index| index.map_or(format!("s({:?})", spatial::NONE), |index| format!("gaps[{index}]")));
                element(
                    typed("Seat<S>", seat(&one.link)),
                    typed(
                        format!("Pin<S, {}>", contact.of),
                        format!("Pin {{ gaps: [{}], contact: {} }}", gaps.join(", "), contact.value),
                    ),
                    3,
                )
            }
            SpatialElement::Contact(SpatialContact::Wall(one)) => {
                names.extend(["Port", "Seat"]);
                laws.extend(["Axis", "Wall"]);
                element(typed("Seat<S>", seat(&one.link)), wall((one.law.axis, one.law.sign), gap, &contact), 3)
            }
            SpatialElement::Contour(one) => {
                names.extend(["Port", "Seat"]);
                laws.extend(["Axis", "Contour", "Contoured", "Wall"]);
                if let (true, Some(JointKind::Track { gaps })) = (of_track.is_empty(), joint.map(|joint| &joint.kind)) {
                    of_track.extend(gaps.iter().enumerate().filter_map(|(i, gap)| Some((i, (*gap)?))));
                }
                let (i, of) = of_track.pop_front().unwrap_or_default();
                let wall = wall((one.law.wall.axis, one.law.wall.sign), of, &contact);
                let contour = joint.map_or_else(String::new, |joint| contour(&joint.walls, i, 1.0, &one.law.contour));
                element(typed("Seat<S>", seat(&one.link)), contoured(wall, one.law.along, &contour), 3)
            }
            SpatialElement::Line(one) => {
                names.extend(["Port", "Seat"]);
                laws.push("LineSpring");
                element(typed("Seat<S>", seat(&one.link)), line_spring(&one.law), 3)
            }
            SpatialElement::Contact(SpatialContact::Ring(one)) => {
                names.extend(["Port", "Rim", "Seat"]);
                laws.push("Ring");
                let (of, axes) = match one.link.axes {
                    Some(axes) => {
                        let of = "slipfit_core::SMatrix<S, 3, 3>";
                        let values = numbers(axes.transpose().as_slice());
                        (format!("Rim<S, {of}>"), format!("slipfit_core::SMatrix::<S, 3, 3>::new({values})"))
                    }
                    None => {
                        names.push("Parallel");
                        ("Rim<S>".to_owned(), "Parallel".to_owned())
                    }
                };
                let (seat, radius) = (seat(&one.link.seat), one.link.radius);
                element(
                    typed(of, format!("Rim {{ seat: {seat}, axes: {axes}, radius: s({radius:?}) }}")),
                    typed(
                        format!("Ring<S, {}>", contact.of),
                        format!("Ring {{ clearance: gaps[{gap}], contact: {} }}", contact.value),
                    ),
                    3,
                )
            }
            SpatialElement::Motor(one) => {
                names.push("About");
                laws.push("Motor");
                let link = one.link;
                element(
                    typed(
                        "About<S>",
                        format!("About {{ body: {}, axis_w: {} }}", link.body, vector(link.axis_w.as_slice())),
                    ),
                    drive("Motor"),
                    1,
                )
            }
            SpatialElement::AtPoint(one) => {
                names.push("AtPoint");
                laws.push("Motor");
                let link = one.link;
                element(pushing("AtPoint", link.body, [&link.lever, &link.axis_w]), drive("Motor"), 1)
            }
            SpatialElement::Pusher(one) => {
                names.push("Along");
                laws.push("Pusher");
                let link = one.link;
                element(pushing("Along", link.body, [&link.lever, &link.axis_w]), drive("Pusher"), 2)
            }
        });
    }
    Ok(written)
}
