//! What is kept of a run step by step, and what is told of it at its end.

use std::{ops::ControlFlow, time::Duration};

use nalgebra::Vector3;
use slipfit_core::{SVector, integrator::Motion, system::spatial::PlacedBody};

use super::{
    Mechanism, NamedDrive,
    energy::{Energies, Work},
    limits::Limits,
    record::{MechanismRun, Moment, Samples},
    sampler::Sampler,
    state::State,
    sunk::{self, Depths},
    told::Told,
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

/// What a drive sees.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    /// Speed (m/s, rad/s).
    vz: f64,
    /// Travel (m, rad) since the start, which need not be the drawn pose.
    z: f64,
    /// How much faster (m/s) the point goes where it acts.
    beyond: f64,
}

impl Values for Seen {
    /// The acceleration (m/s², rad/s²).
    type Rates = f64;

    fn slope(&self, acceleration: &f64) -> Self {
        self.known_slope(Self { vz: *acceleration, z: 0.0, beyond: 0.0 })
    }

    fn known_slope(&self, guess: Self) -> Self {
        Self { z: self.vz, ..guess }
    }

    #[inline]
    fn combined<const N: usize>(of: [&Self; N], by: impl Fn([f64; N]) -> f64) -> Self {
        Self { vz: by(of.map(|seen| seen.vz)), z: by(of.map(|seen| seen.z)), beyond: by(of.map(|seen| seen.beyond)) }
    }
}

/// What is told of how a mechanism moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Telling {
    /// Time (s) between two samples.
    pub every: f64,
    /// Moments that show the motion, about.
    pub moments: usize,
}

/// A run of a mechanism with poses `P`, as far as it has come.
pub(super) struct Recorder<'a, P, const D: usize> {
    mechanism: &'a Mechanism,
    bodies: Box<dyn Told<P, D> + 'a>,
    energies: Energies,
    depths: Depths,
    /// Places (m, rad) of the drives at the start.
    origins: Vec<f64>,
    observers: Vec<Observer>,
    samplers: Vec<Option<Sampler<'a>>>,
    /// Ends of steps (s), and the energies (J) of motion and height there.
    times: Vec<f64>,
    energy: Vec<[f64; 2]>,
    /// What each drive sees there.
    drives: Vec<Vec<Knot<Seen>>>,
    /// All that moves there, if it is to be told.
    knots: Option<Vec<Knot<State<D>>>>,
    /// Error of speed (m/s) that a step is allowed.
    tolerance: f64,
}

/// A speed (m/s, rad/s) that no mechanism has, at which the run of one whose drive runs away ends.
const ABSURD: f64 = 1e5;

impl<'a, P: Copy, const D: usize> Recorder<'a, P, D> {
    /// Of a run of `mechanism`, whose `bodies` start at a pose and at rates; of one that is told of, not judged alone, everything that
    /// moves is kept.
    pub fn new(
        mechanism: &'a Mechanism,
        mut bodies: Box<dyn Told<P, D> + 'a>,
        (pose, rates): &(P, SVector<f64, D>),
        limits: &Limits,
        is_told: bool,
    ) -> Self {
        // The stroke is the first drive's.
        let of_drive = |k: usize| if k == 0 { mechanism.run } else { RunSpec { stroke: None, ..mechanism.run } };
        let mut at_start = Vec::new();
        let state = bodies.state(pose, (*rates).into());
        bodies.tell(&state, &mut at_start);
        bodies.look(pose, rates);
        let pressed = bodies.gaps(pose, rates);
        let energy = mechanism.energy(bodies.bodies());
        let named = mechanism.drives.iter().enumerate();
        Self {
            mechanism,
            energies: Energies::new(mechanism, &at_start, energy, pressed.iter().copied()),
            depths: Depths::new(pressed),
            origins: mechanism.drives.iter().map(|named| seen(named, &mut *bodies, 0.0).z).collect(),
            observers: named.map(|(k, named)| Observer::new(named.setpoint(), of_drive(k))).collect(),
            samplers: mechanism.drives.iter().map(Sampler::of).collect(),
            times: Vec::new(),
            energy: Vec::new(),
            drives: vec![Vec::new(); mechanism.drives.len()],
            knots: is_told.then(Vec::new),
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
        // Where the step began they were looked at last.
        for (named, knots) in mechanism.drives.iter().zip(&mut *drives) {
            let rates = accelerations.map(|[start, _]| [felt(named, &**bodies, &start), 0.0]);
            knots.push(Knot { t, values: Seen { vz: 0.0, z: 0.0, beyond: 0.0 }, rates });
        }
        bodies.look(&motion.pose, &motion.velocity);
        self.times.push(t);
        self.energy.push(mechanism.energy(bodies.bodies()));
        for ((named, knots), origin) in mechanism.drives.iter().zip(&mut *drives).zip(origins) {
            let Some(knot) = knots.last_mut() else { continue };
            knot.values = seen(named, &mut **bodies, *origin);
            if let (Some([_, end]), Some([_, at_end])) = (accelerations, &mut knot.rates) {
                *at_end = felt(named, &**bodies, &end);
            }
        }
        if let Some(knots) = &mut self.knots {
            let values = bodies.state(&motion.pose, motion.velocity.into());
            knots.push(Knot { t, values, rates: accelerations.map(|rates| rates.map(<[f64; D]>::from)) });
        }
        for ((sampler, knots), named) in self.samplers.iter_mut().zip(&*drives).zip(&mechanism.drives) {
            if let (Some(sampler), Some(Knot { values: Seen { vz, z, .. }, .. })) = (sampler, knots.last())
                && sampler.is_due(t)
            {
                sampler.sample(Instant { t, vz: *vz, force: named.effort(t, *vz), z: *z });
            }
        }
        let is_absurd = motion.velocity.iter().any(|rate| rate.abs() > ABSURD) && self.has_run_away();
        if is_absurd || self.has_ended() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Whether the first drive has come to the end of its stroke.
    fn has_ended(&self) -> bool {
        let last = self.observers.first().zip(self.drives.first().and_then(|knots| knots.last()));
        last.is_some_and(|(first, knot)| first.is_at_end(knot.values.z))
    }

    /// Whether a drive has run away: it does so until no number is large enough, so that the run ends there.
    fn has_run_away(&self) -> bool {
        let mut drives = self.mechanism.drives.iter().zip(&self.drives);
        drives.any(|(named, knots)| knots.last().is_some_and(|knot| has_run_away(knot.values.vz, named.drive.speed)))
    }

    /// What is known of the run, whose integration took this time and these `steps`, or was stopped; how it moves, if it is to be `told`.
    ///
    /// # Errors
    /// Why it was stopped, unless a drive had run away.
    pub fn finished(
        mut self,
        steps: Result<error_control::Effort, Stopped>,
        integration: Duration,
        told: Option<Telling>,
    ) -> Result<MechanismRun, Stopped> {
        let steps = steps.or_else(|stopped| {
            if stopped != Stopped::Interrupted && self.has_run_away() {
                Ok(error_control::Effort { accepted: self.times.len() as u32 - 1, refused: 0 })
            } else {
                Err(stopped)
            }
        })?;
        let end = match (self.observers.first(), self.drives.first()) {
            (Some(first), Some(knots)) => end(knots, |seen| first.is_at_end(seen.z)),
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
            looks(knots, end, |t, Seen { vz, z, beyond }, place| {
                let by_speed = named.effort(t, vz);
                let power = |force: f64| (force - offset) * (vz + beyond);
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
                observer.observe(Instant { t, vz, force, z });
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
        if let (Some(told), Some(knots)) = (told, &self.knots) {
            self.tell(knots, end, &efforts, told, &mut run);
        }
        Ok(run)
    }

    /// What a drive gives that sees this at the ends of steps.
    fn effort(&self, named: &NamedDrive, knots: &[Knot<Seen>], sampler: Option<Sampler>) -> Effort {
        if let Some(sampler) = sampler {
            return Effort::held(&sampler.into_samples());
        }
        let values = knots.iter().map(|knot| named.effort(knot.t, knot.values.vz)).collect();
        // What other joints hold still has a speed that is known exactly at all times.
        let moves = knots.iter().any(|knot| knot.values.vz != 0.0);
        let time_constant = if moves { self.mechanism.least_inertia(named) / named.drive.gain } else { f64::INFINITY };
        Effort::new(self.times.clone(), values, time_constant)
    }

    /// Tells how everything moves up to the `end` (s), by the states at the ends of steps and what the drives give.
    fn tell(
        &self,
        knots: &[Knot<State<D>>],
        end: f64,
        efforts: &[Effort],
        Telling { every, moments }: Telling,
        run: &mut MechanismRun,
    ) {
        let Self { mechanism, bodies, .. } = self;
        let mut motions = Vec::new();
        let times = samples(end, every);
        for (t, state) in times.clone().zip(sampled(knots, times)) {
            bodies.tell(&state, &mut motions);
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
                bodies.tell(values, &mut motions);
                let by_speed = mechanism.drives_at(t, &motions).map(|at| at.force);
                let efforts = by_speed.zip(efforts).map(|(force, effort)| effort.at_knot(t, force)).collect();
                Moment { t, motions, efforts }
            };
            run.film = chosen(&before_end, moments).into_iter().map(moment).collect();
        }
    }
}

/// What a drive sees of `bodies` where they were looked at last, its place from `origin` (m, rad) on.
fn seen<P, const D: usize>(named: &NamedDrive, bodies: &mut (dyn Told<P, D> + '_), origin: f64) -> Seen {
    let PlacedBody { to_frame, displacement_w, velocity_w, rotation_w, .. } = bodies.bodies()[named.body];
    let turn = |lever: Vector3<f64>| to_frame * lever;
    let turned = || bodies.turned(named.body);
    let [vz, z] = named.sees([velocity_w, rotation_w], displacement_w, named.arms(turn), turned);
    Seen { vz, z: z - origin, beyond: named.beyond(rotation_w, turn) }
}

/// How fast (m/s², rad/s²) the speed that a drive sees changes there, where coordinates have these accelerations.
fn felt<P, const D: usize>(
    named: &NamedDrive,
    bodies: &(dyn Told<P, D> + '_),
    of_coordinates: &SVector<f64, D>,
) -> f64 {
    let PlacedBody { to_frame, rotation_w, .. } = bodies.bodies()[named.body];
    let [_, arm] = named.arms(|lever| to_frame * lever);
    let centre = || bodies.acceleration(named.body, of_coordinates);
    named.feels(centre, bodies.turning(named.body, of_coordinates), rotation_w, arm)
}
