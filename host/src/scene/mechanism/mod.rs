//! Reading a mechanism: bodies, joints, springs and drives.

mod body;
mod command;
mod contact;
mod contour;
mod drive;
mod joint;
mod names;
mod parameters;
mod place;
mod recorded;
mod segment;
mod spring;
#[cfg(test)]
mod tests;

use slipfit_tolerance::{
    product::Product,
    unit::{self, Quantity},
};

use self::{
    contact::{Gaps, laws},
    names::Names,
    parameters::named,
    place::place,
};
use super::{
    Problem, SceneError, identify,
    measured::columns::Columns,
    parse,
    plausible::{self, Loads},
    uncertain::uncertain,
    value::Field,
    vary::vary,
};
use crate::{
    dynamics::driven::DriveKind,
    identify::Identification,
    mechanism::{Joint, JointKind, Mechanism, MountError, Mounts, NormalData, spatial},
    setup::{LevelRange, SURFACES},
};

const GRAVITY: Quantity = Quantity { units: unit::ACCELERATION, range: [-1e4, 1e4] };

/// The levels of a sweep where a scene states none.
const LEVELS: LevelRange = LevelRange { first: -3.0, step: 0.5, count: 13 };

/// Whether the scene `root` has bodies of its own.
pub(super) fn is_mechanism(root: &Field) -> bool {
    ["mechanism", "body", "joint"].iter().any(|key| root.get(key).is_some())
}

/// Refuses the tables of a slide beside those of a mechanism, which would have no effect.
pub(super) fn refuse_slide(root: &Field) -> Result<(), SceneError> {
    let has = |key: &&str| root.get(key).is_some();
    let Some(own) = ["mechanism", "body", "joint"].iter().find(|key| has(key)) else { return Ok(()) };
    for key in ["slide", "pin", "drawing"] {
        if let Some(field) = root.get(key) {
            let what = format!("`{key}` beside `{own}`");
            let allowed = "a slide, [slide] and [[pin]], or bodies and joints, [mechanism], [[body]] and [[joint]]";
            return Err(field.error(Problem::Unsupported { what }, allowed));
        }
    }
    Ok(())
}

/// Reads the mechanism of the scene `root`, whose gaps may be measures of `product` or `measured`, and what is sought of it in records.
pub(super) fn mechanism(
    root: &Field,
    (title, file_name): (String, &str),
    product: Option<&Product>,
    measured: Option<&Columns>,
) -> Result<(Mechanism, Option<Identification>), SceneError> {
    let found = root.found();
    let table = root.table("mechanism")?;
    let planar = match table.get("space") {
        None => false,
        Some(field) => match field.to_text()? {
            "plane" => true,
            "space" => false,
            _ => {
                let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
                return Err(field.error(problem, "plane, space"));
            }
        },
    };
    let gravity = match table.get("gravity") {
        None => [0.0; 3],
        Some(field) => {
            let gravity = place(&field, planar, &GRAVITY)?;
            plausible::gravity(&field, gravity);
            gravity
        }
    };
    let (bodies, fields) = body::bodies(root, planar)?;
    let names = Names { names: bodies.iter().map(|body| body.name.clone()).collect() };
    let laws = laws(root, None)?;
    let mut gaps = Gaps { gaps: Vec::new(), product, measured };
    let (joints, joint_fields) = joint::joints(root, planar, &names, laws, &mut gaps)?;
    let sweep = root.get("sweep").map(|_| parse::sweep(&root.table("sweep")?)).transpose()?.unwrap_or(LEVELS);
    let drives = drive::drives(root, planar, &names, file_name)?;
    let turns = drives.first().is_some_and(|first| first.action.kind() == DriveKind::Turns);
    let run = parse::run(&root.table("run")?, turns)?;
    let mut mechanism = Mechanism {
        title,
        vary: Vec::new(),
        uncertain: Vec::new(),
        planar,
        gravity,
        springs: spring::springs(root, planar, &names)?,
        drives,
        bodies,
        joints,
        gaps: gaps.gaps,
        run,
        controller: parse::controller(root, laws.is_some_and(|laws| laws.friction.sticks()))?,
        sweep,
        measured: None,
        warnings: Vec::new(),
    };
    mechanism.set_prescribed_gains();
    let varied = vary(named(root, "vary", &names, &mechanism)?)?;
    let unknown = uncertain(root, named(root, "uncertain", &names, &mechanism)?, &mechanism)?;
    let mechanism = Mechanism { vary: varied, uncertain: unknown, ..mechanism };
    // With values that stand for wrong ones there is nothing to look at.
    if !found.any() {
        joint::check(&mechanism, &joint_fields, &fields)?;
        body::check(&mechanism, &fields)?;
        drive::check(&mechanism, root)?;
        check_tree(&mechanism, &joint_fields, root)?;
        check_gaps(&mechanism, &joint_fields, root)?;
        body::check_start(&mechanism, &joint_fields, &fields)?;
        // A weight that is doubtful itself is no measure of the others.
        if plausible::is_gravity(gravity) {
            doubt(&mechanism, &joint_fields, root);
        }
    }
    let sought = named(root, "identify", &names, &mechanism)?;
    let identify = identify::mechanism(root, &sought, &mechanism)?;
    Ok((mechanism, identify))
}

/// Warns about stiffnesses and gaps that are implausible for the loads of the `mechanism`.
fn doubt(mechanism: &Mechanism, joints: &[Field], root: &Field) {
    let mass: f64 = mechanism.bodies.iter().map(|body| body.mass).sum();
    let pushes = mechanism.drives.iter().filter(|drive| drive.action.kind() == DriveKind::Pushes);
    let drives = pushes.map(|named| (named.drive.gain * named.drive.speed).abs()).sum();
    let loads = Loads::new(mass, mechanism.gravity, drives);
    // How fast surfaces slide that a drive turns, depends on where they are.
    let speed = mechanism.drives.iter().map(|named| match named.action.kind() {
        DriveKind::Pushes => named.drive.speed.abs(),
        DriveKind::Turns => f64::INFINITY,
    });
    let speed = speed.reduce(f64::max).unwrap_or_default();
    let with_play = || mechanism.joints.iter().filter(|joint| !joint.kind.is_ideal());
    let widest = mechanism.widest_gap();
    let all_stop = with_play().all(|joint| joint.kind.is_stop());
    // A bearing and a guide have two ends.
    let ends = |joint: &Joint| match joint.kind {
        JointKind::Bearing { .. } | JointKind::Guide { .. } => 2,
        _ => 1,
    };
    let contacts = with_play().filter(|joint| all_stop || !joint.kind.is_stop()).map(ends).sum();
    for (joint, field) in mechanism.joints.iter().zip(joints).filter(|(joint, _)| !joint.kind.is_ideal()) {
        let law = match joint.laws.contact {
            NormalData::Impact(data) => [data.stiffness, data.exponent],
            NormalData::HuntCrossley(data) | NormalData::LankaraniNikravesh(data) => [data.stiffness, data.exponent],
        };
        let mut is_soft = false;
        let stiffness = [field, root].iter().find_map(|table| table.get("contact"));
        if let Some(stiffness) = stiffness.and_then(|contact| contact.get("stiffness")) {
            is_soft = plausible::stiffness(&stiffness, law, loads, contacts, widest);
        }
        let contact = [field, root].iter().find_map(|table| table.get("contact"));
        if let (NormalData::Impact(data), Some(table), false) = (&joint.laws.contact, contact, is_soft) {
            plausible::damping(&table, data, mass, widest);
        }
        let friction = [field, root].iter().find_map(|table| table.get("friction"));
        if let Some(band) = friction.and_then(|friction| friction.get("stick_band")) {
            plausible::stick_band(&band, joint.laws.friction.stick_band(), speed);
        }
        if let (JointKind::Journal { gap, radius } | JointKind::Bearing { gap, radius, .. }, Some(stated)) =
            (&joint.kind, field.get("radius"))
        {
            plausible::radius(&stated, *radius, mechanism.gaps[*gap].statistics.mean);
        }
        for of in joint.kind.gaps() {
            let name = &mechanism.gaps[of].name;
            let key = SURFACES.into_iter().find(|surface| *name == format!("{} {surface}", joint.name));
            if let Some(stated) = field.get(key.unwrap_or("clearance")) {
                let gap = mechanism.gaps[of].statistics.mean;
                plausible::pressed(&stated, name, joint.kind.is_stop(), gap, law, loads);
            }
        }
    }
}

/// Whether the gaps of the mean unit and of all levels are possible.
fn check_gaps(mechanism: &Mechanism, joints: &[Field], root: &Field) -> Result<(), SceneError> {
    if let Err(error) = mechanism.gaps_at(&[0.0]) {
        let is_of = |joint: &crate::mechanism::Joint| joint.gaps().any(|gap| mechanism.gaps[gap].name == error.name);
        let number = mechanism.joints.iter().position(is_of).unwrap_or_default();
        let is_own = mechanism.joints[number].kind.gaps().any(|gap| mechanism.gaps[gap].name == error.name);
        let field = joints[number].get(if is_own { "clearance" } else { "along" });
        let field = field.unwrap_or_else(|| joints[number].clone());
        return Err(field.error(Problem::Mechanism(error.to_string()), "a mean gap that is not negative"));
    }
    let Some(table) = root.get("sweep") else { return Ok(()) };
    for i in [0, mechanism.sweep.count - 1] {
        if let Err(error) = mechanism.gaps_at(&[mechanism.sweep.level(i)]) {
            let field = table.get("n").unwrap_or_else(|| table.clone());
            return Err(field.error(Problem::Play(error), "levels below `closes at n` of `check`, or less deviation"));
        }
    }
    Ok(())
}

/// Whether ideal joints make a tree.
fn check_tree(mechanism: &Mechanism, joints: &[Field], root: &Field) -> Result<(), SceneError> {
    let tree = if mechanism.planar { Mounts::of(mechanism).map(drop) } else { spatial::mounts(mechanism).map(drop) };
    match tree {
        Ok(()) => Ok(()),
        Err(MountError::Loop { joint }) => {
            let at = mechanism.joints.iter().position(|one| one.name == joint).unwrap_or_default();
            let allowed = "a clearance for one joint of the loop, which opens it";
            Err(joints[at].error(Problem::IdealLoop { joint }, allowed))
        }
        Err(error @ MountError::Coordinates { .. }) => {
            Err(root.error(Problem::Mechanism(error.to_string()), "fewer bodies, or joints that hold them"))
        }
    }
}
