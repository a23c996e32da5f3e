//! Many units by error-controlled steps, as many at a time as a pack has lanes.
//!
//! Every lane has a time and a step of its own, and takes the next unit as soon as its own has come to its end: units in
//! lockstep, or with one step for all, would wait for each other. The steps are those of the kernel's RODAS3.

use pulp::Simd;
use slipfit_core::{
    Scalar,
    integrator::{Integrator, Rodas3},
    law::{Elastic, Friction},
    mechanism::Mechanism,
    menu::SlideData,
    pose::Pose,
    slide::{CONTACTS, Internal, Slide},
};

use crate::{
    closing::{self, Approach, Between, Gaps},
    error_control::{CHANGES, FIRST_STEP, GREATEST_STEP, PLACE, SAFETY},
    out_of_line::OutOfLine,
    pack::Pack,
};

use super::{
    figures::{BETWEEN_NOTES, Ends, Figures, Watch},
    lane::{Motions, at_rest, numbers, put},
};

/// What all units are simulated for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// The longest simulated time (s).
    pub duration: f64,
    /// Travel (m) along the command at which a unit is at its end.
    pub stroke: Option<f64>,
    /// Error of the drive force (N) that a step may make.
    pub tolerance: f64,
}

/// As many slides as a pack has lanes.
pub trait Slides<V: Simd>: Mechanism<Pack<V>, 6, Pose = Pose<Pack<V>>, Internal = Internal<()>> {
    /// The gaps (m) of each.
    fn gaps(&self, pose: &Pose<Pack<V>>) -> [Pack<V>; CONTACTS];
}

impl<V: Simd, E: Elastic<Pack<V>>, F: Friction<Pack<V>, Internal = ()>> Slides<V> for Slide<Pack<V>, E, F> {
    #[inline(always)]
    fn gaps(&self, pose: &Pose<Pack<V>>) -> [Pack<V>; CONTACTS] {
        self.gaps(pose)
    }
}

impl<V: Simd, M: Slides<V>> Slides<V> for OutOfLine<M> {
    fn gaps(&self, pose: &Pose<Pack<V>>) -> [Pack<V>; CONTACTS] {
        self.mechanism().gaps(pose)
    }
}

/// Least step (s): single precision resolves no shorter ones.
const LEAST_STEP: f32 = 1e-9;
/// How far (m) from the end of its stroke a unit may stop.
const BEYOND: f64 = 1e-7;
/// The part of a step over which the rates of gaps are quotients of differences.
const DIFFERENCE: f32 = 0.05;
/// Steps after which a unit has stalled.
const MOST_STEPS: u32 = 200_000;

/// Simulates all `units`, slides that `load` makes of their parameters, and writes what each did to `figures`, of the same
/// length. Where `load` makes none there are no figures. That the machine has them is what `_instructions` prove.
#[inline(always)]
pub fn integrate<V: Simd, M: Slides<V>>(
    _instructions: V,
    course: &Course,
    units: &[SlideData<f64>],
    figures: &mut [Figures],
    load: impl Fn(&SlideData<Pack<V>>) -> Option<M>,
) {
    let Some(first) = units.first() else { return };
    let mut all = Lanes::<V>::new(first);
    let mut next = 0;
    loop {
        for lane in 0..Pack::<V>::LANES {
            if all.lanes[lane].ended {
                all.load(course, lane, &mut next, units);
            }
        }
        if !all.busy() {
            return;
        }
        let Some(slide) = load(&all.data) else { return };
        all.gaps = slide.gaps(&all.motions.pose);
        while !all.step(course, &slide, figures) {}
    }
}

/// Units at work.
struct Lanes<V: Simd> {
    data: SlideData<Pack<V>>,
    motions: Motions<V>,
    /// Gaps (m) there.
    gaps: [Pack<V>; CONTACTS],
    watch: Watch<V>,
    /// Distances (m) of the farthest pins from the centres of mass at the start.
    lever: Pack<V>,
    /// How deep (m) contacts may be that a step passes over: their forces are within the tolerance.
    depth: Pack<V>,
    /// Lengths of the next steps (s).
    lengths: Pack<V>,
    lanes: Vec<Lane>,
}

/// How far the unit in a lane is.
#[derive(Clone, Copy, Default)]
struct Lane {
    /// Its index; none if there are no more.
    unit: Option<usize>,
    ended: bool,
    /// Its time (s).
    time: f64,
    /// When its force was noted last (s).
    noted: f64,
    /// Steps, refused ones among them.
    tried: u32,
}

impl<V: Simd> Lanes<V> {
    fn new(any: &SlideData<f64>) -> Self {
        Self {
            data: any.cast(Pack::from_f64),
            motions: at_rest(),
            gaps: [Pack::splat(0.0); CONTACTS],
            watch: Watch::new(),
            lever: Pack::splat(0.0),
            depth: Pack::splat(0.0),
            lengths: Pack::from_f64(FIRST_STEP),
            lanes: vec![Lane { ended: true, ..Lane::default() }; Pack::<V>::LANES],
        }
    }

    fn busy(&self) -> bool {
        self.lanes.iter().any(|lane| lane.unit.is_some())
    }

    /// Puts the next of `units` into a `lane`, from rest.
    fn load(&mut self, course: &Course, lane: usize, next: &mut usize, units: &[SlideData<f64>]) {
        let unit = units.get(*next).map(|unit| {
            put(&mut self.data, lane, unit);
            let farthest = unit.body.pins_w.iter().map(|pin| pin.norm()).fold(0.0, f64::max);
            self.lever.set(lane, farthest as f32);
            let depth = libm::pow(course.tolerance / unit.contact.stiffness, 1.0 / unit.contact.exponent);
            self.depth.set(lane, depth.max(PLACE * course.tolerance) as f32);
            *next += 1;
            *next - 1
        });
        self.lanes[lane] = Lane { unit, noted: f64::NEG_INFINITY, ..Lane::default() };
        for (number, rest) in numbers(&mut self.motions).into_iter().zip(numbers(&mut at_rest::<V>())) {
            number.set(lane, rest.get(lane));
        }
        self.watch.clear(lane);
        self.lengths.set(lane, FIRST_STEP as f32);
    }

    /// A step in every lane; whether units have come to their ends by it.
    #[inline(always)]
    fn step<M: Slides<V>>(&mut self, course: &Course, slide: &M, figures: &mut [Figures]) -> bool {
        let (zero, one) = (Pack::splat(0.0), Pack::splat(1.0));
        let (mut start, mut length) = (zero, zero);
        for (lane, Lane { time, .. }) in self.lanes.iter().enumerate() {
            let left = (course.duration - time) as f32;
            start.set(lane, *time as f32);
            let step = self.lengths.get(lane);
            length.set(lane, if 1.01 * step >= left { left.max(LEAST_STEP) } else { step });
        }
        let mut step = Rodas3::step::<Pack<V>, _, 6>(slide, start, length, &self.motions);
        let error = self.error(course, [step.error, step.drift]);
        let factor = Pack::from_f64(SAFETY) / error.pow(Pack::from_f64(1.0 / 3.0));
        self.lengths = (length * factor.within(Pack::from_f64(CHANGES[0]), Pack::from_f64(CHANGES[1])))
            .within(Pack::splat(LEAST_STEP), Pack::from_f64(GREATEST_STEP));
        let drive = self.data.drive;
        let along = zero.select_gt(drive.speed, -one, one);
        let before = self.motions.pose.displacement_w.z * along;
        let after = step.motion.pose.displacement_w.z * along;
        // A step that ends beyond the stroke is taken again, as long as it may be.
        let stroke = Pack::from_f64(course.stroke.unwrap_or(f64::from(f32::MAX)));
        let beyond = (after - stroke).select_gt(Pack::from_f64(BEYOND), one, zero);
        let shorter = length * ((stroke - before) / (after - before)).within(Pack::splat(0.0), one);
        let good = error.select_gt(one, zero, one);
        let gaps = slide.gaps(&step.motion.pose);
        // Nor may it pass over a contact.
        let apart = self.apart(slide, &step.motion, &gaps, length, good);
        let accepted = (good - good * beyond) * apart;
        self.lengths = (good * beyond).select_gt(zero, shorter.max_of(Pack::splat(LEAST_STEP)), self.lengths);
        for (number, new) in numbers(&mut self.motions).into_iter().zip(numbers(&mut step.motion)) {
            *number = accepted.select_gt(zero, *new, *number);
        }
        for (gap, new) in self.gaps.iter_mut().zip(gaps) {
            *gap = accepted.select_gt(zero, new, *gap);
        }

        let speed = self.motions.velocity.z;
        let ends = Ends {
            accepted,
            start,
            length,
            force: drive.force(start + length, speed) * along,
            speed: speed * along,
            gaps: &self.gaps,
            ramp_start: drive.ramp_start,
        };
        self.watch.observe(&ends);
        let travel = self.motions.pose.displacement_w.z * along;
        for (lane, Lane { unit, ended, time, noted, tried }) in self.lanes.iter_mut().enumerate() {
            let Some(unit) = *unit else { continue };
            *tried += 1;
            if accepted.get(lane) > 0.0 {
                *time += f64::from(length.get(lane));
                if *time - *noted >= BETWEEN_NOTES {
                    self.watch.note(lane, *time);
                    *noted = *time;
                }
            }
            let stalled = (good.get(lane) == 0.0 && length.get(lane) <= LEAST_STEP) || *tried >= MOST_STEPS;
            let at_end = travel.get(lane) >= stroke.get(lane) - BEYOND as f32;
            *ended = stalled || at_end || *time >= course.duration - f64::from(LEAST_STEP);
            if *ended {
                let of_unit = &mut figures[unit];
                self.watch.conclude(lane, *time, of_unit);
                of_unit.final_velocity = ends.speed.get(lane);
                of_unit.travel = travel.get(lane).min(stroke.get(lane));
                (of_unit.steps, of_unit.stalled) = (*tried, stalled);
            }
        }
        self.lanes.iter().any(|lane| lane.ended)
    }

    /// 1 in each lane whose step of this `length` (s) to the motions `after` and the `gaps` (m) there passes no contact over, or is not
    /// `good`; 0 in the others, and a shorter length for the next step. A contact counts that is deep enough to err by more than the
    /// tolerance.
    #[inline(always)]
    fn apart<M: Slides<V>>(
        &mut self,
        slide: &M,
        after: &Motions<V>,
        gaps: &[Pack<V>; CONTACTS],
        length: Pack<V>,
        good: Pack<V>,
    ) -> Pack<V> {
        let (zero, one) = (Pack::splat(0.0), Pack::splat(1.0));
        // A gap that closes and opens again moves twice its own size; a contact moves no faster than this.
        let speed = self.most_approach(&self.motions).max_of(self.most_approach(after));
        let reach = speed * length * Pack::splat(0.75) - self.depth;
        let mut may_close = zero;
        for (from, to) in self.gaps.iter().zip(gaps) {
            let least = from.select_gt(*to, *to, *from);
            let is_open = least.select_gt(zero, one, zero);
            may_close = reach.select_gt(least, may_close.max_of(is_open), may_close);
        }
        let may_close = may_close * good;
        if may_close <= zero {
            return one;
        }
        self.searched(slide, after, gaps, length, may_close)
    }

    /// A speed (m/s) that no gap exceeds: sliding counts as far as the walls are tilted.
    #[inline(always)]
    fn most_approach(&self, motions: &Motions<V>) -> Pack<V> {
        let amount = |x: Pack<V>| x.max_of(-x);
        let [x, y, z, turn_x, turn_y, turn_z] = motions.velocity.data.0[0].map(amount);
        let pose = &motions.pose;
        let tilt = pose.orientation.v.data.0[0].map(amount);
        let place = pose.displacement_w.data.0[0].map(amount);
        let tilt = (tilt[0] + tilt[1] + tilt[2]) * Pack::splat(2.0);
        let lever = self.lever + place[0] + place[1] + place[2];
        x + y + z * tilt + (turn_x + turn_y + turn_z) * lever
    }

    /// [`apart`](Self::apart) where lanes `may_close`, each for itself. Out of line, since it is rare.
    #[inline(never)]
    fn searched<M: Slides<V>>(
        &mut self,
        slide: &M,
        after: &Motions<V>,
        gaps: &[Pack<V>; CONTACTS],
        length: Pack<V>,
        may_close: Pack<V>,
    ) -> Pack<V> {
        let part = length * Pack::splat(DIFFERENCE);
        let later = |motions: &Motions<V>| slide.gaps(&slide.explicit_update(&motions.pose, &motions.velocity, part));
        let ends = [(&self.motions, &self.gaps, later(&self.motions)), (after, gaps, later(after))];
        let speeds = [self.most_approach(&self.motions), self.most_approach(after)];
        let mut apart = Pack::splat(1.0);
        for lane in 0..Pack::<V>::LANES {
            if may_close.get(lane) <= 0.0 {
                continue;
            }
            let number = |pack: &Pack<V>| f64::from(pack.get(lane));
            let [before, after] = [0, 1].map(|end| {
                let (motions, gaps, later) = &ends[end];
                let approach = |(gap, later): (&Pack<V>, &Pack<V>)| {
                    let [gap, later] = [gap, later].map(number);
                    Approach { gap, rate: (later - gap) / number(&part), speed: number(&speeds[end]) }
                };
                let [.., x, y, z] = motions.velocity.data.0[0].each_ref().map(number);
                let spin = libm::sqrt(x * x + y * y + z * z);
                Gaps { approaches: gaps.iter().zip(later).map(approach).collect(), spin }
            });
            if let Between::Closes(share) = closing::between(&before, &after, number(&length), number(&self.depth))
                && length.get(lane) > LEAST_STEP
            {
                apart.set(lane, 0.0);
                self.lengths.set(lane, (length.get(lane) * share as f32).max(LEAST_STEP));
            }
        }
        apart
    }

    /// The error of a step whose estimates of momentum (N·s) and of place (N·s²) these are; 1 is allowed. What is not a
    /// number is the worst of all.
    #[inline(always)]
    fn error(&self, course: &Course, [momentum, place]: [Pack<V>; 2]) -> Pack<V> {
        let (mass, gain) = (self.data.body.mass, self.data.drive.gain);
        let velocity_error = momentum * (gain * Pack::from_f64(1.0 / course.tolerance));
        let place_error = place * Pack::from_f64(1.0 / (PLACE * course.tolerance));
        let not_a_number = (velocity_error + place_error) * Pack::splat(0.0);
        let error = (velocity_error.max_of(place_error) + not_a_number) / mass;
        let worst = Pack::splat(1e9);
        worst.select_gt(error, error, worst).max_of(Pack::splat(1e-9))
    }
}
