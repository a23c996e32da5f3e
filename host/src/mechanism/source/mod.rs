//! A mechanism as Rust source for firmware: its composed type and a function that makes it.
//!
//! What is written is what [`run`](super::run) computes with, element by element in the same order, so that the type gives the
//! same bits in f64.

mod expression;
mod laws;
mod parts;
mod planar;
mod spatial;

use std::fmt::Write;

use slipfit_desk::scheme::IntegratorKind;

use super::{Joint, Mechanism, RunError, hash::hash, joint_elements::joints_of_elements};
use expression::{grouped, nested, typed};
use laws::Contacts;
use parts::Parts;

fn parts(mechanism: &Mechanism, contacts: &mut Contacts) -> Result<Parts, RunError> {
    if mechanism.planar { planar::parts(mechanism, contacts) } else { spatial::parts(mechanism, contacts) }
}

/// What there is in `mechanism` that no kernel has.
fn unsupported(mechanism: &Mechanism) -> Option<String> {
    mechanism.drives.iter().find_map(|named| {
        let what = match named {
            named if named.sampling.is_some() => "a controller that samples",
            named if named.is_prescribed => "a prescribed motion",
            named if named.command.as_ref().is_some_and(|command| command.is_recorded) => "a recorded command",
            _ => return None,
        };
        Some(format!("{what}, as the drive \"{}\" has", named.name))
    })
}

/// A Rust module with the type `Unit` of `mechanism`, its gaps over the production as `GAPS`, `unit(n)` and the kernel `predictor(n)`.
///
/// # Errors
/// If the mechanism has no run, see [`RunError`].
pub fn rust_source(mechanism: &Mechanism) -> Result<String, RunError> {
    if let Some(what) = unsupported(mechanism) {
        return Err(RunError::NoKernel(what));
    }
    let mut contacts = Contacts::default();
    let parts = parts(mechanism, &mut contacts)?;
    let Parts { head, dimension, bodies, elements, module, pose, rates, .. } = &parts;
    let drives = write_drives(mechanism, &parts);
    let mut elements = nested(grouped(elements));
    if let Some(width) = parts.through_joints {
        elements =
            typed(format!("ThroughJoints<{}, {width}>", elements.of), format!("ThroughJoints({})", elements.value));
    }
    let through = if parts.through_joints.is_some() { ", ThroughJoints" } else { "" };
    let title = mechanism.title.split_whitespace().collect::<Vec<_>>().join(" ");
    let (scheme, scheme_type) = scheme(mechanism.controller.integrator);
    let list = |names: &[&'static str]| {
        let mut names = names.to_vec();
        names.sort_unstable();
        names.dedup();
        names.join(", ")
    };
    let mut laws = parts.laws.clone();
    let clearance = if mechanism.gaps.is_empty() { "" } else { "    clearance::GapStatistics,\n" };
    let drive = match &list(&parts.drives)[..] {
        "" => String::new(),
        "Drive" => "    drive::Drive,\n".to_owned(),
        several => format!("    drive::{{{several}}},\n"),
    };
    let poses = if pose.of.contains("Pose") { "    pose::Pose,\n" } else { "" };
    let vectors = if parts.drives.contains(&"Drive") { "Vector2, Vector3" } else { "Vector2" };
    let vectors = if *module == "planar" { vectors } else { "Vector3" };
    let driving = if mechanism.drives.is_empty() { "" } else { "Driving, " };
    let mut core_laws = String::new();
    if !contacts.is_empty() {
        laws.push("Contact");
        core_laws = format!("    law::{{{}}},\n", list(&contacts.names()));
    }
    let mut text = format!(
        "// {title}: a mechanism for firmware, to be compiled against slipfit-core. SI units.\n\n\
         use slipfit_core::{{\n    ParameterError, SVector, Scalar, {vectors},\n{clearance}{drive}    \
         integrator::{scheme},\n    kernel::{{Kernel, StateOf}},\n{core_laws}{poses}    system::{{\n        {driving}Element, System{through},\n        \
         law::{{{}}},\n        {module}::{{{}}},\n    }},\n}};\n\n\
         /// Number of coordinates.\npub const DIMENSION: usize = {dimension};\n\n\
         /// Step (s).\npub const STEP: f32 = {:?};\n\n/// Steps of the scene's run.\npub const STEPS: u32 = {};\n\n/// The scheme.\npub type Scheme = {scheme_type};\n\n{head}",
        list(&laws),
        list(&parts.names),
        mechanism.controller.step as f32,
        (mechanism.run.duration / mechanism.controller.step).round(),
    );
    write_hashes(&mut text, mechanism);
    let _ = write!(
        text,
        "/// The bodies.\npub type Bodies<S> = {};\n\n/// What acts on them.\npub type Elements<S> = {};\n\n\
         /// A unit's type: what the mechanism does not have leaves no code.\npub type Unit<S> = System<Bodies<S>, Elements<S>>;\n\n",
        bodies.of, elements.of
    );
    write_gaps(&mut text, mechanism);
    let _ = write!(
        text,
        "/// The unit of tolerance level `n`.\n///\n/// # Errors\n/// If a gap at that level, or another parameter, is out of bounds.\n\
         pub fn unit<S: Scalar + PartialOrd>({}: S) -> Result<Unit<S>, ParameterError<S>> {{\n    let s = S::from_f64;\n{}",
        if mechanism.gaps.is_empty() { "_" } else { "n" },
        gaps_at_level(mechanism)
    );
    let _ = write!(
        text,
        "{}    let bodies = {};\n    let elements = {};\n    Ok(System::new(bodies, elements))\n}}\n\n",
        contacts.made(),
        bodies.value,
        elements.value
    );
    let rates: Vec<_> = rates.iter().map(|rate| format!("s({rate:?})")).collect();
    let _ = write!(
        text,
        "/// Where and how fast the unit starts: pose and generalised velocities.\n\
         pub fn start<S: Scalar>() -> ({}, SVector<S, {dimension}>) {{\n    let s = S::from_f64;\n    \
         let pose = {};\n    (pose, SVector::from([{}]))\n}}\n\n\
         /// A kernel and the state that it steps.\n\
         pub type Predictor = (Kernel<f32, Unit<f32>, Scheme>, StateOf<f32, Unit<f32>, {dimension}>);\n\n\
         /// The state of a unit's `kernel` at the start.\n\
         pub fn at_start(kernel: &Kernel<f32, Unit<f32>, Scheme>) -> StateOf<f32, Unit<f32>, {dimension}> {{\n    \
         let (pose, velocity) = start();\n    let mut state = kernel.at_rest(pose);\n    \
         state.motion.velocity = velocity;\n    state\n}}\n\n\
         /// The kernel of the unit of tolerance level `n` and its state at the start.\n///\n/// # Errors\n\
         /// If a gap at that level, or another parameter, is out of bounds.\n\
         pub fn predictor(n: f32) -> Result<Predictor, \
         ParameterError<f32>> {{\n    let kernel = Kernel::new(unit(n)?, STEP)?;\n    \
         let state = at_start(&kernel);\n    Ok((kernel, state))\n}}\n",
        pose.of,
        pose.value,
        rates.join(", ")
    );
    text.push_str(&drives);
    Ok(text)
}

/// Adds what the flash tables of the drives are stamped with.
fn write_hashes(text: &mut String, mechanism: &Mechanism) {
    let hashes: Vec<_> = (0..mechanism.drives.len()).map(|drive| format!("{:#018x}", hash(mechanism, drive))).collect();
    let _ = match &hashes[..] {
        [] => Ok(()),
        [one] => write!(
            text,
            "/// What a flash table of this mechanism is stamped with: it must be equal before a lookup is trusted.\n\
             pub const SCENE_HASH: u64 = {one};\n\n"
        ),
        all => write!(
            text,
            "/// What a flash table of each drive is stamped with: it must be equal before a lookup is trusted.\n\
             pub const SCENE_HASHES: [u64; {}] = [{}];\n\n",
            all.len(),
            all.join(", ")
        ),
    };
}

/// Functions for each drive that evaluate it and set its command. Drives are the last elements.
fn write_drives(mechanism: &Mechanism, parts: &Parts) -> String {
    let first = parts.elements.len() - mechanism.drives.len();
    let paths = parts.paths();
    let driving = if parts.through_joints.is_some() { "driving_through_joints" } else { "driving" };
    let mut text = String::new();
    for ((at, drive), name) in paths[first..].iter().zip(&mechanism.drives).zip(drive_names(mechanism)) {
        let kind = drive.action.kind();
        let _ = write!(
            text,
            "\n/// Speed ({}) and {} ({}) of the drive {:?} at time `t` (s).\n\
             pub fn {name}<S: Scalar>(unit: &Unit<S>, t: S, pose: &{}, velocity: &SVector<S, DIMENSION>) -> Driving<S> {{\n    \
             unit.{driving}(&unit.elements(){at}, t, pose, velocity)\n}}\n\n\
             /// From now on the commanded speed ({}) of the drive {:?} is `speed`, in place of the scene's, until another one is set.\n\
             pub fn {}<S: Scalar>(unit: &mut Unit<S>, speed: S) {{\n    \
             slipfit_core::drive::Commandable::set_command(&mut unit.elements_mut(){at}.law.0, speed);\n}}\n",
            kind.choose("m/s", "rad/s"),
            kind.effort(),
            kind.effort_unit(),
            drive.name,
            parts.pose.of,
            kind.choose("m/s", "rad/s"),
            drive.name,
            command_name(&name),
        );
    }
    text
}

/// Where in a unit's `elements()` those of the joints with play, the springs and the drives are, in this order, each with its joint.
///
/// # Errors
/// If the mechanism has no run, see [`RunError`].
pub fn element_paths(mechanism: &Mechanism) -> Result<Vec<(String, Option<&Joint>)>, RunError> {
    let parts = parts(mechanism, &mut Contacts::default())?;
    Ok(parts.paths().into_iter().zip(joints_of_elements(mechanism)).collect())
}

/// How many coordinates a kernel of `mechanism` has.
///
/// # Errors
/// If the mechanism has no run, see [`RunError`].
pub fn dimension(mechanism: &Mechanism) -> Result<usize, RunError> {
    Ok(parts(mechanism, &mut Contacts::default())?.dimension)
}

/// The name of the function that sets the command of the drive whose function is called `drive_name`.
pub fn command_name(drive_name: &str) -> String {
    drive_name.replacen("drive", "command", 1)
}

/// What the functions of the drives are called; those that would be called the same have their number.
pub fn drive_names(mechanism: &Mechanism) -> Vec<String> {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
    let plain: Vec<String> =
        mechanism.drives.iter().map(|drive| "drive_".chars().chain(drive.name.chars().map(letter)).collect()).collect();
    let is_double = |name: &String| plain.iter().filter(|other| *other == name).count() > 1;
    plain
        .iter()
        .enumerate()
        .map(|(k, name)| if is_double(name) { format!("{name}_{k}") } else { name.clone() })
        .collect()
}

/// The gaps of level `n`, none below what its joint allows.
fn gaps_at_level(mechanism: &Mechanism) -> String {
    if mechanism.gaps.is_empty() {
        return String::new();
    }
    let gap = |i| format!("gap(GAPS[{i}], {:?})?", mechanism.allowed_gap(i)[0]);
    format!(
        "    let gap = |[mean, deviation]: [f64; 2], least| GapStatistics {{ mean: s(mean), deviation: s(deviation) }}.checked_at(n, least);\n    \
         let gaps = [{}];\n",
        (0..mechanism.gaps.len()).map(gap).collect::<Vec<_>>().join(", ")
    )
}

/// Adds the gaps over the production.
fn write_gaps(text: &mut String, mechanism: &Mechanism) {
    if mechanism.gaps.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "/// Gaps over the production, mean and standard deviation (m).\npub const GAPS: [[f64; 2]; {}] = [",
        mechanism.gaps.len()
    );
    for gap in &mechanism.gaps {
        let _ = writeln!(text, "    [{:?}, {:?}], // {}", gap.statistics.mean, gap.statistics.deviation, gap.name);
    }
    text.push_str("];\n\n");
}

/// Name and type of a scheme in core.
pub(crate) fn scheme(kind: IntegratorKind) -> (&'static str, &'static str) {
    match kind {
        IntegratorKind::SemiImplicitEuler => ("SemiImplicitEuler", "SemiImplicitEuler"),
        IntegratorKind::RungeKutta4 => ("RungeKutta4", "RungeKutta4"),
        IntegratorKind::Rodas3 => ("Rodas3", "Rodas3"),
        IntegratorKind::Rodas4 => ("Rodas4", "Rodas4"),
        IntegratorKind::LinearlyImplicitEuler => ("ImplicitEuler", "ImplicitEuler<1>"),
        IntegratorKind::ImplicitEuler => ("ImplicitEuler", "ImplicitEuler<4>"),
        IntegratorKind::Sdirk2 => ("Sdirk2", "Sdirk2<4>"),
        IntegratorKind::Extrapolated => ("Extrapolated", "Extrapolated<2, 4>"),
    }
}
