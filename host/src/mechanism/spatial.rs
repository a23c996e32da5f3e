//! A mechanism in space as core computes with it: free bodies on joints with play, or bodies on ideal joints.

use nalgebra::Matrix3;
use slipfit_core::{
    ParameterError, Vector3,
    drive::Train,
    system::{
        Element,
        law::{Axis, Contoured, LineSpring, Motor, Pin, Pusher, Ring, Wall},
        spatial::{
            About, Along, AtPoint, FreeBodies, Port as PointOf, Rigid, Rim, Seat,
            tree::{Joint as IdealJoint, Mount, SpatialTree},
        },
    },
};

use slipfit_desk::drive::AnyDrive;

use super::{
    Action, Joint, JointKind, Mechanism, MountError, Port, SpringKind,
    element::{AnyContact, SpatialContact, SpatialElement, contact},
    hanging::{Hung, hanging},
};

/// A gap (m) that never closes.
pub const NONE: f64 = slipfit_core::slide::ABSENT;

/// Most bodies of a mechanism in space.
pub const MOST: usize = slipfit_desk::plant::MOST_BODIES;

/// Most coordinates of one with ideal joints.
pub const MOST_COORDINATES: usize = 14;

/// The bodies of `mechanism`.
///
/// # Errors
/// [`ParameterError`] names the first parameter that is not finite or out of bounds.
pub fn bodies<const N: usize, const D: usize>(
    mechanism: &Mechanism,
) -> Result<FreeBodies<f64, N, D>, ParameterError<f64>> {
    let none = Rigid { mass: 1.0, inertia_b: Vector3::repeat(1.0), centre_w: Vector3::zeros() };
    let mut bodies = [none; N];
    for (k, (rigid, body)) in bodies.iter_mut().zip(&mechanism.bodies).enumerate() {
        let (mass, inertia) = mechanism.moved_with(k);
        *rigid = Rigid { mass, inertia_b: inertia.into(), centre_w: body.centre.into() };
    }
    FreeBodies::new(bodies, mechanism.gravity.into())
}

/// How the bodies of `mechanism` hang on ideal joints; `None` where all of its joints have play.
///
/// # Errors
/// See [`MountError`].
pub fn mounts(mechanism: &Mechanism) -> Result<Option<Vec<Mount<f64>>>, MountError> {
    if !mechanism.has_ideal_joints_in_space() {
        return Ok(None);
    }
    let ideal = |joint: &Joint| {
        let at = joint.at.into();
        match joint.kind {
            JointKind::Revolute { axis } => IdealJoint::Revolute { at, axis: axis.into() },
            JointKind::Prismatic { axis } => IdealJoint::Prismatic { axis: axis.into() },
            JointKind::Cylindrical { axis } => IdealJoint::Cylindrical { at, axis: axis.into() },
            JointKind::Spherical => IdealJoint::Spherical { at },
            _ => IdealJoint::Fixed,
        }
    };
    let mount = |Hung { body, on, by }| Mount {
        body,
        on,
        joint: by.map_or(IdealJoint::Free, |by: usize| ideal(&mechanism.joints[by])),
    };
    let mounts: Vec<_> = hanging(mechanism)?.into_iter().map(mount).collect();
    let found = coordinates(&mounts);
    if found > MOST_COORDINATES {
        return Err(MountError::Coordinates { found, most: MOST_COORDINATES });
    }
    Ok(Some(mounts))
}

/// How many coordinates the `mounts` leave.
pub fn coordinates(mounts: &[Mount<f64>]) -> usize {
    mounts.iter().map(|mount| mount.joint.freedoms()).sum()
}

/// The bodies of `mechanism` on their `mounts`.
///
/// # Errors
/// [`ParameterError`] names the first parameter that is not finite or out of bounds.
pub fn tree<const N: usize, const W: usize, const D: usize>(
    mechanism: &Mechanism,
    mounts: &[Mount<f64>],
) -> Result<SpatialTree<f64, N, W, D>, ParameterError<f64>> {
    SpatialTree::new(bodies(mechanism)?, mounts)
}

/// What acts on the bodies of `mechanism` with the given `gaps` (m); a stick band (m/s) stands for true stick.
///
/// # Errors
/// [`ParameterError`] names the first parameter that is not finite or out of bounds.
pub fn elements(
    mechanism: &Mechanism,
    gaps: &[f64],
    stick_band: f64,
) -> Result<Vec<SpatialElement>, ParameterError<f64>> {
    let mut elements = Vec::new();
    for joint in &mechanism.joints {
        add(mechanism, joint, gaps, contact(&joint.laws, stick_band)?, &mut elements)?;
    }
    for spring in &mechanism.springs {
        let SpringKind::Line { ends, free_length } = spring.kind else { continue };
        let [of_first, of_second] = ends.map(Vector3::from);
        let [first, from] = spring.between;
        let (stiffness, damping) = (spring.stiffness, spring.damping);
        let law = LineSpring { stiffness, damping, free_length, drawn: of_first - of_second };
        let link = Seat { point: point_of(mechanism, first, of_first), from };
        elements.push(SpatialElement::Line(Element { link, law }));
    }
    for joint in &mechanism.joints {
        let Some(data) = joint.drag else { continue };
        let law = Motor(AnyDrive::Friction(Train::new((), data)?));
        let Some(body) = joint.between.into_iter().flatten().next() else { continue };
        elements.push(match joint.kind {
            JointKind::Revolute { axis } => {
                SpatialElement::Motor(Element { link: About { body, axis_w: axis.into() }, law })
            }
            JointKind::Prismatic { axis } => {
                let lever = point_of(mechanism, Some(body), joint.at.into()).lever;
                SpatialElement::AtPoint(Element { link: AtPoint { body, lever, axis_w: axis.into() }, law })
            }
            _ => continue,
        });
    }
    for named in &mechanism.drives {
        let drive = named.law(mechanism)?;
        let lever = named.drive.point_b;
        elements.push(match named.action {
            Action::Pushes { axis } if !named.at_centre && lever != Vector3::zeros() => {
                SpatialElement::AtPoint(Element {
                    link: AtPoint { body: named.body, lever, axis_w: axis.into() },
                    law: Motor(drive),
                })
            }
            Action::Turns { axis } => SpatialElement::Motor(Element {
                link: About { body: named.body, axis_w: axis.into() },
                law: Motor(drive),
            }),
            Action::Pushes { axis } => SpatialElement::Pusher(Element {
                link: Along { body: named.body, lever, axis_w: axis.into() },
                law: Pusher(drive),
            }),
        });
    }
    Ok(elements)
}

/// A point of a body that is `at` (m) in the drawn pose.
fn point_of(mechanism: &Mechanism, body: Port, at: Vector3<f64>) -> PointOf<f64> {
    let centre = body.map_or(Vector3::zeros(), |body| mechanism.bodies[body].centre.into());
    PointOf { body, lever: at - centre }
}

/// Adds the elements of a `joint`.
fn add(
    mechanism: &Mechanism,
    joint: &Joint,
    gaps: &[f64],
    contact: AnyContact,
    elements: &mut Vec<SpatialElement>,
) -> Result<(), ParameterError<f64>> {
    let [first, from] = joint.between;
    let at: Vector3<f64> = joint.at.into();
    let seat = |at| Seat { point: point_of(mechanism, first, at), from };
    match joint.kind {
        JointKind::Track { gaps: indices } if !joint.walls.is_parallel() => {
            let walls = [(Axis::X, 1.0), (Axis::X, -1.0), (Axis::Y, -1.0), (Axis::Y, 1.0)];
            for (i, (gap, (axis, sign))) in indices.into_iter().zip(walls).enumerate() {
                if let (Some(gap), Some(contour)) = (gap, joint.walls.contour(i, gaps)) {
                    let wall = Wall { axis, sign, gap: gaps[gap], contact };
                    let law = Contoured { wall, along: Axis::Z, contour };
                    elements.push(SpatialElement::Contour(Element { link: seat(at), law }));
                }
            }
        }
        JointKind::Track { gaps: indices } => {
            let gaps = indices.map(|gap| gap.map_or(NONE, |gap| gaps[gap]));
            elements.push(SpatialElement::Contact(SpatialContact::Pin(Element {
                link: seat(at),
                law: Pin { gaps, contact },
            })));
        }
        JointKind::Stop { gap, normal } => {
            let slanted = ParameterError { parameter: "normal", value: normal[0], least: -1.0, greatest: 1.0 };
            let (axis, sign) = axis_of(normal).ok_or(slanted)?;
            let law = Wall { axis, sign, gap: gaps[gap], contact };
            elements.push(SpatialElement::Contact(SpatialContact::Wall(Element { link: seat(at), law })));
        }
        JointKind::Bearing { gap, axis, length, radius } => {
            let axis = Vector3::from(axis);
            for end in [-0.5, 0.5] {
                let centre = at + axis * (length * end);
                let link = Rim { seat: seat(centre), axes: axes_with_third(&axis), radius };
                let law = Ring { clearance: gaps[gap], contact };
                elements.push(SpatialElement::Contact(SpatialContact::Ring(Element { link, law })));
            }
        }
        _ => {}
    }
    Ok(())
}

/// Which axis of the frame the unit vector `normal` is, and its sign; `None` where it is none of them.
pub fn axis_of(normal: [f64; 3]) -> Option<(Axis, f64)> {
    let axis = [Axis::X, Axis::Y, Axis::Z].into_iter().find(|axis| axis.of(normal).abs() == 1.0)?;
    let is_alone = normal.iter().filter(|x| **x != 0.0).count() == 1;
    is_alone.then(|| (axis, axis.of(normal)))
}

/// Axes of which the third is `axis`, of unit length; `None` where those of the frame are such.
fn axes_with_third(axis: &Vector3<f64>) -> Option<Matrix3<f64>> {
    let aside = if axis.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let first = (aside - axis * axis.dot(&aside)).normalize();
    (*axis != Vector3::z()).then(|| Matrix3::from_columns(&[first, axis.cross(&first), *axis]))
}
