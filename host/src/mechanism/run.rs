//! One unit of any mechanism: by the desk in error-controlled steps, or by its controller's in steps of one length.

use std::time::Instant;

use slipfit_core::{
    SVector,
    pose::Pose,
    system::{System, ThroughJoints, planar::PlanarTree, spatial::tree::Mount},
};
use slipfit_desk::{
    out_of_line::OutOfLine,
    plant::{Allowed, FreePlant, JointedPlant, PlanarPlant, Plant, Reported},
    side_by_side::SideBySide,
};

use super::{
    Mechanism, Mounts, Rest, RunError,
    bends::bends,
    columns::JointedBodies,
    element::PlanarElement,
    joint_elements::joints_of_elements,
    kinematics::{FreeKinematics, JointedKinematics, Kinematics, PlanarKinematics},
    limits::Limits,
    planar,
    record::MechanismRun,
    recorder::{Output, Recorder},
    spatial,
    start::thrown,
    state::half_angle,
};
use crate::setup::ControllerSpec;

/// Runs the unit of `mechanism` with the given `gaps` (m) and tells of it every `every` (s).
///
/// # Errors
/// See [`RunError`].
pub fn run(mechanism: &Mechanism, gaps: &[f64], every: f64) -> Result<MechanismRun, RunError> {
    run_by(mechanism, gaps, By { controller: None, output: Some(Output { every, moments: 0 }) })
}

/// The same with about `count` moments of the motion, half of them evenly spread over the steps, which are short where much
/// happens, and half over the time.
///
/// # Errors
/// See [`RunError`].
pub fn film(mechanism: &Mechanism, gaps: &[f64], count: usize) -> Result<MechanismRun, RunError> {
    run_by(
        mechanism,
        gaps,
        By { controller: None, output: Some(Output { every: mechanism.run.duration, moments: count }) },
    )
}

/// The same by the steps of its controller, in double precision. Only implicit schemes are known; implicit Euler stands for the
/// others. A narrow stick band stands for true stick, as at the desk.
///
/// # Errors
/// See [`RunError`].
pub fn controller_run(mechanism: &Mechanism, gaps: &[f64], every: f64) -> Result<MechanismRun, RunError> {
    run_by(mechanism, gaps, By { controller: Some(mechanism.controller), output: Some(Output { every, moments: 0 }) })
}

/// The result of the unit of `mechanism` with the given `gaps` (m), without its motion.
///
/// # Errors
/// See [`RunError`].
pub(super) fn run_without_output(mechanism: &Mechanism, gaps: &[f64]) -> Result<MechanismRun, RunError> {
    run_by(mechanism, gaps, By { controller: None, output: None })
}

fn run_by(mechanism: &Mechanism, gaps: &[f64], by: By) -> Result<MechanismRun, RunError> {
    let own = mechanism.with_own_controllers();
    let mechanism = own.as_ref().unwrap_or(mechanism);
    if mechanism.planar {
        let mounts = Mounts::of(mechanism)?;
        match mounts.coordinates().len() {
            ..=3 => in_plane::<3>(mechanism, &mounts, gaps, by),
            _ => in_plane::<6>(mechanism, &mounts, gaps, by),
        }
    } else if let Some(mounts) = spatial::mounts(mechanism)? {
        if mechanism.bodies.len() > spatial::MOST {
            return Err(RunError::Bodies(mechanism.bodies.len()));
        }
        // Not each number for itself: those beyond what the mounts leave stand still and change no bit.
        match spatial::coordinates(&mounts) {
            0..=8 => on_joints::<8>(mechanism, &mounts, gaps, by),
            _ => on_joints::<{ spatial::MOST_COORDINATES }>(mechanism, &mounts, gaps, by),
        }
    } else {
        match mechanism.bodies.len() {
            1 => in_space::<1, 6>(mechanism, gaps, by),
            2 => in_space::<2, 12>(mechanism, gaps, by),
            3 => in_space::<3, 18>(mechanism, gaps, by),
            other => Err(RunError::Bodies(other)),
        }
    }
}

/// Steps and output of a run.
#[derive(Clone, Copy)]
struct By {
    /// A controller's steps; the desk's, if there are none.
    controller: Option<ControllerSpec>,
    /// Samples and moments of the motion; without them outcomes alone.
    output: Option<Output>,
}

/// One unit in a plane, ready to be simulated.
pub(super) struct PlanarUnit<const D: usize> {
    pub tree: PlanarTree<f64, D>,
    pub elements: Vec<PlanarElement<D>>,
    pub limits: Limits,
    /// Pose and rates.
    pub start: ([[f64; 2]; D], SVector<f64, D>),
    places: [f64; D],
}

impl<const D: usize> PlanarUnit<D> {
    /// That of `mechanism` on its `mounts` with these `gaps` (m).
    pub fn new(mechanism: &Mechanism, mounts: &Mounts, gaps: &[f64]) -> Result<Self, RunError> {
        let tree = planar::bodies::<D>(mechanism, mounts)?;
        let limits = Limits::of(mechanism, |body| mounts.turn(Some(body)).map_or(0.0, |turn| tree.lever(turn)));
        let elements = planar::elements::<D>(mechanism, mounts, gaps, limits.stick_band())?;
        let Rest { places, rates } = Rest::of(mechanism, mounts);
        Ok(Self { tree, elements, limits, start: (tree.pose(places, half_angle), rates.into()), places })
    }

    /// Its kinematics.
    pub fn kinematics<'a>(&'a self, mechanism: &Mechanism, mounts: &Mounts) -> PlanarKinematics<'a, D> {
        PlanarKinematics::new(mechanism, mounts, &self.tree, &self.elements, self.places)
    }
}

fn in_plane<const D: usize>(
    mechanism: &Mechanism,
    mounts: &Mounts,
    gaps: &[f64],
    by: By,
) -> Result<MechanismRun, RunError>
where
    for<'a> PlanarPlant<'a, D>: Plant<D, Pose = [[f64; 2]; D]>,
{
    let unit = PlanarUnit::<D>::new(mechanism, mounts, gaps)?;
    let desk = OutOfLine::new(System::new(unit.tree, &unit.elements[..]));
    solve(mechanism, desk, unit.start, (&unit.limits, Box::new(unit.kinematics(mechanism, mounts))), by)
}

fn in_space<const N: usize, const D: usize>(
    mechanism: &Mechanism,
    gaps: &[f64],
    by: By,
) -> Result<MechanismRun, RunError>
where
    for<'a> FreePlant<'a, N, D>: Plant<D, Pose = [Pose<f64>; N]>,
{
    let bodies = spatial::bodies::<N, D>(mechanism)?;
    let limits = Limits::of(mechanism, |body| bodies.lever(body));
    let elements = spatial::elements(mechanism, gaps, limits.stick_band())?;
    let (mut poses, mut rates) = (bodies.nominal(), [0.0; D]);
    for (k, (pose, velocity)) in thrown(mechanism).into_iter().enumerate() {
        poses[k] = pose;
        rates[6 * k..6 * k + 6].copy_from_slice(&velocity);
    }
    let laws = joints_of_elements(mechanism).map(|joint| joint.map(|joint| joint.laws));
    let contacts = SideBySide::new(&bodies, &elements, laws, limits.stick_band());
    let desk = OutOfLine::by(System::new(bodies, &elements[..]), contacts);
    solve(mechanism, desk, (poses, rates.into()), (&limits, Box::new(FreeKinematics::new(&bodies, &elements))), by)
}

fn on_joints<const D: usize>(
    mechanism: &Mechanism,
    mounts: &[Mount<f64>],
    gaps: &[f64],
    by: By,
) -> Result<MechanismRun, RunError>
where
    for<'a> JointedPlant<'a, D>: Plant<D, Pose = [[f64; 2]; D]>,
{
    let tree = spatial::tree::<{ spatial::MOST }, { 6 * spatial::MOST }, D>(mechanism, mounts)?;
    let bodies = JointedBodies::new(mechanism.bodies.len(), tree);
    let limits = Limits::of(mechanism, |body| bodies.lever(body));
    let elements = spatial::elements(mechanism, gaps, limits.stick_band())?;
    let Rest { places, rates } = Rest::on_joints(mechanism, mounts);
    let start = (tree.pose(places, half_angle), rates.into());
    let desk = OutOfLine::new(System::new(tree, ThroughJoints(&elements[..])));
    let told = Box::new(JointedKinematics::new(&tree, &elements, &bodies, places));
    solve(mechanism, desk, start, (&limits, told), by)
}

fn solve<P: Plant<D>, const D: usize>(
    mechanism: &Mechanism,
    desk: P,
    start: (P::Pose, SVector<f64, D>),
    (limits, told): (&Limits, Box<dyn Kinematics<P::Pose, D> + '_>),
    by: By,
) -> Result<MechanismRun, RunError> {
    let least_mass = desk.least_mass();
    let mut recorder = Recorder::new(mechanism, told, &start, limits, by.output.is_some());
    let (duration, bends) = (mechanism.run.duration, bends(mechanism));
    let mut keep = |t: f64, motion: &_, accelerations, gap| recorder.keep(t, motion, accelerations, gap);
    let clock = Instant::now();
    let effort = match by.controller {
        None => {
            let error = |step: Reported, length: f64| limits.error(&step, length, least_mass);
            desk.by_desk(start, duration, Allowed { error: &error, depth: limits.place(), bends: &bends }, &mut keep)
        }
        Some(ControllerSpec { step, integrator, .. }) => {
            desk.by_controller(start, duration, (integrator, step), &mut keep)
        }
    };
    Ok(recorder.finished(effort, clock.elapsed(), by.output)?)
}
