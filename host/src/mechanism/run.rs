//! One unit of any mechanism: by the desk in error-controlled steps, or by its controller's in steps of one length.

use std::{ops::ControlFlow, time::Instant};

use slipfit_core::{
    SVector,
    integrator::Motion,
    pose::Pose,
    system::{Bodies, Reduced, System, ThroughJoints, spatial::tree::Mount},
};
use slipfit_desk::{
    closing::Gaps,
    out_of_line::OutOfLine,
    plant::{Allowed, FreePlant, JointedPlant, PlanarPlant, Plant, Reported},
    side_by_side::SideBySide,
};

use super::{
    Mechanism, Mounts, NamedDrive, Rest, RunError,
    bends::bends,
    columns::{self, BodyMotion, JointedBodies, PlanarBodies},
    energy::Energies,
    joint_elements::joints_of_elements,
    limits::Limits,
    planar,
    record::{MechanismRun, Moment, Samples},
    sampler::Sampler,
    spatial,
    start::thrown,
    state::{State, half_angle},
    sunk::{self, Depths},
};
use crate::{
    dynamics::{
        effort::Effort,
        error_control::{self, Accelerations, Knot, Stopped, sampled},
        film::chosen,
        looks::{Place, end, looks, samples},
        observer::{Instant as Looked, Observer},
        outcome::{Outcome, Verdict, has_run_away},
        trajectory::Trajectory,
    },
    setup::{ControllerSpec, RunSpec},
};

/// Runs the unit of `mechanism` with the given `gaps` (m) and tells of it every `every` (s).
///
/// # Errors
/// See [`RunError`].
pub fn run(mechanism: &Mechanism, gaps: &[f64], every: f64) -> Result<MechanismRun, RunError> {
    run_by(mechanism, gaps, By { every, controller: None, moments: 0 })
}

/// The same with about `count` moments of the motion, half of them evenly spread over the steps, which are short where much
/// happens, and half over the time.
///
/// # Errors
/// See [`RunError`].
pub fn film(mechanism: &Mechanism, gaps: &[f64], count: usize) -> Result<MechanismRun, RunError> {
    run_by(mechanism, gaps, By { every: mechanism.run.duration, controller: None, moments: count })
}

/// The same by the steps of its controller, in double precision. Only implicit schemes are known; implicit Euler stands for the
/// others. A narrow stick band stands for true stick, as at the desk.
///
/// # Errors
/// See [`RunError`].
pub fn controller_run(mechanism: &Mechanism, gaps: &[f64], every: f64) -> Result<MechanismRun, RunError> {
    run_by(mechanism, gaps, By { every, controller: Some(mechanism.controller), moments: 0 })
}

fn run_by(mechanism: &Mechanism, gaps: &[f64], by: By) -> Result<MechanismRun, RunError> {
    let own = mechanism.with_own_controllers();
    let mechanism = own.as_ref().unwrap_or(mechanism);
    if mechanism.planar {
        let mounts = Mounts::of(mechanism)?;
        match mounts.coordinates().len() {
            1 => in_plane::<1>(mechanism, &mounts, gaps, by),
            2 => in_plane::<2>(mechanism, &mounts, gaps, by),
            3 => in_plane::<3>(mechanism, &mounts, gaps, by),
            4 => in_plane::<4>(mechanism, &mounts, gaps, by),
            5 => in_plane::<5>(mechanism, &mounts, gaps, by),
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

/// How a unit is computed and told of.
#[derive(Clone, Copy)]
struct By {
    /// Time (s) between two samples.
    every: f64,
    /// A controller's steps; the desk's, if there are none.
    controller: Option<ControllerSpec>,
    /// Moments that show the motion.
    moments: usize,
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
    let tree = planar::bodies::<D>(mechanism, mounts)?;
    let limits = Limits::of(mechanism, |body| mounts.turn(Some(body)).map_or(0.0, |turn| tree.lever(turn)));
    let elements = planar::elements::<D>(mechanism, mounts, gaps, limits.stick_band())?;
    let Rest { places, rates } = Rest::of(mechanism, mounts);
    let pose = tree.pose(places, half_angle);
    let gaps_at = |pose: &_, velocity: &_| {
        let placed = tree.placed(pose, velocity);
        elements.iter().map(|element| element.gap((&tree, &placed))).collect()
    };
    let topology = *tree.topology();
    let mut last = places;
    let state = move |pose: &[[f64; 2]; D], rates: [f64; D]| {
        let state = State::planar(&topology, pose, rates, &last);
        last = state.places;
        state
    };
    let bodies = PlanarBodies::of(mechanism, mounts, &tree);
    let system = System::new(tree, &elements[..]);
    let desk = OutOfLine::new(system);
    solve(mechanism, desk, (pose, rates), (&limits, gaps_at), by, state, |state: &State<D>, told: &mut _| {
        bodies.tell(state, told)
    })
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
    let start = (poses, rates);
    let gaps_at = |pose: &_, velocity: &_| {
        let placed = bodies.placed(pose, velocity);
        elements.iter().map(|element| element.gap((&bodies, &placed))).collect()
    };
    let laws = joints_of_elements(mechanism).map(|joint| joint.map(|joint| joint.laws));
    let system = System::new(bodies, &elements[..]);
    let desk = OutOfLine::by(system, SideBySide::new(&bodies, &elements, laws, limits.stick_band()));
    let mut last = State::at_rest([0.0; D]);
    let state = move |poses: &[Pose<f64>; N], rates: [f64; D]| {
        last = State::spatial(poses, rates, &last);
        last
    };
    solve(mechanism, desk, start, (&limits, gaps_at), by, state, columns::spatial)
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
    let start = (tree.pose(places, half_angle), rates);
    let gaps_at = |pose: &_, velocity: &_| {
        let placed = tree.placed(pose, velocity);
        elements.iter().map(|element| element.gap(tree.free(&placed))).collect()
    };
    let mut last = State::at_rest(places);
    let state = move |pose: &[[f64; 2]; D], rates: [f64; D]| {
        last = State::on_joints(&tree, pose, rates, &last);
        last
    };
    let system = System::new(tree, ThroughJoints(&elements[..]));
    let desk = OutOfLine::new(system);
    solve(mechanism, desk, start, (&limits, gaps_at), by, state, |state: &State<D>, told: &mut _| {
        bodies.tell(state, told)
    })
}

fn solve<P: Plant<D>, const D: usize>(
    mechanism: &Mechanism,
    desk: P,
    (pose, rates): (P::Pose, [f64; D]),
    (limits, gaps_at): (&Limits, impl Fn(&P::Pose, &SVector<f64, D>) -> Vec<Option<f64>>),
    by: By,
    mut state: impl FnMut(&P::Pose, [f64; D]) -> State<D>,
    told: impl Fn(&State<D>, &mut Vec<BodyMotion>),
) -> Result<MechanismRun, RunError> {
    let least_mass = desk.least_mass();
    // The stroke is the first drive's.
    let of_drive = |k: usize| if k == 0 { mechanism.run } else { RunSpec { stroke: None, ..mechanism.run } };
    // Travel counts from the start, which need not be the drawn pose.
    let mut at_start = Vec::new();
    told(&state(&pose, rates), &mut at_start);
    let pressed = gaps_at(&pose, &SVector::from(rates));
    let mut energies = Energies::new(mechanism, &at_start, pressed.iter().copied());
    let mut depths = Depths::new(pressed);
    let origins: Vec<f64> = mechanism.drives_at(0.0, &at_start).map(|at| at.z).collect();
    let drives_at = |t: f64, motions: &[BodyMotion], drives: &mut Vec<Looked>| {
        let from = |(at, origin): (Looked, &f64)| Looked { z: at.z - origin, ..at };
        drives.clear();
        drives.extend(mechanism.drives_at(t, motions).zip(&origins).map(from));
    };
    let named = mechanism.drives.iter().enumerate();
    let mut observers: Vec<_> = named.map(|(k, named)| Observer::new(named.setpoint(), of_drive(k))).collect();
    let mut there = Vec::new();
    let mut ends = |observers: &[Observer], state: &State<D>| {
        let (Some(first), Some(_)) = (observers.first(), mechanism.run.stroke) else { return false };
        told(state, &mut there);
        let first_drive = mechanism.drives_at(0.0, &there).next();
        first_drive.is_some_and(|at| first.is_at_end(at.z - origins[0]))
    };
    // What runs away does so until no number is large enough: the run ends there.
    let run_away = |t: f64, state: &State<D>| {
        let mut motions = Vec::new();
        told(state, &mut motions);
        let mut drives = mechanism.drives.iter().zip(mechanism.drives_at(t, &motions));
        drives.any(|(named, at)| has_run_away(at.vz, named.drive.speed))
    };
    let mut samplers: Vec<Option<Sampler>> = mechanism.drives.iter().map(Sampler::of).collect();
    let (duration, bends) = (mechanism.run.duration, bends(mechanism));
    let (mut sampled_motions, mut sampled_drives) = (Vec::new(), Vec::new());
    let mut sample = |t: f64, state: &State<D>| {
        if samplers.iter().flatten().any(|sampler| sampler.is_due(t)) {
            told(state, &mut sampled_motions);
            drives_at(t, &sampled_motions, &mut sampled_drives);
            let due = samplers.iter_mut().zip(&sampled_drives).filter_map(|(of, at)| Some((of.as_mut()?, at)));
            due.filter(|(sampler, _)| sampler.is_due(t)).for_each(|(sampler, at)| sampler.sample(*at));
        }
    };
    let mut knots: Vec<Knot<State<D>>> = Vec::new();
    let clock = Instant::now();
    let mut keep = |t: f64, motion: &Motion<f64, P::Pose, (), D>, accelerations: Option<_>, gaps: Option<&Gaps>| {
        if gaps.is_some_and(|gaps| gaps.least() < -sunk::LEAST) {
            depths.observe(gaps_at(&motion.pose, &motion.velocity));
        }
        let values = state(&motion.pose, motion.velocity.into());
        sample(t, &values);
        knots.push(Knot { t, values, rates: accelerations.map(|rates: Accelerations<D>| rates.map(<[f64; D]>::from)) });
        let is_absurd = motion.velocity.iter().any(|rate| rate.abs() > ABSURD) && run_away(t, &values);
        if is_absurd || ends(&observers, &values) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let start = (pose, SVector::from(rates));
    let effort = match by.controller {
        None => {
            let error = |step: Reported, length: f64| limits.error(&step, length, least_mass);
            desk.by_desk(start, duration, Allowed { error: &error, depth: limits.place(), bends: &bends }, &mut keep)
        }
        Some(ControllerSpec { step, integrator, .. }) => {
            desk.by_controller(start, duration, (integrator, step), &mut keep)
        }
    };
    let integration = clock.elapsed();
    let effort = effort.or_else(|stopped| match knots.last() {
        Some(knot) if stopped != Stopped::Interrupted && run_away(knot.t, &knot.values) => {
            Ok(error_control::Effort { accepted: knots.len() as u32 - 1, refused: 0 })
        }
        _ => Err(stopped),
    })?;
    let end = end(&knots, |state| ends(&observers, state));
    let told_at = |knot: &Knot<State<D>>| {
        let mut motions = Vec::with_capacity(mechanism.bodies.len());
        told(&knot.values, &mut motions);
        motions
    };
    let motions: Vec<_> = knots.iter().map(told_at).collect();
    let times: Vec<f64> = knots.iter().map(|knot| knot.t).collect();
    let mut drives = Vec::new();
    // Of each drive its effort, and whether its body ever moves along it.
    let mut at_knots = vec![(Vec::with_capacity(knots.len()), false); mechanism.drives.len()];
    for (knot, motions) in knots.iter().zip(&motions) {
        drives_at(knot.t, motions, &mut drives);
        for ((values, moves), at) in at_knots.iter_mut().zip(&drives) {
            values.push(at.force);
            *moves |= at.vz != 0.0;
        }
    }
    let efforts = mechanism.drives.iter().zip(at_knots).zip(samplers).map(|((named, (values, moves)), sampler)| {
        if let Some(sampler) = sampler {
            return Effort::held(&sampler.into_samples());
        }
        // What other joints hold still has a speed that is known exactly at all times.
        let time_constant = if moves { mechanism.least_inertia(named) / named.drive.gain } else { f64::INFINITY };
        Effort::new(times.clone(), values, time_constant)
    });
    let efforts: Vec<_> = efforts.collect();
    let mut between = Vec::new();
    looks(&knots, end, |t, state, place| {
        let motions = match place {
            Place::At(knot) => &motions[knot],
            Place::Before(_) => {
                told(&state, &mut between);
                &between
            }
        };
        drives_at(t, motions, &mut drives);
        match place {
            Place::At(_) => {
                let mut any = false;
                for (at, effort) in drives.iter_mut().zip(&efforts) {
                    any |= effort.held_before(t).map(|before| at.force = before).is_some();
                }
                // The work up to here is that of what was held.
                if any {
                    energies.observe(t, motions, &drives);
                }
                drives.iter_mut().zip(&efforts).for_each(|(at, effort)| at.force = effort.at_knot(t, at.force));
            }
            Place::Before(knot) => {
                drives.iter_mut().zip(&efforts).for_each(|(at, effort)| at.force = effort.before(knot, t, at.force));
            }
        }
        energies.observe(t, motions, &drives);
        observers.iter_mut().zip(&drives).for_each(|(observer, at)| observer.observe(*at));
    });
    let mut trajectories = vec![Trajectory::default(); mechanism.drives.len()];
    let mut rows = Vec::new();
    let times = samples(end, by.every);
    for (t, state) in times.clone().zip(sampled(&knots, times)) {
        told(&state, &mut between);
        drives_at(t, &between, &mut drives);
        drives.iter_mut().zip(&efforts).for_each(|(at, effort)| at.force = effort.at(t, at.force));
        rows.push(mechanism.row(t, &drives, &between));
        for ((trajectory, named), at) in trajectories.iter_mut().zip(&mechanism.drives).zip(&drives) {
            let place = between[named.body].displacement;
            trajectory.push(t, [at.vz, place.x, place.y, at.z], at.force);
        }
    }
    let before_end: Vec<f64> = knots.iter().map(|knot| knot.t).filter(|t| *t <= end).collect();
    let shown = if by.moments > 0 { chosen(&before_end, by.moments) } else { Vec::new() };
    let moment = |k: usize| {
        let (t, motions) = (knots[k].t, motions[k].clone());
        let by_speed = mechanism.drives_at(t, &motions).map(|at| at.force);
        let efforts = by_speed.zip(&efforts).map(|(force, effort)| effort.at_knot(t, force)).collect();
        Moment { t, motions, efforts }
    };
    let film = shown.into_iter().map(moment).collect();
    let outcome = |(observer, named): (&Observer, &NamedDrive)| {
        let outcome = observer.outcome();
        // Also before its ramp is over.
        let verdict = if outcome.runs_away(named.drive.speed) { Verdict::Overruns } else { outcome.verdict };
        Outcome { verdict, ..outcome }
    };
    let outcomes = observers.iter().zip(&mechanism.drives).map(outcome).collect();
    let samples = Samples { columns: mechanism.columns(), rows };
    let energy_excess = energies.excess();
    Ok(MechanismRun {
        samples,
        outcomes,
        trajectories,
        film,
        energy_excess,
        sunk: depths.sunk(mechanism),
        tolerance: limits.speed,
        error: mechanism.run.error,
        effort,
        integration,
    })
}

/// A speed (m/s, rad/s) that no mechanism has, at which the run of one whose drive runs away ends.
const ABSURD: f64 = 1e5;
