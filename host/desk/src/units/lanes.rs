//! Units on the lanes of a register, each with its own time and step length.

use pulp::Simd;
use slipfit_core::{
    SVector, Scalar as _,
    integrator::{Integrator, Motion, Rodas4, Step},
    mechanism::Mechanism as _,
    system::{Bodies, System},
};

use super::unit::{Unit, Wide, WidePose};
use crate::{
    closing::WideGaps,
    element::{AngularSpeeds, HasContacts},
    error_control::{Effort, FIRST_STEP, Stopped},
    plant::Reported,
    real::Real,
    step_control::StepControl,
};

/// Fills in the contacts of the units of `system`.
#[inline(always)]
fn watch<S: Real, B, E, const D: usize>(
    system: &System<B, &[E]>,
    pose: &B::Pose,
    velocity: &SVector<S, D>,
    gaps: &mut WideGaps<S>,
) where
    B: AngularSpeeds<S, D>,
    E: HasContacts<S, B, D>,
{
    let placed = system.bodies().placed(pose, velocity);
    gaps.spin = system.bodies().max_angular_speed(&placed);
    gaps.contacts.clear();
    let mut see = |contact| gaps.contacts.push(contact);
    for element in *system.elements() {
        element.approach((system.bodies(), &placed), &mut see);
    }
}

/// The motion of the unit on a `lane`.
#[inline(always)]
fn of_lane<S: Real, P, W: WidePose<P>, R, const D: usize>(
    motion: &Motion<S, W, R, D>,
    lane: usize,
) -> Motion<f64, P, (), D> {
    Motion {
        pose: motion.pose.of_unit(lane),
        velocity: motion.velocity.map(|rate| rate.get(lane)),
        acceleration: motion.acceleration.map(|rate| rate.get(lane)),
        internal: (),
    }
}

/// The most lanes of a register.
const MOST_LANES: usize = 8;

/// Units on lanes, with poses `P` and what their laws remember, `R`.
pub struct Lanes<V: Simd, P, R, const D: usize> {
    /// Which unit is on each lane, and how far it is; none where there are no more.
    on: Vec<Option<(usize, StepControl)>>,
    /// Whose numbers are on each lane, also where the unit has ended.
    pub sources: Vec<usize>,
    /// The first unit that no lane has had.
    next: usize,
    /// Where the units are and how they move.
    pub motion: Motion<Wide<V>, P, R, D>,
    before: WideGaps<Wide<V>>,
    after: WideGaps<Wide<V>>,
}

/// The next step of each unit.
pub struct NextStep<V: Simd> {
    /// When (s) it starts.
    pub t: Wide<V>,
    /// Length (s).
    pub length: Wide<V>,
    /// When (s) it ends at the latest.
    limits: [f64; MOST_LANES],
}

/// The motion at the ends of steps, and their accelerations.
type Ended<'a, V, P, R, const D: usize> = (&'a Motion<Wide<V>, P, R, D>, &'a [SVector<Wide<V>, D>; 2]);

// No closures in what is hot: they are compiled without the instructions of the function that they are in.
impl<V: Simd, P: Copy, R: Copy + Default, const D: usize> Lanes<V, P, R, D> {
    /// No units yet; lanes have this motion until they have one.
    pub fn new(motion: Motion<Wide<V>, P, R, D>) -> Self {
        let (before, after) = (WideGaps::default(), WideGaps::default());
        Self { on: vec![None; Wide::<V>::LANES], sources: vec![0; Wide::<V>::LANES], next: 0, motion, before, after }
    }

    /// Puts units on the lanes that have none; 1 where there is a fresh one.
    pub fn load<B: Bodies<f64, D>, E>(&mut self, units: &[Unit<B, E, D>]) -> Wide<V>
    where
        P: WidePose<B::Pose>,
    {
        let mut fresh = Wide::<V>::splat(0.0);
        for (lane, on) in self.on.iter_mut().enumerate() {
            if let (None, Some(unit)) = (&on, units.get(self.next)) {
                *on = Some((self.next, StepControl::default()));
                self.sources[lane] = self.next;
                self.next += 1;
                let (pose, velocity) = &unit.start;
                self.motion.pose.put(lane, pose);
                self.motion.velocity.iter_mut().zip(velocity).for_each(|(number, x)| number.set(lane, *x));
                fresh.set(lane, 1.0);
            }
        }
        fresh
    }

    /// Whether units are on lanes, and on all of them as long as there are more of `count`.
    pub fn is_running(&self, count: usize) -> bool {
        let mut on = self.on.iter();
        if self.next < count { on.all(Option::is_some) } else { on.any(Option::is_some) }
    }

    /// Looks at `fresh` units where they start.
    #[inline(always)]
    pub fn start_units<B, E, W, F>(&mut self, system: &System<W, &[F]>, fresh: Wide<V>, units: &mut [Unit<B, E, D>])
    where
        B: Bodies<f64, D>,
        W: AngularSpeeds<Wide<V>, D, Pose = P>,
        F: HasContacts<Wide<V>, W, D, Internal = R>,
        P: WidePose<B::Pose>,
    {
        let (pose, forgotten) = (self.motion.pose, R::default());
        system.accept(fresh, (&pose, &forgotten), (&mut self.motion.pose, &mut self.motion.internal));
        watch(system, &self.motion.pose, &self.motion.velocity, &mut self.after);
        if self.before.contacts.len() != self.after.contacts.len() {
            self.before.clone_from(&self.after);
        }
        self.before.accept(fresh, &self.after);
        let least = self.before.least();
        for (lane, on) in self.on.iter_mut().enumerate() {
            if let (Some((unit, _)), true) = (&on, fresh.get(lane) > 0.0) {
                let Unit { observer, duration, .. } = &mut units[*unit];
                let start = of_lane(&self.motion, lane);
                if observer.observe(0.0, &start, None, least.get(lane)).is_break() || *duration <= 0.0 {
                    observer.finish(Ok(Effort::default()));
                    *on = None;
                }
            }
        }
    }

    /// The next step of each unit; lanes without one stand still.
    #[inline(always)]
    pub fn next_step<B: Bodies<f64, D>, E>(&self, units: &[Unit<B, E, D>]) -> NextStep<V> {
        let mut next = NextStep { t: Wide::splat(0.0), length: Wide::splat(FIRST_STEP), limits: [0.0; MOST_LANES] };
        for (lane, on) in self.on.iter().enumerate() {
            if let Some((unit, step_control)) = on {
                let Unit { duration, allowed, .. } = &units[*unit];
                let (length, limit) = step_control.next(*duration, allowed.bends);
                next.t.set(lane, step_control.t);
                next.length.set(lane, length);
                next.limits[lane] = limit;
            }
        }
        next
    }

    /// 1 for units whose `step` is good enough.
    #[inline(always)]
    pub fn check_steps<B, E, W, F>(
        &mut self,
        system: &System<W, &[F]>,
        step: &Step<Wide<V>, P, R, D>,
        next: &NextStep<V>,
        units: &mut [Unit<B, E, D>],
    ) -> Wide<V>
    where
        B: Bodies<f64, D>,
        W: AngularSpeeds<Wide<V>, D, Pose = P>,
        F: HasContacts<Wide<V>, W, D, Internal = R>,
    {
        let mut good = Wide::splat(0.0);
        let Step { residual, error, drift, motion: end } = step;
        let probe = system.finiteness_probe(&end.pose) + end.velocity.sum() * good;
        for (lane, on) in self.on.iter_mut().enumerate() {
            let Some((unit, step_control)) = on else { continue };
            let reported = Reported { residual: residual.get(lane), error: error.get(lane), drift: drift.get(lane) };
            let length = next.length.get(lane);
            let error = (units[*unit].allowed.error)(reported, length) + probe.get(lane);
            match step_control.accepts_error(error, length, Rodas4::ORDER) {
                Ok(accepts_error) => good.set(lane, if accepts_error { 1.0 } else { 0.0 }),
                Err(stopped) => {
                    units[*unit].observer.finish(Err(stopped));
                    *on = None;
                }
            }
        }
        watch(system, &end.pose, &end.velocity, &mut self.after);
        let may_act = self.before.may_act(&self.after, next.length);
        for (lane, on) in self.on.iter_mut().enumerate() {
            if let (Some((unit, step_control)), true) = (on, good.get(lane) > 0.0 && may_act.get(lane) != 0.0) {
                let length = next.length.get(lane);
                let between = self.before.between(&self.after, lane, length, units[*unit].allowed.depth);
                if step_control.shortens(between, length) {
                    good.set(lane, 0.0);
                }
            }
        }
        good
    }

    /// Takes the `good` steps, which end with the motion `end` and have these `accelerations`.
    #[inline(always)]
    pub fn accept_steps<B, E, W, F>(
        &mut self,
        system: &System<W, &[F]>,
        (end, accelerations): Ended<V, P, R, D>,
        (good, next): (Wide<V>, &NextStep<V>),
        units: &mut [Unit<B, E, D>],
    ) where
        B: Bodies<f64, D>,
        W: AngularSpeeds<Wide<V>, D, Pose = P>,
        F: HasContacts<Wide<V>, W, D, Internal = R>,
        P: WidePose<B::Pose>,
    {
        let Self { motion, before, after, on, .. } = self;
        system.accept(good, (&end.pose, &end.internal), (&mut motion.pose, &mut motion.internal));
        for (kept, new) in motion.velocity.iter_mut().zip(&end.velocity) {
            *kept = good.select_gt(Wide::splat(0.0), *new, *kept);
        }
        before.accept(good, after);
        let (least, slack) = (before.least(), before.slack());
        for (lane, on) in on.iter_mut().enumerate() {
            let (Some((unit, step_control)), true) = (&mut *on, good.get(lane) > 0.0) else { continue };
            let Unit { duration, allowed, observer, .. } = &mut units[*unit];
            let pushed = if slack.get(lane) > 0.0 { before.until_pushed(lane, allowed.depth) } else { f64::INFINITY };
            step_control.accept(next.length.get(lane), next.limits[lane], pushed);
            let rates = accelerations.each_ref().map(|rates| rates.map(|rate| rate.get(lane)));
            let flow = observer.observe(step_control.t, &of_lane(motion, lane), Some(rates), least.get(lane));
            if flow.is_break() || step_control.t >= *duration {
                observer.finish(Ok(step_control.effort));
                *on = None;
            }
        }
    }

    /// Tells units that have not come to their ends that somebody asked to stop.
    pub fn interrupt<B: Bodies<f64, D>, E>(&self, units: &mut [Unit<B, E, D>]) {
        let begun = self.on.iter().flatten().map(|(unit, _)| *unit);
        begun.chain(self.next..units.len()).for_each(|unit| units[unit].observer.finish(Err(Stopped::Interrupted)));
    }
}
