//! Bodies.

use slipfit_core::system::{planar::Coordinate, spatial::tree::Joint as IdealJoint};
use slipfit_tolerance::unit::{self, Quantity};

use super::{names::tables, place::place};
use crate::{
    mechanism::{Body, Joint, JointKind, Mechanism, Mounts, Start, Thrown, Torn, spatial, torn},
    scene::{
        Problem, SceneError, plausible,
        quantity::POINT,
        tree::Value,
        value::{Field, OneOrEach},
    },
};

pub(super) const MASS: Quantity = Quantity { units: unit::MASS, range: [1e-6, 1e7] };
const INERTIA: Quantity = Quantity { units: unit::INERTIA, range: [1e-6, 1e15] };
const ANGLE: Quantity = Quantity { units: unit::ANGLE, range: [-1e4, 1e4] };
const SPIN: Quantity = Quantity { units: unit::ROTATION, range: [-1e6, 1e6] };
const SPEED: Quantity = Quantity { units: unit::SPEED, range: [-1e6, 1e6] };

/// Reads the bodies, with the tables that they stand in.
pub(super) fn bodies<'t, 's>(
    root: &Field<'t, 's>,
    planar: bool,
) -> Result<(Vec<Body>, Vec<Field<'t, 's>>), SceneError> {
    root.require("body", "tables [[body]]")?;
    let mut bodies = Vec::new();
    let mut fields = Vec::new();
    for (name, table) in tables(root, "body")? {
        bodies.push(body(name, &table, planar)?);
        fields.push(table);
    }
    Ok((bodies, fields))
}

fn body(name: String, table: &Field, planar: bool) -> Result<Body, SceneError> {
    let mass = table.number("mass", &MASS)?;
    let inertia =
        if planar { [0.0, 0.0, table.number("inertia", &INERTIA)?] } else { table.numbers("inertia", &INERTIA)? };
    if let Some(field) = table.get("inertia").filter(|_| !planar && !plausible::are_moments(inertia)) {
        let allowed = "principal moments of inertia, of which none is greater than the other two together";
        table.found().note(field.out_of_range("g·mm²", allowed));
    }
    let centre = table.require("centre", if planar { "a place [x, y] in mm" } else { "a place [x, y, z] in mm" })?;
    let centre = place(&centre, planar, &POINT)?;
    Ok(Body { name, mass, inertia, centre, start: start(table, planar)? })
}

/// Reads how a body starts: by numbers on its own ideal joint, by lists where none holds it.
fn start(table: &Field, planar: bool) -> Result<Start, SceneError> {
    // The number on a joint, and the list of a free body.
    let either = |key: &str, quantity, planar| -> Result<(f64, Option<[f64; 3]>), SceneError> {
        let Some(field) = table.get(key) else { return Ok((0.0, None)) };
        let read = if planar {
            match field.one_or_each::<2>(quantity)? {
                OneOrEach::One(one) => OneOrEach::One(one),
                OneOrEach::Each([x, y]) => OneOrEach::Each([x, y, 0.0]),
            }
        } else {
            field.one_or_each::<3>(quantity)?
        };
        Ok(match read {
            OneOrEach::One(one) => (one, None),
            OneOrEach::Each(each) => (0.0, Some(each)),
        })
    };
    let number = |key: &str, quantity| -> Result<f64, SceneError> {
        table.get(key).map_or(Ok(0.0), |field| field.to_number(quantity))
    };
    let (speed, velocity) = either("speed", &SPEED, planar)?;
    // In a plane a body turns about one axis.
    let [(angle, turned), (turning, spin)] = match planar {
        true => [(number("angle", &ANGLE)?, None), (number("spin", &SPIN)?, None)],
        false => [either("angle", &ANGLE, false)?, either("spin", &SPIN, false)?],
    };
    let displacement = table.get("displaced").map(|field| place(&field, planar, &POINT)).transpose()?;
    if let Some(field) = table.get("displaced").filter(|_| planar) {
        let what = "`displaced` in a plane".into();
        return Err(field.error(Problem::Unsupported { what }, "a centre where the body starts"));
    }
    let is_thrown = [velocity, turned, spin, displacement].iter().any(Option::is_some);
    let thrown = is_thrown.then(|| Thrown {
        displacement: displacement.unwrap_or_default(),
        turned: turned.unwrap_or_default(),
        velocity: velocity.unwrap_or_default(),
        spin: spin.unwrap_or_default(),
    });
    Ok(Start { angle, spin: turning, speed, thrown })
}

/// Whether something holds or moves each body.
pub(super) fn check(mechanism: &Mechanism, fields: &[Field]) -> Result<(), SceneError> {
    for (i, body) in mechanism.bodies.iter().enumerate() {
        let driven = mechanism.drives.iter().any(|drive| drive.body == i) && body.start.thrown.is_some();
        let joined = driven || mechanism.joints.iter().any(|joint| joint.between.contains(&Some(i)));
        let sprung = mechanism.springs.iter().any(|spring| spring.between.contains(&Some(i)));
        if !joined && !sprung {
            let name = fields[i].get("name").unwrap_or_else(|| fields[i].clone());
            let error = name.error(Problem::Floating { body: body.name.clone() }, "a [[joint]] that joins it");
            fields[i].found().note(error);
        }
        // What only slides on the frame never turns.
        let slides = |joint: &Joint| matches!(joint.kind, JointKind::Prismatic { .. }) && joint.between.contains(&None);
        let turns = !mechanism.joints.iter().any(|joint| joint.between.contains(&Some(i)) && slides(joint));
        if let Some(inertia) = fields[i].get("inertia").filter(|_| turns) {
            plausible::inertia(&inertia, body.mass, mechanism.planar, body.inertia);
        }
    }
    // A loop of joints is told elsewhere.
    if mechanism.planar {
        if let Ok(mounts) = Mounts::of(mechanism) {
            let own =
                |i| mounts.coordinates().iter().filter(move |owned| owned.body == i).map(|owned| &owned.coordinate);
            fields.iter().enumerate().for_each(|(i, table)| {
                let turns = own(i).any(|coordinate| matches!(coordinate, Coordinate::Turn));
                let slides = own(i).filter(|coordinate| matches!(coordinate, Coordinate::Slide { .. })).count() == 1;
                let is_free = own(i).filter(|coordinate| matches!(coordinate, Coordinate::Slide { .. })).count() == 2;
                check_freedoms([turns, slides], is_free, table);
            });
        }
    } else if let Ok(mounts) = spatial::mounts(mechanism) {
        fields.iter().enumerate().for_each(|(i, table)| {
            let own = mounts.iter().flatten().find(|mount| mount.body == i).map(|mount| mount.joint);
            check_freedoms(
                match own {
                    Some(IdealJoint::Revolute { .. }) => [true, false],
                    Some(IdealJoint::Prismatic { .. }) => [false, true],
                    Some(IdealJoint::Cylindrical { .. }) => [true, true],
                    _ => [false, false],
                },
                mounts.is_none(),
                table,
            );
        });
    }
    Ok(())
}

/// Whether a body that is read from `table` can start as it says: turned where it turns by itself, with a speed where its own joint lets
/// it slide along one axis; by lists where no ideal joint holds it, in space none of the mechanism.
fn check_freedoms([turns, slides]: [bool; 2], is_free: bool, table: &Field) {
    for (key, can) in [("angle", turns), ("spin", turns), ("speed", slides), ("displaced", false)] {
        let can = |field: &Field| match field.node.value {
            Value::List(_) => is_free,
            _ => can,
        };
        if let Some(field) = table.get(key).filter(|field| !can(field)) {
            let what = format!("`{key}` at the start of a body that no joint lets move so");
            let allowed = if is_free { "a list of numbers, or to leave it out" } else { "to leave it out" };
            table.found().note(field.error(Problem::Unsupported { what }, allowed));
        }
    }
}

/// Whether the angles at which bodies start leave the joints of the mean unit together.
pub(super) fn check_start<'t, 's>(
    mechanism: &Mechanism,
    joints: &[Field<'t, 's>],
    fields: &[Field<'t, 's>],
) -> Result<(), SceneError> {
    let gaps = mechanism.stated_gaps_at(&[0.0]);
    // What has no run is told elsewhere.
    let Ok(Some(Torn { joint, depth })) = torn(mechanism, &gaps) else { return Ok(()) };
    let of_start = |body: &Field<'t, 's>| ["angle", "displaced"].iter().find_map(|key| body.get(key));
    let of_joint = joint.between.iter().flatten().find_map(|body| of_start(&fields[*body]));
    // Walls that slope or bow may be too near in the drawn pose.
    let of_walls = || {
        let own = mechanism.joints.iter().zip(joints).find(|(one, _)| one.name == joint.name);
        own.and_then(|(_, field)| ["slope", "bow", "along"].iter().find_map(|key| field.get(key)))
    };
    let field = of_joint.or_else(of_walls).or_else(|| fields.iter().find_map(of_start));
    let Some(field) = field else { return Ok(()) };
    let problem =
        format!("this start tears `{}` open: the parts of this joint overlap by {:.4} mm", joint.name, 1e3 * depth);
    let allowed = "angles and places that fit each other, or parts that are drawn where they start";
    Err(field.error(Problem::Mechanism(problem), allowed))
}
