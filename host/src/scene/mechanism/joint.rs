//! Joints, ideal or with play.

use slipfit_core::drive::TrainData;
use slipfit_tolerance::{
    number::three_digits,
    unit::{self, Quantity},
};

use super::{
    contact::{Gaps, NO_CONTACT, laws},
    contour::walls,
    drive,
    names::{Names, tables},
    place::{direction, place},
};
use crate::{
    mechanism::{Joint, JointKind, Laws, Mechanism, Port, STOP_MOST, SlidingData},
    scene::{Problem, SceneError, pins::MEAN, plausible, quantity::POINT, value::Field},
    setup::SURFACES,
};

const LENGTH: Quantity = Quantity { units: unit::LENGTH, range: [0.0, 1e5] };
const EDGE: Quantity = Quantity { units: unit::LENGTH, range: [0.001, 1e5] };

/// The mean of the distance to a stop.
const DISTANCE: Quantity = Quantity { units: unit::LENGTH, range: [-STOP_MOST * 1e3, STOP_MOST * 1e3] };

/// How many radii of gyration a joint may be from both of its bodies.
const FAR: f64 = 100.0;

/// Reads the joints, with the tables that they stand in.
pub(super) fn joints<'t, 's>(
    root: &Field<'t, 's>,
    planar: bool,
    names: &Names,
    otherwise: Option<Laws>,
    gaps: &mut Gaps,
) -> Result<(Vec<Joint>, Vec<Field<'t, 's>>), SceneError> {
    let (mut joints, mut fields) = (Vec::new(), Vec::new());
    for (name, table) in tables(root, "joint")? {
        joints.push(joint(name, &table, planar, names, otherwise, gaps)?);
        fields.push(table);
    }
    Ok((joints, fields))
}

fn joint(
    name: String,
    table: &Field,
    planar: bool,
    names: &Names,
    otherwise: Option<Laws>,
    gaps: &mut Gaps,
) -> Result<Joint, SceneError> {
    let between = names.between(table)?;
    let at = table.require("at", if planar { "a place [x, y] in mm" } else { "a place [x, y, z] in mm" })?;
    let at = place(&at, planar, &POINT)?;
    let kind = kind(&name, table, planar, gaps)?;
    let laws = laws(table, otherwise)?;
    let laws = match laws {
        Some(laws) => laws,
        None if kind.is_ideal() => NO_LAWS,
        None => {
            return Err(table.error(Problem::Missing("contact".into()), "a table [contact], or one of the joint's own"));
        }
    };
    let walls = walls(&name, table, &kind, gaps)?;
    let drag = drag(table, planar, &kind, between)?;
    Ok(Joint { name, between, at, kind, laws, walls, drag })
}

/// Reads the friction of an ideal joint, which has one motion to rub against.
fn drag(
    table: &Field,
    planar: bool,
    kind: &JointKind,
    between: [Port; 2],
) -> Result<Option<TrainData<f64>>, SceneError> {
    let stated = ["coulomb", "viscous", "stick_band"].iter().find_map(|key| table.get(key));
    let Some(field) = stated else { return Ok(None) };
    let to_frame = between.contains(&None);
    let is_known = match kind {
        JointKind::Revolute { .. } => planar || to_frame,
        JointKind::Prismatic { .. } => to_frame,
        _ => false,
    };
    if is_known {
        return drive::drag(table, matches!(kind, JointKind::Revolute { .. }));
    }
    let what = format!("`{}` of a joint of kind \"{}\" like this one", field.key, kind.name());
    let allowed = "an ideal revolute or prismatic joint with the frame, in a plane a revolute one of any bodies; joints with play have \
                   [joint.friction]";
    Err(field.error(Problem::Unsupported { what }, allowed))
}

/// The laws of a joint without contacts.
const NO_LAWS: Laws = Laws { contact: NO_CONTACT, friction: SlidingData::NONE };

/// Reads what the joint called `name` is.
fn kind(name: &str, table: &Field, planar: bool, gaps: &mut Gaps) -> Result<JointKind, SceneError> {
    let allowed = if planar {
        "fixed, revolute, prismatic, pin-slot, stop"
    } else {
        "fixed, revolute, prismatic, cylindrical, spherical, track, stop"
    };
    let field = table.require("kind", allowed)?;
    let clearance = table.get("clearance");
    let axis = || direction(table, "axis", planar);
    let length = |key: &str, quantity| table.number(key, quantity);
    let needed = || table.require("clearance", "[mean, standard deviation] in mm, or a measure");
    let text = field.to_text()?;
    Ok(match (text, planar, clearance) {
        ("fixed", _, None) => JointKind::Fixed,
        ("revolute", true, None) => JointKind::Revolute { axis: [0.0, 0.0, 1.0] },
        ("revolute", false, None) => JointKind::Revolute { axis: axis()? },
        ("prismatic", _, None) => JointKind::Prismatic { axis: axis()? },
        ("cylindrical", false, None) => JointKind::Cylindrical { axis: axis()? },
        ("spherical", false, None) => JointKind::Spherical,
        ("pin-slot", true, None) => JointKind::PinSlot { axis: axis()? },
        ("revolute", true, Some(clearance)) => {
            JointKind::Journal { gap: gaps.add(name.into(), &clearance, &MEAN)?, radius: length("radius", &LENGTH)? }
        }
        ("prismatic", true, Some(clearance)) => JointKind::Guide {
            gap: gaps.add(name.into(), &clearance, &MEAN)?,
            axis: axis()?,
            edges: [length("length", &EDGE)?, length("width", &EDGE)?],
        },
        ("cylindrical", false, Some(clearance)) => JointKind::Bearing {
            gap: gaps.add(name.into(), &clearance, &MEAN)?,
            axis: axis()?,
            length: length("length", &EDGE)?,
            radius: length("radius", &LENGTH)?,
        },
        ("track", false, None) => {
            let mut indices = [None; 4];
            for (index, surface) in indices.iter_mut().zip(SURFACES) {
                let gap =
                    table.get(surface).map(|field| gaps.add(format!("{name} {surface}"), &field, &MEAN)).transpose()?;
                *index = gap;
            }
            JointKind::Track { gaps: indices }
        }
        ("stop", _, _) => {
            let normal = direction(table, "normal", planar)?;
            if !planar && normal.iter().filter(|x| **x != 0.0).count() != 1 {
                let field = table.require("normal", "")?;
                return Err(field.out_of_range("", "in space along one of the axes, such as [0, 0, -1]"));
            }
            JointKind::Stop { gap: gaps.add(name.into(), &needed()?, &DISTANCE)?, normal }
        }
        ("fixed" | "pin-slot" | "track" | "spherical", _, Some(clearance)) => {
            let what = format!("a clearance of a joint of kind \"{text}\"");
            return Err(clearance.error(Problem::Unsupported { what }, "a joint without it"));
        }
        ("revolute" | "prismatic", false, Some(clearance)) => {
            let what = format!("a clearance of a joint of kind \"{text}\" in space");
            let instead = "a joint without it, or joints of the kinds \"cylindrical\", \"track\" and \"stop\"";
            return Err(clearance.error(Problem::Unsupported { what }, instead));
        }
        ("pin-slot", false, _) => {
            let what = format!("a joint of kind \"{text}\" in space");
            return Err(field.error(Problem::Unsupported { what }, allowed));
        }
        ("cylindrical" | "track" | "spherical", true, _) => {
            let what = format!("a joint of kind \"{text}\" in a plane");
            return Err(field.error(Problem::Unsupported { what }, allowed));
        }
        _ => {
            let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
            return Err(field.error(problem, allowed));
        }
    })
}

/// Whether each joint is somewhere near its bodies, which are read from `bodies`.
pub(super) fn check(mechanism: &Mechanism, fields: &[Field], bodies: &[Field]) -> Result<(), SceneError> {
    let mut blamed = Vec::new();
    for (joint, field) in mechanism.joints.iter().zip(fields) {
        // How far it is from a body, and how far it may be.
        let distances = joint.between.iter().flatten().map(|index| {
            let body = &mechanism.bodies[*index];
            let apart: f64 = joint.at.iter().zip(body.centre).map(|(a, b)| (a - b) * (a - b)).sum();
            let gyration = body.inertia.iter().fold(0.0, |most: f64, i| most.max(*i)) / body.mass;
            (*index, [libm::sqrt(apart), FAR * libm::sqrt(gyration).max(1e-9)])
        });
        let nearest = distances.min_by(|(_, one), (_, other)| (one[0] / one[1]).total_cmp(&(other[0] / other[1])));
        let Some((index, [away, most])) = nearest.filter(|(_, [away, most])| away > most) else { continue };
        if blamed.contains(&index) {
            continue;
        }
        let body = &mechanism.bodies[index];
        // Where no body has such moments of inertia, they are wrong, not the joint.
        let stated = bodies[index].get("inertia");
        let stated = stated.filter(|_| !plausible::is_body(body.mass, mechanism.planar, body.inertia));
        let error = match stated {
            Some(inertia) => {
                blamed.push(index);
                inertia.error(
                Problem::Mechanism(format!(
                    "`{}` is {}, which with the mass of \"{}\" is a radius of gyration of {} mm, but its joint \"{}\" is {} mm away",
                    inertia.key,
                    inertia.written(unit::INERTIA[0].symbol),
                    body.name,
                    three_digits(most * 1e3 / FAR),
                    joint.name,
                    three_digits(away * 1e3),
                )),
                format!(
                    "moments of inertia of a body of that size{}",
                    plausible::inertia_meant(&inertia, body.mass, mechanism.planar, body.inertia)
                ),
                )
            }
            None => {
                let at = field.get("at").unwrap_or_else(|| field.clone());
                let problem = Problem::Far { joint: joint.name.clone(), away: away * 1e3 };
                at.error(problem, format!("{} mm at most, {FAR} of its radii of gyration", three_digits(most * 1e3)))
            }
        };
        field.found().note(error);
    }
    Ok(())
}
