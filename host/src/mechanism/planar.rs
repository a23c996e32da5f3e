//! A mechanism in a plane as core computes with it.

use slipfit_core::{
    ParameterError, Vector2,
    drive::Train,
    system::{
        Element,
        law::{Axis, Contour, Contoured, Journal, LineSpring, Motor, Pad, Pusher, Spring},
        planar::{Across, Along, Between, Coordinate, PlanarTree, Rigid, Turning},
    },
};

use slipfit_desk::drive::AnyDrive;

use super::{
    Action, Body, JointKind, Mechanism, Mounts, Rest, SpringKind,
    element::{PlanarElement, contact},
    mounts::flat,
};

/// The bodies of `mechanism` on their `mounts`.
///
/// # Errors
/// [`ParameterError`] names the first parameter that is not finite or out of bounds.
pub fn bodies<const D: usize>(
    mechanism: &Mechanism,
    mounts: &Mounts,
) -> Result<PlanarTree<f64, D>, ParameterError<f64>> {
    // Those beyond what the mounts leave move nothing and stand still.
    let mut coordinates = [Coordinate::Slide { on: None, axis: Vector2::zeros() }; D];
    for (coordinate, owned) in coordinates.iter_mut().zip(mounts.coordinates()) {
        *coordinate = owned.coordinate;
    }
    PlanarTree::new(coordinates, &rigid(mechanism, mounts), flat(mechanism.gravity))
}

/// The bodies of `mechanism` on their `mounts`: masses, moments of inertia and centres of mass.
pub fn rigid<const D: usize>(mechanism: &Mechanism, mounts: &Mounts) -> Vec<Rigid<f64, D>> {
    let body = |(i, body): (usize, &Body)| {
        let (mass, [_, _, inertia]) = mechanism.moved_with(i);
        Rigid { mass, inertia, centre: mounts.point(Some(i), flat(body.centre)) }
    };
    mechanism.bodies.iter().enumerate().map(body).collect()
}

/// What acts on the bodies of `mechanism` with the given `gaps` (m); a stick band (m/s) stands for true stick.
///
/// # Errors
/// [`ParameterError`] names the first parameter that is not finite or out of bounds.
pub fn elements<const D: usize>(
    mechanism: &Mechanism,
    mounts: &Mounts,
    gaps: &[f64],
    stick_band: f64,
) -> Result<Vec<PlanarElement<D>>, ParameterError<f64>> {
    let mut elements = Vec::new();
    for joint in &mechanism.joints {
        let [first, second] = joint.between;
        let at = flat(joint.at);
        match joint.kind {
            JointKind::Journal { gap, radius } => {
                let link = Between { hole: mounts.point(first, at), pin: mounts.point(second, at) };
                let law = Journal { clearance: gaps[gap], radius, contact: contact(&joint.laws, stick_band)? };
                elements.push(PlanarElement::Journal(Element { link, law }));
            }
            JointKind::Guide { gap, axis, edges: [along, across] } => {
                let axis = flat(axis);
                let up = Vector2::new(-axis.y, axis.x);
                for (side, end) in [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5), (-0.5, -0.5)] {
                    let corner = at + axis * (along * end) + up * (across * side);
                    let seat = at + up * (across * side);
                    let normal = up * if side > 0.0 { -1.0 } else { 1.0 };
                    let link = Across { point: mounts.point(first, corner), seat: mounts.point(second, seat), normal };
                    let wall = Pad { gap: gaps[gap], contact: contact(&joint.laws, stick_band)? };
                    // The second axis of the link points back along the lines on their left, and along them on their right.
                    let (line, sense) = if side > 0.0 { (0, 1.0) } else { (1, -1.0) };
                    elements.push(match joint.walls.contour(line, gaps) {
                        None => PlanarElement::Pad(Element { link, law: wall }),
                        Some(Contour { slope, curvature }) => {
                            let contour = Contour { slope: sense * slope, curvature };
                            PlanarElement::Contour(Element { link, law: Contoured { wall, along: Axis::Y, contour } })
                        }
                    });
                }
            }
            JointKind::Stop { gap, normal } => {
                let link =
                    Across { point: mounts.point(first, at), seat: mounts.point(second, at), normal: flat(normal) };
                let law = Pad { gap: gaps[gap], contact: contact(&joint.laws, stick_band)? };
                elements.push(PlanarElement::Pad(Element { link, law }));
            }
            _ => {}
        }
    }
    let Rest { places, .. } = Rest::<D>::of(mechanism, mounts);
    for spring in &mechanism.springs {
        let (stiffness, damping) = (spring.stiffness, spring.damping);
        let rest = match spring.kind {
            SpringKind::Torsion { rest } => rest,
            SpringKind::Line { ends: [of_first, of_second], free_length } => {
                let [first, second] = spring.between;
                let link =
                    Between { hole: mounts.point(second, flat(of_second)), pin: mounts.point(first, flat(of_first)) };
                let law = LineSpring { stiffness, damping, free_length, drawn: Vector2::zeros() };
                elements.push(PlanarElement::Line(Element { link, law }));
                continue;
            }
        };
        let [body, against] = spring.between.map(|port| mounts.turn(port));
        let starts = [body, against].map(|turn| turn.map_or(0.0, |k| places[k]));
        let law = Spring { stiffness, damping, rest, start: starts[0] - starts[1] };
        elements.push(PlanarElement::Spring((Element { link: Turning { body, against }, law }, starts)));
    }
    for joint in &mechanism.joints {
        let Some(data) = joint.drag else { continue };
        let drag = AnyDrive::Friction(Train::new((), data)?);
        let [first, second] = joint.between;
        elements.push(match joint.kind {
            JointKind::Prismatic { axis } => {
                let point = mounts.point(first.or(second), flat(joint.at));
                PlanarElement::Pusher(Element {
                    link: Along { point, sensor: point, axis: flat(axis) },
                    law: Pusher(drag),
                })
            }
            _ => {
                // Of two bodies the second turns against the first, of one and the frame that one.
                let (body, against) = if second.is_some() { (second, first) } else { (first, second) };
                let link = Turning { body: mounts.turn(body), against: mounts.turn(against) };
                PlanarElement::Motor(Element { link, law: Motor(drag) })
            }
        });
    }
    for named in &mechanism.drives {
        let drive = named.law(mechanism)?;
        elements.push(match named.action {
            Action::Turns { .. } => {
                let link = Turning { body: mounts.turn(Some(named.body)), against: None };
                PlanarElement::Motor(Element { link, law: Motor(drive) })
            }
            Action::Pushes { axis } => {
                let centre = flat(mechanism.bodies[named.body].centre);
                let point = centre + Vector2::new(named.drive.point_b.x, named.drive.point_b.y);
                let sensor = if named.at_centre { centre } else { point };
                let [point, sensor] = [point, sensor].map(|at| mounts.point(Some(named.body), at));
                PlanarElement::Pusher(Element { link: Along { point, sensor, axis: flat(axis) }, law: Pusher(drive) })
            }
        });
    }
    Ok(elements)
}
