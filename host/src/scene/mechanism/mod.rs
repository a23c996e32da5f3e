//! Reading a mechanism: bodies, joints, springs and drives.

mod body;
mod drive;
mod joint;
#[cfg(test)]
mod tests;
mod vary;

use slipfit_core::{clearance::GapStatistics, menu::FrictionData};
use slipfit_tolerance::product::Product;
use slipfit_tolerance::unit::{self, Quantity};

use super::{
    Problem, SceneError, contact,
    diagnostic::Found,
    parse,
    plausible::{self, Loads},
    tree::Value,
    value::Field,
};
use crate::setup::LevelRange;
use crate::{
    dynamics::driven::DriveKind,
    mechanism::{Gap, Joint, JointKind, Laws, Mechanism, MountError, Mounts, NormalData, Port, spatial},
    setup::SURFACES,
};

const GRAVITY: Quantity = Quantity { units: unit::ACCELERATION, range: [-1e4, 1e4] };

/// What the frame is called where bodies are named.
const FRAME: &str = "frame";

/// The levels of a sweep where a scene states none.
const LEVELS: LevelRange = LevelRange { first: -3.0, step: 0.5, count: 13 };

/// How long an axis or a normal at least is, in its own numbers.
const LEAST_AXIS: f64 = 1e-9;

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

/// Reads the mechanism of the scene `root`, whose gaps may be measures of `product`.
pub(super) fn mechanism(root: &Field, title: String, product: Option<&Product>) -> Result<Mechanism, SceneError> {
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
    let mut gaps = Gaps { gaps: Vec::new(), product };
    let (joints, joint_fields) = joint::joints(root, planar, &names, laws, &mut gaps)?;
    let sweep = root.get("sweep").map(|_| parse::sweep(&root.table("sweep")?)).transpose()?.unwrap_or(LEVELS);
    let drives = drive::drives(root, planar, &names)?;
    let turns = drives.first().is_some_and(|first| first.action.kind() == DriveKind::Turns);
    let run = parse::run(&root.table("run")?, turns)?;
    let mechanism = Mechanism {
        title,
        vary: Vec::new(),
        planar,
        gravity,
        springs: drive::springs(root, planar, &names)?,
        drives,
        bodies,
        joints,
        gaps: gaps.gaps,
        run,
        controller: parse::controller(root, &laws.map_or(FrictionData::None, |laws| laws.friction))?,
        sweep,
        warnings: Vec::new(),
    };
    let mechanism = Mechanism { vary: vary::vary(root, &names, &mechanism)?, ..mechanism };
    // With values that stand for wrong ones there is nothing to look at.
    if !found.any() {
        joint::check(&mechanism, &joint_fields, &fields)?;
        body::check(&mechanism, &fields)?;
        check_tree(&mechanism, &joint_fields, root)?;
        check_gaps(&mechanism, &joint_fields, root)?;
        body::check_start(&mechanism, &fields)?;
        // A weight that is doubtful itself is no measure of the others.
        if plausible::is_gravity(gravity) {
            doubt(&mechanism, &joint_fields, root);
        }
    }
    Ok(mechanism)
}

/// Warns about stiffnesses and gaps that are implausible for the loads of the `mechanism`.
fn doubt(mechanism: &Mechanism, joints: &[Field], root: &Field) {
    let mass: f64 = mechanism.bodies.iter().map(|body| body.mass).sum();
    let pushes = mechanism.drives.iter().filter(|drive| drive.action.kind() == DriveKind::Pushes);
    let drives = pushes.map(|named| (named.drive.gain * named.drive.speed).abs()).sum();
    let loads = Loads::new(mass, mechanism.gravity, drives);
    let is_stop = |joint: &Joint| matches!(joint.kind, JointKind::Stop { .. });
    let with_play = || mechanism.joints.iter().filter(|joint| !joint.kind.is_ideal());
    let gap = |gap: usize| mechanism.gaps[gap].statistics;
    // The distance to a stop is no play, unless there is nothing else.
    let all_stop = with_play().all(is_stop);
    let widest = with_play().filter(|joint| all_stop || !is_stop(joint)).flat_map(|joint| joint.kind.gaps());
    let widest = widest.map(|of| gap(of).mean.abs() + 3.0 * gap(of).deviation).fold(0.0, f64::max);
    // A bearing and a guide have two ends.
    let ends = |joint: &Joint| match joint.kind {
        JointKind::Bearing { .. } | JointKind::Guide { .. } => 2,
        _ => 1,
    };
    let contacts = with_play().filter(|joint| all_stop || !is_stop(joint)).map(ends).sum();
    for (joint, field) in mechanism.joints.iter().zip(joints).filter(|(joint, _)| !joint.kind.is_ideal()) {
        let law = match joint.laws.contact {
            NormalData::Impact(data) => [data.stiffness, data.exponent],
            NormalData::HuntCrossley(data) | NormalData::LankaraniNikravesh(data) => [data.stiffness, data.exponent],
        };
        let stiffness = [field, root].iter().find_map(|table| table.get("contact"));
        if let Some(stiffness) = stiffness.and_then(|contact| contact.get("stiffness")) {
            plausible::stiffness(&stiffness, law, loads, contacts, widest);
        }
        for of in joint.kind.gaps() {
            let name = &mechanism.gaps[of].name;
            let key = SURFACES.into_iter().find(|surface| *name == format!("{} {surface}", joint.name));
            if let Some(stated) = field.get(key.unwrap_or("clearance")) {
                plausible::pressed(&stated, name, is_stop(joint), gap(of).mean, law, loads);
            }
        }
    }
}

/// Whether the gaps of the mean unit and of all levels are possible.
fn check_gaps(mechanism: &Mechanism, joints: &[Field], root: &Field) -> Result<(), SceneError> {
    if let Err(error) = mechanism.gaps_at(&[0.0]) {
        let is_of =
            |joint: &crate::mechanism::Joint| joint.kind.gaps().any(|gap| mechanism.gaps[gap].name == error.name);
        let joint = &joints[mechanism.joints.iter().position(is_of).unwrap_or_default()];
        let field = joint.get("clearance").unwrap_or_else(|| joint.clone());
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

/// Names of bodies.
struct Names {
    names: Vec<String>,
}

impl Names {
    /// The body that `field` names, or the frame.
    fn port(&self, field: &Field) -> Result<Port, SceneError> {
        let name = field.to_text()?;
        if name == FRAME {
            return Ok(None);
        }
        self.find(name).map(Some).ok_or_else(|| {
            let problem = Problem::UnknownName { of: "body".into(), name: name.into() };
            field.error(problem, format!("{FRAME}, {}", self.names.join(", ")))
        })
    }

    /// The moving body that `field` names.
    fn body(&self, field: &Field) -> Result<usize, SceneError> {
        let name = field.to_text()?;
        self.find(name).ok_or_else(|| {
            let (key, of, name) = (field.key.clone(), "body".into(), name.into());
            let problem =
                if name == FRAME { Problem::Choice { key, written: name } } else { Problem::UnknownName { of, name } };
            field.error(problem, format!("a body that moves: {}", self.names.join(", ")))
        })
    }

    fn find(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|one| one == name)
    }

    /// The two bodies of a joint or spring.
    fn between(&self, table: &Field) -> Result<[Port; 2], SceneError> {
        const ALLOWED: &str = "a list of two bodies, such as [\"frame\", \"crank\"]";
        let field = table.require("between", ALLOWED)?;
        let Value::List(nodes) = &field.node.value else { return Err(field.wrong_type(ALLOWED)) };
        let [first, second] = &nodes[..] else {
            return Err(field.error(Problem::Length { key: field.key.clone(), found: nodes.len() }, ALLOWED));
        };
        let port = |node| self.port(&Field { key: field.key.clone(), node });
        let between = [port(first)?, port(second)?];
        if between[0] == between[1] {
            let name = between[0].map_or(FRAME, |body| &self.names[body]).to_owned();
            return Err(field.error(Problem::JoinedToItself { key: field.key.clone(), name }, "two different bodies"));
        }
        Ok(between)
    }
}

/// The gaps met so far.
struct Gaps<'p> {
    gaps: Vec<Gap>,
    product: Option<&'p Product>,
}

impl Gaps<'_> {
    /// The index of a new gap with the statistics that `field` gives, by itself or as a measure of the product; its mean is a `quantity`.
    fn add(&mut self, name: String, field: &Field, quantity: &Quantity) -> Result<usize, SceneError> {
        let (statistics, measure) = match field.node.value {
            Value::Text(_) => self.measured(field)?,
            _ => (super::pins::statistics(field, quantity)?, None),
        };
        self.gaps.push(Gap { name, statistics, measure });
        Ok(self.gaps.len() - 1)
    }

    fn measured(&self, field: &Field) -> Result<(GapStatistics<f64>, Option<usize>), SceneError> {
        let model = self.product.map(|product| &product.model);
        let index = super::pins::length(field, model)?;
        let moments = model.map(slipfit_tolerance::theory::moments::of_measures).unwrap_or_default();
        let of = moments.get(index).map(|of| GapStatistics { mean: of.mean, deviation: of.deviation });
        of.map(|of| (of, Some(index))).ok_or_else(|| field.wrong_type("a measure of the product"))
    }
}

/// Reads the laws of `table`, where it states none of its own `otherwise`; the friction law alone may be missing. A mistake in one law is
/// noted, and another law stands for it.
fn laws(table: &Field, otherwise: Option<Laws>) -> Result<Option<Laws>, SceneError> {
    let found = table.found();
    let contact = match table.get("contact") {
        None => otherwise.map(|laws| laws.contact),
        Some(_) => {
            Some(found.recover(table.table("contact").and_then(|table| contact::normal(&table)), joint::NO_CONTACT))
        }
    };
    let friction = match table.get("friction") {
        None => otherwise.map_or(FrictionData::None, |laws| laws.friction),
        Some(_) => found.recover(table.table("friction").and_then(|table| parse::friction(&table)), FrictionData::None),
    };
    Ok(contact.map(|contact| Laws { contact, friction }))
}

/// Reads a list of tables, each with a name of its own.
fn tables<'t, 's>(root: &Field<'t, 's>, key: &str) -> Result<Vec<(String, Field<'t, 's>)>, SceneError> {
    let Some(list) = root.get(key) else { return Ok(Vec::new()) };
    let allowed = format!("tables [[{}]]", list.key);
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(allowed)) };
    let mut named: Vec<(String, Field)> = Vec::new();
    for node in nodes {
        let table = Field { key: list.key.clone(), node };
        table.expect_table()?;
        let field = table.require("name", "a text in quotes")?;
        let name = field.to_text()?;
        if name == FRAME {
            let problem = Problem::Choice { key: field.key.clone(), written: name.into() };
            return Err(field.error(problem, "another name: this is what the frame is called, which does not move"));
        }
        if named.iter().any(|(other, _)| other == name) {
            let problem = Problem::Duplicate { key: field.key.clone(), name: name.into() };
            return Err(field.error(problem, "a name of its own for each"));
        }
        named.push((name.into(), table));
    }
    Ok(named)
}

/// Reads a place or a direction: two numbers in a plane, else three.
fn place(field: &Field, planar: bool, quantity: &Quantity) -> Result<[f64; 3], SceneError> {
    if planar { field.to_numbers::<2>(quantity).map(|[x, y]| [x, y, 0.0]) } else { field.to_numbers(quantity) }
}

/// Reads a direction, to unit length.
fn direction(table: &Field, key: &str, planar: bool) -> Result<[f64; 3], SceneError> {
    const NUMBER: Quantity = Quantity { units: unit::ONE, range: [-1e6, 1e6] };
    let field = table.require(key, if planar { "a direction [x, y]" } else { "a direction [x, y, z]" })?;
    let axis = place(&field, planar, &NUMBER)?;
    let length = libm::sqrt(axis.iter().map(|x| x * x).sum());
    if length < LEAST_AXIS {
        return Err(field.out_of_range("", "a direction other than zero"));
    }
    // What is given along an axis stays exactly so.
    Ok(if axis.iter().filter(|x| **x != 0.0).count() == 1 {
        axis.map(f64::signum_or_zero)
    } else {
        axis.map(|x| x / length)
    })
}

/// The sign of a number, 0 for 0.
trait SignumOrZero {
    fn signum_or_zero(self) -> f64;
}

impl SignumOrZero for f64 {
    fn signum_or_zero(self) -> f64 {
        if self == 0.0 { 0.0 } else { self.signum() }
    }
}

/// Notes an `error` and goes on.
fn note(found: &Found, result: Result<(), SceneError>) {
    found.recover(result, ());
}
