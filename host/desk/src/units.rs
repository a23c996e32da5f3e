//! Many units of a mechanism at a time, each on a lane of the machine's registers, by error-controlled steps.
//!
//! Units have the same bodies, joints and laws, and other numbers. Every lane has a time and a step of its own, and takes the next
//! unit as soon as its own has come to its end. A unit has the bits that it has alone, by
//! [`integrate`](crate::error_control::integrate).

use std::ops::ControlFlow;

use pulp::{Simd, WithSimd};
use slipfit_core::{
    Cast, SVector, Scalar as _,
    integrator::{Dense, Integrator, Motion, Rodas4, Step},
    mechanism::Mechanism,
    system::{Bodies, System, planar::PlanarTree},
};
use slipfit_system::interrupt;

use crate::{
    closing::WideGaps,
    element::{PlanarElement, Spinning, Touching},
    error_control::{Accelerations, Effort, FIRST_STEP, Pace, STEPS_PER_LOOK, Stopped},
    pack::Pack,
    plant::{Allowed, Reported},
    real::Real,
};

/// A unit to be moved: its bodies and what acts on them, where and how fast it starts, and who sees it move.
pub struct Unit<'a, B: Bodies<f64, D>, E, const D: usize> {
    /// The bodies.
    pub bodies: B,
    /// What acts on them.
    pub elements: Vec<E>,
    /// Pose and velocities at the start.
    pub start: (B::Pose, SVector<f64, D>),
    /// Simulated time (s).
    pub duration: f64,
    /// What a step may err by.
    pub allowed: Allowed<'a>,
    /// Who sees it move.
    pub witness: &'a mut dyn Witness<B::Pose, D>,
}

/// Who sees a unit move.
pub trait Witness<P, const D: usize> {
    /// Sees the start and the end of every step, as [`See`](crate::plant::See) does.
    fn see(
        &mut self,
        t: f64,
        motion: &Motion<f64, P, (), D>,
        accelerations: Option<Accelerations<D>>,
        least_gap: f64,
    ) -> ControlFlow<()>;

    /// Hears what the whole motion took, or why it was stopped.
    fn hear(&mut self, effort: Result<Effort, Stopped>);
}

/// Where bodies are, of as many units as there are lanes.
pub trait WidePose<P> {
    /// All units at the same `pose`.
    fn everywhere(pose: &P) -> Self;

    /// Where those of the unit on a `lane` are.
    fn of_unit(&self, lane: usize) -> P;

    /// Puts those of the unit on a `lane` there.
    fn put(&mut self, lane: usize, pose: &P);
}

impl<S: Real, const D: usize> WidePose<[[f64; 2]; D]> for [[S; 2]; D] {
    fn everywhere(pose: &[[f64; 2]; D]) -> Self {
        pose.map(|pair| pair.map(S::from_f64))
    }

    #[inline(always)]
    fn of_unit(&self, lane: usize) -> [[f64; 2]; D] {
        self.map(|pair| pair.map(|number| number.get(lane)))
    }

    fn put(&mut self, lane: usize, pose: &[[f64; 2]; D]) {
        for (numbers, pair) in self.iter_mut().zip(pose) {
            numbers.iter_mut().zip(pair).for_each(|(number, x)| number.set(lane, *x));
        }
    }
}

/// Numbers of some units in the registers of the instructions `V`.
type Wide<V> = Pack<V, f64>;

/// What `T` is of such numbers.
type WideOf<V, T> = <T as Cast>::Of<Wide<V>>;

/// The mechanisms of some units.
type WideSystem<'w, V, B, E> = System<WideOf<V, B>, &'w [WideOf<V, E>]>;

/// Whether two units, each with its bodies and elements, have the same bodies, joints and laws, so that numbers alone differ.
pub fn are_alike<B, E>(one: (&B, &[E]), other: (&B, &[E])) -> bool
where
    B: Cast<Of<f64>: PartialEq>,
    E: Cast<Of<f64>: PartialEq>,
{
    let none = &mut |_| 0.0;
    one.0.cast(none) == other.0.cast(none)
        && one.1.len() == other.1.len()
        && one.1.iter().zip(other.1).all(|(one, other)| one.cast(none) == other.cast(none))
}

/// The bodies and elements of those of the `units` that are on the lanes: `sources` says which is on each.
fn gathered<V: Simd, B, E, const D: usize>(
    units: &[Unit<B, E, D>],
    sources: &[usize],
) -> (WideOf<V, B>, Vec<WideOf<V, E>>)
where
    B: Cast + Bodies<f64, D>,
    E: Cast,
{
    let mut numbers: Vec<Wide<V>> = Vec::new();
    for (lane, source) in sources.iter().enumerate() {
        let mut k = 0;
        let mut put = |x: f64| {
            if lane == 0 {
                numbers.push(Wide::splat(x));
            } else if let Some(number) = numbers.get_mut(k) {
                number.set(lane, x);
            }
            k += 1;
            x
        };
        let Unit { bodies, elements, .. } = &units[*source];
        bodies.cast(&mut put);
        elements.iter().for_each(|element| drop(element.cast(&mut put)));
    }
    let mut numbers = numbers.into_iter();
    let mut next = |_| numbers.next().unwrap_or_default();
    let Unit { bodies, elements, .. } = &units[sources[0]];
    (bodies.cast(&mut next), elements.iter().map(|element| element.cast(&mut next)).collect())
}

/// Fills in the contacts of the units of `system`.
#[inline(always)]
fn watch<S: Real, B, E, const D: usize>(
    system: &System<B, &[E]>,
    pose: &B::Pose,
    velocity: &SVector<S, D>,
    gaps: &mut WideGaps<S>,
) where
    B: Spinning<S, D>,
    E: Touching<S, B, D>,
{
    let placed = system.bodies().placed(pose, velocity);
    gaps.spin = system.bodies().fastest(&placed);
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
struct Lanes<V: Simd, P, R, const D: usize> {
    /// Which unit is on each lane, and how far it is; none where there are no more.
    on: Vec<Option<(usize, Pace)>>,
    /// Whose numbers are on each lane, also where the unit has ended.
    sources: Vec<usize>,
    /// The first unit that no lane has had.
    next: usize,
    motion: Motion<Wide<V>, P, R, D>,
    before: WideGaps<Wide<V>>,
    after: WideGaps<Wide<V>>,
}

/// The next step of each unit.
struct NextStep<V: Simd> {
    /// When (s) it starts.
    t: Wide<V>,
    /// Length (s).
    length: Wide<V>,
    /// When (s) it ends at the latest.
    limits: [f64; MOST_LANES],
}

/// The motion at the ends of steps, and their accelerations.
type Ended<'a, V, P, R, const D: usize> = (&'a Motion<Wide<V>, P, R, D>, &'a [SVector<Wide<V>, D>; 2]);

// No closures in what is hot: they are compiled without the instructions of the function that they are in.
impl<V: Simd, P: Copy, R: Copy + Default, const D: usize> Lanes<V, P, R, D> {
    /// Puts units on the lanes that have none; 1 where there is a fresh one.
    fn load<B: Bodies<f64, D>, E>(&mut self, units: &[Unit<B, E, D>]) -> Wide<V>
    where
        P: WidePose<B::Pose>,
    {
        let mut fresh = Wide::<V>::splat(0.0);
        for (lane, on) in self.on.iter_mut().enumerate() {
            if let (None, Some(unit)) = (&on, units.get(self.next)) {
                *on = Some((self.next, Pace::default()));
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
    fn are_at_work(&self, count: usize) -> bool {
        let mut on = self.on.iter();
        if self.next < count { on.all(Option::is_some) } else { on.any(Option::is_some) }
    }

    /// Looks at `fresh` units where they start.
    #[inline(always)]
    fn begin<B, E, W, F>(&mut self, system: &System<W, &[F]>, fresh: Wide<V>, units: &mut [Unit<B, E, D>])
    where
        B: Bodies<f64, D>,
        W: Spinning<Wide<V>, D, Pose = P>,
        F: Touching<Wide<V>, W, D, Internal = R>,
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
                let Unit { witness, duration, .. } = &mut units[*unit];
                let start = of_lane(&self.motion, lane);
                if witness.see(0.0, &start, None, least.get(lane)).is_break() || *duration <= 0.0 {
                    witness.hear(Ok(Effort::default()));
                    *on = None;
                }
            }
        }
    }

    /// The next step of each unit; lanes without one stand still.
    #[inline(always)]
    fn next_step<B: Bodies<f64, D>, E>(&self, units: &[Unit<B, E, D>]) -> NextStep<V> {
        let mut next = NextStep { t: Wide::splat(0.0), length: Wide::splat(FIRST_STEP), limits: [0.0; MOST_LANES] };
        for (lane, on) in self.on.iter().enumerate() {
            if let Some((unit, pace)) = on {
                let Unit { duration, allowed, .. } = &units[*unit];
                let (length, limit) = pace.next(*duration, allowed.bends);
                next.t.set(lane, pace.t);
                next.length.set(lane, length);
                next.limits[lane] = limit;
            }
        }
        next
    }

    /// 1 for units whose `step` is good enough.
    #[inline(always)]
    fn judge<B, E, W, F>(
        &mut self,
        system: &System<W, &[F]>,
        step: &Step<Wide<V>, P, R, D>,
        next: &NextStep<V>,
        units: &mut [Unit<B, E, D>],
    ) -> Wide<V>
    where
        B: Bodies<f64, D>,
        W: Spinning<Wide<V>, D, Pose = P>,
        F: Touching<Wide<V>, W, D, Internal = R>,
    {
        let mut good = Wide::splat(0.0);
        let Step { residual, error, drift, motion: end } = step;
        let probe = system.finiteness_probe(&end.pose) + end.velocity.sum() * good;
        for (lane, on) in self.on.iter_mut().enumerate() {
            let Some((unit, pace)) = on else { continue };
            let reported = Reported { residual: residual.get(lane), error: error.get(lane), drift: drift.get(lane) };
            let length = next.length.get(lane);
            let error = (units[*unit].allowed.error)(reported, length) + probe.get(lane);
            match pace.is_good(error, length, Rodas4::ORDER) {
                Ok(is_good) => good.set(lane, if is_good { 1.0 } else { 0.0 }),
                Err(stopped) => {
                    units[*unit].witness.hear(Err(stopped));
                    *on = None;
                }
            }
        }
        watch(system, &end.pose, &end.velocity, &mut self.after);
        let may_act = self.before.may_act(&self.after, next.length);
        for (lane, on) in self.on.iter_mut().enumerate() {
            if let (Some((unit, pace)), true) = (on, good.get(lane) > 0.0 && may_act.get(lane) != 0.0) {
                let length = next.length.get(lane);
                let between = self.before.between(&self.after, lane, length, units[*unit].allowed.depth);
                if pace.is_shortened(between, length) {
                    good.set(lane, 0.0);
                }
            }
        }
        good
    }

    /// Takes the `good` steps, which end with the motion `end` and have these `accelerations`.
    #[inline(always)]
    fn accept<B, E, W, F>(
        &mut self,
        system: &System<W, &[F]>,
        (end, accelerations): Ended<V, P, R, D>,
        (good, next): (Wide<V>, &NextStep<V>),
        units: &mut [Unit<B, E, D>],
    ) where
        B: Bodies<f64, D>,
        W: Spinning<Wide<V>, D, Pose = P>,
        F: Touching<Wide<V>, W, D, Internal = R>,
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
            let (Some((unit, pace)), true) = (&mut *on, good.get(lane) > 0.0) else { continue };
            let Unit { duration, allowed, witness, .. } = &mut units[*unit];
            let pushed = if slack.get(lane) > 0.0 { before.until_pushed(lane, allowed.depth) } else { f64::INFINITY };
            pace.accept(next.length.get(lane), next.limits[lane], pushed);
            let rates = accelerations.each_ref().map(|rates| rates.map(|rate| rate.get(lane)));
            let flow = witness.see(pace.t, &of_lane(motion, lane), Some(rates), least.get(lane));
            if flow.is_break() || pace.t >= *duration {
                witness.hear(Ok(pace.effort));
                *on = None;
            }
        }
    }

    /// Tells units that have not come to their ends that somebody asked to stop.
    fn interrupt<B: Bodies<f64, D>, E>(&self, units: &mut [Unit<B, E, D>]) {
        let begun = self.on.iter().flatten().map(|(unit, _)| *unit);
        begun.chain(self.next..units.len()).for_each(|unit| units[unit].witness.hear(Err(Stopped::Interrupted)));
    }
}

/// Moves the `units`, which are alike. That the machine has them is what `_instructions` prove.
#[inline(always)]
fn integrate<V: Simd, B, E, const D: usize>(_instructions: V, units: &mut [Unit<B, E, D>])
where
    B: Cast<Of<Wide<V>>: Copy> + Bodies<f64, D>,
    E: Cast,
    WideOf<V, B>: Spinning<Wide<V>, D, Pose: WidePose<B::Pose>>,
    WideOf<V, E>: Touching<Wide<V>, WideOf<V, B>, D, Internal: Default>,
{
    let Some(first) = units.first() else { return };
    let still = SVector::zeros();
    let pose = WidePose::everywhere(&first.start.0);
    let mut all = Lanes {
        on: vec![None; Wide::<V>::LANES],
        sources: vec![0; Wide::<V>::LANES],
        next: 0,
        motion: Motion { pose, velocity: still, acceleration: still, internal: Default::default() },
        before: WideGaps::default(),
        after: WideGaps::default(),
    };
    let mut steps: u32 = 0;
    loop {
        let fresh = all.load(units);
        if !all.are_at_work(units.len()) {
            return;
        }
        let (bodies, elements) = gathered::<V, _, _, D>(units, &all.sources);
        let system: WideSystem<V, B, E> = System::new(bodies, &elements[..]);
        all.begin(&system, fresh, units);
        let mut at_start = None;
        while all.are_at_work(units.len()) {
            if steps.is_multiple_of(STEPS_PER_LOOK) && interrupt::requested() {
                return all.interrupt(units);
            }
            steps = steps.wrapping_add(1);
            let next = all.next_step(units);
            let Motion { pose, velocity, internal, .. } = &all.motion;
            let here = match at_start {
                Some(here) => here,
                None => system.differentiated(next.t, pose, internal, velocity),
            };
            let (step, accelerations) = Rodas4::dense_step(&system, next.t, next.length, &all.motion, &here);
            let good = all.judge(&system, &step, &next, units);
            at_start = (good == Wide::splat(0.0)).then_some(here);
            all.accept(&system, (&step.motion, &accelerations), (good, &next), units);
        }
    }
}

/// How many units of a mechanism are moved at a time, at most `most`; none where the machine has no registers for several.
pub fn lanes(most: usize) -> Option<usize> {
    #[cfg(target_arch = "x86_64")]
    {
        if most >= 8 && pulp::x86::V4::try_new().is_some() {
            return Some(8);
        }
        if most >= 4 && pulp::x86::V3::try_new().is_some() {
            return Some(4);
        }
    }
    None
}

/// Bodies with elements whose units are moved several at a time.
pub trait Together<const D: usize>: Bodies<f64, D> + Sized {
    /// What acts on them.
    type Element;

    /// Moves `units` that are [alike](are_alike), as many at a time as there are [`lanes`].
    fn move_together(lanes: usize, units: &mut [Unit<Self, Self::Element, D>]);
}

/// Units to be moved by wide instructions.
struct Work<'w, 'a, B: Bodies<f64, D>, E, const D: usize> {
    units: &'w mut [Unit<'a, B, E, D>],
}

/// Compiled here, so that what calls it does not compile a step again.
macro_rules! together {
    ($($dimension:literal),*) => { $(
        impl WithSimd for Work<'_, '_, PlanarTree<f64, $dimension>, PlanarElement<$dimension>, $dimension> {
            type Output = ();

            #[inline(always)]
            fn with_simd<V: Simd>(self, instructions: V) {
                integrate(instructions, self.units);
            }
        }

        impl Together<$dimension> for PlanarTree<f64, $dimension> {
            type Element = PlanarElement<$dimension>;

            fn move_together(lanes: usize, units: &mut [Unit<Self, Self::Element, $dimension>]) {
                #[cfg(target_arch = "x86_64")]
                match (lanes, pulp::x86::V4::try_new(), pulp::x86::V3::try_new()) {
                    (8, Some(avx512), _) => Simd::vectorize(avx512, Work { units }),
                    (_, _, Some(avx2)) => Simd::vectorize(avx2, Work { units }),
                    _ => {}
                }
            }
        }
    )* };
}

together!(3, 6);
