//! What is kept of units while they move: figures, not runs.

use pulp::Simd;
use slipfit_core::{Scalar, slide::CONTACTS};

use crate::{
    pack::Pack,
    settled::{BREAKAWAY_SPEED, SETTLED_WINDOW, settled},
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
            windows: vec![Window::EMPTY; Pack::<V>::LANES],
        };
        (0..Pack::<V>::LANES).for_each(|lane| watch.clear(lane));
        watch
    }

    /// Forgets what was in a `lane`.
    pub fn clear(&mut self, lane: usize) {
        let Self { breakaway, peak, depths, force, speed, force_before, length_before, windows } = self;
        breakaway.set(lane, f32::NAN);
        peak.set(lane, f32::NEG_INFINITY);
        length_before.set(lane, 1.0);
        depths.iter_mut().chain([force, speed, force_before]).for_each(|pack| pack.set(lane, 0.0));
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
        let [before, middle, last] = [self.force_before, self.force, force].map(|force| force.max_of(-force));
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
    }

    /// Takes note of force and speed at the end of an accepted step of a `lane`, at time `t` (s).
    #[inline(always)]
    pub fn note(&mut self, lane: usize, t: f64) {
        self.windows[lane].note(t, [self.force, self.speed].map(|pack| pack.get(lane)));
    }

    /// Writes what is known of the unit in a `lane` at its end, time `t` (s), to `figures`.
    pub fn conclude(&self, lane: usize, t: f64, figures: &mut Figures) {
        figures.breakaway = self.breakaway.get(lane);
        figures.peak_force = self.peak.get(lane);
        let [force, speed] = [self.force, self.speed].map(|pack| pack.get(lane));
        figures.settled_force = self.windows[lane].settled(t, force);
        figures.end_speeds = self.windows[lane].speeds(t, speed);
        let deepest = (0..CONTACTS).max_by(|i, j| self.depths[*i].get(lane).total_cmp(&self.depths[*j].get(lane)));
        let deepest = deepest.unwrap_or(0);
        figures.contact = deepest as u8;
        figures.depth = self.depths[deepest].get(lane);
        figures.end = t as f32;
    }
}

/// Forces and speeds of the last 20 ms.
#[derive(Clone, Copy)]
struct Window {
    times: [f64; 2 * SAMPLES],
    forces: [f32; 2 * SAMPLES],
    speeds: [f32; 2 * SAMPLES],
    count: usize,
}

impl Window {
    const EMPTY: Self = Self {
        times: [f64::NEG_INFINITY; 2 * SAMPLES],
        forces: [0.0; 2 * SAMPLES],
        speeds: [0.0; 2 * SAMPLES],
        count: 0,
    };

    fn clear(&mut self) {
        self.times.fill(f64::NEG_INFINITY);
        self.count = 0;
    }

    #[inline(always)]
    fn note(&mut self, t: f64, [force, speed]: [f32; 2]) {
        let at = self.count % (2 * SAMPLES);
        (self.times[at], self.forces[at], self.speeds[at]) = (t, force, speed);
        self.count += 1;
    }

    /// What was noted in the last 20 ms before `end` (s).
    fn within(&self, end: f64) -> impl Iterator<Item = usize> {
        let times = &self.times;
        (0..2 * SAMPLES).filter(move |i| times[*i] >= end - SETTLED_WINDOW * (1.0 + 1e-9) && times[*i] < end)
    }

    /// The mean force, if it varies by less than 1 %, over the last 20 ms before `end` (s), where it is `force` (N).
    fn settled(&self, end: f64, force: f32) -> f32 {
        let mut marks: Vec<(f64, f64)> = self.within(end).map(|i| (self.times[i], f64::from(self.forces[i]))).collect();
        marks.push((end, f64::from(force)));
        marks.sort_by(|one, other| one.0.total_cmp(&other.0));
        settled(marks.iter().copied()).map_or(f32::NAN, |mean| mean as f32)
    }

    /// The least and the greatest speed over the same time, at whose end it is `speed` (m/s).
    fn speeds(&self, end: f64, speed: f32) -> [f32; 2] {
        self.within(end)
            .map(|i| self.speeds[i])
            .fold([speed; 2], |[least, greatest], speed| [least.min(speed), greatest.max(speed)])
    }
}

#[cfg(test)]
mod tests {
    use super::{SAMPLES, Window};

    #[test]
    fn a_window_knows_the_last_twenty_milliseconds() {
        let mut window = Window::EMPTY;
        // One note a millisecond, the speed ever slower.
        for k in 0..3 * SAMPLES as u32 {
            window.note(f64::from(k) * 1e-3, [2.0, 0.2 - 1e-3 * k as f32]);
        }
        let end = (3 * SAMPLES) as f64 * 1e-3;
        let [least, greatest] = window.speeds(end, 0.05);
        assert_eq!((least, greatest), (0.05, 0.2 - 1e-3 * (3 * SAMPLES - 20) as f32));
        assert_eq!(window.settled(end, 2.0), 2.0);
        assert_eq!(Window::EMPTY.speeds(end, 0.05), [0.05; 2]);
    }
}
