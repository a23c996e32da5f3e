//! What is kept of units while they move: figures, not runs.

use pulp::Simd;
use slipfit_core::{Scalar, slide::CONTACTS};

use crate::{
    pack::Pack,
    settled::{BREAKAWAY_SPEED, SETTLED_SHARE, SETTLED_WINDOW, settled},
};

/// Figures of one unit, in SI units. Speeds, forces and travel count along the commanded direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// When the slide breaks away (s): the last upward crossing of 0.2 mm/s after the ramp's start; NaN if there is none.
    pub breakaway: f32,
    /// Magnitude of the greatest force, driving or braking, from the ramp's start on (N).
    pub peak_force: f32,
    /// Mean force over the last 20 ms (N), if it varies by less than 1 %; else NaN.
    pub settled_force: f32,
    /// Least and greatest velocity (m/s) over the last 20 ms.
    pub end_speeds: [f32; 2],
    /// Velocity at the end (m/s).
    pub final_velocity: f32,
    /// End of the run (s).
    pub end: f32,
    /// Travel at the end (m).
    pub travel: f32,
    /// The contact that was pressed in deepest.
    pub contact: u8,
    /// How deep (m).
    pub depth: f32,
    /// Steps, refused ones among them.
    pub steps: u32,
    /// Whether no step, however short, met the tolerance: the figures are those up to there.
    pub stalled: bool,
}

impl Figures {
    /// Of a unit that was not simulated.
    pub const NONE: Self = Self {
        breakaway: f32::NAN,
        peak_force: f32::NAN,
        settled_force: f32::NAN,
        end_speeds: [f32::NAN; 2],
        final_velocity: f32::NAN,
        end: 0.0,
        travel: 0.0,
        contact: 0,
        depth: 0.0,
        steps: 0,
        stalled: true,
    };
}

/// Ends of steps whose force and speed count for whether it has settled: one in this share of the window.
const SAMPLES: usize = 32;
/// Least time (s) between two of them.
pub const BETWEEN_NOTES: f64 = SETTLED_WINDOW / SAMPLES as f64;

/// Watches as many units as a pack has lanes.
pub struct Watch<V: Simd> {
    breakaway: Pack<V>,
    peak: Pack<V>,
    depths: [Pack<V>; CONTACTS],
    /// Force and speed at the end of the last accepted step, the force before that, and the length of the step between.
    force: Pack<V>,
    speed: Pack<V>,
    force_before: Pack<V>,
    length_before: Pack<V>,
    /// Least and greatest force and speed at the ends of accepted steps since the last note.
    forces: [Pack<V>; 2],
    speeds: [Pack<V>; 2],
    windows: Vec<Window>,
}

/// The ends of steps that are accepted in some lanes.
pub struct Ends<'a, V: Simd> {
    /// Above 0 where the step is accepted.
    pub accepted: Pack<V>,
    /// Time at the start of the step (s).
    pub start: Pack<V>,
    /// Its length (s).
    pub length: Pack<V>,
    /// Drive force (N) at its end.
    pub force: Pack<V>,
    /// Speed (m/s) at its end.
    pub speed: Pack<V>,
    /// Gaps (m) at its end.
    pub gaps: &'a [Pack<V>; CONTACTS],
    /// Start of the ramp (s).
    pub ramp_start: Pack<V>,
}

impl<V: Simd> Ends<'_, V> {
    /// `new` where the step is accepted, else `old`.
    #[inline(always)]
    fn or_old(&self, new: Pack<V>, old: Pack<V>) -> Pack<V> {
        self.accepted.select_gt(Pack::splat(0.0), new, old)
    }

    /// `yes` where the time `t` (s) is not before the ramp's start, else `no`.
    #[inline(always)]
    fn since_ramp(&self, t: Pack<V>, yes: Pack<V>, no: Pack<V>) -> Pack<V> {
        self.ramp_start.select_gt(t, no, yes)
    }
}

impl<V: Simd> Watch<V> {
    /// Of units that have not begun.
    pub fn new() -> Self {
        let zero = Pack::splat(0.0);
        let mut watch = Self {
            breakaway: zero,
            peak: zero,
            depths: [zero; CONTACTS],
            force: zero,
            speed: zero,
            force_before: zero,
            length_before: zero,
            forces: [zero; 2],
            speeds: [zero; 2],
            windows: vec![Window::EMPTY; Pack::<V>::LANES],
        };
        (0..Pack::<V>::LANES).for_each(|lane| watch.clear(lane));
        watch
    }

    /// Forgets what was in a `lane`.
    pub fn clear(&mut self, lane: usize) {
        let Self { breakaway, peak, depths, force, speed, force_before, length_before, forces, speeds, windows } = self;
        breakaway.set(lane, f32::NAN);
        peak.set(lane, f32::NEG_INFINITY);
        length_before.set(lane, 1.0);
        depths.iter_mut().chain([force, speed, force_before]).for_each(|pack| pack.set(lane, 0.0));
        for [least, greatest] in [forces, speeds] {
            least.set(lane, f32::INFINITY);
            greatest.set(lane, f32::NEG_INFINITY);
        }
        windows[lane].clear();
    }

    /// Takes note of the ends of steps.
    #[inline(always)]
    pub fn observe(&mut self, ends: &Ends<V>) {
        let Ends { start, length, force, speed, gaps, .. } = *ends;
        let zero = Pack::splat(0.0);
        let end = start + length;

        let threshold = Pack::splat(BREAKAWAY_SPEED as f32);
        let crossing = start + length * (threshold - self.speed) / (speed - self.speed);
        let crosses =
            threshold.select_gt(self.speed, threshold.select_gt(speed, self.breakaway, crossing), self.breakaway);
        self.breakaway = ends.or_old(ends.since_ramp(start, crosses, self.breakaway), self.breakaway);

        // The top of the parabola through three ends, where the middle one is the highest.
        // Number by number: in a map over an array vectors would not stay in registers.
        let (before, middle) = (self.force_before.max_of(-self.force_before), self.force.max_of(-self.force));
        let last = force.max_of(-force);
        let rise = (middle - before) / self.length_before;
        let fall = (last - middle) / length;
        let bend = (rise - fall) / (self.length_before + length);
        let slope = (rise * length + fall * self.length_before) / (self.length_before + length);
        let top = middle + slope * slope / (bend * Pack::splat(4.0));
        let is_top = rise.select_gt(zero, zero.select_gt(fall, top, self.peak), self.peak);
        // Only what begins after the ramp's start counts; NaN keeps the old.
        let between = ends.since_ramp(start, self.peak.max_of(is_top), self.peak);
        let peak = between.max_of(ends.since_ramp(end, last, self.peak));
        self.peak = ends.or_old(peak, self.peak);

        for (depth, gap) in self.depths.iter_mut().zip(gaps) {
            *depth = ends.or_old(depth.max_of(-*gap), *depth);
        }
        self.force_before = ends.or_old(self.force, self.force_before);
        self.length_before = ends.or_old(length, self.length_before);
        self.force = ends.or_old(force, self.force);
        self.speed = ends.or_old(speed, self.speed);
        for ([least, greatest], now) in [(&mut self.forces, force), (&mut self.speeds, speed)] {
            *least = ends.or_old(-(-now).max_of(-*least), *least);
            *greatest = ends.or_old(now.max_of(*greatest), *greatest);
        }
    }

    /// Takes note of force and speed at the end of an accepted step of a `lane`, at time `t` (s), and of their extremes since the last
    /// note.
    #[inline(always)]
    pub fn note(&mut self, lane: usize, t: f64) {
        let mark = self.mark(lane, t);
        self.windows[lane].note(mark);
    }

    /// Forgets the extremes of the lanes that are `noted`, above 0. At once, since a register waits for lanes that are written one by one.
    #[inline(always)]
    pub fn forget_extremes(&mut self, noted: Pack<V>) {
        let zero = Pack::splat(0.0);
        for [least, greatest] in [&mut self.forces, &mut self.speeds] {
            *least = noted.select_gt(zero, Pack::splat(f32::INFINITY), *least);
            *greatest = noted.select_gt(zero, Pack::splat(f32::NEG_INFINITY), *greatest);
        }
    }

    fn mark(&self, lane: usize, t: f64) -> Mark {
        let of = |[least, greatest]: [Pack<V>; 2], now: Pack<V>| {
            let now = now.get(lane);
            Reading { now, least: least.get(lane).min(now), greatest: greatest.get(lane).max(now) }
        };
        Mark { t, force: of(self.forces, self.force), speed: of(self.speeds, self.speed) }
    }

    /// Writes what is known of the unit in a `lane` at its end, time `t` (s), to `figures`.
    pub fn conclude(&self, lane: usize, t: f64, figures: &mut Figures) {
        figures.breakaway = self.breakaway.get(lane);
        figures.peak_force = self.peak.get(lane);
        let end = self.mark(lane, t);
        let within = self.windows[lane].within(end);
        figures.settled_force = settled_force(&within);
        figures.end_speeds = extremes(within.iter().map(|mark| mark.speed));
        let deepest = (0..CONTACTS).max_by(|i, j| self.depths[*i].get(lane).total_cmp(&self.depths[*j].get(lane)));
        let deepest = deepest.unwrap_or(0);
        figures.contact = deepest as u8;
        figures.depth = self.depths[deepest].get(lane);
        figures.end = t as f32;
    }
}

/// A number at one time, and its extremes since the last note.
#[derive(Clone, Copy)]
struct Reading {
    now: f32,
    least: f32,
    greatest: f32,
}

/// Force and speed at the time `t` (s).
#[derive(Clone, Copy)]
struct Mark {
    t: f64,
    force: Reading,
    speed: Reading,
}

/// Forces and speeds of the last 20 ms and more.
#[derive(Clone, Copy)]
struct Window {
    marks: [Mark; 2 * SAMPLES],
    count: usize,
}

impl Window {
    const EMPTY: Self = {
        let none = Reading { now: 0.0, least: 0.0, greatest: 0.0 };
        Self { marks: [Mark { t: f64::NEG_INFINITY, force: none, speed: none }; 2 * SAMPLES], count: 0 }
    };

    fn clear(&mut self) {
        *self = Self::EMPTY;
    }

    #[inline(always)]
    fn note(&mut self, mark: Mark) {
        self.marks[self.count % (2 * SAMPLES)] = mark;
        self.count += 1;
    }

    /// The marks of the last 20 ms up to `end`, in order of time. The first is where the window begins: between the last mark before and the
    /// first within, if there is one before. A step may be as long as the window, so that one of them alone says nothing of it.
    fn within(&self, end: Mark) -> Vec<Mark> {
        let begin = end.t - SETTLED_WINDOW * (1.0 + 1e-9);
        let mark = |i: usize| self.marks[i % (2 * SAMPLES)];
        let earliest = self.count.saturating_sub(2 * SAMPLES);
        // A mark at the end itself says the same again.
        let last = self.count - usize::from(self.count > 0 && mark(self.count - 1).t >= end.t);
        let inside = (earliest..last).rev().take_while(|i| mark(*i).t >= begin).count();
        let mut first = if inside > 0 { mark(last - inside) } else { end };
        let mut within = Vec::with_capacity(inside + 2);
        if last - inside > earliest {
            let before = mark(last - inside - 1);
            let share = ((begin - before.t) / (first.t - before.t)) as f32;
            let at_begin = |before: Reading, first: Reading| {
                let now = before.now + share * (first.now - before.now);
                Reading { now, least: now, greatest: now }
            };
            let force = at_begin(before.force, first.force);
            let speed = at_begin(before.speed, first.speed);
            // Its extremes may be from before the window.
            for reading in [&mut first.force, &mut first.speed] {
                (reading.least, reading.greatest) = (reading.now, reading.now);
            }
            within.push(Mark { t: begin, force, speed });
        }
        within.push(first);
        within.extend((last - inside + 1..last).map(mark).chain((inside > 0).then_some(end)));
        within
    }
}

/// The mean force over the `marks` of a window, if it varies by less than 1 %; else NaN.
fn settled_force(marks: &[Mark]) -> f32 {
    let [least, greatest] = extremes(marks.iter().map(|mark| mark.force));
    let mean = settled(marks.iter().map(|mark| (mark.t, f64::from(mark.force.now))));
    // Between the notes, too.
    let mean = mean.filter(|mean| f64::from(greatest - least) < SETTLED_SHARE * mean.abs());
    mean.map_or(f32::NAN, |mean| mean as f32)
}

/// The least and the greatest of `readings`.
fn extremes(readings: impl Iterator<Item = Reading>) -> [f32; 2] {
    readings.fold([f32::INFINITY, f32::NEG_INFINITY], |[least, greatest], reading| {
        [least.min(reading.least), greatest.max(reading.greatest)]
    })
}

#[cfg(test)]
mod tests {
    use super::{Ends, Figures, Mark, Reading, SAMPLES, Watch, Window, extremes, settled_force};
    use crate::pack::Pack;
    use slipfit_core::{Scalar, slide::CONTACTS};

    fn mark(t: f64, [force, speed]: [f32; 2]) -> Mark {
        let reading = |now| Reading { now, least: now, greatest: now };
        Mark { t, force: reading(force), speed: reading(speed) }
    }

    fn settled(window: &Window, end: Mark) -> f32 {
        settled_force(&window.within(end))
    }

    fn speeds(window: &Window, end: Mark) -> [f32; 2] {
        extremes(window.within(end).iter().map(|mark| mark.speed))
    }

    #[test]
    fn a_window_knows_the_last_twenty_milliseconds() {
        let mut window = Window::EMPTY;
        // One note a millisecond, the speed ever slower.
        for k in 0..3 * SAMPLES as u32 {
            window.note(mark(f64::from(k) * 1e-3, [2.0, 0.2 - 1e-3 * k as f32]));
        }
        let end = mark((3 * SAMPLES) as f64 * 1e-3, [2.0, 0.05]);
        let [least, greatest] = speeds(&window, end);
        assert_eq!(least, 0.05);
        assert!((greatest - (0.2 - 1e-3 * (3 * SAMPLES - 20) as f32)).abs() < 1e-6, "{greatest}");
        assert_eq!(settled(&window, end), 2.0);
        assert_eq!(speeds(&Window::EMPTY, end), [0.05; 2]);
    }

    #[test]
    fn a_force_that_changes_within_one_long_step_or_between_two_notes_has_not_settled() {
        let mut window = Window::EMPTY;
        // Steps of 15 ms: the last of them, and a part of the one before, are the window. It rises by 1.3 % in 20 ms.
        for k in 0..4 {
            window.note(mark(0.015 * f64::from(k), [2.0 + 0.02 * k as f32, 0.1]));
        }
        assert!(settled(&window, mark(0.06, [2.08, 0.1])).is_nan());
        // At a tenth of that it has: the mean is that of the middle of the window.
        let mut window = Window::EMPTY;
        for k in 0..4 {
            window.note(mark(0.015 * f64::from(k), [2.0 + 0.002 * k as f32, 0.1]));
        }
        let mean = settled(&window, mark(0.06, [2.008, 0.1]));
        assert!((mean - (2.008 - 0.002 * 10.0 / 15.0)).abs() < 1e-6, "{mean}");
        let mut burst = mark(0.055, [2.0073, 0.1]);
        burst.force.greatest = 2.05;
        window.note(burst);
        assert!(settled(&window, mark(0.06, [2.008, 0.1])).is_nan());
    }

    /// A force that is steady but for a burst in the run's last half millisecond, whose end is noted.
    #[test]
    fn what_happens_right_before_the_end_counts() {
        type One = Pack<pulp::Scalar>;
        for (burst, has_settled) in [(2.0, true), (2.05, false)] {
            let mut watch = Watch::<pulp::Scalar>::new();
            // Steps of a quarter of a millisecond; a note after every fourth.
            let mut figures = Figures::NONE;
            for k in 1..=120u32 {
                let (force, t) = (if k == 119 { burst } else { 2.0 }, 0.25e-3 * f64::from(k));
                watch.observe(&Ends {
                    accepted: One::splat(1.0),
                    start: One::from_f64(t - 0.25e-3),
                    length: One::from_f64(0.25e-3),
                    force: One::splat(force),
                    speed: One::splat(0.1),
                    gaps: &[One::splat(1.0); CONTACTS],
                    ramp_start: One::splat(0.0),
                });
                if k % 4 == 0 {
                    watch.note(0, t);
                    if k == 120 {
                        watch.conclude(0, t, &mut figures);
                    }
                    watch.forget_extremes(One::splat(1.0));
                }
            }
            assert_eq!(!figures.settled_force.is_nan(), has_settled, "{burst}");
        }
    }
}
