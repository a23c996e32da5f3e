//! What is kept of a run step by step, and what is told of it at its end.

use std::{ops::ControlFlow, time::Duration};

use slipfit_core::{SVector, integrator::Motion};

use super::{
    Mechanism, NamedDrive,
    columns::BodyMotion,
    energy::Energies,
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
        error_control::{self, Accelerations, Knot, Stopped, sampled},
        film::chosen,
        looks::{Place, end, looks, samples},
        observer::{Instant, Observer},
        outcome::{Outcome, Verdict, has_run_away},
        trajectory::Trajectory,
    },
    setup::RunSpec,
};

/// A run of a mechanism with poses `P`, as far as it has come.
pub(super) struct Recorder<'a, P, const D: usize> {
    mechanism: &'a Mechanism,
    bodies: Box<dyn Told<P, D> + 'a>,
    energies: Energies<'a>,
    depths: Depths,
    /// Places (m, rad) of the drives at the start, which need not be the drawn pose: travel counts from there.
    origins: Vec<f64>,
    observers: Vec<Observer>,
    samplers: Vec<Option<Sampler<'a>>>,
    knots: Vec<Knot<State<D>>>,
    /// Error of speed (m/s) that a step is allowed.
    tolerance: f64,
    motions: Vec<BodyMotion>,
    drives: Vec<Instant>,
}

/// A speed (m/s, rad/s) that no mechanism has, at which the run of one whose drive runs away ends.
const ABSURD: f64 = 1e5;

impl<'a, P: Copy, const D: usize> Recorder<'a, P, D> {
    /// Of a run of `mechanism`, whose `bodies` start at a pose and at rates.
    pub fn new(
        mechanism: &'a Mechanism,
        mut bodies: Box<dyn Told<P, D> + 'a>,
        (pose, rates): &(P, SVector<f64, D>),
        limits: &Limits,
    ) -> Self {
        // The stroke is the first drive's.
        let of_drive = |k: usize| if k == 0 { mechanism.run } else { RunSpec { stroke: None, ..mechanism.run } };
        let mut at_start = Vec::new();
        let state = bodies.state(pose, (*rates).into());
        bodies.tell(&state, &mut at_start);
        let pressed = bodies.gaps(pose, rates);
        let named = mechanism.drives.iter().enumerate();
        Self {
            mechanism,
            bodies,
            energies: Energies::new(mechanism, &at_start, pressed.iter().copied()),
            depths: Depths::new(pressed),
            origins: mechanism.drives_at(0.0, &at_start).map(|at| at.z).collect(),
            observers: named.map(|(k, named)| Observer::new(named.setpoint(), of_drive(k))).collect(),
            samplers: mechanism.drives.iter().map(Sampler::of).collect(),
            knots: Vec::new(),
            tolerance: limits.speed,
            motions: Vec::new(),
            drives: Vec::new(),
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
        if least_gap.is_some_and(|gap| gap < -sunk::LEAST) {
            self.depths.observe(self.bodies.gaps(&motion.pose, &motion.velocity));
        }
        let values = self.bodies.state(&motion.pose, motion.velocity.into());
        if self.samplers.iter().flatten().any(|sampler| sampler.is_due(t)) {
            self.sample(t, &values);
        }
        self.knots.push(Knot { t, values, rates: accelerations.map(|rates| rates.map(<[f64; D]>::from)) });
        let is_absurd = motion.velocity.iter().any(|rate| rate.abs() > ABSURD) && self.has_run_away(t, &values);
        if is_absurd || self.ends(&values) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Lets controllers whose time it is sample the motion.
    fn sample(&mut self, t: f64, state: &State<D>) {
        self.bodies.tell(state, &mut self.motions);
        drives_at(self.mechanism, &self.origins, t, &self.motions, &mut self.drives);
        for (sampler, at) in self.samplers.iter_mut().zip(&self.drives) {
            if let Some(sampler) = sampler.as_mut().filter(|sampler| sampler.is_due(t)) {
                sampler.sample(*at);
            }
        }
    }

    /// Whether the first drive has come to the end of its stroke.
    fn ends(&self, state: &State<D>) -> bool {
        let (Some(first), Some(_)) = (self.observers.first(), self.mechanism.run.stroke) else { return false };
        let mut motions = Vec::new();
        self.bodies.tell(state, &mut motions);
        let first_drive = self.mechanism.drives_at(0.0, &motions).next();
        first_drive.is_some_and(|at| first.is_at_end(at.z - self.origins[0]))
    }

    /// Whether a drive has run away: it does so until no number is large enough, so that the run ends there.
    fn has_run_away(&self, t: f64, state: &State<D>) -> bool {
        let mut motions = Vec::new();
        self.bodies.tell(state, &mut motions);
        let mut drives = self.mechanism.drives.iter().zip(self.mechanism.drives_at(t, &motions));
        drives.any(|(named, at)| has_run_away(at.vz, named.drive.speed))
    }

    /// What is told of the run, whose integration took this `effort` and this time, or was stopped: every `every` (s), with about `moments`
    /// moments of the motion.
    ///
    /// # Errors
    /// Why it was stopped, unless a drive had run away.
    pub fn finished(
        self,
        effort: Result<error_control::Effort, Stopped>,
        integration: Duration,
        (every, moments): (f64, usize),
    ) -> Result<MechanismRun, Stopped> {
        let effort = effort.or_else(|stopped| match self.knots.last() {
            Some(knot) if stopped != Stopped::Interrupted && self.has_run_away(knot.t, &knot.values) => {
                Ok(error_control::Effort { accepted: self.knots.len() as u32 - 1, refused: 0 })
            }
            _ => Err(stopped),
        })?;
        let end = end(&self.knots, |state| self.ends(state));
        let Self { mechanism, bodies, mut energies, depths, origins, mut observers, samplers, knots, .. } = self;
        let drives_at = |t: f64, motions: &[BodyMotion], drives: &mut Vec<Instant>| {
            drives_at(mechanism, &origins, t, motions, drives);
        };
        let told_at = |knot: &Knot<State<D>>| {
            let mut motions = Vec::with_capacity(mechanism.bodies.len());
            bodies.tell(&knot.values, &mut motions);
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
                    bodies.tell(&state, &mut between);
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
        let times = samples(end, every);
        for (t, state) in times.clone().zip(sampled(&knots, times)) {
            bodies.tell(&state, &mut between);
            drives_at(t, &between, &mut drives);
            drives.iter_mut().zip(&efforts).for_each(|(at, effort)| at.force = effort.at(t, at.force));
            rows.push(mechanism.row(t, &drives, &between));
            for ((trajectory, named), at) in trajectories.iter_mut().zip(&mechanism.drives).zip(&drives) {
                let place = between[named.body].displacement;
                trajectory.push(t, [at.vz, place.x, place.y, at.z], at.force);
            }
        }
        let before_end: Vec<f64> = knots.iter().map(|knot| knot.t).filter(|t| *t <= end).collect();
        let shown = if moments > 0 { chosen(&before_end, moments) } else { Vec::new() };
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
        Ok(MechanismRun {
            samples: Samples { columns: mechanism.columns(), rows },
            outcomes,
            trajectories,
            film,
            energy_excess: energies.excess(),
            sunk: depths.sunk(mechanism),
            tolerance: self.tolerance,
            error: mechanism.run.error,
            effort,
            integration,
        })
    }
}

/// Puts what the drives of `mechanism` see and do at time `t` (s), their places from `origins` (m, rad) on, in place of `drives`.
fn drives_at(mechanism: &Mechanism, origins: &[f64], t: f64, motions: &[BodyMotion], drives: &mut Vec<Instant>) {
    let from = |(at, origin): (Instant, &f64)| Instant { z: at.z - origin, ..at };
    drives.clear();
    drives.extend(mechanism.drives_at(t, motions).zip(origins).map(from));
}
