//! Many units by error-controlled steps, as many at a time as a pack has lanes.
//!
//! Every lane has a time and a step of its own, and takes the next unit as soon as its own has come to its end: units in
//! lockstep, or with one step for all, would wait for each other. The steps are those of the kernel's RODAS3.

use slipfit_core::{
    Scalar,
    integrator::{Integrator, Rodas3},
    law::{Elastic, Friction},
    mechanism::Mechanism,
    menu::SlideData,
    pose::Pose,
    slide::{CONTACTS, SLOTS, Slide},
};

use crate::dynamics::{
    error_control::{CHANGES, FIRST_STEP, GREATEST_STEP, PLACE, SAFETY},
    out_of_line::OutOfLine,
};

use super::{
    figures::{Ends, Figures, Watch},
    lane::{Motions, at_rest, each_number, put},
    pack::Pack,
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
pub trait Slides<const W: usize>: Mechanism<Pack<W>, 6, Pose = Pose<Pack<W>>, Memory = [(); SLOTS]> {
    /// The gaps (m) of each.
    fn gaps(&self, pose: &Pose<Pack<W>>) -> [Pack<W>; CONTACTS];
}

impl<const W: usize, E: Elastic<Pack<W>>, F: Friction<Pack<W>, Memory = ()>> Slides<W> for Slide<Pack<W>, E, F> {
    #[inline(always)]
    fn gaps(&self, pose: &Pose<Pack<W>>) -> [Pack<W>; CONTACTS] {
        self.gaps(pose)
    }
}

impl<const W: usize, M: Slides<W>> Slides<W> for OutOfLine<Pack<W>, M, 6> {
    fn gaps(&self, pose: &Pose<Pack<W>>) -> [Pack<W>; CONTACTS] {
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
/// length. Where `load` makes none there are no figures.
#[inline(always)]
pub fn integrate<const W: usize, M: Slides<W>>(
    course: &Course,
    units: &[SlideData<f64>],
    figures: &mut [Figures],
    load: impl Fn(&SlideData<Pack<W>>) -> Option<M>,
) {
    let Some(first) = units.first() else { return };
    let mut lanes = Lanes::<W>::new(first);
    let mut next = 0;
    for lane in 0..W {
        lanes.load(lane, &mut next, units);
    }
    let Some(mut slide) = load(&lanes.data) else { return };
    while lanes.busy() {
        if lanes.step(course, &slide, figures) {
            for lane in 0..W {
                if lanes.ended[lane] {
                    lanes.load(lane, &mut next, units);
                }
            }
            let Some(loaded) = load(&lanes.data) else { return };
            slide = loaded;
        }
    }
}

/// Units at work.
struct Lanes<const W: usize> {
    data: SlideData<Pack<W>>,
    motions: Motions<W>,
    watch: Watch<W>,
    /// Which unit is in each lane.
    units: [Option<usize>; W],
    ended: [bool; W],
    times: [f64; W],
    lengths: Pack<W>,
    tried: [u32; W],
}

impl<const W: usize> Lanes<W> {
    fn new(any: &SlideData<f64>) -> Self {
        Self {
            data: any.cast(Pack::from_f64),
            motions: at_rest(),
            watch: Watch::new(),
            units: [None; W],
            ended: [false; W],
            times: [0.0; W],
            lengths: Pack::from_f64(FIRST_STEP),
            tried: [0; W],
        }
    }

    fn busy(&self) -> bool {
        self.units.iter().any(Option::is_some)
    }

    /// Puts the next of `units` into a `lane`, from rest.
    fn load(&mut self, lane: usize, next: &mut usize, units: &[SlideData<f64>]) {
        self.units[lane] = units.get(*next).map(|unit| {
            put(&mut self.data, lane, unit);
            *next += 1;
            *next - 1
        });
        each_number(&mut self.motions, &at_rest(), |number, rest| number.0[lane] = rest.0[lane]);
        self.watch.clear(lane);
        (self.ended[lane], self.times[lane], self.tried[lane]) = (false, 0.0, 0);
        self.lengths.0[lane] = FIRST_STEP as f32;
    }

    /// A step in every lane; whether units have come to their ends by it.
    #[inline(always)]
    fn step<M: Slides<W>>(&mut self, course: &Course, slide: &M, figures: &mut [Figures]) -> bool {
        let (zero, one) = (Pack::splat(0.0), Pack::splat(1.0));
        let (mut start, mut length) = (zero, zero);
        for lane in 0..W {
            let left = (course.duration - self.times[lane]) as f32;
            start.0[lane] = self.times[lane] as f32;
            let step = self.lengths.0[lane];
            length.0[lane] = if 1.01 * step >= left { left.max(LEAST_STEP) } else { step };
        }
        let step = Rodas3::step::<Pack<W>, _, 6>(slide, start, length, &self.motions);
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
        each_number(&mut self.motions, &step.motion, |number, new| *number = accepted.select_gt(zero, new, *number));

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
        for lane in 0..W {
            let Some(unit) = self.units[lane] else { continue };
            self.tried[lane] += 1;
            if accepted.0[lane] > 0.0 {
                self.times[lane] += f64::from(length.0[lane]);
                self.watch.mark(lane, self.times[lane]);
            }
            let stalled = (good.0[lane] == 0.0 && length.0[lane] <= LEAST_STEP) || self.tried[lane] >= MOST_STEPS;
            let at_end = travel.0[lane] >= stroke.0[lane] - BEYOND as f32;
            self.ended[lane] = stalled || at_end || self.times[lane] >= course.duration - f64::from(LEAST_STEP);
            if self.ended[lane] {
                let of_unit = &mut figures[unit];
                self.watch.conclude(lane, self.times[lane], of_unit);
                of_unit.final_velocity = ends.speed.0[lane];
                of_unit.travel = travel.0[lane].min(stroke.0[lane]);
                (of_unit.steps, of_unit.stalled) = (self.tried[lane], stalled);
            }
        }
        self.ended.contains(&true)
    }

    /// The error of a step whose estimates of momentum (N·s) and of place (N·s²) these are; 1 is allowed. What is not a
    /// number is the worst of all.
    #[inline(always)]
    fn error(&self, course: &Course, [momentum, place]: [Pack<W>; 2]) -> Pack<W> {
        let (mass, gain) = (self.data.body.mass, self.data.drive.gain);
        let velocity_error = momentum * (gain * Pack::from_f64(1.0 / course.tolerance));
        let place_error = place * Pack::from_f64(1.0 / (PLACE * course.tolerance));
        let not_a_number = (velocity_error + place_error) * Pack::splat(0.0);
        let error = (velocity_error.max_of(place_error) + not_a_number) / mass;
        let worst = Pack::splat(1e9);
        worst.select_gt(error, error, worst).max_of(Pack::splat(1e-9))
    }
}
