//! Many units by error-controlled steps, as many at a time as a pack has lanes.
//!
//! Every lane has a time and a step of its own, and takes the next unit as soon as its own has come to its end: units in
//! lockstep, or with one step for all, would wait for each other. The steps are those of the kernel's RODAS3.

use pulp::Simd;
use slipfit_core::{
    SVector, Scalar, Vector3,
    integrator::{Integrator, Rodas3},
    law::{Elastic, Friction},
    mechanism::Mechanism,
    menu::SlideData,
    pose::Pose,
    slide::{Internal, PINS, Slide, to_walls},
    system::Seen,
};

use crate::{
    error_control::{CHANGES, FIRST_STEP, GREATEST_STEP, PLACE, SAFETY},
    out_of_line::OutOfLine,
    pack::Pack,
};

use super::{
    cube_root::cube_root,
    figures::{BETWEEN_NOTES, Ends, Figures, Watch},
    lane::{Motions, at_rest, numbers, put},
    passed_over::{self, End},
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
    /// See [`Slide::pins`].
    fn pins(&self, pose: &Pose<Pack<V>>, velocity: &SVector<Pack<V>, 6>) -> [Seen<Pack<V>, 3>; PINS];

    /// The normal force (N) of a contact at this `penetration` (m) and its `rate` (m/s).
    fn pressed(&self, penetration: Pack<V>, rate: Pack<V>) -> Pack<V>;
}

impl<V: Simd, E: Elastic<Pack<V>>, F: Friction<Pack<V>, Internal = ()>> Slides<V> for Slide<Pack<V>, E, F> {
    #[inline(always)]
    fn pins(&self, pose: &Pose<Pack<V>>, velocity: &SVector<Pack<V>, 6>) -> [Seen<Pack<V>, 3>; PINS] {
        self.pins(pose, velocity)
    }

    #[inline(always)]
    fn pressed(&self, penetration: Pack<V>, rate: Pack<V>) -> Pack<V> {
        self.contact().normal.response(penetration, rate).force
    }
}

impl<V: Simd, M: Slides<V>> Slides<V> for OutOfLine<M> {
    fn pins(&self, pose: &Pose<Pack<V>>, velocity: &SVector<Pack<V>, 6>) -> [Seen<Pack<V>, 3>; PINS] {
        self.mechanism().pins(pose, velocity)
    }

    fn pressed(&self, penetration: Pack<V>, rate: Pack<V>) -> Pack<V> {
        self.mechanism().pressed(penetration, rate)
    }
}

/// Least step (s): single precision resolves no shorter ones.
const LEAST_STEP: f32 = 1e-9;
/// How far (m) from the end of its stroke a unit may stop.
const BEYOND: f64 = 1e-7;
/// Steps after which a unit has stalled.
const MOST_STEPS: f64 = 200_000.0;

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
            if all.progress.ended.get(lane) > 0.0 {
                all.load(lane, &mut next, units);
            }
        }
        if !all.busy() {
            return;
        }
        let Some(slide) = load(&all.data) else { return };
        all.pins = slide.pins(&all.motions.pose, &all.motions.velocity);
        while !all.step(course, &slide, figures) {}
    }
}

/// Units at work.
struct Lanes<V: Simd> {
    data: SlideData<Pack<V>>,
    motions: Motions<V>,
    /// How the slides see their pins there.
    pins: [Seen<Pack<V>, 3>; PINS],
    watch: Watch<V>,
    /// Lengths of the next steps (s).
    lengths: Pack<V>,
    progress: Progress<V>,
}

/// The most lanes of a register.
const MOST_LANES: usize = 16;

/// How far the unit in each lane is.
struct Progress<V: Simd> {
    /// Its index.
    units: [usize; MOST_LANES],
    /// 1 where there is one, 0 where there are no more.
    busy: Pack<V>,
    /// Its time (s).
    times: [f64; MOST_LANES],
    /// Time (s) since its force was noted last.
    since_note: Pack<V>,
    /// Steps, refused ones among them.
    tried: Pack<V>,
    /// Above 0 where it has come to its end, and the lane waits for another.
    ended: Pack<V>,
}

impl<V: Simd> Lanes<V> {
    fn new(any: &SlideData<f64>) -> Self {
        Self {
            data: any.cast(Pack::from_f64),
            motions: at_rest(),
            pins: [Seen { place: Vector3::zeros(), rate: Vector3::zeros() }; PINS],
            watch: Watch::new(),
            lengths: Pack::from_f64(FIRST_STEP),
            progress: Progress {
                units: [0; MOST_LANES],
                busy: Pack::splat(0.0),
                times: [0.0; MOST_LANES],
                since_note: Pack::splat(0.0),
                tried: Pack::splat(0.0),
                ended: Pack::splat(1.0),
            },
        }
    }

    fn busy(&self) -> bool {
        self.progress.busy.numbers().iter().any(|busy| *busy > 0.0)
    }

    /// Puts the next of `units` into a `lane`, from rest.
    fn load(&mut self, lane: usize, next: &mut usize, units: &[SlideData<f64>]) {
        let of = &mut self.progress;
        of.busy.set(lane, 0.0);
        if let Some(unit) = units.get(*next) {
            put(&mut self.data, lane, unit);
            of.busy.set(lane, 1.0);
            of.units[lane] = *next;
            *next += 1;
        }
        of.times[lane] = 0.0;
        of.since_note.set(lane, f32::INFINITY);
        of.tried.set(lane, 0.0);
        of.ended.set(lane, 0.0);
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
        let (mut start, mut left) = (zero, zero);
        for (lane, time) in self.progress.times[..Pack::<V>::LANES].iter().enumerate() {
            start.set(lane, *time as f32);
            left.set(lane, (course.duration - time) as f32);
        }
        let length =
            left.select_gt(self.lengths * Pack::splat(1.01), self.lengths, left.max_of(Pack::splat(LEAST_STEP)));
        let mut step = Rodas3::step::<Pack<V>, _, 6>(slide, start, length, &self.motions);
        let error = self.error(course, [step.error, step.drift]);
        let mut root = error;
        root.numbers_mut().iter_mut().for_each(|x| *x = cube_root(*x));
        let factor = Pack::from_f64(SAFETY) / root;
        self.lengths = (length * factor.within(Pack::from_f64(CHANGES[0]), Pack::from_f64(CHANGES[1])))
            .within(Pack::splat(LEAST_STEP), Pack::from_f64(GREATEST_STEP));
        let along = zero.select_gt(self.data.drive.speed, -one, one);
        let before = self.motions.pose.displacement_w.z * along;
        let after = step.motion.pose.displacement_w.z * along;
        // A step that ends beyond the stroke is taken again, as long as it may be.
        let stroke = Pack::from_f64(course.stroke.unwrap_or(f64::from(f32::MAX)));
        let beyond = (after - stroke).select_gt(Pack::from_f64(BEYOND), one, zero);
        let shorter = length * ((stroke - before) / (after - before)).within(Pack::splat(0.0), one);
        let good = error.select_gt(one, zero, one);
        self.lengths = (good * beyond).select_gt(zero, shorter.max_of(Pack::splat(LEAST_STEP)), self.lengths);
        let within = good - good * beyond;
        // One that passes a contact over ends within it instead.
        let pins = slide.pins(&step.motion.pose, &step.motion.velocity);
        let ends = [
            End { pins: &self.pins, velocity: &self.motions.velocity },
            End { pins: &pins, velocity: &step.motion.velocity },
        ];
        let asked = length.select_gt(Pack::splat(LEAST_STEP), within, zero);
        let pressed = |penetration, rate| slide.pressed(penetration, rate);
        let share = passed_over::share(&self.data, ends, length, asked, PLACE * course.tolerance, pressed);
        let accepted = one.select_gt(share, zero, within);
        self.lengths = one.select_gt(share, (length * share).max_of(Pack::splat(LEAST_STEP)), self.lengths);
        for (number, new) in numbers(&mut self.motions).into_iter().zip(numbers(&mut step.motion)) {
            *number = accepted.select_gt(zero, *new, *number);
        }
        for (Seen { place, rate }, new) in self.pins.iter_mut().zip(&pins) {
            for axis in 0..2 {
                place[axis] = accepted.select_gt(zero, new.place[axis], place[axis]);
                rate[axis] = accepted.select_gt(zero, new.rate[axis], rate[axis]);
            }
        }

        let (drive, speed) = (&self.data.drive, self.motions.velocity.z);
        let mut gaps = self.data.body.gaps;
        for (gaps, pin) in gaps.as_chunks_mut::<4>().0.iter_mut().zip(&self.pins) {
            *gaps = to_walls(*gaps, &pin.place);
        }
        let ends = Ends {
            accepted,
            start,
            length,
            force: drive.force(start + length, speed) * along,
            speed: speed * along,
            gaps: &gaps,
            ramp_start: drive.ramp_start,
        };
        self.watch.observe(&ends);
        let travel = self.motions.pose.displacement_w.z * along;
        let Progress { units, busy, times, since_note, tried, ended } = &mut self.progress;
        let gone = length * accepted;
        times.iter_mut().zip(gone.numbers()).for_each(|(time, gone)| *time += f64::from(*gone));
        *tried += one;
        *since_note += gone;
        let notes = *busy * Pack::from_f64(BETWEEN_NOTES).select_gt(*since_note, zero, accepted);
        *since_note = notes.select_gt(zero, zero, *since_note);
        let least_step = Pack::splat(LEAST_STEP);
        let stalled = (one - good) * length.select_gt(least_step, zero, one);
        let stalled = Pack::from_f64(MOST_STEPS).select_gt(*tried, stalled, one);
        let at_stroke = (stroke - Pack::from_f64(BEYOND)).select_gt(travel, zero, one);
        *ended = *busy * (left - gone).select_gt(least_step, stalled.max_of(at_stroke), one);
        for lane in 0..Pack::<V>::LANES {
            if notes.get(lane) > 0.0 {
                self.watch.note(lane, times[lane]);
            }
            if ended.get(lane) > 0.0 {
                let of_unit = &mut figures[units[lane]];
                self.watch.conclude(lane, times[lane], of_unit);
                of_unit.final_velocity = ends.speed.get(lane);
                of_unit.travel = travel.get(lane).min(stroke.get(lane));
                (of_unit.steps, of_unit.stalled) = (tried.get(lane) as u32, stalled.get(lane) > 0.0);
            }
        }
        self.watch.forget_extremes(notes);
        let none_ended = *ended <= zero;
        !none_ended
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

#[cfg(test)]
mod tests {
    use slipfit_core::slide::ABSENT;

    use super::*;
    use crate::laws;

    /// Of the four gaps of a pin, the one that opens as the slide rises and the one that closes.
    const RAIL: usize = 2;
    const CEILING: usize = 3;

    /// More units than lanes, and a number of them that no register divides: each has the figures that it has alone.
    #[test]
    fn lanes_that_have_no_more_units_change_nothing() {
        let slides: Vec<SlideData<f64>> = (0..19).map(|k| slide(RAIL, 1e-6 * f64::from(k))).collect();
        let course = Course { duration: 0.02, stroke: None, tolerance: 1e-4 };
        let together = super::super::simulate(course, &slides);
        for (slide, figures) in slides.iter().zip(&together) {
            let alone = super::super::simulate(course, std::slice::from_ref(slide));
            assert_eq!(format!("{:?}", alone[0]), format!("{figures:?}"));
        }
    }

    /// A slide on four pins at the distance `gap` (m) from this wall of each.
    fn slide(wall: usize, gap: f64) -> SlideData<f64> {
        let mut data = slipfit_problems::cd_rom::data(0.0);
        data.body.pins_w =
            [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, z]| Vector3::new(x, 0.0, z) * 0.05);
        data.body.gaps = std::array::from_fn(|k| if k % 4 == wall { gap } else { ABSENT });
        (data.drive.ramp_start, data.drive.ramp_end) = (10.0, 11.0);
        data
    }

    /// The greatest height (m), and the speed (m/s) at the end, of a slide that is thrown up at this `speed` for a `duration` (s).
    fn thrown(data: &SlideData<f64>, speed: f32, duration: f64, tolerance: f64) -> [f64; 2] {
        let course = Course { duration: 1.0, stroke: None, tolerance };
        let mut lanes = Lanes::<pulp::Scalar>::new(data);
        lanes.load(0, &mut 0, std::slice::from_ref(data));
        lanes.motions.velocity.y.set(0, speed);
        let slide = laws::usual::<Pack<pulp::Scalar>>(&lanes.data).unwrap();
        lanes.pins = slide.pins(&lanes.motions.pose, &lanes.motions.velocity);
        let mut figures = [Figures::NONE];
        let mut highest = 0.0;
        while lanes.progress.times[0] < duration {
            lanes.step(&course, &slide, &mut figures);
            highest = lanes.motions.pose.displacement_w.y.get(0).max(highest);
        }
        [highest, lanes.motions.velocity.y.get(0)].map(f64::from)
    }

    /// Pins that leave their walls faster than springs can follow are pushed at last, where damping has faded out.
    #[test]
    fn a_slide_that_leaves_damped_walls_is_pushed_at_last() {
        // Depth at the start and depth of full damping (m), damping (N·s/m), stiffness (N/m^1.5), speed (m/s).
        let starts = [
            [63.2e-6, 43.7e-6, 3520.0, 7.0e8, 0.0618],
            [275e-6, 99.5e-6, 4270.0, 2.5e8, 0.106],
            [224e-6, 165e-6, 2810.0, 3.0e8, 0.343],
            [32.8e-6, 58.1e-6, 5820.0, 1.8e9, 0.181],
        ];
        for [start, full, damping, stiffness, speed] in starts {
            let mut data = slide(RAIL, -start);
            data.body.gravity_w = Vector3::zeros();
            (data.contact.stiffness, data.contact.damping, data.contact.depth) = (stiffness, damping, full);
            let (mut height, mut expected, h) = (0.0, speed, 1e-8);
            while height < start {
                let depth: f64 = start - height;
                let s = (depth / full).min(1.0);
                let force = stiffness * depth * libm::sqrt(depth) - damping * s * s * (3.0 - 2.0 * s) * expected;
                expected += h * 4.0 * force.max(0.0) / data.body.mass;
                height += h * expected;
            }
            for tolerance in [1e-3, 1e-4] {
                let [_, found] = thrown(&data, speed as f32, 2.0 * start / speed, tolerance);
                let [gained, error] = [expected - speed, found - expected];
                assert!(gained > 5e-3 * speed, "{start} {speed}: {gained}");
                // In a step the speed may err by what the drive's force may.
                let allowed = 1e-2 * gained + 2.0 * tolerance / data.drive.gain;
                assert!(error.abs() < allowed, "{start} {speed} {tolerance}: {error} of {gained}");
            }
        }
    }

    /// The closed form: what reaches the walls with some speed presses into them until their springs hold its energy.
    #[test]
    fn a_slide_that_is_thrown_at_walls_does_not_pass_through_them() {
        let data = slipfit_problems::cd_rom::data(0.0);
        for ceiling in [40.0, 50.0, 50.9, 50.95, 50.96, 51.0] {
            let ceiling = ceiling * 1e-3;
            let energy = 0.5 * data.body.mass * f64::max(1.0 - 2.0 * 9.81 * ceiling, 0.0);
            for stiffness in [2e4, 2e5] {
                let power = data.contact.exponent + 1.0;
                let pressed = libm::pow(energy * power / (4.0 * stiffness), 1.0 / power);
                let highest = (ceiling + pressed).min(1.0 / (2.0 * 9.81));
                let mut data = slide(CEILING, ceiling);
                data.body.gravity_w = Vector3::new(0.0, -9.81, 0.0);
                (data.contact.stiffness, data.contact.damping) = (stiffness, 0.0);
                for tolerance in [1e-1, 1e-3] {
                    let [found, _] = thrown(&data, 1.0, 0.15, tolerance);
                    let least = highest - if ceiling > highest { 1e-3 } else { pressed.max(1e-5) };
                    assert!(
                        found < highest + 2e-6 && found > least,
                        "{ceiling} {stiffness} {tolerance}: {found} {highest}"
                    );
                }
            }
        }
    }
}
