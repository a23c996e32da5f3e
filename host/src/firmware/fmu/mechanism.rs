//! A mechanism of bodies and joints as a co-simulation unit.

use std::{fmt::Write, path::Path};

use super::{
    Unit, model,
    variable::{Causality, Variables},
};
use crate::{
    dynamics::driven::Driven,
    firmware::kernel_crate::mechanism_crate,
    mechanism::{
        Action, ByDrive, Joint, JointKind, Mechanism, NamedDrive, RunError, SlidingData, drive_names, element_paths,
    },
};

/// The parts of the model's source that go by what there is.
#[derive(Default)]
struct Model {
    /// Statements that change the elements.
    changes: String,
    /// Expressions of the outputs, a line each.
    outputs: String,
    /// Names from `slipfit_core::law`.
    laws: Vec<&'static str>,
}

/// The unit of `mechanism`; `core` is where slipfit-core lies.
///
/// # Errors
/// If the mechanism has no run, see [`RunError`].
pub fn mechanism_unit(mechanism: &Mechanism, core: &Path) -> Result<Unit, RunError> {
    use Causality::Fixed;
    if let Some(what) = unsupported(mechanism) {
        return Err(RunError::NoUnit(what));
    }
    let hash = ByDrive::new(mechanism, 0).map_or(0, |driven| driven.hash());
    let token = super::token(hash, &mechanism.controller);
    let mut variables = Variables::default();
    let mut model = Model::default();
    variables.set(Fixed, "n", "1", 0.0, super::LEVEL);
    let mut gaps = Vec::new();
    for (i, gap) in mechanism.gaps.iter().enumerate() {
        let name = &gap.name;
        let what = format!("gap {name} at level 0 as drawn");
        let mean = variables.set(Fixed, format!("gap.{name}"), "m", gap.statistics.mean, what);
        let deviation = format!("kernel::GAPS[{i}][1] as f32");
        gaps.push(model::gap(name, &mean, &deviation, mechanism.allowed_gap(i)));
    }
    let elements = element_paths(mechanism)?;
    let joints: Vec<_> = elements.iter().filter_map(|(at, joint)| Some((at.as_str(), (*joint)?))).collect();
    set_gaps(&joints, &gaps, &mut model);
    set_friction(&joints, &mut variables, &mut model);
    let first = elements.len() - mechanism.drives.len();
    let drives: Vec<_> = elements[first..].iter().map(|(at, _)| at.as_str()).zip(&mechanism.drives).collect();
    set_drives(&drives, &mut variables, &mut model);
    read_drives(mechanism, &drives, &mut variables, &mut model);
    read_bodies(mechanism, &mut variables, &mut model);
    read_joints(mechanism, &joints, &mut variables, &mut model);
    super::add_report(&mut variables, &mut model.outputs);

    let variables = variables.all();
    let source = source(&token, mechanism, &variables, model);
    Ok(Unit {
        title: mechanism.title.clone(),
        token,
        step: mechanism.controller.step,
        duration: mechanism.run.duration,
        variables,
        kernel: mechanism_crate(mechanism, "kernel", Some(core))?,
        model: source,
    })
}

/// What there is in `mechanism` that a unit cannot set.
fn unsupported(mechanism: &Mechanism) -> Option<String> {
    let walls = mechanism.joints.iter().find(|joint| !joint.walls.is_parallel());
    let walls = walls.map(|joint| format!("walls that slope or bow, as \"{}\" has", joint.name));
    let is_more = |named: &&NamedDrive| {
        let has_command = named.command.is_some() || named.sampling.is_some() || named.is_prescribed;
        has_command || named.train_in(mechanism).is_some()
    };
    let drive = mechanism.drives.iter().find(is_more);
    walls.or(drive.map(|named| format!("a drive with more than a gain and a ramp, as \"{}\" has", named.name)))
}

fn set_gaps(joints: &[(&str, &Joint)], gaps: &[String], model: &mut Model) {
    use JointKind::{Bearing, Guide, Journal, Stop, Track};
    for (at, joint) in joints {
        let mut change = |field: &str, gap: usize| {
            let _ = writeln!(model.changes, "        elements{at}.law.{field} = {};", gaps[gap]);
        };
        match &joint.kind {
            Journal { gap, .. } | Bearing { gap, .. } => change("clearance", *gap),
            Guide { gap, .. } | Stop { gap, .. } => change("gap", *gap),
            Track { gaps } => {
                for (wall, gap) in gaps.iter().enumerate() {
                    if let Some(gap) = gap {
                        change(&format!("gaps[{wall}]"), *gap);
                    }
                }
            }
            _ => {}
        }
    }
}

/// One coefficient for all contacts where the scene has one for all, else one a joint.
fn set_friction(joints: &[(&str, &Joint)], variables: &mut Variables, model: &mut Model) {
    // Friction with several numbers stays as the scene has it.
    let coulomb = |joint: &Joint| match joint.laws.friction {
        SlidingData::Coulomb(data) if data.coefficient() != 0.0 => Some(data),
        _ => None,
    };
    let frictional = joints.iter().filter_map(|(at, joint)| Some((at, joint, coulomb(joint)?)));
    let frictional: Vec<_> = frictional.collect();
    let Some((.., first)) = frictional.first() else { return };
    let is_one = frictional.iter().all(|(.., data)| data.coefficient() == first.coefficient());
    let mut known: Vec<(&str, String)> = Vec::new();
    for (at, joint, data) in frictional {
        let of = if is_one { "" } else { joint.name.as_str() };
        let value = match known.iter().find(|(name, _)| *name == of) {
            Some((_, value)) => value.clone(),
            None => {
                let (name, what) = if is_one {
                    ("friction.coefficient".to_owned(), "coefficient of friction of all contacts".to_owned())
                } else {
                    (format!("friction.coefficient.{of}"), format!("coefficient of friction in the joint {of}"))
                };
                let value = variables.set(Causality::Tunable, name, "1", data.coefficient(), what);
                known.push((of, value.clone()));
                value
            }
        };
        let (law, made) = model::friction(data, Some(&value));
        model.laws.push(law);
        let _ = writeln!(model.changes, "        elements{at}.law.contact.friction = {made};");
    }
}

fn set_drives(drives: &[(&str, &NamedDrive)], variables: &mut Variables, model: &mut Model) {
    for (at, NamedDrive { action, drive, name, .. }) in drives {
        let (unit, what) = (action.kind().choose("N.s/m", "N.m.s/rad"), format!("gain of the drive {name}"));
        let gain = variables.set(Causality::Tunable, format!("gain.{name}"), unit, drive.gain, what);
        let _ = writeln!(model.changes, "        elements{at}.law.0.gain = {gain} as f32;");
    }
    for (at, NamedDrive { action, drive, name, .. }) in drives {
        let (unit, what) = (action.kind().choose("m/s", "rad/s"), format!("{} of the drive {name}", model::COMMAND));
        let speed = variables.set(Causality::Input, format!("command.{name}"), unit, drive.speed, what);
        model.changes.push_str(&model::command(&format!("elements{at}.law.0"), &speed));
    }
    for (at, _) in drives {
        let _ = writeln!(model.changes, "        elements{at}.law.0 = elements{at}.law.0.checked()?;");
    }
}

fn read_drives(mechanism: &Mechanism, drives: &[(&str, &NamedDrive)], variables: &mut Variables, model: &mut Model) {
    for ((at, drive), function) in drives.iter().zip(drive_names(mechanism)) {
        let (kind, name) = (drive.action.kind(), &drive.name);
        let now = format!("kernel::{function}(unit, t, pose, velocity)");
        let effort = kind.effort();
        variables.output(format!("{effort}.{name}"), kind.choose("N", "N.m"), format!("{effort} of the drive {name}"));
        variables.output(
            format!("speed.{name}"),
            kind.choose("m/s", "rad/s"),
            format!("speed that the drive {name} goes by"),
        );
        let _ = writeln!(model.outputs, "            f64::from({now}.effort),\n            f64::from({now}.speed),");
        let path = if mechanism.planar {
            let seen = format!("seen(unit.bodies(), pose, velocity, &unit.elements(){at})");
            match drive.action {
                Action::Turns { .. } => format!("{seen}[0]"),
                Action::Pushes { .. } => {
                    let drawn = format!("seen(unit.bodies(), &drawn, velocity, &unit.elements(){at})");
                    format!("{seen}[1] - {drawn}[1]")
                }
            }
        } else {
            let place = body(mechanism, drive.body);
            match drive.action {
                Action::Turns { axis } => {
                    let [x, y, z] = axis.map(|component| format!("{component:?}f64 as f32"));
                    let turned = if mechanism.has_ideal_joints_in_space() {
                        format!("quaternion(&{place}.to_frame)")
                    } else {
                        format!(
                            "[{place}.orientation.w, {place}.orientation.v.x, {place}.orientation.v.y, {place}.orientation.v.z]"
                        )
                    };
                    format!("turn_about({turned}, [{x}, {y}, {z}])")
                }
                Action::Pushes { axis } => {
                    let part = |(name, component): (&str, f64)| {
                        format!("{place}.displacement_w.{name} * {component:?}f64 as f32")
                    };
                    ["x", "y", "z"].into_iter().zip(axis).map(part).collect::<Vec<_>>().join(" + ")
                }
            }
        };
        let (name, what) = kind.choose(
            (format!("travel.{name}"), "how far the body of the drive has come along it from the drawn pose"),
            (format!("angle.{name}"), "how far the body of the drive has turned, −π to π"),
        );
        variables.output(name, kind.choose("m", "rad"), what);
        let _ = writeln!(model.outputs, "            f64::from({path}),");
    }
}

/// The body `i` of a mechanism in space, where it is.
fn body(mechanism: &Mechanism, i: usize) -> String {
    if mechanism.has_ideal_joints_in_space() {
        format!("unit.bodies().placed(pose, velocity).free.bodies[{i}]")
    } else {
        format!("pose[{i}]")
    }
}

/// Where bodies in space are.
fn read_bodies(mechanism: &Mechanism, variables: &mut Variables, model: &mut Model) {
    if mechanism.planar {
        return;
    }
    for (i, of) in mechanism.bodies.iter().enumerate() {
        for axis in ["x", "y", "z"] {
            let what = format!("displacement of the centre of mass of {} along {axis}", of.name);
            variables.output(format!("{axis}.{}", of.name), "m", what);
            let place = body(mechanism, i);
            let _ = writeln!(model.outputs, "            f64::from({place}.displacement_w.{axis}),");
        }
    }
}

/// How far contacts are from touching.
fn read_joints(mechanism: &Mechanism, joints: &[(&str, &Joint)], variables: &mut Variables, model: &mut Model) {
    use JointKind::{Bearing, Guide, Journal, Stop, Track};
    for (k, (at, joint)) in joints.iter().enumerate() {
        let element = format!("unit.elements(){at}");
        let seen = if mechanism.has_ideal_joints_in_space() { "seen_free" } else { "seen" };
        let seen = format!("let place = {seen}(unit.bodies(), pose, velocity, &{element});");
        let mut output = |name: String, distance: String| {
            let what = format!("gap {name} now; negative where the parts penetrate");
            variables.output(format!("distance.{name}"), "m", what);
            let _ = writeln!(
                model.outputs,
                "            {{\n                {seen}\n                f64::from({distance})\n            }},"
            );
        };
        // Joints of several contacts have them numbered.
        let same = joints.iter().filter(|(_, other)| other.name == joint.name).count();
        let number = 1 + joints[..k].iter().filter(|(_, other)| other.name == joint.name).count();
        let name = if same > 1 { format!("{} {number}", joint.name) } else { joint.name.clone() };
        match &joint.kind {
            Journal { .. } | Bearing { .. } => {
                output(name, format!("{element}.law.clearance - (place[0] * place[0] + place[1] * place[1]).sqrt()"));
            }
            Guide { .. } => output(name, format!("{element}.law.gap + place[0]")),
            Stop { .. } if mechanism.planar => output(name, format!("{element}.law.gap + place[0]")),
            Stop { .. } => {
                output(
                    name,
                    format!("{element}.law.gap + {element}.law.sign * {element}.law.axis.of(place.data.0[0])"),
                );
            }
            Track { gaps } => {
                for (wall, (gap, offset)) in
                    gaps.iter().zip(["+ place[0]", "- place[0]", "- place[1]", "+ place[1]"]).enumerate()
                {
                    if let Some(gap) = gap {
                        output(mechanism.gaps[*gap].name.clone(), format!("{element}.law.gaps[{wall}] {offset}"));
                    }
                }
            }
            _ => {}
        }
    }
}

/// Functions that the outputs use.
const MEASURES: &str = "\
/// What the link of an element sees in `pose`.
#[allow(dead_code)]
fn seen<B, L, W, const R: usize, const D: usize>(
    bodies: &B,
    pose: &B::Pose,
    velocity: &SVector<f32, D>,
    element: &Element<L, W, R>,
) -> SVector<f32, R>
where
    B: Bodies<f32, D>,
    L: Link<f32, B, D, R>,
{
    let placed = bodies.placed(pose, velocity);
    let view = element.link.view(bodies, &placed);
    element.link.seen((bodies, &placed), &view).place
}

/// The same of bodies on joints.
#[allow(dead_code)]
fn seen_free<B, L, W, const R: usize, const D: usize, const F: usize>(
    bodies: &B,
    pose: &B::Pose,
    velocity: &SVector<f32, D>,
    element: &Element<L, W, R>,
) -> SVector<f32, R>
where
    B: Reduced<f32, D, F>,
    L: Link<f32, B::Free, F, R>,
{
    let placed = bodies.placed(pose, velocity);
    let free = bodies.free(&placed);
    element.link.seen(free, &element.link.view(free.0, free.1)).place
}

/// The quaternion of a rotation, real part first.
#[allow(dead_code)]
fn quaternion(turn: &slipfit_core::SMatrix<f32, 3, 3>) -> [f32; 4] {
    let part = |sum: f32| 0.5 * libm::sqrtf(if sum > 0.0 { sum } else { 0.0 });
    let [x, y, z] = [turn[(0, 0)], turn[(1, 1)], turn[(2, 2)]];
    let signed = |size: f32, sign: f32| libm::copysignf(size, sign);
    [
        part(1.0 + x + y + z),
        signed(part(1.0 + x - y - z), turn[(2, 1)] - turn[(1, 2)]),
        signed(part(1.0 - x + y - z), turn[(0, 2)] - turn[(2, 0)]),
        signed(part(1.0 - x - y + z), turn[(1, 0)] - turn[(0, 1)]),
    ]
}

/// How far a body has turned about an axis of unit length (rad), by its quaternion.
#[allow(dead_code)]
fn turn_about([w, a, b, c]: [f32; 4], [x, y, z]: [f32; 3]) -> f32 {
    2.0 * libm::atan2f(a * x + b * y + c * z, w)
}
";

fn source(token: &str, mechanism: &Mechanism, variables: &[super::Variable], model: Model) -> String {
    let constants = model::constants(token, mechanism.controller.step, variables);
    let Model { changes, outputs, mut laws } = model;
    laws.sort_unstable();
    laws.dedup();
    let laws = if laws.is_empty() { String::new() } else { format!(", law::{{{}}}", laws.join(", ")) };
    let gap = if mechanism.gaps.is_empty() { "" } else { ", gap" };
    format!(
        "{constants}use slipfit_core::{{SVector, kernel::{{Kernel, Report}}{laws}, system::{{Bodies, Element, Link, Reduced, System}}}};\n\n\
         use crate::instance::{{Trouble{gap}}};\n\n\
         /// The kernel of some values.\n#[derive(Clone, Copy)]\npub struct Model(kernel::Parameters);\n\n\
         impl Model {{\n    #[allow(unused_variables)]\n    pub fn new(values: &[f64; VALUES], set_while_stepping: &[bool; VALUES]) -> Result<Self, Trouble> {{\n        \
         let unit = kernel::unit::<f32>(values[0] as f32)?;\n        \
         #[allow(unused_mut)]\n        let mut elements = *unit.elements();\n{changes}        \
         Ok(Self(Kernel::new(System::new(*unit.bodies(), elements), kernel::STEP)?))\n    }}\n\n    \
         /// Where it starts.\n    pub fn start(&self) -> State {{\n        kernel::at_start(&self.0)\n    }}\n\n    \
         pub fn step(&self, state: &mut State) -> Report<f32> {{\n        kernel::step(&self.0, state)\n    }}\n\n    \
         #[allow(unused_variables)]\n    \
         pub fn outputs(&self, state: &State, report: &Report<f32>) -> [f64; OUTPUTS] {{\n        \
         let (unit, t) = (self.0.mechanism(), self.0.time(state.steps));\n        \
         let (pose, velocity) = (&state.motion.pose, &state.motion.velocity);\n        \
         let (drawn, _) = kernel::start::<f32>();\n        [\n{outputs}        ]\n    }}\n}}\n\n{MEASURES}"
    )
}
