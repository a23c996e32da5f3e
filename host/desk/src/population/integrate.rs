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
                all.load(lane, &mut next, units);
            }
        }
        if !all.busy() {
            return;
        }
        let Some(slide) = load(&all.data) else { return };
        while !all.step(course, &slide, figures) {}
    }
}

/// Units at work.
struct Lanes<V: Simd> {
    data: SlideData<Pack<V>>,
    motions: Motions<V>,
    watch: Watch<V>,
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
            watch: Watch::new(),
            lengths: Pack::from_f64(FIRST_STEP),
            lanes: vec![Lane { ended: true, ..Lane::default() }; Pack::<V>::LANES],
        }
    }

    fn busy(&self) -> bool {
        self.lanes.iter().any(|lane| lane.unit.is_some())
    }

    /// Puts the next of `units` into a `lane`, from rest.
    fn load(&mut self, lane: usize, next: &mut usize, units: &[SlideData<f64>]) {
        let unit = units.get(*next).map(|unit| {
            put(&mut self.data, lane, unit);
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
        let drive = &self.data.drive;
        let along = zero.select_gt(drive.speed, -one, one);
        let before = self.motions.pose.displacement_w.z * along;
        let after = step.motion.pose.displacement_w.z * along;
        // A step that ends beyond the stroke is taken again, as long as it may be.
        let stroke = Pack::from_f64(course.stroke.unwrap_or(f64::from(f32::MAX)));
        let beyond = (after - stroke).select_gt(Pack::from_f64(BEYOND), one, zero);
        let shorter = length * ((stroke - before) / (after - before)).within(Pack::splat(0.0), one);
        let good = error.select_gt(one, zero, one);
        let accepted = good - good * beyond;
        self.lengths = (good * beyond).select_gt(zero, shorter.max_of(Pack::splat(LEAST_STEP)), self.lengths);
        for (number, new) in numbers(&mut self.motions).into_iter().zip(numbers(&mut step.motion)) {
            *number = accepted.select_gt(zero, *new, *number);
        }

        let speed = self.motions.velocity.z;
        let ends = Ends {
            accepted,
            start,
            length,
            force: drive.force(start + length, speed) * along,
            speed: speed * along,
            gaps: &slide.gaps(&self.motions.pose),
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
