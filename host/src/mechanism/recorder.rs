//! Records a run step by step and makes its result at its end.

use std::{ops::ControlFlow, time::Duration};

use nalgebra::Vector3;
use slipfit_core::{SVector, integrator::Motion, system::spatial::PlacedBody};

use super::{
    Mechanism, NamedDrive,
    energy::{Energies, Work},
    kinematics::Kinematics,
    limits::Limits,
    record::{MechanismRun, Moment, Samples},
    sampler::Sampler,
    state::State,
    sunk::{self, Depths},
};
use crate::{
    dynamics::{
        effort::Effort,
        error_control::{self, Accelerations, Knot, Stopped, Values, sampled},
        film::chosen,
        looks::{Place, end, looks, samples},
        observer::{Instant, Observer},
        outcome::{Outcome, Verdict, has_run_away},
        trajectory::Trajectory,
    },
    setup::RunSpec,
};

/// Motion of a drive along or about its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DriveMotion {
    /// Speed (m/s, rad/s).
    speed: f64,
    /// Travel (m, rad) since the start, which need not be the drawn pose.
    travel: f64,
    /// How much faster (m/s) the point where it acts goes along the axis than the one whose speed it controls.
    point_excess: f64,
}

impl Values for DriveMotion {
    /// The acceleration (m/s², rad/s²).
    type Rates = f64;

    fn slope(&self, acceleration: &f64) -> Self {
        self.known_slope(Self { speed: *acceleration, travel: 0.0, point_excess: 0.0 })
    }

    fn known_slope(&self, guess: Self) -> Self {
        Self { travel: self.speed, ..guess }
    }

    #[inline]
    fn combined<const N: usize>(of: [&Self; N], by: impl Fn([f64; N]) -> f64) -> Self {
        Self {
            speed: by(of.map(|drive_motion| drive_motion.speed)),
            travel: by(of.map(|drive_motion| drive_motion.travel)),
            point_excess: by(of.map(|drive_motion| drive_motion.point_excess)),
        }
    }
}

/// What a run returns of the motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Output {
    /// Time (s) between two samples.
    pub every: f64,
    /// About how many moments show the motion.
    pub moments: usize,
}

/// A run in progress of a mechanism with poses `P`.
pub(super) struct Recorder<'a, P, const D: usize> {
    mechanism: &'a Mechanism,
    bodies: Box<dyn Kinematics<P, D> + 'a>,
    energies: Energies,
    depths: Depths,
    /// Places (m, rad) of the drives at the start.
    origins: Vec<f64>,
    observers: Vec<Observer>,
    samplers: Vec<Option<Sampler<'a>>>,
    /// Ends of steps (s), and the energies (J) of motion and height there.
    times: Vec<f64>,
    energy: Vec<[f64; 2]>,
    /// Motion of each drive there.
    drives: Vec<Vec<Knot<DriveMotion>>>,
    /// State of all coordinates there, if the run has an output.
    knots: Option<Vec<Knot<State<D>>>>,
    /// Error of speed (m/s) that a step is allowed.
    tolerance: f64,
}

/// A speed (m/s, rad/s) that no mechanism has, at which the run of one whose drive runs away ends.
const ABSURD: f64 = 1e5;

impl<'a, P: Copy, const D: usize> Recorder<'a, P, D> {
    /// A run of `mechanism` whose `bodies` start at a pose and at rates. It keeps the states of all coordinates if `keeps_states`.
    pub fn new(
        mechanism: &'a Mechanism,
        mut bodies: Box<dyn Kinematics<P, D> + 'a>,
        (pose, rates): &(P, SVector<f64, D>),
        limits: &Limits,
        keeps_states: bool,
    ) -> Self {
        // The stroke is the first drive's.
        let of_drive = |k: usize| if k == 0 { mechanism.run } else { RunSpec { stroke: None, ..mechanism.run } };
        let mut at_start = Vec::new();
        let state = bodies.state(pose, (*rates).into());
        bodies.body_motions(&state, &mut at_start);
        bodies.update(pose, rates);
        let pressed = bodies.gaps(pose, rates);
        let energy = mechanism.energy(bodies.bodies());
        let named = mechanism.drives.iter().enumerate();
        Self {
            mechanism,
            energies: Energies::new(mechanism, &at_start, energy, pressed.iter().copied()),
            depths: Depths::new(pressed),
            origins: mechanism.drives.iter().map(|named| drive_motion(named, &mut *bodies, 0.0).travel).collect(),
            observers: named.map(|(k, named)| Observer::new(named.setpoint(), of_drive(k))).collect(),
            samplers: mechanism.drives.iter().map(Sampler::of).collect(),
            times: Vec::new(),
            energy: Vec::new(),
            drives: vec![Vec::new(); mechanism.drives.len()],
            knots: keeps_states.then(Vec::new),
            tolerance: limits.speed,
            bodies,
        }
    }

    /// Takes note of the motion at the start or the end of a step, with its accelerations and the least gap (m) where they are known, and
    /// says whether to go on.
    pub fn keep(
        &mut self,
        t: f64,
        motion: &Motion<f64, P, (), D>,
        accelerations: Option<Accelerations<D>>,
        least_gap: Option<f64>,
    ) -> ControlFlow<()> {
        let Self { mechanism, bodies, drives, origins, .. } = self;
        if least_gap.is_some_and(|gap| gap < -sunk::LEAST) {
            self.depths.observe(bodies.gaps(&motion.pose, &motion.velocity));
        }
        // The last pose of the bodies is that at the start of the step.
        for (named, knots) in mechanism.drives.iter().zip(&mut *drives) {
            let rates = accelerations.map(|[start, _]| [drive_acceleration(named, &**bodies, &start), 0.0]);
            knots.push(Knot { t, values: DriveMotion { speed: 0.0, travel: 0.0, point_excess: 0.0 }, rates });
        }
        bodies.update(&motion.pose, &motion.velocity);
        self.times.push(t);
        self.energy.push(mechanism.energy(bodies.bodies()));
        for ((named, knots), origin) in mechanism.drives.iter().zip(&mut *drives).zip(origins) {
            let Some(knot) = knots.last_mut() else { continue };
            knot.values = drive_motion(named, &mut **bodies, *origin);
            if let (Some([_, end]), Some([_, at_end])) = (accelerations, &mut knot.rates) {
                *at_end = drive_acceleration(named, &**bodies, &end);
            }
        }
        if let Some(knots) = &mut self.knots {
            let values = bodies.state(&motion.pose, motion.velocity.into());
            knots.push(Knot { t, values, rates: accelerations.map(|rates| rates.map(<[f64; D]>::from)) });
        }
        for ((sampler, knots), named) in self.samplers.iter_mut().zip(&*drives).zip(&mechanism.drives) {
            if let (Some(sampler), Some(Knot { values: DriveMotion { speed, travel, .. }, .. })) =
                (sampler, knots.last())
                && sampler.is_due(t)
            {
                sampler.sample(Instant { t, vz: *speed, force: named.effort(t, *speed), z: *travel });
            }
        }
        let is_absurd = motion.velocity.iter().any(|rate| rate.abs() > ABSURD) && self.has_run_away();
        if is_absurd || self.has_ended() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Whether the first drive has come to the end of its stroke.
    fn has_ended(&self) -> bool {
        let last = self.observers.first().zip(self.drives.first().and_then(|knots| knots.last()));
        last.is_some_and(|(first, knot)| first.is_at_end(knot.values.travel))
    }

    /// Whether a drive has run away: it does so until no number is large enough, so that the run ends there.
    fn has_run_away(&self) -> bool {
        let mut drives = self.mechanism.drives.iter().zip(&self.drives);
        drives.any(|(named, knots)| knots.last().is_some_and(|knot| has_run_away(knot.values.speed, named.drive.speed)))
    }

    /// The result of the run, whose integration took this time and these `steps`, or was stopped, with the motion as `output` asks for it.
    ///
    /// # Errors
    /// Why it was stopped, unless a drive had run away.
    pub fn finished(
        mut self,
        steps: Result<error_control::Effort, Stopped>,
        integration: Duration,
        output: Option<Output>,
    ) -> Result<MechanismRun, Stopped> {
        let steps = steps.or_else(|stopped| {
            if stopped != Stopped::Interrupted && self.has_run_away() {
                Ok(error_control::Effort { accepted: self.times.len() as u32 - 1, refused: 0 })
            } else {
                Err(stopped)
            }
        })?;
        let end = match (self.observers.first(), self.drives.first()) {
            (Some(first), Some(knots)) => end(knots, |drive_motion| first.is_at_end(drive_motion.travel)),
            _ => self.times[self.times.len() - 1],
        };
        let mut work_at_knots = vec![0.0; self.times.len()];
        let (mut efforts, mut outcomes) = (Vec::new(), Vec::new());
        let (samplers, observers) = (std::mem::take(&mut self.samplers), std::mem::take(&mut self.observers));
        let drives = self.mechanism.drives.iter().zip(&self.drives);
        for ((named, knots), (sampler, observer)) in drives.zip(samplers.into_iter().zip(observers)) {
            let effort = self.effort(named, knots, sampler);
            // An offset of the drive train works like a force.
            let offset = named.train.map_or(0.0, |train| train.offset);
            let (mut observer, mut work) = (observer.until(end), Work::default());
            looks(knots, end, |t, DriveMotion { speed, travel, point_excess }, place| {
                let by_speed = named.effort(t, speed);
                let power = |force: f64| (force - offset) * (speed + point_excess);
                let force = match place {
                    Place::At(_) => {
                        // The work up to here is that of what was held.
                        if let Some(before) = effort.held_before(t) {
                            work.observe(t, power(before));
                        }
                        effort.at_knot(t, by_speed)
                    }
                    Place::Before(knot) => effort.before(knot, t, by_speed),
                };
                work.observe(t, power(force));
                if let Place::At(knot) = place {
                    work_at_knots[knot] += work.done;
                }
                observer.observe(Instant { t, vz: speed, force, z: travel });
            });
            let outcome = observer.outcome();
            // Also before its ramp is over.
            let verdict = if outcome.runs_away(named.drive.speed) { Verdict::Overruns } else { outcome.verdict };
            outcomes.push(Outcome { verdict, ..outcome });
            efforts.push(effort);
        }
        let before_end = self.times.iter().take_while(|t| **t <= end).count();
        let at_knots = self.energy.iter().copied().zip(work_at_knots).take(before_end);
        let mut run = MechanismRun {
            samples: Samples { columns: self.mechanism.columns(), rows: Vec::new() },
            outcomes,
            trajectories: vec![Trajectory::default(); self.mechanism.drives.len()],
            film: Vec::new(),
            energy_excess: self.energies.excess(at_knots),
            sunk: self.depths.sunk(self.mechanism),
            tolerance: self.tolerance,
            error: self.mechanism.run.error,
            effort: steps,
            integration,
        };
        if let (Some(output), Some(knots)) = (output, &self.knots) {
            self.write_output(knots, end, &efforts, output, &mut run);
        }
        Ok(run)
    }

    /// Force or torque of a drive over the run, by its motion at the ends of steps.
    fn effort(&self, named: &NamedDrive, knots: &[Knot<DriveMotion>], sampler: Option<Sampler>) -> Effort {
        if let Some(sampler) = sampler {
            return Effort::held(&sampler.into_samples());
        }
        let values = knots.iter().map(|knot| named.effort(knot.t, knot.values.speed)).collect();
        // What other joints hold still has a speed that is known exactly at all times.
        let moves = knots.iter().any(|knot| knot.values.speed != 0.0);
        let time_constant = if moves { self.mechanism.least_inertia(named) / named.drive.gain } else { f64::INFINITY };
        Effort::new(self.times.clone(), values, time_constant)
    }

    /// Adds samples and moments of the motion up to its `end` (s) to `run`, from the states at the ends of steps and the efforts of the drives.
    fn write_output(
        &self,
        knots: &[Knot<State<D>>],
        end: f64,
        efforts: &[Effort],
        Output { every, moments }: Output,
        run: &mut MechanismRun,
    ) {
        let Self { mechanism, bodies, .. } = self;
        let mut motions = Vec::new();
        let times = samples(end, every);
        for (t, state) in times.clone().zip(sampled(knots, times)) {
            bodies.body_motions(&state, &mut motions);
            let mut drives: Vec<_> = mechanism.drives_at(t, &motions).collect();
            for ((at, origin), effort) in drives.iter_mut().zip(&self.origins).zip(efforts) {
                (at.z, at.force) = (at.z - origin, effort.at(t, at.force));
            }
            run.samples.rows.push(mechanism.row(t, &drives, &motions));
            for ((trajectory, named), at) in run.trajectories.iter_mut().zip(&mechanism.drives).zip(&drives) {
                let place = motions[named.body].displacement;
                trajectory.push(t, [at.vz, place.x, place.y, at.z], at.force);
            }
        }
        if moments > 0 {
            let before_end: Vec<f64> = self.times.iter().copied().filter(|t| *t <= end).collect();
            let moment = |k: usize| {
                let Knot { t, ref values, .. } = knots[k];
                let mut motions = Vec::with_capacity(mechanism.bodies.len());
                bodies.body_motions(values, &mut motions);
                let by_speed = mechanism.drives_at(t, &motions).map(|at| at.force);
                let efforts = by_speed.zip(efforts).map(|(force, effort)| effort.at_knot(t, force)).collect();
                Moment { t, motions, efforts }
            };
            run.film = chosen(&before_end, moments).into_iter().map(moment).collect();
        }
    }
}

/// Motion of a drive at the last pose of `bodies`; travel counts from `origin` (m, rad).
fn drive_motion<P, const D: usize>(
    named: &NamedDrive,
    bodies: &mut (dyn Kinematics<P, D> + '_),
    origin: f64,
) -> DriveMotion {
    let PlacedBody { to_frame, displacement_w, velocity_w, rotation_w, .. } = bodies.bodies()[named.body];
    let turn = |lever: Vector3<f64>| to_frame * lever;
    let rotation = || bodies.rotation(named.body);
    let [speed, travel] = named.measured_motion([velocity_w, rotation_w], displacement_w, named.arms(turn), rotation);
    DriveMotion { speed, travel: travel - origin, point_excess: named.point_excess(rotation_w, turn) }
}

/// Acceleration (m/s², rad/s²) of a drive at the last pose of `bodies`, for these accelerations of the coordinates.
fn drive_acceleration<P, const D: usize>(
    named: &NamedDrive,
    bodies: &(dyn Kinematics<P, D> + '_),
    of_coordinates: &SVector<f64, D>,
) -> f64 {
    let PlacedBody { to_frame, rotation_w, .. } = bodies.bodies()[named.body];
    let [_, arm] = named.arms(|lever| to_frame * lever);
    let centre = || bodies.acceleration(named.body, of_coordinates);
    named.measured_acceleration(centre, bodies.angular_acceleration(named.body, of_coordinates), rotation_w, arm)
}
